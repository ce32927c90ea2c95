//! Whole numbers that are computed at more bits than they are stored with.

use crate::{Conversion, Elementary, Expr, ExprKind, Op, Type};

/// Whether a type is of whole numbers, or bits, of fewer than 32 bits.
pub fn is_narrow(ty: Elementary) -> bool {
    (ty.is_integer() || ty.is_bits() && ty != Elementary::Bool) && ty.repr().size() < 4
}

/// A promoted value where it is stored: its low bits. They are computed at the type of the store where
/// that gives the same ones.
pub fn stored(value: Expr, to: Elementary) -> Expr {
    if is_narrow(to)
        && let ExprKind::Apply(..) = value.kind
        && let Some(narrow) = low_bits(&value, to)
    {
        return narrow;
    }
    converted(value, to)
}

/// What gives the same low bits at `to`: no higher bit of an operand changes them.
fn low_bits(value: &Expr, to: Elementary) -> Option<Expr> {
    match &value.kind {
        ExprKind::Const(_) => Some(converted(value.clone(), to)),
        ExprKind::Convert(Conversion::Value, inner) => {
            let from = inner.ty.elementary().filter(|it| is_narrow(*it) && it.repr().size() <= to.repr().size())?;
            let is_read = inner.ty == Type::Elementary(from);
            is_read.then(|| converted((**inner).clone(), to))
        }
        ExprKind::Apply(op @ (Op::Add | Op::Sub | Op::Mul | Op::Neg | Op::And | Op::Or | Op::Xor), operands) => {
            let operands = operands.iter().map(|it| low_bits(it, to)).collect::<Option<_>>()?;
            Some(Expr::apply(*op, Type::Elementary(to), operands, value.at))
        }
        ExprKind::Apply(..)
        | ExprKind::ApplyText(..)
        | ExprKind::Convert(Conversion::Same | Conversion::Truncate | Conversion::Bits, _)
        | ExprKind::Load(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Text(_)
        | ExprKind::Aggregate(_) => None,
    }
}

/// An integer at another type, folded where it is constant.
fn converted(value: Expr, to: Elementary) -> Expr {
    let (at, ty) = (value.at, Type::Elementary(to));
    if value.ty == ty {
        return value;
    }
    if let Some(constant) = value.as_const() {
        return Expr::constant(to, staunch_runtime::ops::convert_value(constant, to.repr()), at);
    }
    let same = value.ty.elementary().is_some_and(|it| it.repr() == to.repr());
    Expr::convert(if same { Conversion::Same } else { Conversion::Value }, ty, value, at)
}

#[cfg(test)]
mod tests;
