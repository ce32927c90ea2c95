//! FOR whose step is computed at more bits than its counter has: `BY u - 2` of a USINT counts down. Limit and step are
//! looked at once.

use super::each_turn::Calls;
use crate::Span;
use crate::expr::checker::Checker;
use crate::expr::operand::{Operand, stored};
use staunch_ir::{
    Block, Conversion, Elementary, Expr, For, Location, Op, Place, Statement, StatementKind, Type, turns,
};
use staunch_runtime::FaultKind;

const LINT: Type = Type::Elementary(Elementary::Lint);
const ULINT: Type = Type::Elementary(Elementary::Ulint);

/// A loop of which the step is one of these.
#[derive(Clone, Copy)]
enum Way {
    Up,
    Down,
}

impl<'s> Checker<'_, 's> {
    /// The step as it is computed, where the counter's type may not hold it.
    pub(super) fn step_beyond_counter<'c>(&self, head: &For, calls: &'c Calls) -> Option<&'c Expr> {
        let wide = calls.wide_step.as_ref()?;
        let (least, most) = head.counter.ty.elementary()?.repr().range()?;
        let known = self.known_range(wide);
        (known.0 < least || most < known.1).then_some(wide)
    }

    /// The loop by turns: where the step would leave the counter's type, it ends, and the counter stays.
    pub(super) fn loop_by_wide_step(&mut self, head: For, step: &Expr, span: Span) -> Option<()> {
        let at = self.at(span);
        self.push(StatementKind::Assign { target: head.counter.clone(), value: head.first.clone() }, span);
        let limit = self.kept("limit", head.last.clone(), span);
        let step = self.exact(step.clone(), LINT);
        let step = self.kept("step", step, span);
        let is_zero = self.step_is(Op::Eq, &step, span)?;
        self.push(when(is_zero, vec![fault(FaultKind::ZeroStep, head.step_at)], Vec::new()), span);

        let goes_up = self.step_is(Op::Gt, &step, span)?;
        let [up, down] = [Way::Up, Way::Down].map(|way| self.past_limit(way, &head, &limit, span));
        let mut body = vec![Statement::new(when(goes_up.clone(), up?, down?), at)];
        let turn = body.len();
        let [up, down] = [Way::Up, Way::Down].map(|way| self.past_range(way, &head, &step, &limit, span));
        let mut continuing = vec![Statement::new(when(goes_up, up?, down?), at)];
        let ty = work(&head);
        let step = self.exact(step, ty);
        let next = self.next(&head, step, span)?;
        let next = stored(next, head.counter.ty.elementary()?);
        let next = self.coerce(Operand::Typed(next), head.counter.ty, span)?;
        continuing.push(Statement::assign(head.counter.clone(), next, at));
        body.extend(head.body);
        if !turns::divides(&self.frame(), &body, &continuing) {
            body.insert(turn, Statement::new(StatementKind::Turn, at));
        }
        self.push(StatementKind::Loop { body, continuing, count: None }, span);
        Some(())
    }

    /// Leaves the loop where the counter is past its limit.
    fn past_limit(&mut self, way: Way, head: &For, limit: &Expr, span: Span) -> Option<Block> {
        let at = self.at(span);
        let ty = work(head);
        let [count, limit] = [Expr::load(head.counter.clone(), at), limit.clone()].map(|it| self.exact(it, ty));
        let is_past = self.apply(past(way), ty, vec![count, limit], Type::BOOL, span)?;
        Some(leave(is_past, Block::new(), at))
    }

    /// Leaves the loop where the step would leave the counter's range: its type, or its subrange, where that is a fault
    /// unless the limit is passed.
    fn past_range(&mut self, way: Way, head: &For, step: &Expr, limit: &Expr, span: Span) -> Option<Block> {
        let (at, ty) = (self.at(span), work(head));
        let count = self.exact(Expr::load(head.counter.clone(), at), ty);
        let end = match way {
            Way::Up => head.range.1,
            Way::Down => head.range.0,
        };
        let end = self.coerce(Operand::Integer(end), ty, span)?;
        // Both are at least 0.
        let (room, size) = match way {
            Way::Up => (self.apply(Op::Sub, ty, vec![end, count], ty, span)?, step.clone()),
            Way::Down => {
                let size = self.apply(Op::Neg, LINT, vec![step.clone()], LINT, span)?;
                (self.apply(Op::Sub, ty, vec![count, end], ty, span)?, size)
            }
        };
        let size = self.exact(size, ty);
        let leaves = self.apply(Op::Gt, ty, vec![size, room], Type::BOOL, span)?;
        let mut block = Block::new();
        if matches!(head.counter.ty, Type::Subrange(..)) {
            let step = self.exact(step.clone(), ty);
            let next = self.next(head, step, span)?;
            let last = self.exact(limit.clone(), ty);
            let is_past = self.apply(past(way), ty, vec![next, last], Type::BOOL, span)?;
            let goes_on = self.apply(Op::Not, Type::BOOL, vec![is_past], Type::BOOL, span)?;
            let fault = fault(FaultKind::SubrangeViolated, head.step_at);
            block.push(Statement::new(when(goes_on, vec![fault], Vec::new()), at));
        }
        Some(leave(leaves, block, at))
    }

    /// The counter and the step, added.
    fn next(&mut self, head: &For, step: Expr, span: Span) -> Option<Expr> {
        let (at, ty) = (self.at(span), work(head));
        let count = self.exact(Expr::load(head.counter.clone(), at), ty);
        self.apply(Op::Add, ty, vec![count, step], ty, span)
    }

    /// Whether a value of the counter is before the limit, as whole numbers are: the limit may have a sign where the counter
    /// has none.
    pub(super) fn is_before(&mut self, op: Op, head: &For, limit: &Expr, span: Span) -> Option<Expr> {
        let ty = work(head);
        let [first, number] = [head.first.clone(), limit.clone()].map(|it| self.exact(it, ty));
        let is_before = self.apply(op, ty, vec![first, number], Type::BOOL, span)?;
        if ty == LINT || self.known_range(limit).0 >= 0 {
            return Some(is_before);
        }
        let zero = self.coerce(Operand::Integer(0), limit.ty, span)?;
        let (sign, joins) = if op == Op::Le { (Op::Ge, Op::And) } else { (Op::Lt, Op::Or) };
        let sign = self.apply(sign, limit.ty, vec![limit.clone(), zero], Type::BOOL, span)?;
        self.apply(joins, Type::BOOL, vec![sign, is_before], Type::BOOL, span)
    }

    /// A value that is computed once, before the loop.
    fn kept(&mut self, name: &str, value: Expr, span: Span) -> Expr {
        let place: Place = self.temporary(name, value.ty);
        self.assign(place.clone(), value, span);
        Expr::load(place, self.at(span))
    }

    fn exact(&mut self, value: Expr, ty: Type) -> Expr {
        let value = value.read();
        if value.ty == ty { value } else { self.convert(Conversion::Value, ty, value) }
    }

    fn step_is(&mut self, op: Op, step: &Expr, span: Span) -> Option<Expr> {
        let zero = self.coerce(Operand::Integer(0), LINT, span)?;
        self.apply(op, LINT, vec![step.clone(), zero], Type::BOOL, span)
    }
}

/// The type that holds all values of the counter, and what is between them.
fn work(head: &For) -> Type {
    if head.range.1 > i128::from(i64::MAX) { ULINT } else { LINT }
}

fn past(way: Way) -> Op {
    match way {
        Way::Up => Op::Gt,
        Way::Down => Op::Lt,
    }
}

fn fault(kind: FaultKind, at: Location) -> Statement {
    Statement::new(StatementKind::Fault(kind), at)
}

fn when(condition: Expr, then: Block, otherwise: Block) -> StatementKind {
    StatementKind::If { condition, then, otherwise }
}

fn leave(condition: Expr, mut before: Block, at: Location) -> Block {
    before.push(Statement::new(StatementKind::Exit, at));
    vec![Statement::new(when(condition, before, Vec::new()), at)]
}
