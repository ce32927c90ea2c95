//! Constants and enumerations of a program, as constants of C.

use super::names::Names;
use super::tables::quoted;
use staunch_ir::{Chars, Const, Elementary, Field, Program, Type, Value};
use std::fmt::Write;

/// What is declared CONSTANT, as far as it is a number or a text; and the values of enumerations.
pub fn constants(program: &Program, names: &mut Names) -> String {
    let mut text = String::new();
    let instances = program.instances.iter().map(|it| (it.name.as_str(), program.class(it.program).state));
    for (owner, structure) in instances.chain([("Globals", program.globals)]) {
        let fields = program.structure(structure).fields.iter().filter(|it| it.constant);
        for (field, value) in fields.filter_map(|it| Some((it, value(program, it)?))) {
            let name = names.claim(&[owner, &field.name]);
            let _ = writeln!(text, "#define {name} {value} /* {} */", program.type_name(field.ty));
        }
    }
    for it in &program.enums {
        for value in &it.values {
            let name = names.claim(&[&it.name, &value.name]);
            let _ = writeln!(text, "#define {name} {} /* {} */", literal(value.value, it.base), it.name);
        }
    }
    match text.is_empty() {
        true => text,
        false => format!("\n/* Constants: the program uses these values, whatever the state contains. */\n{text}"),
    }
}

/// Whether C has a constant for a variable.
pub fn is_constant(program: &Program, field: &Field) -> bool {
    field.constant && value(program, field).is_some()
}

fn value(program: &Program, field: &Field) -> Option<String> {
    let ty = match field.ty {
        Type::Elementary(ty) | Type::Subrange(ty, _) => ty,
        Type::Enum(id) => program.enumeration(id).base,
        Type::String(it) => {
            return match &field.initial {
                Const::Text(Chars::Narrow(bytes)) => Some(quoted(bytes)),
                Const::Zero if !it.wide => Some(quoted("")),
                _ => None,
            };
        }
        Type::Reference(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => return None,
    };
    match &field.initial {
        Const::Scalar(value) => Some(literal(*value, ty)),
        Const::Zero => Some(literal(ty.repr().zero(), ty)),
        Const::Text(_) | Const::Array(_) | Const::Struct(_) => None,
    }
}

/// A number of C's that has the very value and type.
fn literal(value: Value, ty: Elementary) -> String {
    let cast = super::types::c_type(ty.repr());
    match value {
        Value::Bool(it) => it.to_string(),
        Value::F32(it) if it.is_finite() => format!("{it:e}f"),
        Value::F64(it) if it.is_finite() => format!("{it:e}"),
        Value::F32(it) => special(f64::from(it), "float"),
        Value::F64(it) => special(it, "double"),
        Value::I64(i64::MIN) => "INT64_MIN".to_owned(),
        Value::I64(it) => format!("INT64_C({it})"),
        Value::U64(it) => format!("UINT64_C({it})"),
        it => format!("(({cast}){})", it.as_integer().unwrap_or_default()),
    }
}

fn special(value: f64, ty: &str) -> String {
    let sign = if value.is_sign_negative() { "-" } else { "" };
    let over = if value.is_nan() { "0.0" } else { "1.0" };
    format!("(({ty})({sign}{over} / 0.0))")
}
