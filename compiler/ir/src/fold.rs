//! Constant expressions, computed by the functions that run later.

use crate::evaluate::{Storage, scalar, text};
use crate::{Chars, Const, Expr, ExprKind, Place, Type, Value};
use staunch_runtime::Fault;

/// The value of a constant, or of an operation on constants; `None` for what is more than that.
pub fn fold(expr: &Expr) -> Option<Result<Const, Fault>> {
    let known = match &expr.kind {
        ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => operands.iter().all(is_constant),
        ExprKind::Convert(_, operand) => is_constant(operand),
        ExprKind::Const(_)
        | ExprKind::Text(_)
        | ExprKind::Aggregate(_)
        | ExprKind::Load(_)
        | ExprKind::AddressOf(_) => is_constant(expr),
    };
    known.then(|| constant(expr))
}

fn constant(expr: &Expr) -> Result<Const, Fault> {
    match expr.ty {
        Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
            scalar(&NoStorage, expr).map(Const::Scalar)
        }
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
        | ExprKind::AddressOf(_)
        | ExprKind::Apply(..)
        | ExprKind::ApplyText(..)
        | ExprKind::Convert(..) => unreachable!("verified IR: an aggregate is read or constant"),
    }
}

fn is_constant(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => true,
        ExprKind::Load(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Apply(..)
        | ExprKind::ApplyText(..)
        | ExprKind::Convert(..) => false,
    }
}

struct NoStorage;

impl Storage for NoStorage {
    fn load(&self, _place: &Place) -> Result<Value, Fault> {
        unreachable!("a constant expression reads no place")
    }

    fn address_of(&self, _place: &Place) -> Result<Value, Fault> {
        unreachable!("a constant expression names no place")
    }

    fn load_text(&self, _place: &Place) -> Result<Chars, Fault> {
        unreachable!("a constant expression reads no place")
    }
}
