//! `s[i]`: a character of a string. In the standard they are CHARs and count from 1; in CODESYS they are bytes, or
//! WORDs of a WSTRING, and count from 0 up to the zero after the last one.

use super::checker::Checker;
use crate::dialect::Dialect;
use crate::{Code, Diagnostic, Span, ast};
use ast::ExprKind as Ast;
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, Op, StringType, TextOp, Type, Value};

impl<'s> Checker<'_, 's> {
    /// The string and the index, where the expression is a character of a string.
    pub(crate) fn character_of<'a>(&self, expr: &'a ast::Expr<'s>) -> Option<(&'a ast::Expr<'s>, &'a ast::Expr<'s>)> {
        let Ast::Index(text, indices) = &expr.kind else { return None };
        let [index] = indices.as_slice() else { return None };
        first_character(self.decl.dialect(expr.span))?;
        matches!(self.static_type(text), Some(Type::String(_))).then_some((text, index))
    }

    /// The character as a value.
    pub(super) fn character_value(&mut self, text: &ast::Expr<'s>, index: &ast::Expr<'s>) -> Option<Expr> {
        let mut whole = self.typed(text, None)?;
        let ty = whole.ty.string_type()?;
        let position = self.after(&mut [&mut whole], |this| this.character_index(index, ty))?;
        let (op, made) = match ty.wide {
            true => (TextOp::WcharAt, Elementary::Wchar),
            false => (TextOp::CharAt, Elementary::Char),
        };
        let at = self.at(index.span);
        let value = Expr::new(Type::Elementary(made), ExprKind::ApplyText(op, vec![whole, position]), at);
        let value = self.evaluated(value, index.span)?;
        let to = self.character_type(ty, index.span);
        Some(self.convert(Conversion::Value, to, value))
    }

    /// What a character is where the program reads or assigns it.
    pub(crate) fn character_type(&self, ty: StringType, span: Span) -> Type {
        let counts = self.decl.dialect(span).mixes_bits_and_integers();
        Type::Elementary(match (ty.wide, counts) {
            (false, false) => Elementary::Char,
            (true, false) => Elementary::Wchar,
            (false, true) => Elementary::Byte,
            (true, true) => Elementary::Word,
        })
    }

    /// The string with another character.
    pub(crate) fn with_character(&mut self, text: Expr, position: Expr, character: Expr, span: Span) -> Option<Expr> {
        let ty = text.ty.string_type()?;
        let (op, of) = match ty.wide {
            true => (TextOp::WithWchar, Elementary::Wchar),
            false => (TextOp::WithChar, Elementary::Char),
        };
        let character = self.convert(Conversion::Value, Type::Elementary(of), character);
        let at = self.at(span);
        Some(Expr::new(Type::String(ty), ExprKind::ApplyText(op, vec![text, position, character]), at))
    }

    /// The number of characters before the one that an index names; outside of the string's capacity, a fault.
    pub(crate) fn character_index(&mut self, index: &ast::Expr<'s>, ty: StringType) -> Option<Expr> {
        let first = first_character(self.decl.dialect(index.span))?;
        let last = i64::from(ty.capacity);
        let value = self.integer_index(index)?;
        if let Some(number) = value.as_const().and_then(Value::as_integer)
            && !(i128::from(first)..=i128::from(last)).contains(&number)
        {
            self.report(
                Diagnostic::new(Code::E0208, index.span, format!("the index {number} is out of range"))
                    .label(format!("the characters are numbered from {first} to {last}")),
            );
            return None;
        }
        let at = self.at(index.span);
        let value = self.as_lint(value, index.span)?;
        let bound = |it: i64| Expr::constant(Elementary::Lint, Value::I64(it), at);
        let value =
            self.apply(Op::CheckIndex, Type::LINT, vec![bound(first), value, bound(last)], Type::LINT, index.span)?;
        match first {
            0 => Some(value),
            first => self.apply(Op::Sub, Type::LINT, vec![value, bound(first)], Type::LINT, index.span),
        }
    }
}

/// Whether a string has characters that an index names.
pub(super) const fn has_characters(dialect: Dialect) -> bool {
    first_character(dialect).is_some()
}

/// The index of a string's first character, in dialects that have one.
const fn first_character(dialect: Dialect) -> Option<i64> {
    match dialect {
        Dialect::Iec | Dialect::Openplc | Dialect::Openplc4 | Dialect::Siemens => Some(1),
        Dialect::Codesys => Some(0),
        Dialect::Cscape | Dialect::Logix => None,
    }
}
