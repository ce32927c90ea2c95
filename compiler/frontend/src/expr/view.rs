//! Variables that are some bits of another one: reading and assigning them.

use super::checker::Checker;
use super::place::{Bits, Found};
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Conversion, Elementary, Expr, Op, Place, Type, Value, View};

impl<'s> Checker<'_, 's> {
    /// The type of what is found: a view's own.
    pub(crate) fn type_of(&self, found: &Found<'s>) -> Type {
        found.view.map_or(found.place.ty, |it| Type::Elementary(it.ty))
    }

    /// What is found, unless it is a view: nothing can be handed some bits of a variable.
    pub(crate) fn whole(&mut self, found: Found<'s>, span: Span) -> Option<Found<'s>> {
        if found.view.is_none() {
            return Some(found);
        }
        let text = self.decl.log.sources.text(span).to_owned();
        self.report(
            Diagnostic::new(Code::E0410, span, format!("`{text}` shares its bits with another address"))
                .label("it can be read and assigned, and be given to inputs and outputs")
                .help("use a variable of its own here, and assign that"),
        );
        None
    }

    /// Reads a variable, or the bits that one is.
    pub(crate) fn read(&mut self, place: Place, view: Option<View>, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let Some(view) = view else { return Some(Expr::load(place, at)) };
        let units = self.units(&place, view, span)?;
        let ty = Type::Elementary(view.ty);
        if let [(unit, bits)] = units.as_slice() {
            let value = self.unsigned(Expr::load(unit.clone(), at));
            return self.bits(value, *bits, ty, span);
        }
        let whole = Type::Elementary(of_bits(view.ty));
        let mut shift = 0;
        let mut value: Option<Expr> = None;
        for (unit, bits) in units {
            let part = self.unsigned(Expr::load(unit, at));
            let part = self.convert(Conversion::Value, whole, part);
            let part = self.shifted(Op::Shl, part, shift, span)?;
            value = Some(match value {
                Some(lower) => self.apply(Op::Or, whole, vec![lower, part], whole, span)?,
                None => part,
            });
            shift += bits.width;
        }
        Some(self.convert(Conversion::Value, ty, value?))
    }

    /// Assigns to a variable, or to the bits that one is.
    pub(crate) fn write(&mut self, place: Place, view: Option<View>, mut value: Expr, span: Span) -> Option<()> {
        let Some(view) = view else {
            self.assign(place, value, span);
            return Some(());
        };
        let units = self.units(&place, view, span)?;
        if let [(unit, bits)] = units.as_slice() {
            return self.merge(unit.clone(), *bits, value, span);
        }
        // Its parts are assigned one after the other, and may be what the value is made of.
        if value.as_const().is_none() {
            self.save("shared", &mut value);
        }
        let value = self.convert(Conversion::Value, Type::Elementary(of_bits(view.ty)), value);
        let mut shift = 0;
        for (unit, bits) in units {
            let part = self.shifted(Op::Shr, value.clone(), shift, span)?;
            let part = self.convert(Conversion::Value, unit.ty, part);
            self.assign(unit, part, span);
            shift += bits.width;
        }
        Some(())
    }

    /// Gives some bits of an integer another value; the others stay.
    pub(crate) fn merge(&mut self, place: Place, bits: Bits, value: Expr, span: Span) -> Option<()> {
        let (at, ty) = (self.at(span), place.ty.read());
        let Type::Elementary(whole) = ty else { return None };
        let unsigned = of_bits(whole);
        let mask = unsigned.repr().integer(((1i128 << bits.width) - 1) << bits.shift)?;
        let mask = self.convert(Conversion::Value, ty, Expr::constant(unsigned, mask, at));
        let kept = self.apply(Op::Not, ty, vec![mask.clone()], ty, span)?;
        let old = Expr::load(place.clone(), at);
        let cleared = self.apply(Op::And, ty, vec![old, kept], ty, span)?;
        let value = self.convert(Conversion::Value, ty, value);
        let shifted = self.shifted(Op::Shl, value, bits.shift, span)?;
        // A signed part's sign bits do not spill over its neighbours.
        let shifted = self.apply(Op::And, ty, vec![shifted, mask], ty, span)?;
        let merged = self.apply(Op::Or, ty, vec![cleared, shifted], ty, span)?;
        let merged = self.coerce(super::operand::Operand::Typed(merged), place.ty, span)?;
        self.assign(place, merged, span);
        Some(())
    }

    /// Some bits of an integer, as a value of type `ty`.
    pub(crate) fn bits(&mut self, value: Expr, bits: Bits, ty: Type, span: Span) -> Option<Expr> {
        let (whole, at) = (value.ty, value.at);
        let shifted = self.shifted(Op::Shr, value, bits.shift, span)?;
        if ty != Type::BOOL {
            return Some(self.convert(Conversion::Value, ty, shifted));
        }
        let Type::Elementary(of) = whole else { return None };
        let one = Expr::constant(of, of.repr().integer(1)?, at);
        let masked = self.apply(Op::And, whole, vec![shifted, one], whole, span)?;
        Some(self.convert(Conversion::Value, ty, masked))
    }

    fn shifted(&mut self, op: Op, value: Expr, by: u32, span: Span) -> Option<Expr> {
        if by == 0 {
            return Some(value);
        }
        let (ty, at) = (value.ty, value.at);
        let by = Expr::constant(Elementary::Lint, Value::I64(i64::from(by)), at);
        self.apply(op, ty, vec![value, by], ty, span)
    }

    fn unsigned(&mut self, value: Expr) -> Expr {
        match value.ty {
            Type::Elementary(it) => self.convert(Conversion::Value, Type::Elementary(of_bits(it)), value),
            _ => value,
        }
    }

    /// The integers that hold the bits of a view, the lowest first, and which bits of each.
    fn units(&mut self, place: &Place, view: View, span: Span) -> Option<Vec<(Place, Bits)>> {
        let width = u32::from(view.address.width);
        let Type::Array(id) = place.ty else {
            return Some(vec![(place.clone(), Bits { shift: u32::try_from(view.bit).ok()?, width })]);
        };
        let (array, at) = (self.decl.program.array(id), self.at(span));
        let size = self.decl.program.repr(array.element)?.size() * 8;
        let first = array.low.checked_add_unsigned(view.bit / u64::from(size))?;
        let shift = u32::try_from(view.bit % u64::from(size)).ok()?;
        let count = width.div_ceil(size);
        let unit = |number: u32| {
            let index = Expr::constant(Elementary::Lint, Value::I64(first + i64::from(number)), at);
            (place.clone().index(index, array.element, at), Bits { shift, width: width.min(size) })
        };
        Some((0..count).map(unit).collect())
    }
}

/// The bit string of the same width, whose values are all bit patterns.
fn of_bits(ty: Elementary) -> Elementary {
    match ty.repr().size() {
        1 => Elementary::Byte,
        2 => Elementary::Word,
        4 => Elementary::Dword,
        _ => Elementary::Lword,
    }
}
