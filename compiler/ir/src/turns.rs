//! Which loops have a number of turns that is known when they start.

mod size;

use crate::alias::{self, Frame};
use crate::loops::{Known, exit_condition, is_private};
use crate::{Expr, ExprKind, Op, Place, Program, RoutineId, Statement, StatementKind, Value, faults, visit};

/// Whether a block, or what it calls, takes turns.
pub fn takes_turns(block: &[Statement], callee_does: &dyn Fn(RoutineId) -> bool) -> bool {
    any(block, &|kind| match kind {
        StatementKind::Turn => true,
        StatementKind::For(it) => it.taking.is_ahead(),
        StatementKind::Loop { count, .. } => count.as_ref().is_some_and(|it| it.taking.is_ahead()),
        StatementKind::Call { callee, .. } => callee_does(*callee),
        StatementKind::Assign { .. }
        | StatementKind::If { .. }
        | StatementKind::Case { .. }
        | StatementKind::Try { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::External(_)
        | StatementKind::CallBlock { .. }
        | StatementKind::PrescanBlock { .. }
        | StatementKind::Stop(_)
        | StatementKind::Fault(_) => false,
    })
}

/// About how many operations statements are.
pub fn size_of(block: &[Statement]) -> usize {
    size::size(block)
}

/// About how many operations one turn of a loop is that takes one turn itself, and whose statements take none;
/// `None` for other loops.
pub fn size_of_single(
    body: &[Statement],
    continuing: &[Statement],
    callee_does: &dyn Fn(RoutineId) -> bool,
) -> Option<usize> {
    let (turn, others): (Vec<_>, Vec<_>) = body.iter().partition(|it| matches!(it.kind, StatementKind::Turn));
    let takes = |it: &Statement| takes_turns(std::slice::from_ref(it), callee_does);
    let is_single = turn.len() == 1 && !others.into_iter().any(takes) && !takes_turns(continuing, callee_does);
    is_single.then(|| size::size(body) + size::size(continuing))
}

fn any(block: &[Statement], is: &dyn Fn(&StatementKind) -> bool) -> bool {
    let mut found = false;
    visit::statements(block, &mut |statement| found |= is(&statement.kind));
    found
}

/// `WHILE i < last AND other DO … i := i + 1; … END_WHILE`: a variable that nothing else writes takes one
/// step in each turn, toward a bound that stays, and does not wrap on its way.
#[derive(Clone, Debug)]
pub struct Linear<'a> {
    pub counter: &'a Place,
    pub step: i128,
    /// The counter is at most `bound + offset` in each turn, at least where the step is negative.
    pub bound: &'a Expr,
    pub offset: i128,
    /// Whether something has to hold besides.
    pub has_others: bool,
    /// The condition's statements, and what leaves the loop.
    pub test: &'a [Statement],
    /// What comes after them, with the `Turn`.
    pub rest: &'a [Statement],
}

impl Linear<'_> {
    /// How many turns it has at most, after the statements `before` it; `None` where nothing says it.
    pub fn most_turns(&self, frame: &Frame<'_>, before: &[Statement], known: &Known<'_>) -> Option<u64> {
        let (first, bound) = (value_after(frame, before, self.counter)?, known.said(self.bound)?);
        let way = if self.step > 0 { bound.1 + self.offset - first } else { first - bound.0 - self.offset };
        if way < 0 { Some(0) } else { u64::try_from(way / self.step.abs() + 1).ok() }
    }
}

/// The constant that a variable has after these statements, if the last that may write it assigns one.
fn value_after(frame: &Frame<'_>, statements: &[Statement], variable: &Place) -> Option<i128> {
    let writes = |it: &Statement| alias::writes(frame, std::slice::from_ref(it), variable);
    let at = statements.iter().rposition(writes)?;
    let StatementKind::Assign { target, value } = &statements[at].kind else { return None };
    match &value.kind {
        _ if !target.is_same_variable(variable) => None,
        // As where a variable is kept in a local while a loop runs.
        ExprKind::Load(from) => value_after(frame, &statements[..at], from),
        _ => value.as_const()?.as_integer(),
    }
}

/// A WHILE loop whose turns are known, but for an early end.
pub fn linear<'a>(frame: &Frame<'_>, body: &'a [Statement]) -> Option<Linear<'a>> {
    let (at, stays) = body.iter().enumerate().find_map(|(at, it)| {
        let ExprKind::Apply(Op::Not, stays) = &exit_condition(it)?.kind else { return None };
        Some((at, &stays[0]))
    })?;
    let (test, rest) = body.split_at(at + 1);
    let before = &test[..at];
    let stays = if before.is_empty() { stays } else { first_of_chain(before, stays)? };
    if any(body, &|kind| matches!(kind, StatementKind::Continue)) {
        return None;
    }
    let mut conditions = Vec::new();
    parts(Op::And, stays, &mut conditions);
    let has_others = !before.is_empty() || conditions.len() > 1;
    let known = Known { program: frame.program, loops: &[], checked: &|_| false, seen: &[] };
    conditions.into_iter().flat_map(compared).find_map(|(counter, bound, ahead, offset)| {
        let step = only_step(frame, rest, counter).filter(|_| is_private(frame, counter, before))?;
        let toward = step.is_positive() == ahead && !alias::changes(frame, body, bound);
        let fits = !faults::expr_faults(frame.program, bound) && never_wraps(&known, counter, bound, offset + step);
        (toward && fits).then_some(Linear { counter, step, bound, offset, has_others, test, rest })
    })
}

/// `both := a; IF both THEN …; both := b; END_IF`, of which `a AND_THEN b` is made, and `both`: only where `a` holds that does.
fn first_of_chain<'a>(before: &'a [Statement], both: &Expr) -> Option<&'a Expr> {
    let (first, others) = before.split_first()?;
    let StatementKind::Assign { target, value } = &first.kind else { return None };
    let is_both = |it: &Expr| matches!(&it.kind, ExprKind::Load(place) if place.is_same_variable(target));
    let is_asked = |it: &Statement| match &it.kind {
        StatementKind::If { condition, otherwise, .. } => otherwise.is_empty() && is_both(condition),
        _ => false,
    };
    (is_both(both) && others.iter().all(is_asked)).then_some(value)
}

/// Whether each turn divides a variable, `x := SHR(x, 1);` or `n := n / 10;`, until the loop is left for how small it is:
/// `WHILE x <> 0`, `UNTIL n < 10`. That is after no more turns than the variable has bits, and one.
pub fn divides(frame: &Frame<'_>, body: &[Statement], continuing: &[Statement]) -> bool {
    if any(body, &|kind| matches!(kind, StatementKind::Continue)) {
        return false;
    }
    let mut conditions = Vec::new();
    let body = match (body, continuing) {
        ([test, body @ ..], []) if let Some(leave) = exit_condition(test) => {
            let ExprKind::Apply(Op::Not, stay) = &leave.kind else { return false };
            parts(Op::And, &stay[0], &mut conditions);
            body
        }
        (_, [test]) if let Some(leave) = exit_condition(test) => {
            parts(Op::Or, leave, &mut conditions);
            body
        }
        _ => return false,
    };
    let is_left = |small: (&Place, bool)| small.1 == continuing.is_empty() && is_divided(frame, body, small.0);
    conditions.into_iter().filter_map(size_test).any(is_left)
}

/// A variable that is tested for its size, and whether it is large where the condition holds. A small value then includes 0, and all below
/// it where the test is one of order.
fn size_test(condition: &Expr) -> Option<(&Place, bool)> {
    let ExprKind::Apply(op, operands) = &condition.kind else { return None };
    let [left, right] = operands.as_slice() else { return None };
    let (place, limit, op) = match (&left.kind, &right.kind) {
        (ExprKind::Load(place), _) => (place, right.as_const()?.as_integer()?, *op),
        (_, ExprKind::Load(place)) => (place, left.as_const()?.as_integer()?, mirrored(*op)?),
        _ => return None,
    };
    let is_large = match op {
        Op::Ne if limit == 0 => true,
        Op::Gt if limit >= 0 => true,
        Op::Ge if limit >= 1 => true,
        Op::Eq if limit == 0 => false,
        Op::Le if limit >= 0 => false,
        Op::Lt if limit >= 1 => false,
        _ => return None,
    };
    Some((place, is_large))
}

/// `0 < x` as `x > 0`.
fn mirrored(op: Op) -> Option<Op> {
    match op {
        Op::Ne | Op::Eq => Some(op),
        Op::Lt => Some(Op::Gt),
        Op::Le => Some(Op::Ge),
        Op::Gt => Some(Op::Lt),
        Op::Ge => Some(Op::Le),
        _ => None,
    }
}

/// Whether each turn divides the variable, and nothing else writes it.
fn is_divided(frame: &Frame<'_>, body: &[Statement], variable: &Place) -> bool {
    let Some(at) = body.iter().position(|it| divides_once(frame.program, it, variable)) else { return false };
    is_private(frame, variable, &body[..at]) && is_private(frame, variable, &body[at + 1..])
}

fn divides_once(program: &Program, statement: &Statement, variable: &Place) -> bool {
    let StatementKind::Assign { target, value } = &statement.kind else { return false };
    let ExprKind::Apply(op, operands) = &value.kind else { return false };
    let [from, by] = operands.as_slice() else { return false };
    let (ExprKind::Load(from), Some(by)) = (&from.kind, by.as_const().and_then(Value::as_integer)) else {
        return false;
    };
    let whole = program.repr(variable.ty).and_then(|it| it.range());
    let is_enough = match op {
        Op::Div => by >= 2 && whole.is_some(),
        // A sign would be shifted into the number.
        Op::Shr => by >= 1 && whole.is_some_and(|it| it.0 == 0),
        _ => false,
    };
    is_enough && target.is_same_variable(variable) && from.is_same_variable(variable)
}

/// The parts of a condition that AND, or OR, joins.
fn parts<'a>(by: Op, condition: &'a Expr, found: &mut Vec<&'a Expr>) {
    match &condition.kind {
        ExprKind::Apply(op, operands) if *op == by => operands.iter().for_each(|it| parts(by, it, found)),
        ExprKind::Apply(..)
        | ExprKind::Const(_)
        | ExprKind::Text(_)
        | ExprKind::Load(_)
        | ExprKind::AddressOf(_)
        | ExprKind::ApplyText(..)
        | ExprKind::Aggregate(_)
        | ExprKind::Convert(..) => found.push(condition),
    }
}

/// Either side of a comparison that is a variable, and its bound; whether that is above, and how far from it
/// the last value is.
fn compared(condition: &Expr) -> impl Iterator<Item = (&Place, &Expr, bool, i128)> {
    let sides = match &condition.kind {
        ExprKind::Apply(op, operands) => match (op, operands.as_slice()) {
            (Op::Lt, [left, right]) => Some((left, right, true, -1)),
            (Op::Le, [left, right]) => Some((left, right, true, 0)),
            (Op::Gt, [left, right]) => Some((left, right, false, 1)),
            (Op::Ge, [left, right]) => Some((left, right, false, 0)),
            _ => None,
        },
        _ => None,
    };
    let both = sides.map(|(left, right, is_above, offset): (&Expr, &Expr, bool, i128)| {
        [(left, right, is_above, offset), (right, left, !is_above, -offset)]
    });
    both.into_iter().flatten().filter_map(|(variable, bound, is_above, offset)| match &variable.kind {
        ExprKind::Load(place) => Some((place, bound, is_above, offset)),
        _ => None,
    })
}

/// By how much the one statement steps that writes `counter`, and which each turn passes.
fn only_step(frame: &Frame<'_>, body: &[Statement], counter: &Place) -> Option<i128> {
    let at = body.iter().position(|it| step_of(it, counter).is_some())?;
    let (before, after) = (&body[..at], &body[at + 1..]);
    let only = is_private(frame, counter, before) && is_private(frame, counter, after);
    if only { step_of(&body[at], counter) } else { None }
}

/// `i := i + 1`
fn step_of(statement: &Statement, counter: &Place) -> Option<i128> {
    let StatementKind::Assign { target, value } = &statement.kind else { return None };
    let ExprKind::Apply(op, operands) = &value.kind else { return None };
    let [from, by] = operands.as_slice() else { return None };
    let ExprKind::Load(from) = &from.kind else { return None };
    let by = by.as_const().and_then(Value::as_integer).filter(|it| *it > 0)?;
    let steps = target.is_same_variable(counter) && from.is_same_variable(counter);
    match op {
        Op::Add if steps => Some(by),
        Op::Sub if steps => Some(-by),
        _ => None,
    }
}

/// Whether a step from the last value leads to one of the counter's type.
fn never_wraps(known: &Known<'_>, counter: &Place, bound: &Expr, way: i128) -> bool {
    let whole = known.program.repr(counter.ty).and_then(|repr| repr.range());
    let (Some((least, most)), Some(bound_range)) = (whole, known.range(bound)) else { return false };
    bound.ty == counter.ty && least <= bound_range.0 + way && bound_range.1 + way <= most
}

#[cfg(test)]
mod tests;
