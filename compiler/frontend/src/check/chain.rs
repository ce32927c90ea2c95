//! Operators called by their names: `ADD(a, b, c)` is `a + b + c`; `GT(a, b, c)` is
//! `a > b AND b > c`, with `b` evaluated once.

use super::Checker;
use super::operand::Operand;
use super::operator::{Sides, beside, compares};
use crate::{Span, ast};
use ast::BinaryOp;
use staunch_ir::{Expr, ExprKind, Projection, Statement, Type};

impl<'s> Checker<'_, 's> {
    pub(super) fn chain(
        &mut self,
        operator: BinaryOp,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        if compares(operator) && values.len() > 2 {
            return self.comparisons(operator, values, name);
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

    fn comparisons(&mut self, op: BinaryOp, values: &[&ast::Expr<'s>], name: ast::Name<'s>) -> Option<Operand> {
        let mut operands: Vec<Operand> = Vec::new();
        let mut complete = true;
        for (at, value) in values.iter().enumerate() {
            let hint = operands.last().and_then(|it| beside(it, None));
            let read_twice = at > 0 && at + 1 < values.len();
            let mut done: Vec<_> = operands.iter_mut().filter_map(Operand::typed_mut).collect();
            let operand = self.after(&mut done, |this| {
                let operand = this.operand(value, hint)?;
                Some(if read_twice { this.kept(operand) } else { operand })
            });
            match operand {
                Some(operand) => operands.push(operand),
                None => complete = false,
            }
        }
        if !complete {
            return None;
        }
        let mut all: Option<Operand> = None;
        for (at, pair) in operands.windows(2).enumerate() {
            let (left, right) = (values[at].span, values[at + 1].span);
            let one = self.joined(op, name.span, (pair[0].clone(), left), (pair[1].clone(), right))?;
            all = Some(match all {
                None => one,
                Some(before) => self.joined(BinaryOp::And, name.span, (before, values[0].span), (one, right))?,
            });
        }
        all
    }

    fn joined(
        &mut self,
        op: BinaryOp,
        op_span: Span,
        (a, left): (Operand, Span),
        (b, right): (Operand, Span),
    ) -> Option<Operand> {
        self.combine(Sides { a, b, left, right, op, op_span, span: left.to(right), hint: None })
    }

    /// The operand for reading it twice: what is more than a variable is computed once.
    fn kept(&mut self, operand: Operand) -> Operand {
        match operand {
            Operand::Typed(expr) if !is_plain(&expr) => {
                let (place, at) = (self.temporary("saved", expr.ty), expr.at);
                self.block.push(Statement::assign(place.clone(), expr, at));
                Operand::Typed(Expr::load(place, at))
            }
            other => other,
        }
    }
}

fn is_plain(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Load(place) => place.projections.iter().all(|it| matches!(it, Projection::Field(_))),
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => true,
        ExprKind::Apply(..) | ExprKind::ApplyText(..) | ExprKind::Convert(..) => false,
    }
}
