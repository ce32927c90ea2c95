//! Operators called by their names: `ADD(a, b, c)` is `a + b + c`; `GT(a, b, c)` is
//! `a > b AND b > c`, with `b` evaluated once.

use super::checker::Checker;
use super::operand::Operand;
use super::operator::{Meeting, Sides, compares};
use crate::dialect::rules::Functions;
use crate::{Span, ast};
use ast::BinaryOp;
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, Op, Projection, Type};

impl<'s> Checker<'_, 's> {
    pub(crate) fn chain(
        &mut self,
        operator: BinaryOp,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        if self.decl.dialect(name.span).rules().promotes_as_c() {
            return self.cut_at_its_type(operator, values, expected, name);
        }
        if compares(operator) && values.len() > 2 {
            return self.comparisons(operator, values, name);
        }
        let is_before_target = self.late.as_ref().is_some_and(|it| it.is_among(values));
        if !values.is_sorted_by_key(|it| it.span.start) || is_before_target {
            return self.folded(operator, values, expected, name);
        }
        let mut values = values.iter();
        let mut tree = (*values.next()?).clone();
        for value in values {
            let span = tree.span.to(value.span);
            let kind = ast::ExprKind::Binary(Box::new([tree, (*value).clone()]), operator, name.span);
            tree = ast::Expr { kind, span };
        }
        self.operand(&tree, expected)
    }

    /// Operands that are not written in the order of their parameters, `SUB(IN2 := b, IN1 := a)`, or with the target of
    /// an ENO.
    fn folded(
        &mut self,
        op: BinaryOp,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        let hint = expected.filter(|_| !compares(op));
        let operands = self.as_written(values, |this, at, side| this.operand(values[at], hint.or(side)))?;
        self.fold_left(op, operands, values, hint, name)
    }

    /// As a C function of its type: what it is given is cut, and what it gives.
    fn cut_at_its_type(
        &mut self,
        op: BinaryOp,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        if compares(op) && values.len() > 2 {
            return self.comparisons(op, values, name);
        }
        let hint = expected.filter(|_| !compares(op));
        let operands =
            self.as_written(values, |this, at, side| Some(this.operand(values[at], hint.or(side))?.cut()))?;
        Some(self.fold_left(op, operands, values, hint, name)?.cut())
    }

    /// An operator on operands of the values, from the left.
    pub(super) fn fold_left(
        &mut self,
        op: BinaryOp,
        operands: Vec<Operand>,
        values: &[&ast::Expr<'s>],
        hint: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        let mut operands = operands.into_iter().zip(values).map(|(operand, value)| (operand, value.span));
        let mut result = operands.next()?;
        for right in operands {
            let span = right.1;
            let matiec = self.decl.dialect(name.span).rules().functions.choice == Functions::OfMatiec;
            let one = match op == BinaryOp::Div && matiec {
                true => self.divided_or_zero(name.span, hint, result, right)?,
                false => self.joined(op, name.span, hint, result, right)?,
            };
            result = (one, span);
        }
        Some(result.0)
    }

    /// `DIV` in MATIEC: 0 where the divisor is 0. A TIME is divided as by the operator.
    fn divided_or_zero(
        &mut self,
        op_span: Span,
        hint: Option<Type>,
        (a, left): (Operand, Span),
        (b, right): (Operand, Span),
    ) -> Option<Operand> {
        let is_time = matches!(a.ty(), Some(Type::Elementary(it)) if it.is_time());
        if is_time {
            return self.joined(BinaryOp::Div, op_span, hint, (a, left), (b, right));
        }
        let a = Operand::Typed(self.materialise(a, hint, left)?);
        let sides = Sides { a, b, left, right, op: BinaryOp::Div, op_span, span: left.to(right), hint };
        let allowed = |ty: Elementary, _: bool| ty.is_integer() || ty.is_real();
        let Meeting { own, a, b, .. } = self.meet(sides, allowed, "both sides need to be numbers")?;
        let [a, b] = [a, b].map(|it| self.convert(Conversion::Value, own, it));
        Some(Operand::Typed(self.apply(Op::DivOrZero, own, vec![a, b], own, op_span)?))
    }

    fn comparisons(&mut self, op: BinaryOp, values: &[&ast::Expr<'s>], name: ast::Name<'s>) -> Option<Operand> {
        let operands = self.as_written(values, |this, at, side| {
            let operand = this.operand(values[at], side)?;
            Some(this.kept_between(operand, at, values.len()))
        })?;
        self.compare_neighbours(op, &operands, values, name)
    }

    /// Each of several operands with the next one.
    pub(super) fn compare_neighbours(
        &mut self,
        op: BinaryOp,
        operands: &[Operand],
        values: &[&ast::Expr<'s>],
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        let mut all: Option<Operand> = None;
        for (at, pair) in operands.windows(2).enumerate() {
            let (left, right) = (values[at].span, values[at + 1].span);
            let one = self.joined(op, name.span, None, (pair[0].clone(), left), (pair[1].clone(), right))?;
            all = Some(match all {
                None => one,
                Some(before) => self.joined(BinaryOp::And, name.span, None, (before, values[0].span), (one, right))?,
            });
        }
        all
    }

    pub(crate) fn joined(
        &mut self,
        op: BinaryOp,
        op_span: Span,
        hint: Option<Type>,
        (a, left): (Operand, Span),
        (b, right): (Operand, Span),
    ) -> Option<Operand> {
        self.combine(Sides { a, b, left, right, op, op_span, span: left.to(right), hint })
    }

    /// The operand at a place among so many that are compared with their neighbours: what is read twice, and more
    /// than a variable, is computed once.
    pub(super) fn kept_between(&mut self, mut operand: Operand, at: usize, count: usize) -> Operand {
        let is_read_twice = at > 0 && at + 1 < count;
        if is_read_twice && let Some(expr) = operand.typed_mut().filter(|it| !is_plain(it)) {
            self.save("saved", expr);
        }
        operand
    }
}

fn is_plain(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Load(place) => place.projections.iter().all(|it| matches!(it, Projection::Field(_))),
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => true,
        ExprKind::AddressOf(_) | ExprKind::Apply(..) | ExprKind::ApplyText(..) | ExprKind::Convert(..) => false,
    }
}
