//! Arithmetic on literals with a fraction. It waits for the type that its place asks for: then each
//! literal is rounded to that type, and each operation is the one that runs later.

use staunch_ir::{Op, Repr, Value, apply};

#[derive(Clone, Debug)]
pub(crate) enum Real {
    /// Digits as they are written, so that they are rounded once.
    Literal(String),
    Apply(Op, Vec<Real>),
}

impl Real {
    /// The value at REAL's or LREAL's repr; `None` at another.
    pub fn value(&self, repr: Repr) -> Option<Value> {
        match self {
            Self::Literal(digits) => literal(digits, repr),
            Self::Apply(op, operands) => {
                let values: Option<Vec<_>> = operands.iter().map(|it| it.value(repr)).collect();
                apply(*op, repr, &values?)?.ok()
            }
        }
    }

    /// Whether each literal has a value at the repr.
    pub fn fits(&self, repr: Repr) -> bool {
        match self {
            Self::Literal(digits) => literal(digits, repr).is_some_and(is_finite),
            Self::Apply(_, operands) => operands.iter().all(|it| it.fits(repr)),
        }
    }
}

fn literal(digits: &str, repr: Repr) -> Option<Value> {
    match repr {
        Repr::F32 => digits.parse().ok().map(Value::F32),
        Repr::F64 => digits.parse().ok().map(Value::F64),
        Repr::Bool | Repr::I8 | Repr::I16 | Repr::I32 | Repr::I64 | Repr::U8 | Repr::U16 | Repr::U32 | Repr::U64 => {
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
