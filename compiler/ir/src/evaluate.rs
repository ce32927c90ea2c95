//! The values of expressions, wherever their places are kept: the interpreter's memory, or nowhere for constants.

use crate::op::TextValue;
use crate::{
    Chars, Conversion, Expr, ExprKind, Location, Op, Place, Repr, StringType, TextOp, Type, Value, apply, apply_text,
};
use staunch_runtime::{Fault, ops};

/// No operation has more operands.
const MAX_OPERANDS: usize = 4;

/// Where the values of places come from.
pub(crate) trait Storage {
    fn load(&self, place: &Place) -> Result<Value, Fault>;
    fn load_text(&self, place: &Place) -> Result<Chars, Fault>;
    fn address_of(&self, place: &Place) -> Result<Value, Fault>;
}

/// The value of an expression of an elementary or enumeration type.
pub(crate) fn scalar(storage: &impl Storage, expr: &Expr) -> Result<Value, Fault> {
    match &expr.kind {
        ExprKind::Const(value) => Ok(*value),
        ExprKind::Load(place) => storage.load(place),
        ExprKind::AddressOf(place) => storage.address_of(place),
        ExprKind::Apply(op, operands) => operation(storage, *op, operands, expr.at),
        ExprKind::ApplyText(op, operands) => match text_operation(storage, *op, operands, 0)? {
            TextValue::Scalar(value) => Ok(value),
            TextValue::Text(_) => {
                unreachable!("verified IR: a text operation with a scalar result")
            }
        },
        ExprKind::Convert(how, operand) => Ok(convert(*how, scalar(storage, operand)?, expr.ty)),
        ExprKind::Text(_) | ExprKind::Aggregate(_) => {
            unreachable!("verified IR: an expression of an elementary type")
        }
    }
}

/// The value of an expression of a string type, within its capacity.
pub(crate) fn text(storage: &impl Storage, expr: &Expr) -> Result<Chars, Fault> {
    match &expr.kind {
        ExprKind::Text(text) => Ok(text.clone()),
        ExprKind::Load(place) => storage.load_text(place),
        ExprKind::ApplyText(op, operands) => {
            match text_operation(storage, *op, operands, string_type(expr.ty).capacity)? {
                TextValue::Text(text) => Ok(text),
                TextValue::Scalar(_) => {
                    unreachable!("verified IR: a text operation with a string result")
                }
            }
        }
        ExprKind::Convert(_, operand) => {
            let mut text = text(storage, operand)?;
            text.cut(string_type(expr.ty).capacity);
            Ok(text)
        }
        ExprKind::Const(_) | ExprKind::AddressOf(_) | ExprKind::Apply(..) | ExprKind::Aggregate(_) => {
            unreachable!("verified IR: an expression of a string type")
        }
    }
}

fn operation(storage: &impl Storage, op: Op, operands: &[Expr], at: Location) -> Result<Value, Fault> {
    let mut values = [Value::Bool(false); MAX_OPERANDS];
    for (value, operand) in values.iter_mut().zip(operands) {
        *value = scalar(storage, operand)?;
    }
    let values = &values[..operands.len()];
    // The operation's repr is that of its first operand without a fixed one.
    let repr = op.operands().iter().zip(values).find(|(fixed, _)| fixed.is_none());
    let outcome = repr.and_then(|(_, value)| apply(op, value.repr(), values));
    outcome.expect("verified IR: operands have the operation's repr").map_err(|kind| Fault { kind, at })
}

fn text_operation(storage: &impl Storage, op: TextOp, operands: &[Expr], capacity: u16) -> Result<TextValue, Fault> {
    let values: Vec<TextValue> = operands
        .iter()
        .map(|operand| match operand.ty {
            Type::String(_) => text(storage, operand).map(TextValue::Text),
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                scalar(storage, operand).map(TextValue::Scalar)
            }
            Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
                unreachable!("verified IR: operands of a text operation")
            }
        })
        .collect::<Result<_, _>>()?;
    Ok(apply_text(op, &values, capacity).expect("verified IR: operands of a text operation"))
}

fn convert(how: Conversion, value: Value, ty: Type) -> Value {
    match how {
        Conversion::Same => value,
        Conversion::Value => ops::convert_value(value, elementary_repr(ty)),
        Conversion::Bits => ops::same_bits(value, elementary_repr(ty)),
        Conversion::Truncate => ops::trunc_value(value, elementary_repr(ty)),
    }
}

fn elementary_repr(ty: Type) -> Repr {
    ty.elementary().expect("verified IR: a conversion to an elementary type").repr()
}

pub(crate) fn string_type(ty: Type) -> StringType {
    ty.string_type().expect("verified IR: an expression of a string type")
}
