//! What an expression may be, whatever its variables are.

use crate::interval::{Range, of_operands};
use crate::{Conversion, Expr, ExprKind, TextOp, Type};

/// What constants and the capacities of strings say of an integer expression; `None` where they say nothing.
pub(crate) fn limits(expr: &Expr) -> Option<Range> {
    let known = match &expr.kind {
        ExprKind::Const(value) => value.as_integer().map(|it| (it, it)),
        ExprKind::Convert(Conversion::Value | Conversion::Same, operand) => limits(operand),
        ExprKind::Apply(op, operands) => of_operands(*op, operands, limits),
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

#[cfg(test)]
mod tests;
