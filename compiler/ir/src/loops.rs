//! What is known of FOR loops: which counters nothing but the loop writes, and what values they
//! have. A back end may keep such a counter in a register beside its storage, and an index whose
//! range follows from the loop's bounds needs no check.

use crate::visit::{self, Access};
use crate::{
    ArrayId, Conversion, Expr, ExprKind, For, Op, Place, Program, Projection, Root, Section, Statement, StatementKind,
    Type, Value,
};

/// Inclusive.
pub type Range = (i128, i128);

/// The condition of `IF … THEN EXIT; END_IF`.
pub fn exit_condition(statement: &Statement) -> Option<&Expr> {
    let StatementKind::If { condition, then, otherwise } = &statement.kind else { return None };
    let exits = matches!(then.as_slice(), [only] if matches!(only.kind, StatementKind::Exit));
    (exits && otherwise.is_empty()).then_some(condition)
}

/// Whether nothing but the loop itself can write its counter while it runs: others cannot name it,
/// and the body neither writes it nor hands it on. `root` is the type of the counter's root.
pub fn is_private(program: &Program, root: Option<Type>, counter: &Place, body: &[Statement]) -> bool {
    is_out_of_reach(program, root, counter) && !writes(body, counter)
}

/// Whether the counter is a local, or below a variable of an instance that only its own body can name.
/// That body does not run a second time while it runs.
fn is_out_of_reach(program: &Program, root: Option<Type>, counter: &Place) -> bool {
    let mut ty = root;
    let mut is_internal = matches!(counter.root, Root::Local(_));
    for projection in &counter.projections {
        let (Projection::Field(id), Some(whole)) = (projection, ty) else { return false };
        if let Type::Struct(structure) = whole
            && (counter.root == Root::Instance || program.class_of_state(structure).is_some())
        {
            let field = &program.structure(structure).fields[id.index()];
            is_internal |= field.section == Section::Internal && field.address.is_none();
        }
        ty = program.member(whole, *id);
    }
    is_internal
}

/// Whether the statements write `place`, which others cannot reach, or hand it on.
fn writes(block: &[Statement], place: &Place) -> bool {
    let mut found = false;
    visit::statements(block, &mut |statement| {
        visit::accesses(statement, &mut |it, access| found |= access != Access::Read && overlaps(it, place));
    });
    found
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
