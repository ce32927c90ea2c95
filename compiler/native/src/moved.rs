//! A reference that has just been followed is moved by one addition.
//!
//! ```text
//! sum := sum + p^;                sum := sum + p^;
//! p := p + 4;                     low := (p + 4) AND 16#FFFF_FFFF;
//!                                 p := (p AND NOT 16#FFFF_FFFF) OR low;      becomes p := p + 4
//! ```
//!
//! The lower half of a reference is an address, which wraps and leaves the upper half as it is. It applies to a reference in a local variable
//! that a statement before has followed, to what it points to itself, and that nothing has written since: had it not led into the
//! state, the scan would have ended. So its address is not less than that of the state's first byte, and far from the greatest.
//! The distance is a constant that is less than both. It may not assume anything of a reference that is
//! only compared or handed on.

use crate::function::Function;
use staunch_ir::alias::{Frame, changes};
use staunch_ir::{Expr, ExprKind, Place, Projection, Root, Statement, StatementKind, Value, visit};
use staunch_runtime::reference::ORIGIN;
use std::slice::from_ref;

/// More statements before are not looked at.
const FAR: usize = 16;
/// Sizes are within 1 GiB, so that addresses are less than twice that.
const MOST: i128 = 1 << 30;

impl Function<'_, '_> {
    /// Whether a reference that is moved by a distance keeps its upper half.
    pub(crate) fn stays_within_its_half(&self, operands: &[Expr]) -> bool {
        let [reference, distance] = operands else { return false };
        let distance = distance.as_const().and_then(Value::as_integer);
        let is_near = distance.is_some_and(|it| -i128::from(ORIGIN) <= it && it <= MOST);
        let Some(reference) = variable(reference).filter(|_| is_near) else { return false };
        let frame = Frame::of(self.module.program, self.routine);
        let value = Expr::load(reference.clone(), Default::default());
        for statement in self.before.iter().rev().take(FAR) {
            if changes(&frame, from_ref(statement), &value) {
                return false;
            }
            if follows(statement, reference) {
                return true;
            }
        }
        false
    }
}

fn variable(expr: &Expr) -> Option<&Place> {
    match &expr.kind {
        ExprKind::Load(place) => {
            (matches!(place.root, Root::Local(_)) && place.projections.is_empty()).then_some(place)
        }
        ExprKind::Convert(_, operand) => variable(operand),
        _ => None,
    }
}

/// Whether an assignment reads or writes what the reference points to.
fn follows(statement: &Statement, reference: &Place) -> bool {
    let mut found = false;
    if matches!(statement.kind, StatementKind::Assign { .. }) {
        visit::accesses(statement, &mut |place, _| {
            let is_direct = matches!(place.projections.as_slice(), [Projection::Deref { .. }]);
            found |= is_direct && place.root == reference.root;
        });
    }
    found
}
