//! `ASSERT_NEAR`: the distance of two numbers. For integers it is exact, even where their own type cannot hold it.

use super::assertion::Claim;
use crate::ast;
use crate::expr::checker::Checker;
use crate::expr::operand::Operand;
use crate::types::coercion::as_number;
use crate::{Span, ast::BinaryOp};
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, Op, Type, Value};

const LINT: Type = Type::Elementary(Elementary::Lint);
const ULINT: Type = Type::Elementary(Elementary::Ulint);

/// What a distance is at most, in words.
pub(super) const WITHIN: &str = "to be within {tolerance} of {}";

impl<'s> Checker<'_, 's> {
    /// `ABS(actual - expected) <= tolerance`.
    pub(super) fn near(&mut self, both: [&ast::Expr<'s>; 2], tolerance: &ast::Expr<'s>, span: Span) -> Option<Claim> {
        let [left, right] = both;
        let sides = self.sides(both, BinaryOp::Sub, span)?;
        let values = [sides.a.clone(), sides.b.clone()];
        let difference = self.combine(sides)?;
        if values.iter().all(is_integer) {
            return self.near_integers(values, both, tolerance, span);
        }
        let difference = self.materialise(difference, None, span)?;
        let ty = difference.ty;
        let (difference, [actual, expected]) = if let ExprKind::Apply(op, operands) = difference.kind {
            let [a, b] = <[Expr; 2]>::try_from(operands).ok()?;
            let (a, actual) = self.keep("actual", a, left.span)?;
            let (b, expected) = self.keep("expected", b, right.span)?;
            (Expr::new(ty, ExprKind::Apply(op, vec![a, b]), difference.at), [actual, expected])
        } else {
            (difference, self.keep_constants(values, both)?)
        };
        let distance = self.apply(Op::Abs, ty, vec![difference], ty, span)?;
        let limit = self.value(tolerance, ty)?;
        let (limit, kept) = self.keep("tolerance", limit, tolerance.span)?;
        let holds = self.apply(Op::Le, ty, vec![distance, limit], Type::BOOL, span)?;
        Some(Claim { tolerance: Some(kept), ..Claim::of(holds, WITHIN, actual, expected) })
    }

    fn near_integers(
        &mut self,
        [a, b]: [Operand; 2],
        [left, right]: [&ast::Expr<'s>; 2],
        tolerance: &ast::Expr<'s>,
        span: Span,
    ) -> Option<Claim> {
        let hints = [b.ty(), a.ty()];
        let a = self.materialise(a.read(), hints[0], left.span)?;
        let b = self.materialise(b.read(), hints[1], right.span)?;
        let (a, actual) = self.keep("actual", a, left.span)?;
        let (b, expected) = self.keep("expected", b, right.span)?;
        let limit = self.operand(tolerance, Some(a.ty))?;
        let limit = match limit.clone().read() {
            Operand::Integer(0..) => self.materialise(limit, Some(ULINT), tolerance.span)?,
            it if is_integer(&it) => self.materialise(it, Some(LINT), tolerance.span)?,
            it => self.coerce(it, a.ty, tolerance.span)?,
        };
        let (limit, kept) = self.keep("tolerance", limit, tolerance.span)?;
        let holds = self.are_near([a, b], limit, span)?;
        Some(Claim { tolerance: Some(kept), ..Claim::of(holds, WITHIN, actual, expected) })
    }

    /// Whether the distance of two integers is at most `limit`.
    fn are_near(&mut self, [a, b]: [Expr; 2], limit: Expr, span: Span) -> Option<Expr> {
        let (a, b) = (self.widened(a), self.widened(b));
        let is_not_negative = self.is_not_negative(&limit, span)?;
        let limit = self.convert(Conversion::Value, ULINT, limit);
        let (less, greater) = (self.is_less(&a, &b, span)?, self.is_less(&b, &a, span)?);
        let above = self.is_within([&b, &a], &limit, span)?;
        let below = self.is_within([&a, &b], &limit, span)?;
        let not_less = self.apply(Op::Not, Type::BOOL, vec![less], Type::BOOL, span)?;
        let not_greater = self.apply(Op::Not, Type::BOOL, vec![greater], Type::BOOL, span)?;
        let above = self.apply(Op::And, Type::BOOL, vec![not_less, above], Type::BOOL, span)?;
        let below = self.apply(Op::And, Type::BOOL, vec![not_greater, below], Type::BOOL, span)?;
        let either = self.apply(Op::Or, Type::BOOL, vec![above, below], Type::BOOL, span)?;
        self.apply(Op::And, Type::BOOL, vec![is_not_negative, either], Type::BOOL, span)
    }

    /// An integer as LINT, or, where it has no sign, as ULINT.
    fn widened(&mut self, value: Expr) -> Expr {
        let is_signed = value.ty.elementary().is_some_and(|it| it.repr().is_signed());
        self.convert(Conversion::Value, if is_signed { LINT } else { ULINT }, value)
    }

    /// Whether `high - low`, where `low` is not above `high`, is at most `limit`. The difference has no sign, and is right in
    /// 64 bits, but for a ULINT above a negative number: there it may be more than any limit.
    fn is_within(&mut self, [low, high]: [&Expr; 2], limit: &Expr, span: Span) -> Option<Expr> {
        let [from, to] = [low, high].map(|it| self.convert(Conversion::Value, ULINT, it.clone()));
        let distance = self.apply(Op::Sub, ULINT, vec![to.clone(), from], ULINT, span)?;
        let is_within = self.apply(Op::Le, ULINT, vec![distance.clone(), limit.clone()], Type::BOOL, span)?;
        if low.ty == high.ty || low.ty != LINT {
            return Some(is_within);
        }
        let is_positive = self.is_not_negative(low, span)?;
        let is_whole = self.apply(Op::Ge, ULINT, vec![distance, to], Type::BOOL, span)?;
        let is_right = self.apply(Op::Or, Type::BOOL, vec![is_positive, is_whole], Type::BOOL, span)?;
        self.apply(Op::And, Type::BOOL, vec![is_right, is_within], Type::BOOL, span)
    }

    /// `a < b`, of a LINT and a ULINT by what they are.
    fn is_less(&mut self, a: &Expr, b: &Expr, span: Span) -> Option<Expr> {
        if a.ty == b.ty {
            return self.apply(Op::Lt, a.ty, vec![a.clone(), b.clone()], Type::BOOL, span);
        }
        let [x, y] = [a, b].map(|it| self.convert(Conversion::Value, ULINT, it.clone()));
        let is_less = self.apply(Op::Lt, ULINT, vec![x, y], Type::BOOL, span)?;
        let is_positive = self.is_not_negative(if a.ty == LINT { a } else { b }, span)?;
        if a.ty == LINT {
            let is_negative = self.apply(Op::Not, Type::BOOL, vec![is_positive], Type::BOOL, span)?;
            return self.apply(Op::Or, Type::BOOL, vec![is_negative, is_less], Type::BOOL, span);
        }
        self.apply(Op::And, Type::BOOL, vec![is_positive, is_less], Type::BOOL, span)
    }

    fn is_not_negative(&mut self, value: &Expr, span: Span) -> Option<Expr> {
        let at = self.at(span);
        if value.ty.elementary().is_some_and(|it| !it.repr().is_signed()) {
            return Some(Expr::bool(true, at));
        }
        let value = self.convert(Conversion::Value, LINT, value.clone());
        let zero = Expr::constant(Elementary::Lint, Value::I64(0), at);
        self.apply(Op::Ge, LINT, vec![value, zero], Type::BOOL, span)
    }
}

/// Whether it is an integer, or a bit string that counts as one.
fn is_integer(operand: &Operand) -> bool {
    match operand.clone().read().ty() {
        Some(Type::Elementary(ty)) => as_number(ty).is_integer(),
        Some(_) => false,
        None => matches!(operand, Operand::Integer(_)),
    }
}
