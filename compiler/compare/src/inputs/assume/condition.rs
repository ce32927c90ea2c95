//! What inputs are said to be together.

use crate::program::facts::Numbers;
use staunch_ir::Value;
use std::cmp::Ordering;

#[derive(Clone, Debug)]
pub enum Condition {
    Is(usize),
    Compare(usize, Relation, Value),
    Not(Box<Condition>),
    And(Box<Condition>, Box<Condition>),
    Or(Box<Condition>, Box<Condition>),
}

#[derive(Clone, Copy, Debug)]
pub enum Relation {
    Lt,
    Le,
    Gt,
    Ge,
    Eq,
    Ne,
}

impl Condition {
    pub fn holds(&self, inputs: &[Value]) -> bool {
        match self {
            Self::Is(at) => inputs[*at] == Value::Bool(true),
            Self::Compare(at, relation, limit) => {
                let ordering = order(inputs[*at], *limit);
                match relation {
                    Relation::Lt => ordering.is_some_and(Ordering::is_lt),
                    Relation::Le => ordering.is_some_and(Ordering::is_le),
                    Relation::Gt => ordering.is_some_and(Ordering::is_gt),
                    Relation::Ge => ordering.is_some_and(Ordering::is_ge),
                    Relation::Eq => ordering.is_some_and(Ordering::is_eq),
                    Relation::Ne => ordering.is_none_or(Ordering::is_ne),
                }
            }
            Self::Not(inner) => !inner.holds(inputs),
            Self::And(a, b) => a.holds(inputs) && b.holds(inputs),
            Self::Or(a, b) => a.holds(inputs) || b.holds(inputs),
        }
    }

    pub fn near(&self, input: usize, found: &mut Numbers) {
        match self {
            Self::Compare(at, _, limit) if *at == input => found.add(*limit),
            Self::Is(_) | Self::Compare(..) => {}
            Self::Not(inner) => inner.near(input, found),
            Self::And(a, b) | Self::Or(a, b) => [a, b].into_iter().for_each(|it| it.near(input, found)),
        }
    }
}

/// Two values of one type; a NaN is in no order.
pub fn order(a: Value, b: Value) -> Option<Ordering> {
    match (a, b) {
        (Value::F32(a), Value::F32(b)) => a.partial_cmp(&b),
        (Value::F64(a), Value::F64(b)) => a.partial_cmp(&b),
        (Value::Bool(a), Value::Bool(b)) => Some(a.cmp(&b)),
        _ => Some(a.as_integer()?.cmp(&b.as_integer()?)),
    }
}

pub fn is_within(value: Value, low: Value, high: Value) -> bool {
    order(low, value).is_some_and(Ordering::is_le) && order(value, high).is_some_and(Ordering::is_le)
}
