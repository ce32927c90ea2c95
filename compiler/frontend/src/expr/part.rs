//! Bits that are selected from an integer or bit string: `.3`, `.%B1`, and `.START` where a CONSTANT counts them.

use super::checker::Checker;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::{Code, Diagnostic, ast};
use staunch_ir::{Const, Elementary, Type};
use std::rc::Rc;

/// A part of an integer or bit string: `.3`, `.%W1`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub ty: Elementary,
    pub shift: u32,
}

/// Bits of one integer.
#[derive(Clone, Copy)]
pub(crate) struct Bits {
    pub shift: u32,
    pub width: u32,
}

impl Part {
    pub fn bits(self) -> Bits {
        let width = if self.ty == Elementary::Bool { 1 } else { self.ty.repr().size() * 8 };
        Bits { shift: self.shift, width }
    }
}

impl<'s> Checker<'_, 's> {
    /// What `.3` or `.%W1` selects from a value of type `ty`.
    pub(crate) fn find_part(&mut self, ty: Type, part: ast::Name<'s>) -> Option<Part> {
        let width = match ty {
            Type::Elementary(it) if it.repr().is_integer() && it.is_integral() => it.repr().size() * 8,
            Type::Enum(id) if self.gives_number(id, part.span) => {
                self.decl.program.enumeration(id).base.repr().size() * 8
            }
            other => {
                let found = self.type_name(other);
                self.report(
                    Diagnostic::new(Code::E0204, part.span, format!("{found} has no bits to select"))
                        .label("bits are selected from integers and bit strings"),
                );
                return None;
            }
        };
        let text = part.text.trim_start_matches('%');
        let (of, number) = match text.chars().next().map(|it| it.to_ascii_uppercase()) {
            Some('X') => (Elementary::Bool, &text[1..]),
            Some('B') => (Elementary::Byte, &text[1..]),
            Some('W') => (Elementary::Word, &text[1..]),
            Some('D') => (Elementary::Dword, &text[1..]),
            Some(_) => (Elementary::Bool, text),
            None => return None,
        };
        let size = if of == Elementary::Bool { 1 } else { of.repr().size() * 8 };
        let shift = number.parse::<u32>().ok().and_then(|it| it.checked_mul(size));
        let Some(shift) = shift.filter(|it| it + size <= width) else {
            let found = self.type_name(ty);
            self.report(
                Diagnostic::new(Code::E0208, part.span, format!("`.{}` is outside {found}", part.text))
                    .label(format!("{found} has {width} bits, the first is 0")),
            );
            return None;
        };
        Some(Part { ty: of, shift })
    }

    /// The bit that a CONSTANT counts: `word.START`.
    pub(super) fn bit_by_name(&mut self, ty: Type, name: ast::Name<'s>) -> Option<Option<Part>> {
        let whole = match ty.read() {
            Type::Elementary(it) => it,
            Type::Enum(id) if self.gives_number(id, name.span) => self.decl.program.enumeration(id).base,
            _ => return None,
        };
        let counted = whole.is_integral() && self.decl.dialect(name.span).selects_by_constants();
        let value = counted.then(|| self.constant_named(name)).flatten()?;
        let width = i128::from(whole.repr().size()) * 8;
        let shift = u32::try_from(value).ok().filter(|_| value < width);
        if shift.is_none() {
            let ty = whole.name();
            self.report(
                Diagnostic::new(Code::E0208, name.span, format!("`{}` is {value}, a bit outside {ty}", name.text))
                    .label(format!("{ty} has {width} bits, the first is 0")),
            );
        }
        Some(shift.map(|shift| Part { ty: Elementary::Bool, shift }))
    }

    /// The value of an integer CONSTANT of the POU, or of a global one.
    fn constant_named(&mut self, name: ast::Name<'s>) -> Option<i128> {
        let variable = match self.scope.get(name.text) {
            Some(variable) => Rc::clone(variable),
            None => match self.decl.lookup(&[name], Sense::Value) {
                Found::One(Meaning::Declared(Entry::Global(at))) => self.decl.global(at)?,
                _ => return None,
            },
        };
        self.decl.log.note_declared(name.span, variable.name.span);
        let Const::Scalar(value) = variable.constant_value()? else {
            let zero = self.decl.program.repr(variable.resolved.ty.read())?.zero();
            variable.used.set(true);
            return zero.as_integer();
        };
        variable.used.set(true);
        value.as_integer()
    }
}
