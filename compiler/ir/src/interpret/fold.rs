//! Constant expressions, computed by the functions that run later.

use super::evaluate::{Storage, scalar, text};
use crate::{Const, Expr, ExprKind, Place, Type, Value};
use staunch_runtime::Fault;

/// The value of an expression that reads no place; `None` if it reads one.
pub fn fold(expr: &Expr) -> Option<Result<Const, Fault>> {
    reads_nothing(expr).then(|| constant(expr))
}

fn constant(expr: &Expr) -> Result<Const, Fault> {
    match expr.ty {
        Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) => scalar(&NoStorage, expr).map(Const::Scalar),
        Type::String(_) => text(&NoStorage, expr).map(Const::Text),
        Type::Array(_) | Type::Struct(_) | Type::Block(_) => Ok(aggregate(expr)),
    }
}

fn aggregate(expr: &Expr) -> Const {
    match &expr.kind {
        ExprKind::Aggregate(value) => value.clone(),
        ExprKind::Const(_)
        | ExprKind::Text(_)
        | ExprKind::Load(_)
        | ExprKind::Apply(..)
        | ExprKind::ApplyText(..)
        | ExprKind::Convert(..) => unreachable!("verified IR: an aggregate is read or constant"),
    }
}

fn reads_nothing(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => true,
        ExprKind::Load(_) => false,
        ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => operands.iter().all(reads_nothing),
        ExprKind::Convert(_, operand) => reads_nothing(operand),
    }
}

struct NoStorage;

impl Storage for NoStorage {
    fn load(&self, _place: &Place) -> Result<Value, Fault> {
        unreachable!("a constant expression reads no place")
    }

    fn load_text(&self, _place: &Place) -> Result<Vec<u8>, Fault> {
        unreachable!("a constant expression reads no place")
    }
}
