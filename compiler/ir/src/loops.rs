//! What is known of FOR loops: which counters nothing but the loop writes, and what values they
//! have. A back end may keep such a counter in a register beside its storage, and an index whose
//! range follows from the loop's bounds needs no check.

use crate::alias::{self, Frame};
use crate::{ArrayId, Conversion, Expr, ExprKind, For, Op, Place, Program, Statement, StatementKind, Value};

/// Inclusive.
pub type Range = (i128, i128);

/// The condition of `IF … THEN EXIT; END_IF`.
pub fn exit_condition(statement: &Statement) -> Option<&Expr> {
    let StatementKind::If { condition, then, otherwise } = &statement.kind else { return None };
    let exits = matches!(then.as_slice(), [only] if matches!(only.kind, StatementKind::Exit));
    (exits && otherwise.is_empty()).then_some(condition)
}

/// Whether nothing but the loop itself can write its counter while it runs: others cannot name it,
/// and the body neither writes it nor hands it on. A back end knows such a counter where it is read by
/// its name, so an element of an array is none.
pub fn is_private(frame: &Frame<'_>, counter: &Place, body: &[Statement]) -> bool {
    counter.indices().next().is_none() && frame.is_private(counter) && !alias::writes(frame, body, counter)
}

/// The 0-based position of an index that is constant and within the bounds.
pub fn constant_position(program: &Program, index: &Expr, array: ArrayId) -> Option<u64> {
    let array = program.array(array);
    let Some(Value::I64(index)) = index.as_const() else { return None };
    (array.low..=array.high).contains(&index).then(|| index.abs_diff(array.low))
}

/// Whether an index needs no check in the bodies of `loops`, whose counters are private.
pub fn is_within(program: &Program, index: &Expr, array: ArrayId, loops: &[&For]) -> bool {
    let array = program.array(array);
    let range = range(program, index, loops);
    range.is_some_and(|(least, most)| i128::from(array.low) <= least && most <= i128::from(array.high))
}

/// What an integer expression may be, in the bodies of `loops`.
fn range(program: &Program, expr: &Expr, loops: &[&For]) -> Option<Range> {
    let whole = program.lane(expr.ty)?.range()?;
    let known = match &expr.kind {
        ExprKind::Const(value) => value.as_integer().map(|it| (it, it)),
        ExprKind::Load(place) => running(loops, place).map(|at| loops[at].bounds()),
        ExprKind::Convert(Conversion::Value | Conversion::Same, operand) => range(program, operand, loops),
        ExprKind::Apply(op, operands) => match operands.as_slice() {
            [a, b] => range(program, a, loops).zip(range(program, b, loops)).and_then(|(a, b)| combined(*op, a, b)),
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

/// Which of the loops has `place` as its counter.
pub fn running(loops: &[&For], place: &Place) -> Option<usize> {
    loops.iter().rposition(|it| place.is_same_variable(&it.counter))
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
