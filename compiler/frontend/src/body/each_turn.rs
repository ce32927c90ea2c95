//! FOR where a system looks at the limit and the step in each turn, as C's `for` does, and calls anew what they call. Where
//! neither changes, nothing is called, and the step has a known sign, this is the FOR that looks at them once.

use crate::dialect::rules::LoopLimit;
use crate::expr::checker::Checker;
use crate::expr::operand::Operand;
use crate::{Span, ast};
use staunch_ir::{Block, Conversion, Expr, For, Op, Statement, StatementKind, Step, Type, Value, alias, turns};

/// What the limit and the step of a FOR do before their values are known, in each turn.
#[derive(Debug, Default)]
pub(super) struct Calls {
    pub limit: Block,
    pub step: Block,
    /// The limit as it is computed, where that is a number which the counter's type may not hold.
    pub wide_limit: Option<Expr>,
    /// So too the step, whose sign counts.
    pub wide_step: Option<Expr>,
}

impl<'s> Checker<'_, 's> {
    /// Whether the dialect looks at the limit and the step of a FOR in each turn.
    pub(super) fn calls_in_each_turn(&self, span: Span) -> bool {
        self.decl.dialect(span).rules().loop_limit.choice != LoopLimit::Once
    }

    /// Whether the loop runs otherwise here than one that looks at its limit and step once.
    pub(super) fn looks_in_each_turn(&self, head: &For, calls: &Calls, by: Option<&ast::Expr<'s>>, span: Span) -> bool {
        let rule = self.decl.dialect(span).rules().loop_limit.choice;
        if matches!(head.counter.ty, Type::Subrange(..)) {
            // A step out of the subrange is a fault, which the loop of the IR alone has.
            return false;
        }
        let changes =
            |it: &Expr| alias::changes(&self.frame(), &head.body, it) || alias::reads(&self.frame(), it, &head.counter);
        let step_changes = match &head.step {
            Step::Constant(_) => false,
            Step::Variable(step) => changes(step),
        };
        let calls = !calls.limit.is_empty() || !calls.step.is_empty();
        match rule {
            LoopLimit::Once => false,
            // A step of 0 is not a fault there.
            LoopLimit::EachTurn => calls || changes(&head.last) || matches!(head.step, Step::Variable(_)),
            LoopLimit::EachTurnUpward => calls || changes(&head.last) || step_changes || !has_known_sign(head, by),
        }
    }

    /// The loop as C has it: test, body, step.
    pub(super) fn loop_by_turns(
        &mut self,
        head: For,
        calls: Calls,
        by: Option<&ast::Expr<'s>>,
        span: Span,
    ) -> Option<()> {
        let at = self.at(span);
        let is_upward = self.decl.dialect(span).rules().loop_limit.choice == LoopLimit::EachTurnUpward;
        let goes_up = if is_upward && !has_known_sign(&head, by) {
            Expr::bool(true, at)
        } else {
            self.goes_up(&head, calls.wide_step.as_ref(), span)?
        };
        // The sign of a step is looked at before the limit; STruC++ goes by the text alone.
        let mut body = if is_upward { Block::new() } else { calls.step.clone() };
        body.extend(calls.limit);
        body.push(self.leave_at_limit(&head, calls.wide_limit.as_ref(), goes_up, span)?);
        let turn = body.len();
        let mut continuing = calls.step;
        continuing.push(self.next_turn(&head, span)?);
        self.push(StatementKind::Assign { target: head.counter, value: head.first }, span);
        body.extend(head.body);
        if !turns::divides(&self.frame(), &body, &continuing) {
            body.insert(turn, Statement::new(StatementKind::Turn, at));
        }
        self.push(StatementKind::Loop { body, continuing, count: None }, span);
        Some(())
    }

    /// Whether the step is above 0.
    fn goes_up(&mut self, head: &For, wide: Option<&Expr>, span: Span) -> Option<Expr> {
        match &head.step {
            Step::Constant(step) => Some(Expr::bool(*step > 0, self.at(span))),
            Step::Variable(step) => {
                let step = wide.unwrap_or(step);
                let ty = step.ty;
                let zero = self.coerce(Operand::Integer(0), ty, span)?;
                self.apply(Op::Gt, ty, vec![step.clone(), zero], Type::BOOL, span)
            }
        }
    }

    /// Leaves the loop where the counter is beyond the limit.
    fn leave_at_limit(&mut self, head: &For, wide: Option<&Expr>, goes_up: Expr, span: Span) -> Option<Statement> {
        let at = self.at(span);
        let mut leave = |stays: Op| -> Option<Statement> {
            let count = Expr::load(head.counter.clone(), at);
            let stays = self.is_before_limit(stays, count, wide.unwrap_or(&head.last), span)?;
            let ends = self.apply(Op::Not, Type::BOOL, vec![stays], Type::BOOL, span)?;
            let then = vec![Statement::new(StatementKind::Exit, at)];
            Some(Statement::new(StatementKind::If { condition: ends, then, otherwise: Vec::new() }, at))
        };
        match goes_up.as_const() {
            Some(Value::Bool(true)) => leave(Op::Le),
            Some(_) => leave(Op::Ge),
            None => {
                let (then, otherwise) = (vec![leave(Op::Le)?], vec![leave(Op::Ge)?]);
                Some(Statement::new(StatementKind::If { condition: goes_up, then, otherwise }, at))
            }
        }
    }

    /// Compares a value of the counter with the limit, as C does: at the type of more bits, of two that have as many at the
    /// one without a sign.
    fn is_before_limit(&mut self, op: Op, count: Expr, limit: &Expr, span: Span) -> Option<Expr> {
        let order = |it: &Expr| it.ty.elementary().map(|it| (it.repr().size(), it.repr().is_unsigned()));
        let ty = if order(&count) > order(limit) { count.ty } else { limit.ty };
        let [count, limit] = [count, limit.clone()].map(|it| match it.ty == ty {
            true => it,
            false => self.convert(Conversion::Value, ty, it),
        });
        self.apply(op, ty, vec![count, limit], Type::BOOL, span)
    }

    /// Adds the step to the counter.
    fn next_turn(&mut self, head: &For, span: Span) -> Option<Statement> {
        let (at, ty) = (self.at(span), head.counter.ty);
        // An unsigned counter has no negative number to add.
        let (op, step) = match &head.step {
            Step::Constant(step) if *step < 0 && head.range.0 == 0 => {
                (Op::Sub, self.coerce(Operand::Integer(-step), ty, span)?)
            }
            Step::Constant(step) => (Op::Add, self.coerce(Operand::Integer(*step), ty, span)?),
            Step::Variable(step) => (Op::Add, step.clone()),
        };
        let count = Expr::load(head.counter.clone(), at);
        let next = self.apply(op, ty, vec![count, step], ty, span)?;
        Some(Statement::assign(head.counter.clone(), next, at))
    }
}

/// Whether the step is a literal, with a sign or without, or 1: STruC++ counts down for a negative literal alone, and not for
/// one in parentheses.
fn has_known_sign(head: &For, by: Option<&ast::Expr<'_>>) -> bool {
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
