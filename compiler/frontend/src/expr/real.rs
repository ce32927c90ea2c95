//! Arithmetic on literals with a fraction. It waits for the type that its place asks for: then each
//! literal is rounded to that type, and each operation is the one that runs later.

use staunch_ir::{Lane, Op, Value, apply};

#[derive(Clone, Debug)]
pub(crate) enum Real {
    /// Digits as they are written, so that they are rounded once.
    Literal(String),
    Apply(Op, Vec<Real>),
}

impl Real {
    /// The value at REAL's or LREAL's lane; `None` at another.
    pub fn value(&self, lane: Lane) -> Option<Value> {
        match self {
            Self::Literal(digits) => literal(digits, lane),
            Self::Apply(op, operands) => {
                let values: Option<Vec<_>> = operands.iter().map(|it| it.value(lane)).collect();
                apply(*op, lane, &values?)?.ok()
            }
        }
    }

    /// Whether each literal has a value at the lane.
    pub fn fits(&self, lane: Lane) -> bool {
        match self {
            Self::Literal(digits) => literal(digits, lane).is_some_and(is_finite),
            Self::Apply(_, operands) => operands.iter().all(|it| it.fits(lane)),
        }
    }
}

fn literal(digits: &str, lane: Lane) -> Option<Value> {
    match lane {
        Lane::F32 => digits.parse().ok().map(Value::F32),
        Lane::F64 => digits.parse().ok().map(Value::F64),
        Lane::Bool | Lane::I8 | Lane::I16 | Lane::I32 | Lane::I64 | Lane::U8 | Lane::U16 | Lane::U32 | Lane::U64 => {
            None
        }
    }
}

fn is_finite(value: Value) -> bool {
    match value {
        Value::F32(it) => it.is_finite(),
        Value::F64(it) => it.is_finite(),
        _ => false,
    }
}
