//! Stops: places between statements where an interpreted run can be looked at.
//!
//! A stop is a CASE whose only arm has no label, on a constant: how many of the routine's locals are declared by the user. No executor ever enters that arm, and every pass treats what is
//! in it as it treats the rest of the routine. The arm holds the expression that the stop is asked about, if there is one.
//! The front end makes stops only for a program that is to be debugged.

use crate::{Arm, Elementary, Expr, Location, Place, Statement, StatementKind, Value};

/// A stop, as it is found in a routine.
#[derive(Clone, Debug)]
pub struct StopStatement<'a> {
    /// So many of the routine's locals, from the first, are declared; the others are temporaries.
    pub declared: usize,
    pub asked: Asked<&'a Expr>,
}

/// What a stop evaluates.
#[derive(Clone, Debug)]
pub enum Asked<E> {
    Nothing,
    /// The run stops here only if this BOOL is TRUE.
    Condition(E),
    /// A value that somebody wants to see.
    Value(E),
}

impl Statement {
    /// A stop before the statement at `at`. A value needs a local of its type, which is never written.
    pub fn stop(declared: usize, asked: Asked<(Expr, Option<Place>)>, at: Location) -> Self {
        let body = match asked {
            Asked::Nothing => Vec::new(),
            Asked::Condition((condition, _)) => {
                vec![Self::new(StatementKind::If { condition, then: Vec::new(), otherwise: Vec::new() }, at)]
            }
            Asked::Value((value, target)) => target.map(|target| Self::assign(target, value, at)).into_iter().collect(),
        };
        let selector = Expr::constant(Elementary::Lint, Value::I64(i64::try_from(declared).unwrap_or(i64::MAX)), at);
        let arms = vec![Arm { labels: Vec::new(), body }];
        Self::new(StatementKind::Case { selector, arms, otherwise: Vec::new() }, at)
    }
}

impl StatementKind {
    pub fn as_stop(&self) -> Option<StopStatement<'_>> {
        let Self::Case { selector, arms, otherwise } = self else { return None };
        let [Arm { labels, body }] = arms.as_slice() else { return None };
        if !labels.is_empty() || !otherwise.is_empty() {
            return None;
        }
        let declared = usize::try_from(selector.as_const()?.as_integer()?).ok()?;
        let asked = match body.first().map(|it| &it.kind) {
            None => Asked::Nothing,
            Some(Self::If { condition, .. }) => Asked::Condition(condition),
            Some(Self::Assign { value, .. }) => Asked::Value(value),
            Some(_) => return None,
        };
        Some(StopStatement { declared, asked })
    }
}
