//! What flows through the statements: which whole numbers a variable may hold at each, where that is less than its type; and the
//! plain form of the statements, in which two systems' programs are the same where they do the same.
//!
//! A variable starts with a value, and holds what the statements assign to it: a preset that a CASE chooses from a recipe is one
//! of a few, and a count that is only raised below a limit does not pass it. What else writes a variable, or may by a
//! reference, leaves it with all that its type holds.

mod exact;
mod known;
mod names;
mod unread;
mod walk;

pub use staunch_ir::interval::Range;

use super::walked::Name;
use known::Known;
use names::{Names, Written};
use staunch_ir::{Expr, Program, Routine, RoutineId, Type, Value, visit};
use std::collections::{BTreeSet, HashMap};

/// Rounds in which ranges grow to the next constant of the program; then at once to all of a type.
const CAREFUL_ROUNDS: usize = 10;
/// In which they grow at all: each variable that grows on is left out.
const MOST_ROUNDS: usize = 40;

#[derive(Debug)]
pub struct Ranges<'p> {
    names: Names<'p>,
}

impl<'p> Ranges<'p> {
    /// Of the variables that start with values in these ranges, and that the program alone writes.
    pub fn of(program: &'p Program, starts: &HashMap<Name, Range>) -> Self {
        let mut names = Names { program, known: starts.clone() };
        let open = names.reached();
        names.known.retain(|name, _| !open.contains(name));
        let limits = limits(program);
        for round in 0..MOST_ROUNDS {
            if names.known.is_empty() || !names.grow(&written(&names), &limits, round < CAREFUL_ROUNDS) {
                return Self { names };
            }
        }
        names.known.clear();
        Self { names }
    }

    /// The values that an expression may have, whatever is known where it is.
    pub fn of_value(&self, at: (&Routine, RoutineId), value: &Expr) -> Range {
        Known::new(&self.names, at.1).of(value).map_or((i128::MIN, i128::MAX), |it| it.range)
    }

    pub fn whole(&self, ty: Type) -> Option<Range> {
        self.names.whole(ty)
    }

    /// Whether a FOR may come to the limit of its counter's type.
    pub fn reach_limits(&self) -> bool {
        self.walked().any(|it| it.reaches_limit)
    }

    /// Whether a sum, difference or product may pass the range of a signed type of 32 or 64 bits.
    pub fn overflow(&self) -> bool {
        self.walked().any(|it| it.overflows)
    }

    fn walked(&self) -> impl Iterator<Item = walk::Plain> {
        let routines = 0..self.names.program.routines.len();
        routines.map(|at| walk::routine(&self.names, RoutineId::next(at), &mut Written::default()))
    }

    /// The program in its plain form: to be printed, not to be run. `None` where it may fault.
    pub fn plain(&self) -> Option<Program> {
        let mut plain = self.names.program.clone();
        for (at, routine) in plain.routines.iter_mut().enumerate() {
            let walked = walk::routine(&self.names, RoutineId::next(at), &mut Written::default());
            if walked.faults {
                return None;
            }
            *routine = unread::without_unread(routine, walked.body);
        }
        Some(plain)
    }
}

/// What all statements give variables, where these hold what is known of them.
fn written(names: &Names<'_>) -> Written {
    let mut written = Written::default();
    for at in 0..names.program.routines.len() {
        walk::routine(names, RoutineId::next(at), &mut written);
    }
    written
}

/// Every whole number of the program, with those next to it.
fn limits(program: &Program) -> BTreeSet<i128> {
    let mut found = BTreeSet::from([0]);
    for routine in &program.routines {
        visit::statements(&routine.body, &mut |statement| {
            visit::all_exprs(statement, &mut |it| {
                let number = it.as_const().and_then(Value::as_integer);
                found.extend(number.into_iter().flat_map(|it| [it - 1, it, it + 1]));
            });
        });
    }
    found
}

#[cfg(test)]
mod tests;
