//! FOR loops whose body leaves the counter alone, read back from what the front end makes of
//! them. A back end may then keep the counter in a register beside its storage, and an index
//! whose range follows from the loop's bounds needs no check.

use crate::{
    Argument, ArrayId, Conversion, Expr, ExprKind, Lane, Op, Place, Pou, Program, Projection, Root, Section, Statement,
    StatementKind, Value,
};

/// A FOR loop with a constant step.
#[derive(Clone, Copy, Debug)]
pub struct Counted<'p> {
    /// A variable that no one outside the POU can write.
    pub counter: &'p Place,
    pub lane: Lane,
    /// The last value that the body runs for: a constant, or a local.
    pub last: &'p Expr,
    pub step: i64,
    /// Past this value the next step would leave the counter's type, so the loop ends first.
    pub end: Option<i128>,
    pub body: &'p [Statement],
    /// What the counter may be in the body.
    pub range: Range,
}

/// Inclusive.
pub type Range = (i128, i128);

impl<'p> Counted<'p> {
    /// The loop at `block[at]`, if it is one.
    pub fn find(program: &Program, pou: &Pou, block: &'p [Statement], at: usize) -> Option<Self> {
        let StatementKind::Loop { body, continuing } = &block[at].kind else { return None };
        let (test, body) = body.split_first()?;
        let (next, end) = continuing.split_last()?;
        let (counter, step) = stepped(next)?;
        let lane = program.lane(counter.ty).filter(|it| it.is_integer())?;
        let last = bound(exit_condition(test)?, counter, step)?;
        let end = match end {
            [] => None,
            [leave] => Some(limit(exit_condition(leave)?, counter, step)?),
            _ => return None,
        };
        if !is_private(program, pou, counter) || writes(body, counter) {
            return None;
        }
        let (min, max) = lane.range()?;
        let first = first_value(&block[..at], counter);
        let stop = last.as_const().and_then(Value::as_integer);
        let range = if step > 0 {
            (first.unwrap_or(min), stop.unwrap_or(max))
        } else {
            (stop.unwrap_or(min), first.unwrap_or(max))
        };
        Some(Self { counter, lane, last, step, end, body, range })
    }
}

/// From `counter := counter + step`, or `-`: the counter and the step.
fn stepped(statement: &Statement) -> Option<(&Place, i64)> {
    let StatementKind::Assign { target, value } = &statement.kind else { return None };
    let ExprKind::Apply(op, operands) = &value.kind else { return None };
    let [counter, step] = operands.as_slice() else { return None };
    let step = i64::try_from(step.as_const()?.as_integer()?).ok()?;
    let step = match op {
        Op::Add => step,
        Op::Sub => -step,
        _ => return None,
    };
    reads(counter, target).then_some((target, step))
}

/// The condition of `IF … THEN EXIT; END_IF`.
pub fn exit_condition(statement: &Statement) -> Option<&Expr> {
    let StatementKind::If { condition, then, otherwise } = &statement.kind else { return None };
    let exits = matches!(then.as_slice(), [only] if matches!(only.kind, StatementKind::Exit));
    (exits && otherwise.is_empty()).then_some(condition)
}

/// From `NOT (counter <= last)`, or `>=` for a step down: `last`.
fn bound<'p>(condition: &'p Expr, counter: &Place, step: i64) -> Option<&'p Expr> {
    let ExprKind::Apply(Op::Not, operand) = &condition.kind else { return None };
    let ExprKind::Apply(op, operands) = &operand.first()?.kind else { return None };
    let [left, last] = operands.as_slice() else { return None };
    let stays = if step > 0 { Op::Le } else { Op::Ge };
    (*op == stays && reads(left, counter)).then_some(last)
}

/// From `counter > limit`, or `<` for a step down: `limit`.
fn limit(condition: &Expr, counter: &Place, step: i64) -> Option<i128> {
    let ExprKind::Apply(op, operands) = &condition.kind else { return None };
    let [left, limit] = operands.as_slice() else { return None };
    let leaves = if step > 0 { Op::Gt } else { Op::Lt };
    limit.as_const()?.as_integer().filter(|_| *op == leaves && reads(left, counter))
}

fn reads(expr: &Expr, place: &Place) -> bool {
    matches!(&expr.kind, ExprKind::Load(it) if it.is_same_variable(place))
}

/// The value that the counter is given before the loop, if it is constant; the bound may be
/// put away between the two.
fn first_value(before: &[Statement], counter: &Place) -> Option<i128> {
    for statement in before.iter().rev().take(2) {
        let StatementKind::Assign { target, value } = &statement.kind else { return None };
        if target.is_same_variable(counter) {
            return value.as_const()?.as_integer();
        }
        if overlaps(target, counter) {
            return None;
        }
    }
    None
}

/// Whether the counter is a local, or a variable that has no address and that others cannot name.
fn is_private(program: &Program, pou: &Pou, counter: &Place) -> bool {
    if !counter.projections.iter().all(|it| matches!(it, Projection::Field(_))) {
        return false;
    }
    match (counter.root, pou.state, counter.projections.first()) {
        (Root::Local(_), ..) => true,
        (Root::Instance, Some(state), Some(Projection::Field(field))) => {
            let field = &program.structure(state).fields[field.index()];
            field.section == Section::Internal && field.address.is_none()
        }
        (Root::Instance | Root::Globals | Root::Param(_), ..) => false,
    }
}

/// Whether a statement may write `place`, which is private.
fn writes(block: &[Statement], place: &Place) -> bool {
    let touches = |it: &Place| overlaps(it, place);
    let refers = |it: &Argument| matches!(it, Argument::Reference(it) if touches(it));
    let directly = |kind: &StatementKind| match kind {
        StatementKind::Assign { target, value: _ } => touches(target),
        StatementKind::Call { callee: _, instance, arguments, result } => {
            instance.iter().chain(result).any(touches) || arguments.iter().any(refers)
        }
        StatementKind::CallBlock { block, .. } | StatementKind::PrescanBlock { block, .. } => touches(block),
        StatementKind::PrescanInstance { callee: _, instance } => touches(instance),
        StatementKind::If { .. }
        | StatementKind::Case { .. }
        | StatementKind::Loop { .. }
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::Fault(_) => false,
    };
    block.iter().any(|it| directly(&it.kind) || it.kind.blocks().into_iter().any(|inner| writes(inner, place)))
}

/// Whether one place may hold the other; `private` is not reached through any other root.
fn overlaps(place: &Place, private: &Place) -> bool {
    place.root == private.root
        && place.projections.iter().zip(&private.projections).all(|pair| match pair {
            (Projection::Field(a), Projection::Field(b)) => a == b,
            (Projection::Index { .. }, _) | (_, Projection::Index { .. }) => true,
        })
}

/// The 0-based position of an index that is constant and within the bounds.
pub fn constant_position(program: &Program, index: &Expr, array: ArrayId) -> Option<u64> {
    let array = program.array(array);
    let Some(Value::I64(index)) = index.as_const() else { return None };
    (array.low..=array.high).contains(&index).then(|| index.abs_diff(array.low))
}

/// Whether an index needs no check.
pub fn is_within(program: &Program, index: &Expr, array: ArrayId, counters: &[Counted<'_>]) -> bool {
    let array = program.array(array);
    let range = range(program, index, counters);
    range.is_some_and(|(least, most)| i128::from(array.low) <= least && most <= i128::from(array.high))
}

/// What an integer expression may be, while the counters of the loops around it are within theirs.
fn range(program: &Program, expr: &Expr, counters: &[Counted<'_>]) -> Option<Range> {
    let whole = program.lane(expr.ty)?.range()?;
    let known = match &expr.kind {
        ExprKind::Const(value) => value.as_integer().map(|it| (it, it)),
        ExprKind::Load(place) => running(counters, place).map(|at| counters[at].range),
        ExprKind::Convert(Conversion::Value | Conversion::Same, operand) => range(program, operand, counters),
        ExprKind::Apply(op, operands) => match operands.as_slice() {
            [a, b] => {
                range(program, a, counters).zip(range(program, b, counters)).and_then(|(a, b)| combined(*op, a, b))
            }
            _ => None,
        },
        ExprKind::Convert(Conversion::Truncate, _)
        | ExprKind::ApplyText(..)
        | ExprKind::Text(_)
        | ExprKind::Aggregate(_) => None,
    };
    // What leaves the type wraps, and may be anything.
    Some(known.filter(|(least, most)| whole.0 <= *least && *most <= whole.1).unwrap_or(whole))
}

/// Which of the counters is `place`.
pub fn running(counters: &[Counted<'_>], place: &Place) -> Option<usize> {
    counters.iter().rposition(|it| place.is_same_variable(it.counter))
}

fn combined(op: Op, a: Range, b: Range) -> Option<Range> {
    match op {
        Op::Add => Some((a.0 + b.0, a.1 + b.1)),
        Op::Sub => Some((a.0 - b.1, a.1 - b.0)),
        Op::Mul => product(a, b),
        // A remainder has the dividend's sign, and is smaller than the divisor.
        Op::Mod if b.0 == b.1 && b.0 > 0 => {
            let most = b.0 - 1;
            Some((if a.0 >= 0 { 0 } else { -most }, if a.1 <= 0 { 0 } else { most }))
        }
        Op::And if b.0 == b.1 && b.0 >= 0 => Some((0, b.0)),
        _ => None,
    }
}

fn product(a: Range, b: Range) -> Option<Range> {
    let corners = [a.0.checked_mul(b.0)?, a.0.checked_mul(b.1)?, a.1.checked_mul(b.0)?, a.1.checked_mul(b.1)?];
    Some((*corners.iter().min()?, *corners.iter().max()?))
}
