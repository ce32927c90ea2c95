//! FOR where a system looks at the limit and the step in each turn, as C's `for` does. Where neither changes, and the step
//! has a known sign, this is the FOR that looks at them once.

use crate::dialect::rules::LoopLimit;
use crate::expr::checker::Checker;
use crate::expr::operand::Operand;
use crate::{Span, ast};
use staunch_ir::{Block, Expr, For, Op, Statement, StatementKind, Step, Type, Value, alias, turns};

impl<'s> Checker<'_, 's> {
    /// Whether the loop runs otherwise here than one that looks at its limit and step once.
    pub(super) fn looks_in_each_turn(&self, head: &For, by: Option<&ast::Expr<'s>>, span: Span) -> bool {
        let rule = self.decl.dialect(span).rules().loop_limit.choice;
        let changes =
            |it: &Expr| alias::changes(&self.frame(), &head.body, it) || alias::reads(&self.frame(), it, &head.counter);
        let step_changes = match &head.step {
            Step::Constant(_) => false,
            Step::Variable(step) => changes(step),
        };
        match rule {
            LoopLimit::Once => false,
            LoopLimit::EachTurn => changes(&head.last) || step_changes,
            LoopLimit::EachTurnUpward => changes(&head.last) || step_changes || !has_sign_in_text(head, by),
        }
    }

    /// The loop as C has it: test, body, step.
    pub(super) fn loop_by_turns(&mut self, head: For, by: Option<&ast::Expr<'s>>, span: Span) -> Option<()> {
        let at = self.at(span);
        let ty = head.counter.ty;
        let count = Expr::load(head.counter.clone(), at);
        let is_up = match self.decl.dialect(span).rules().loop_limit.choice {
            LoopLimit::EachTurnUpward if !has_sign_in_text(&head, by) => Expr::bool(true, at),
            LoopLimit::Once | LoopLimit::EachTurn | LoopLimit::EachTurnUpward => match &head.step {
                Step::Constant(step) => Expr::bool(*step > 0, at),
                Step::Variable(step) => {
                    let zero = self.coerce(Operand::Integer(0), ty, span)?;
                    self.apply(Op::Gt, ty, vec![step.clone(), zero], Type::BOOL, span)?
                }
            },
        };
        self.push(StatementKind::Assign { target: head.counter.clone(), value: head.first }, span);
        let mut test = |op| self.apply(op, ty, vec![count.clone(), head.last.clone()], Type::BOOL, span);
        let (below, above) = (test(Op::Le)?, test(Op::Ge)?);
        let leave = |this: &mut Self, stays: Expr| -> Option<Statement> {
            let ends = this.apply(Op::Not, Type::BOOL, vec![stays], Type::BOOL, span)?;
            let then = vec![Statement::new(StatementKind::Exit, at)];
            Some(Statement::new(StatementKind::If { condition: ends, then, otherwise: Vec::new() }, at))
        };
        let test = match is_up.as_const() {
            Some(Value::Bool(true)) => leave(self, below)?,
            Some(_) => leave(self, above)?,
            None => {
                let (then, otherwise) = (vec![leave(self, below)?], vec![leave(self, above)?]);
                Statement::new(StatementKind::If { condition: is_up, then, otherwise }, at)
            }
        };
        // An unsigned counter has no negative number to add.
        let (op, step) = match &head.step {
            Step::Constant(step) if *step < 0 && head.range.0 == 0 => {
                (Op::Sub, self.coerce(Operand::Integer(-step), ty, span)?)
            }
            Step::Constant(step) => (Op::Add, self.coerce(Operand::Integer(*step), ty, span)?),
            Step::Variable(step) => (Op::Add, step.clone()),
        };
        let next = self.apply(op, ty, vec![count, step], ty, span)?;
        let continuing: Block = vec![Statement::assign(head.counter.clone(), next, at)];
        let mut body = vec![test];
        body.extend(head.body);
        if !turns::divides(&self.frame(), &body, &continuing) {
            body.insert(1, Statement::new(StatementKind::Turn, at));
        }
        self.push(StatementKind::Loop { body, continuing, count: None }, span);
        Some(())
    }
}

/// Whether the step is a number as it is written, or 1: STruC++ counts down for a negative number alone.
fn has_sign_in_text(head: &For, by: Option<&ast::Expr<'_>>) -> bool {
    let is_number = |it: &ast::Expr<'_>| match &it.kind {
        ast::ExprKind::Literal(_) => true,
        ast::ExprKind::Unary(_, inner) => matches!(inner.kind, ast::ExprKind::Literal(_)),
        _ => false,
    };
    match &head.step {
        Step::Constant(step) => *step > 0 || by.is_some_and(is_number),
        Step::Variable(_) => false,
    }
}
