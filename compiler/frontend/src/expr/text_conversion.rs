//! Text of values, and values of text: the functions of the runtime that do it, at each type.

use super::checker::Checker;
use crate::{Span, ast};
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, TextOp, Type, Value};

impl<'s> Checker<'_, 's> {
    /// `x_TO_STRING`.
    pub(super) fn text_of(&mut self, value: Expr, span: Span, name: ast::Name<'s>) -> Option<Expr> {
        if let Type::String(_) = value.ty {
            return Some(value);
        }
        let (value, ty) = self.as_elementary(value, span, name)?;
        let (op, operand, longest) = match ty {
            Elementary::Bool => (TextOp::FromBool, Elementary::Bool, 5),
            Elementary::Real => (TextOp::FromReal, Elementary::Real, 16),
            Elementary::Lreal => (TextOp::FromLreal, Elementary::Lreal, 24),
            Elementary::Ulint | Elementary::Lword => (TextOp::FromUlint, Elementary::Ulint, 20),
            _ if ty.is_time() => (TextOp::FromTime, Elementary::Lint, 40),
            _ => (TextOp::FromLint, Elementary::Lint, 20),
        };
        let mut operands = vec![self.convert(Conversion::Value, Type::Elementary(operand), value)];
        operands.extend(self.kind_of_time(op, ty, name.span));
        let at = self.at(name.span);
        self.evaluated(Expr::new(Type::String(longest), ExprKind::ApplyText(op, operands), at), name.span)
    }

    /// `STRING_TO_x`. An integer takes its low bits of the number that the text spells.
    pub(super) fn value_of_text(&mut self, text: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let (op, made) = match to {
            Elementary::Bool => (TextOp::ToBool, Elementary::Bool),
            Elementary::Real => (TextOp::ToReal, Elementary::Real),
            Elementary::Lreal => (TextOp::ToLreal, Elementary::Lreal),
            Elementary::Ulint | Elementary::Lword => (TextOp::ToUlint, Elementary::Ulint),
            _ if to.is_time() => (TextOp::ToTime, Elementary::Lint),
            _ => (TextOp::ToLint, Elementary::Lint),
        };
        let mut operands = vec![text];
        operands.extend(self.kind_of_time(op, to, span));
        let at = self.at(span);
        let value = Expr::new(Type::Elementary(made), ExprKind::ApplyText(op, operands), at);
        let value = self.evaluated(value, span)?;
        Some(self.convert(Conversion::Value, Type::Elementary(to), value))
    }

    /// The number of a type among all, for the two functions that want it.
    fn kind_of_time(&mut self, op: TextOp, ty: Elementary, span: Span) -> Option<Expr> {
        if !matches!(op, TextOp::FromTime | TextOp::ToTime) {
            return None;
        }
        let number = Elementary::ALL.iter().position(|it| *it == ty)?;
        let number = Value::I64(i64::try_from(number).ok()?);
        Some(Expr::constant(Elementary::Lint, number, self.at(span)))
    }
}
