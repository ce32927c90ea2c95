//! Numbers that decide something, through what is computed of them.

use staunch_ir::{Op, Program, Type, Value};
use std::collections::BTreeSet;

/// Numbers that a variable is worth comparing with; reals keep their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbers {
    pub integers: BTreeSet<i128>,
    pub reals: Vec<f64>,
}

impl Numbers {
    pub fn add(&mut self, value: Value) {
        match value {
            Value::F32(it) => self.add_real(f64::from(it)),
            Value::F64(it) => self.add_real(it),
            other => self.integers.extend(other.as_integer()),
        }
    }

    pub fn add_all(&mut self, more: Self) {
        self.integers.extend(more.integers);
        more.reals.into_iter().for_each(|it| self.add_real(it));
    }

    fn add_real(&mut self, number: f64) {
        if number.is_finite() && !self.reals.contains(&number) {
            self.reals.push(number);
            self.reals.sort_by(f64::total_cmp);
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    Integer(i128),
    Real(f64),
}

impl Number {
    pub fn value(self) -> Option<Value> {
        match self {
            Self::Integer(it) => i64::try_from(it).map(Value::I64).or_else(|_| it.try_into().map(Value::U64)).ok(),
            Self::Real(it) => Some(Value::F64(it)),
        }
    }

    pub fn of_type(self, program: &Program, ty: Type) -> Self {
        let real = program.repr(ty).is_some_and(staunch_runtime::Repr::is_float);
        match (self, real) {
            (Self::Integer(it), true) => Self::Real(real_of(it)),
            (Self::Real(it), false) => Self::Integer(whole(it)),
            (same, _) => same,
        }
    }

    /// What an operand is near to where the operation's result is near to this.
    pub fn before(self, op: Op, at: usize, other: Option<Self>) -> Vec<Self> {
        match (self, other) {
            (Self::Integer(limit), Some(Self::Integer(other))) => {
                integers_before(op, at, limit, other).into_iter().map(Self::Integer).collect()
            }
            (Self::Real(limit), Some(Self::Real(other))) => {
                reals_before(op, at, limit, other).into_iter().map(Self::Real).collect()
            }
            (same, _) => vec![same],
        }
    }
}

fn integers_before(op: Op, at: usize, limit: i128, other: i128) -> Vec<i128> {
    // A quotient is the same for several dividends; a product is near for the factors around.
    let (exact, width) = match (op, at) {
        (Op::Add, _) => (limit.checked_sub(other), 1),
        (Op::Sub, 0) => (limit.checked_add(other), 1),
        (Op::Sub, _) => (other.checked_sub(limit), 1),
        (Op::Mul, _) => (limit.checked_div(other), 2),
        (Op::Div, 0) => (limit.checked_mul(other), other),
        _ => (Some(limit), 1),
    };
    exact.into_iter().flat_map(|it| [it, it.saturating_add(width.saturating_sub(1))]).collect()
}

fn reals_before(op: Op, at: usize, limit: f64, other: f64) -> Vec<f64> {
    vec![match (op, at) {
        (Op::Add, _) => limit - other,
        (Op::Sub, 0) => limit + other,
        (Op::Sub, _) => other - limit,
        (Op::Mul, _) => limit / other,
        (Op::Div, 0) => limit * other,
        _ => limit,
    }]
}

/// The nearest real: a limit need not be exact to be near.
fn real_of(number: i128) -> f64 {
    number.to_string().parse().unwrap_or(0.0)
}

/// The whole part of a real, or 0 where it is none.
fn whole(number: f64) -> i128 {
    format!("{:.0}", number.trunc()).parse().unwrap_or(0)
}
