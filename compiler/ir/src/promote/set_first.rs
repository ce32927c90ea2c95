//! Whether a loop gives a variable a value before it reads it, so that the value from before the loop is nobody's.

use crate::visit;
use crate::{Expr, For, Place, Statement, StatementKind, Step, Value};

/// What statements do first with a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum First {
    Nothing,
    /// It is given a value, on all ways.
    Set,
    /// It may be read, or left as it is.
    Other,
}

/// Whether the loop sets the variable, in all cases, before it reads it.
pub(super) fn is_set_first(statement: &Statement, place: &Place) -> bool {
    first(statement, place) == First::Set
}

fn first_of(block: &[Statement], place: &Place) -> First {
    block.iter().map(|it| first(it, place)).find(|it| *it != First::Nothing).unwrap_or(First::Nothing)
}

fn first(statement: &Statement, place: &Place) -> First {
    match &statement.kind {
        StatementKind::Assign { target, value } if target.is_same_variable(place) && !reads(value, place) => First::Set,
        StatementKind::For(it) => of_for(statement, it, place),
        StatementKind::If { condition, then, otherwise } if !reads(condition, place) => {
            match [then, otherwise].map(|it| first_of(it, place)) {
                [First::Set, First::Set] => First::Set,
                [First::Nothing, First::Nothing] => First::Nothing,
                _ => First::Other,
            }
        }
        // Control continues elsewhere from there.
        StatementKind::Exit | StatementKind::Continue | StatementKind::Return => First::Other,
        _ => of_any(statement, place),
    }
}

fn of_for(statement: &Statement, it: &For, place: &Place) -> First {
    let is_read = |it: &Expr| reads(it, place);
    if it.counter.is_same_variable(place) && !is_read(&it.first) {
        return First::Set;
    }
    let step_reads = matches!(&it.step, Step::Variable(step) if is_read(step));
    let head_reads = is_read(&it.first) || is_read(&it.last) || step_reads;
    if !head_reads && has_a_turn(it) && first_of(&it.body, place) == First::Set {
        return First::Set;
    }
    of_any(statement, place)
}

/// By what is known of its bounds.
fn has_a_turn(it: &For) -> bool {
    let [first, last] = [&it.first, &it.last].map(|it| it.as_const().and_then(Value::as_integer));
    let (Some(first), Some(last), Step::Constant(step)) = (first, last, &it.step) else { return false };
    if *step > 0 { first <= last } else { first >= last }
}

/// Of a statement of which no more is known than whether it touches the variable. What leaves a loop inside of it, stays
/// inside; another loop around is left by what is looked at by itself.
fn of_any(statement: &Statement, place: &Place) -> First {
    let mut found = false;
    let mut see = |it: &Statement| visit::accesses(it, &mut |it, _| found |= it.is_same_variable(place));
    visit::statements(std::slice::from_ref(statement), &mut see);
    let is_loop = matches!(statement.kind, StatementKind::Loop { .. } | StatementKind::For(_));
    let leaves =
        |it: &Statement| matches!(it.kind, StatementKind::Exit | StatementKind::Continue | StatementKind::Return);
    if !is_loop {
        visit::statements(std::slice::from_ref(statement), &mut |it| found |= leaves(it));
    }
    if found { First::Other } else { First::Nothing }
}

fn reads(expr: &Expr, place: &Place) -> bool {
    let mut found = false;
    visit::reads(expr, &mut |it| found |= it.is_same_variable(place));
    found
}
