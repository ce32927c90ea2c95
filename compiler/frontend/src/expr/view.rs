//! Variables that are some bits of another one: those at a direct address that others share, BITs, and the
//! members of a UNION. Reading and assigning them.

use super::checker::Checker;
use super::part::Bits;
use super::place::Found;
use crate::types::window::Window;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Conversion, Elementary, Expr, Op, Place, Projection, Type, Value};

impl<'s> Checker<'_, 's> {
    /// The type of what is found: a view's own.
    pub(crate) fn type_of(&self, found: &Found<'s>) -> Type {
        found.view.map_or(found.place.ty, |it| it.ty)
    }

    /// What is found, unless it is a view: nothing can be handed some bits of a variable.
    pub(crate) fn whole(&mut self, found: Found<'s>, span: Span) -> Option<Found<'s>> {
        let Some(view) = found.view else { return Some(found) };
        self.report_shared(span, view);
        None
    }

    pub(super) fn report_shared(&mut self, span: Span, view: Window) {
        let text = self.decl.log.sources.text(span).to_owned();
        let with = match view.address {
            _ if view.is_packed => {
                return self.report(
                    Diagnostic::new(Code::E0410, span, format!("`{text}` is packed, so it is not a separate variable"))
                        .label("it can be read, assigned, and passed to inputs and outputs")
                        .help("use a separate variable here, and assign it"),
                );
            }
            _ if view.is_selected => {
                return self.report(
                    Diagnostic::new(Code::E0306, span, format!("`{text}` is not a separate variable"))
                        .label("bits of a variable can be read, assigned, and passed to inputs and outputs")
                        .help("use a separate variable here, and assign it"),
                );
            }
            Some(_) => "another address",
            None => "other members",
        };
        self.report(
            Diagnostic::new(Code::E0410, span, format!("`{text}` shares its bits with {with}"))
                .label("it can be read, assigned, and passed to inputs and outputs")
                .help("use a separate variable here, and assign it"),
        );
    }

    /// Reads a variable, or the bits that one is.
    pub(crate) fn read(&mut self, place: Place, view: Option<Window>, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let Some(view) = view else { return Some(Expr::load(place, at)) };
        match view.ty {
            Type::Array(_) | Type::Struct(_) => self.read_whole(&place, view, span),
            Type::String(it) => self.read_text(&place, view, it, span),
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Block(_) | Type::Reference(_) => {
                self.read_number(place, view, span)
            }
        }
    }

    fn read_number(&mut self, mut place: Place, view: Window, span: Span) -> Option<Expr> {
        let at = self.at(span);
        self.save_last_index(&mut place, view);
        let units = self.units(&place, view, span)?;
        if let ([(unit, bits)], true) = (units.as_slice(), view.is_bit) {
            let value = self.unsigned(Expr::load(unit.clone(), at));
            return self.bits(value, *bits, view.ty, span);
        }
        if let [(unit, bits)] = units.as_slice() {
            let value = self.unsigned(Expr::load(unit.clone(), at));
            let value = self.shifted(Op::Shr, value, bits.shift, span)?;
            return self.of_bits(value, view.ty, span);
        }
        let whole = Type::Elementary(unsigned(self.decl.program.repr(view.ty)?.size()));
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
        self.of_bits(value?, view.ty, span)
    }

    /// The low bits of an unsigned number, as a value of another type.
    fn of_bits(&mut self, value: Expr, ty: Type, span: Span) -> Option<Expr> {
        let repr = self.decl.program.repr(ty)?;
        let low = Type::Elementary(unsigned(repr.size()));
        match ty.read() {
            Type::Elementary(it) if it.is_real() => {
                let value = self.convert(Conversion::Value, low, value);
                Some(self.convert(Conversion::Bits, ty, value))
            }
            Type::Elementary(Elementary::Bool) => {
                let value = self.convert(Conversion::Value, low, value);
                Some(self.convert(Conversion::Value, ty, value))
            }
            Type::Elementary(it) if it.is_day() || it.is_time_of_day() => {
                let number = self.convert(Conversion::Value, Type::LINT, value);
                self.as_time(number, it, span)
            }
            Type::Enum(id) => {
                let base = Type::Elementary(self.decl.program.enumeration(id).base);
                let number = self.convert(Conversion::Value, base, value);
                Some(self.convert(Conversion::Same, ty, number))
            }
            // Of a UNION of pointers alone.
            Type::Reference(_) => Some(self.convert(Conversion::Same, ty, value)),
            read => Some(self.convert(Conversion::Value, read, value)),
        }
    }

    /// A value as an unsigned number of its width.
    fn as_bits(&mut self, value: Expr) -> Option<Expr> {
        let bits = Type::Elementary(unsigned(self.decl.program.repr(value.ty)?.size()));
        Some(match value.ty.read() {
            Type::Elementary(it) if it.is_real() => self.convert(Conversion::Bits, bits, value),
            Type::Enum(id) => {
                let base = Type::Elementary(self.decl.program.enumeration(id).base);
                let number = self.convert(Conversion::Same, base, value);
                self.convert(Conversion::Value, bits, number)
            }
            Type::Reference(_) => self.convert(Conversion::Same, bits, value),
            _ => self.convert(Conversion::Value, bits, value),
        })
    }

    /// Assigns to a variable, or to the bits that one is.
    pub(crate) fn write(&mut self, place: Place, view: Option<Window>, value: Expr, span: Span) -> Option<()> {
        let Some(view) = view else {
            self.assign(place, value, span);
            return Some(());
        };
        match view.ty {
            Type::Array(_) | Type::Struct(_) => self.write_whole(&place, view, value, span),
            Type::String(it) => self.write_text(&place, view, it, value, span),
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Block(_) | Type::Reference(_) => {
                self.write_number(place, view, value, span)
            }
        }
    }

    fn write_number(&mut self, mut place: Place, view: Window, mut value: Expr, span: Span) -> Option<()> {
        self.save_last_index(&mut place, view);
        let units = self.units(&place, view, span)?;
        if let ([(unit, bits)], true) = (units.as_slice(), view.is_bit) {
            return self.merge(unit.clone(), *bits, value, span);
        }
        if let [(unit, bits)] = units.as_slice() {
            let value = self.as_bits(value)?;
            if bits.shift == 0 && self.decl.program.repr(unit.ty).is_some_and(|it| it.size() * 8 == bits.width) {
                let value = self.convert(Conversion::Value, unit.ty.read(), value);
                let value = self.coerce(super::operand::Operand::Typed(value), unit.ty, span)?;
                self.assign(unit.clone(), value, span);
                return Some(());
            }
            return self.merge(unit.clone(), *bits, value, span);
        }
        // Its parts are assigned one after the other, and may be what the value is made of.
        if value.as_const().is_none() {
            self.save("shared", &mut value);
        }
        let value = self.as_bits(value)?;
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
        let at = self.at(span);
        let old = self.as_number(Expr::load(place.clone(), at));
        let ty = old.ty.read();
        let Type::Elementary(whole) = ty else { return None };
        let unsigned = unsigned(whole.repr().size());
        let mask = unsigned.repr().integer(((1i128 << bits.width) - 1) << bits.shift)?;
        let mask = self.convert(Conversion::Value, ty, Expr::constant(unsigned, mask, at));
        let kept = self.apply(Op::Not, ty, vec![mask.clone()], ty, span)?;
        let cleared = self.apply(Op::And, ty, vec![old, kept], ty, span)?;
        let value = self.convert(Conversion::Value, ty, value);
        let shifted = self.shifted(Op::Shl, value, bits.shift, span)?;
        // A signed part's sign bits do not spill over its neighbours.
        let shifted = self.apply(Op::And, ty, vec![shifted, mask], ty, span)?;
        // The value is computed before what a reference leads to is read.
        let is_before = place.is_followed() && self.can_fault(&shifted);
        let parts = if is_before { vec![shifted, cleared] } else { vec![cleared, shifted] };
        let merged = self.apply(Op::Or, ty, parts, ty, span)?;
        let merged = match place.ty.read() {
            Type::Enum(_) => self.convert(Conversion::Same, place.ty, merged),
            _ => self.coerce(super::operand::Operand::Typed(merged), place.ty, span)?,
        };
        self.assign(place, merged, span);
        Some(())
    }

    /// An enumeration's value is its number, another value itself.
    fn as_number(&mut self, value: Expr) -> Expr {
        let Type::Enum(id) = value.ty else { return value };
        let base = Type::Elementary(self.decl.program.enumeration(id).base);
        self.convert(Conversion::Same, base, value)
    }

    /// Some bits of an integer, as a value of type `ty`.
    pub(crate) fn bits(&mut self, value: Expr, bits: Bits, ty: Type, span: Span) -> Option<Expr> {
        let value = self.as_number(value);
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
        let value = self.as_number(value);
        match value.ty {
            Type::Elementary(it) => {
                self.convert(Conversion::Value, Type::Elementary(unsigned(it.repr().size())), value)
            }
            _ => value,
        }
    }

    /// Saves the last index on the way to a view of several elements, which each of them is found by.
    fn save_last_index(&mut self, place: &mut Place, view: Window) {
        let unit = self.decl.program.repr(place.ty).map_or(0, |it| u64::from(it.size()));
        let bytes = self.decl.size_of(view.ty);
        if let Some(Projection::Index { index, .. }) = place.projections.last_mut()
            && index.as_const().is_none()
            && bytes > unit
            && !view.is_bit
        {
            self.save("index", index);
        }
    }

    /// The integers that hold the bits of a view, the lowest first, and which bits of each.
    fn units(&mut self, place: &Place, view: Window, span: Span) -> Option<Vec<(Place, Bits)>> {
        let width = match view.is_bit {
            true => 1,
            false => self.decl.program.repr(view.ty)?.size() * 8,
        };
        let (unit, at) = (self.unit_of(place)?, self.at(span));
        let size = unit.size() * 8;
        let (first, shift) = (view.bit / u64::from(size), u32::try_from(view.bit % u64::from(size)).ok()?);
        let count = (shift + width).div_ceil(size);
        let elements = (0..u64::from(count)).map(|it| self.further(place, first + it, at));
        Some(elements.map(|it| (it, Bits { shift, width: width.min(size) })).collect())
    }

    /// The number that a view of a UNION's member begins with.
    pub(super) fn first_unit(&mut self, place: &Place, view: Window, span: Span) -> Place {
        let size = self.unit_of(place).map_or(8, |it| u64::from(it.size()) * 8);
        let at = self.at(span);
        self.further(place, view.bit / size, at)
    }

    /// The repr of a place's elements, or of the place where it has none.
    fn unit_of(&self, place: &Place) -> Option<staunch_ir::Repr> {
        match place.ty {
            Type::Array(id) => self.decl.program.repr(self.decl.program.array(id).element),
            ty => self.decl.program.repr(ty),
        }
    }

    /// The element that is so many after the first of an array, or after an element.
    fn further(&self, place: &Place, count: u64, at: staunch_ir::Location) -> Place {
        let count = i64::try_from(count).unwrap_or(i64::MAX);
        self.moved(place, Expr::constant(Elementary::Lint, Value::I64(count), at), at)
    }

    /// The same, where the count is a LINT.
    pub(super) fn moved(&self, place: &Place, by: Expr, at: staunch_ir::Location) -> Place {
        let add = |to: Expr, by: Expr| match (to.as_const(), by.as_const()) {
            (_, Some(Value::I64(0))) => to,
            (Some(Value::I64(a)), Some(Value::I64(b))) => {
                Expr::constant(Elementary::Lint, Value::I64(a.saturating_add(b)), at)
            }
            (Some(Value::I64(0)), _) => by,
            _ => Expr::apply(Op::Add, Type::LINT, vec![to.read(), by], at),
        };
        let mut place = place.clone();
        if let Type::Array(id) = place.ty {
            let array = self.decl.program.array(id);
            let low = Expr::constant(Elementary::Lint, Value::I64(array.low), at);
            return place.index(add(low, by), array.element, at);
        }
        if let Some(Projection::Index { index, .. }) = place.projections.last_mut() {
            let first = std::mem::replace(&mut **index, Expr::bool(false, at));
            **index = add(first, by);
        }
        place
    }
}

/// The bit string of so many bytes, whose values are all bit patterns.
fn unsigned(size: u32) -> Elementary {
    match size {
        1 => Elementary::Byte,
        2 => Elementary::Word,
        4 => Elementary::Dword,
        _ => Elementary::Lword,
    }
}
