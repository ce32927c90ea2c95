//! FOR whose step is computed at more bits than its counter has: `BY u - 2` of a USINT counts down. Limit and step are
//! looked at once.

use super::each_turn::Calls;
use crate::Span;
use crate::expr::checker::Checker;
use crate::expr::operand::{Operand, stored};
use staunch_ir::{Block, Conversion, Elementary, Expr, For, Op, Place, Statement, StatementKind, Type, turns};
use staunch_runtime::FaultKind;

/// The type in which the step and the counter, which has fewer bits, are added.
const WIDE: Type = Type::Elementary(Elementary::Lint);

impl Checker<'_, '_> {
    /// The step as it is computed, where the counter's type may not hold it. A step out of a subrange is a fault, which the
    /// loop of the IR alone has.
    pub(super) fn step_beyond_counter<'c>(&self, head: &For, calls: &'c Calls) -> Option<&'c Expr> {
        let wide = calls.wide_step.as_ref()?;
        let (least, most) = head.counter.ty.elementary().filter(|it| it.repr().size() < 8)?.repr().range()?;
        let known = self.known_range(wide);
        let is_subrange = matches!(head.counter.ty, Type::Subrange(..));
        (!is_subrange && (known.0 < least || most < known.1)).then_some(wide)
    }

    /// The loop by turns: where the step would leave the counter's type, it ends, and the counter stays.
    pub(super) fn loop_by_wide_step(&mut self, head: For, step: &Expr, limit: Option<&Expr>, span: Span) -> Option<()> {
        let at = self.at(span);
        self.push(StatementKind::Assign { target: head.counter.clone(), value: head.first }, span);
        let limit = limit.unwrap_or(&head.last);
        let limit = self.kept("limit", limit.ty, limit.clone(), span);
        let step_of = self.as_wide(step.clone());
        let step = self.kept("step", WIDE, step_of, span);
        let is_zero = self.step_is(Op::Eq, &step, span)?;
        let fault = Statement::new(StatementKind::Fault(FaultKind::ZeroStep), head.step_at);
        self.push(StatementKind::If { condition: is_zero, then: vec![fault], otherwise: Vec::new() }, span);

        let mut ends = |op: Op| -> Option<Block> {
            let stays = self.is_before_limit(op, Expr::load(head.counter.clone(), at), &limit, span)?;
            let ends = self.apply(Op::Not, Type::BOOL, vec![stays], Type::BOOL, span)?;
            Some(leave(ends, at))
        };
        let (then, otherwise) = (ends(Op::Le)?, ends(Op::Ge)?);
        let goes_up = self.step_is(Op::Gt, &step, span)?;
        let mut body = vec![Statement::new(StatementKind::If { condition: goes_up.clone(), then, otherwise }, at)];
        let turn = body.len();
        body.extend(head.body);

        let mut leaves = |op: Op, end: i128| -> Option<Block> {
            let count = self.as_wide(Expr::load(head.counter.clone(), at));
            let end = self.coerce(Operand::Integer(end), WIDE, span)?;
            let room = self.apply(Op::Sub, WIDE, vec![end, count], WIDE, span)?;
            let leaves = self.apply(op, WIDE, vec![step.clone(), room], Type::BOOL, span)?;
            Some(leave(leaves, at))
        };
        let (then, otherwise) = (leaves(Op::Gt, head.range.1)?, leaves(Op::Lt, head.range.0)?);
        let mut continuing = vec![Statement::new(StatementKind::If { condition: goes_up, then, otherwise }, at)];
        let count = self.as_wide(Expr::load(head.counter.clone(), at));
        let next = self.apply(Op::Add, WIDE, vec![count, step], WIDE, span)?;
        let next = stored(next, head.counter.ty.elementary()?);
        continuing.push(Statement::assign(head.counter, next, at));

        if !turns::divides(&self.frame(), &body, &continuing) {
            body.insert(turn, Statement::new(StatementKind::Turn, at));
        }
        self.push(StatementKind::Loop { body, continuing, count: None }, span);
        Some(())
    }

    /// A value that is computed once, before the loop.
    fn kept(&mut self, name: &str, ty: Type, value: Expr, span: Span) -> Expr {
        let place: Place = self.temporary(name, ty);
        self.assign(place.clone(), value, span);
        Expr::load(place, self.at(span))
    }

    fn as_wide(&mut self, value: Expr) -> Expr {
        if value.ty == WIDE { value } else { self.convert(Conversion::Value, WIDE, value) }
    }

    fn step_is(&mut self, op: Op, step: &Expr, span: Span) -> Option<Expr> {
        let zero = self.coerce(Operand::Integer(0), WIDE, span)?;
        self.apply(op, WIDE, vec![step.clone(), zero], Type::BOOL, span)
    }
}

fn leave(condition: Expr, at: staunch_ir::Location) -> Block {
    let then = vec![Statement::new(StatementKind::Exit, at)];
    vec![Statement::new(StatementKind::If { condition, then, otherwise: Vec::new() }, at)]
}
