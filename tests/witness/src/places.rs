//! Places: where a variable, or a part of one, lies. Each index is evaluated and checked in its turn.

use crate::classes::{is_super, is_this};
use crate::constants::path;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::statements::Flow;
use crate::storage::{Place, Value, integer_cell};
use crate::types::{Elementary, RefKind, Type};
use staunch_frontend::Span;
use staunch_frontend::ast::{Expr, ExprKind, Name};
use staunch_runtime::{BlockInfo, Direction, FaultKind};

/// A character of a text: how many come before it, and how many there can be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Character {
    pub at: usize,
    pub capacity: usize,
}

/// What `.3` or `.%B1` selects: its type, and the number of its first bit.
struct Part {
    ty: Elementary,
    shift: u32,
    width: u32,
}

impl<'a> Machine<'a> {
    /// What a REFERENCE TO leads to is found where its name is.
    pub(crate) fn place(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<Place<'a>> {
        let place = self.unfollowed(frame, expr)?;
        match place.ty {
            Type::Reference(it) if it.kind == RefKind::Alias => {
                let place = self.checked(place)?;
                let cell = self.memory[place.at].clone();
                self.followed(cell, it, expr.span)
            }
            _ => Ok(place),
        }
    }

    /// The variable itself, where it is a REFERENCE TO.
    pub(crate) fn unfollowed(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<Place<'a>> {
        match &expr.kind {
            ExprKind::Paren(inner) => self.unfollowed(frame, inner),
            ExprKind::Deref(inner) if is_this(inner) || is_super(inner) => this(frame),
            ExprKind::Name(_) if is_this(expr) || is_super(expr) => this(frame),
            ExprKind::Deref(inner) => self.dereferenced(frame, inner, expr.span),
            ExprKind::Name(name) => {
                self.variable(frame, name).map_or_else(|| unknown(&format!("the name {}", name.text)), Ok)
            }
            ExprKind::Member(base, name) => {
                if let Some(global) = self.named_global(frame, expr) {
                    return Ok(global);
                }
                let base = self.receiver(frame, base)?;
                self.member(&base, name.text).map_or_else(|| unknown(&format!("the member {}", name.text)), Ok)
            }
            ExprKind::Index(base, indices) => {
                let mut place = self.place(frame, base)?;
                for index in indices {
                    place = self.element(frame, &place, index)?;
                }
                Ok(place)
            }
            ExprKind::Address(name) => self.at_name(name.text),
            ExprKind::Literal(_)
            | ExprKind::Part(..)
            | ExprKind::Call(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Assign(..)
            | ExprKind::Error(_) => unknown("an expression where a variable is asked for"),
        }
    }

    pub(crate) fn variable(&self, frame: &Frame<'a>, name: &Name<'a>) -> Option<Place<'a>> {
        let global = || self.globals.get(&self.declared.names.variable(&[*name])?);
        frame.names.get(&name.text.to_ascii_uppercase()).or_else(global).cloned()
    }

    /// `Plant.Pumps.level`: what a namespace holds.
    fn named_global(&self, frame: &Frame<'a>, expr: &Expr<'a>) -> Option<Place<'a>> {
        let path = self.outer_path(frame, expr)?;
        self.globals.get(&self.declared.names.variable(&path)?).cloned()
    }

    /// The names of a path that begins with no variable of the body.
    pub(crate) fn outer_path(&self, frame: &Frame<'a>, expr: &Expr<'a>) -> Option<Vec<Name<'a>>> {
        let path = path(expr)?;
        let is_own = frame.names.contains_key(&path.first()?.text.to_ascii_uppercase());
        (!is_own).then_some(path)
    }

    pub(crate) fn member(&self, base: &Place<'a>, name: &str) -> Option<Place<'a>> {
        match &base.ty {
            Type::Record(record) | Type::Union(record) => {
                let number = record.fields.iter().position(|it| it.0.eq_ignore_ascii_case(name))?;
                base.field(number)
            }
            Type::Block(info) => {
                let visible = |it: &staunch_runtime::Pin| it.direction != Direction::Memory;
                let at = info.pins.iter().position(|it| visible(it) && it.name.eq_ignore_ascii_case(name))?;
                Some(base.part(at, &pin_type(info, at)))
            }
            _ => None,
        }
    }

    pub(crate) fn element(&mut self, frame: &Frame<'a>, base: &Place<'a>, index: &'a Expr<'a>) -> Outcome<Place<'a>> {
        let number = self.value(frame, index, None)?.as_integer()?;
        if let (Type::Text(text), None) = (&base.ty, base.window) {
            return self.character(base, *text, number, (FaultKind::IndexOutOfRange, index.span));
        }
        let Type::Array(array) = &base.ty else { return unknown("an index into something other than an array") };
        if !(array.low..=array.high).contains(&number) {
            return Err(self.fault(FaultKind::IndexOutOfRange, index.span));
        }
        let at = usize::try_from(number - array.low).unwrap_or(0);
        base.nth(at).map_or_else(|| unknown("this element"), Ok)
    }

    /// `w.3`, `w.%B1`
    pub(crate) fn part(&mut self, frame: &Frame<'a>, base: &'a Expr<'a>, part: &Name<'a>) -> Outcome<Value<'a>> {
        let whole = self.value(frame, base, None)?;
        let part = part_named(part.text)?;
        let bits = whole.as_integer()? >> part.shift & mask(part.width);
        Ok(Value { ty: Type::Elementary(part.ty), cells: vec![integer_cell(part.ty, bits)] })
    }

    /// The other bits are those that the variable has when the value has been computed.
    pub(crate) fn assign_part(
        &mut self,
        frame: &Frame<'a>,
        place: &Place<'a>,
        part: &Name<'a>,
        value: &'a Expr<'a>,
        at: Span,
    ) -> Outcome<Flow<'a>> {
        let part = part_named(part.text)?;
        let value = self.value_as(frame, value, &Type::Elementary(part.ty))?.as_integer()?;
        let Some(ty) = place.ty.elementary() else { return unknown("bits of something other than a number") };
        let width = ty.repr().size() * 8;
        let place = &self.checked(place.clone())?;
        let old = self.read(place).as_integer()? & mask(width);
        let new = old & !(mask(part.width) << part.shift) | (value & mask(part.width)) << part.shift;
        let signed = if ty.repr().is_signed() && new > ty.range().1 { new - (1 << width) } else { new };
        let whole = Value { ty: Type::Elementary(ty), cells: vec![integer_cell(ty, signed)] };
        let whole = self.converted(whole, &place.ty, at)?;
        self.write(place, &whole);
        Ok(Flow::Next)
    }
}

fn this<'a>(frame: &Frame<'a>) -> Outcome<Place<'a>> {
    frame.this.as_ref().map_or_else(|| unknown("THIS without an instance"), |it| Ok(it.1.clone()))
}

fn mask(width: u32) -> i128 {
    (1 << width) - 1
}

fn part_named(text: &str) -> Outcome<Part> {
    let text = text.trim_start_matches('%');
    let (ty, width, number) = match text.as_bytes().first().map(u8::to_ascii_uppercase) {
        Some(b'X') => (Elementary::Bool, 1, &text[1..]),
        Some(b'B') => (Elementary::Byte, 8, &text[1..]),
        Some(b'W') => (Elementary::Word, 16, &text[1..]),
        Some(b'D') => (Elementary::Dword, 32, &text[1..]),
        Some(_) | None => (Elementary::Bool, 1, text),
    };
    let number: u32 = number.parse().or_else(|_| unknown("this part of a number"))?;
    Ok(Part { ty, shift: number * width, width })
}

/// The type of a standard block's pin.
pub(crate) fn pin_type<'a>(info: &BlockInfo, at: usize) -> Type<'a> {
    Type::Elementary(Elementary::named(info.pins[at].ty.name()).unwrap_or(Elementary::Bool))
}
