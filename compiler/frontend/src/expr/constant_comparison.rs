//! Comparisons whose outcome is known: the other side's type holds no value that changes it.

use super::checker::Checker;
use super::operand::Operand;
use super::operator::Sides;
use crate::diagnostic::wording::article;
use crate::{Code, Diagnostic};
use ast::BinaryOp;
use staunch_ir::{Elementary, Type, Value};

use crate::ast;

impl Checker<'_, '_> {
    /// Reports an integer variable that is compared with what its type never reaches.
    pub(crate) fn always_the_same(&mut self, sides: &Sides) {
        let found = match (variable(&sides.a), constant(&sides.b)) {
            (Some(ty), Some(limit)) => Some((ty, sides.op, limit)),
            _ => variable(&sides.b).zip(constant(&sides.a)).map(|(ty, limit)| (ty, turned(sides.op), limit)),
        };
        let Some((ty, op, limit)) = found else { return };
        let range = self.decl.program.range(ty).or_else(|| ty.elementary()?.repr().range());
        let Some((low, high)) = range else { return };
        // Traps of a move between systems have a lint of their own.
        if low == 0 && limit == 0 {
            return;
        }
        let Some(outcome) = outcome(op, (low, high), limit) else { return };
        self.report(
            Diagnostic::new(
                Code::W0510,
                sides.op_span,
                format!("{} holds {low} to {high}", article(&self.type_name(ty))),
            )
            .label(format!("so this is always {}", if outcome { "TRUE" } else { "FALSE" }))
            .help("compare with a value that the type reaches, or declare the variable of a wider type"),
        );
    }
}

/// The type of an integer or bit string whose value is not known.
fn variable(operand: &Operand) -> Option<Type> {
    let expr = operand.typed().filter(|it| it.as_const().is_none())?;
    let declared = expr.declared();
    match expr.ty {
        Type::Elementary(it) if it.is_integral() && it != Elementary::Bool => Some(declared),
        Type::Elementary(_)
        | Type::Reference(_)
        | Type::Subrange(..)
        | Type::String(_)
        | Type::Enum(_)
        | Type::Array(_)
        | Type::Struct(_)
        | Type::Block(_) => None,
    }
}

fn constant(operand: &Operand) -> Option<i128> {
    match operand {
        Operand::Integer(value) => Some(*value),
        Operand::Typed(expr) | Operand::Promoted(expr, _) => expr.as_const().and_then(Value::as_integer),
        Operand::Real { .. } => None,
    }
}

/// The operator with its sides exchanged.
fn turned(op: BinaryOp) -> BinaryOp {
    match op {
        BinaryOp::Lt => BinaryOp::Gt,
        BinaryOp::Gt => BinaryOp::Lt,
        BinaryOp::Le => BinaryOp::Ge,
        BinaryOp::Ge => BinaryOp::Le,
        other => other,
    }
}

/// What `x op limit` is for every `x` in the range, where that is one value.
fn outcome(op: BinaryOp, (low, high): (i128, i128), limit: i128) -> Option<bool> {
    let outside = !(low..=high).contains(&limit);
    match op {
        BinaryOp::Gt if limit >= high => Some(false),
        BinaryOp::Gt if limit < low => Some(true),
        BinaryOp::Ge if limit > high => Some(false),
        BinaryOp::Ge if limit <= low => Some(true),
        BinaryOp::Lt if limit <= low => Some(false),
        BinaryOp::Lt if limit > high => Some(true),
        BinaryOp::Le if limit < low => Some(false),
        BinaryOp::Le if limit >= high => Some(true),
        BinaryOp::Eq if outside => Some(false),
        BinaryOp::Ne if outside => Some(true),
        _ => None,
    }
}
