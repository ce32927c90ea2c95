//! What an expression may be, whatever its variables are.

use crate::{Conversion, Expr, ExprKind, Op, TextOp, Type};

/// Inclusive.
pub type Range = (i128, i128);

/// What constants and the capacities of strings say of an integer expression; `None` where they say nothing.
pub(crate) fn limits(expr: &Expr) -> Option<Range> {
    let known = match &expr.kind {
        ExprKind::Const(value) => value.as_integer().map(|it| (it, it)),
        ExprKind::Convert(Conversion::Value | Conversion::Same, operand) => limits(operand),
        ExprKind::Apply(op, operands) => match operands.as_slice() {
            [a, b] => combined(*op, limits(a)?, limits(b)?),
            _ => None,
        },
        ExprKind::ApplyText(op, operands) => length(*op, operands),
        ExprKind::Load(_)
        | ExprKind::Convert(Conversion::Truncate | Conversion::Bits, _)
        | ExprKind::Text(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Aggregate(_) => None,
    };
    let Type::Elementary(ty) = expr.ty else { return known.filter(|_| matches!(expr.kind, ExprKind::Const(_))) };
    let whole = ty.repr().range()?;
    // What leaves the type wraps, and may be anything.
    known.filter(|(least, most)| whole.0 <= *least && *most <= whole.1)
}

/// A string is never longer than its type says, and `LEN` never gives more than an INT holds. What a reference leads to
/// may be a string of another type.
pub(crate) fn length(op: TextOp, operands: &[Expr]) -> Option<Range> {
    match (op, operands) {
        (TextOp::Len, [Expr { kind: ExprKind::Load(place), ty: Type::String(ty), .. }]) if !place.is_followed() => {
            Some((0, i128::from(ty.capacity).min(i16::MAX.into())))
        }
        _ => None,
    }
}

pub(crate) fn combined(op: Op, a: Range, b: Range) -> Option<Range> {
    match op {
        Op::Add => Some((a.0 + b.0, a.1 + b.1)),
        Op::Sub => Some((a.0 - b.1, a.1 - b.0)),
        Op::Mul => product(a, b),
        // A remainder has the dividend's sign, and is smaller than the divisor.
        Op::Mod if b.0 == b.1 && b.0 > 0 => {
            let most = b.0 - 1;
            Some((if a.0 >= 0 { 0 } else { -most }, if a.1 <= 0 { 0 } else { most }))
        }
        Op::And if b.0 == b.1 && b.0 >= 0 => Some((0, b.0)),
        _ => None,
    }
}

fn product(a: Range, b: Range) -> Option<Range> {
    let corners = [a.0.checked_mul(b.0)?, a.0.checked_mul(b.1)?, a.1.checked_mul(b.0)?, a.1.checked_mul(b.1)?];
    Some((*corners.iter().min()?, *corners.iter().max()?))
}

#[cfg(test)]
mod tests;
