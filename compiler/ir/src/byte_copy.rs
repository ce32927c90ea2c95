//! Loops that copy bytes from one reference to another: what MEMCPY is in the IR, where the interpreter runs it. A back end may
//! call the runtime once for all of its turns, which does the same to the state, and faults in the same way.

use crate::{Conversion, Elementary, Expr, ExprKind, For, Location, Op, Place, Projection, Root, Statement};
use crate::{StatementKind, Step, Type, Value};

/// `to^ := from^; to := to + by; from := from + by;` in each turn.
#[derive(Clone, Copy, Debug)]
pub struct ByteCopy<'a> {
    /// A local.
    pub to: &'a Place,
    /// Another.
    pub from: &'a Place,
    /// A LINT that no turn changes.
    pub by: &'a Expr,
    /// Where an access faults.
    pub at: Location,
}

/// The copy that a loop is which counts up from 1 and takes no turn of its own in its body.
pub fn byte_copy(it: &For) -> Option<ByteCopy<'_>> {
    let [copy, first, second] = it.body.as_slice() else { return None };
    let counts = matches!(it.step, Step::Constant(1)) && it.first.as_const() == Some(Value::I64(1));
    let StatementKind::Assign { target, value } = &copy.kind else { return None };
    let ExprKind::Load(source) = &value.kind else { return None };
    let ((to, at), (from, source_at)) = (byte_behind(target)?, byte_behind(source)?);
    let (to, from) = (moved(first, to)?, moved(second, from)?);
    let locals = [local(&it.counter)?, local(to.0)?, local(from.0)?];
    let are_apart = locals[0] != locals[1] && locals[0] != locals[2] && locals[1] != locals[2];
    let is_fixed = |by: &Expr| match &by.kind {
        ExprKind::Const(_) => true,
        ExprKind::Load(place) => local(place).is_some_and(|it| !locals.contains(&it)),
        _ => false,
    };
    let same = is_same(to.1, from.1) && is_fixed(to.1);
    let is_it = counts && it.is_private && at == source_at && are_apart && same;
    is_it.then_some(ByteCopy { to: to.0, from: from.0, by: to.1, at })
}

/// The root of `pointer^`, a BYTE.
fn byte_behind(place: &Place) -> Option<(Root, Location)> {
    match place.projections.as_slice() {
        [Projection::Deref { target: Type::Elementary(Elementary::Byte), at, .. }] => Some((place.root, *at)),
        _ => None,
    }
}

/// `pointer := pointer + by`, of the pointer that is this root.
fn moved(statement: &Statement, pointer: Root) -> Option<(&Place, &Expr)> {
    let StatementKind::Assign { target, value } = &statement.kind else { return None };
    let ExprKind::Convert(Conversion::Same, sum) = &value.kind else { return None };
    let ExprKind::Apply(Op::Advance, operands) = &sum.kind else { return None };
    let [from, by] = operands.as_slice() else { return None };
    let ExprKind::Convert(Conversion::Same, from) = &from.kind else { return None };
    let is_it = target.projections.is_empty() && target.root == pointer;
    let goes_on = matches!(&from.kind, ExprKind::Load(it) if it.is_same_variable(target));
    (is_it && goes_on).then_some((target, by))
}

fn local(place: &Place) -> Option<Root> {
    (matches!(place.root, Root::Local(_)) && place.projections.is_empty()).then_some(place.root)
}

fn is_same(a: &Expr, b: &Expr) -> bool {
    match (&a.kind, &b.kind) {
        (ExprKind::Const(a), ExprKind::Const(b)) => a == b,
        (ExprKind::Load(a), ExprKind::Load(b)) => a.is_same_variable(b),
        _ => false,
    }
}
