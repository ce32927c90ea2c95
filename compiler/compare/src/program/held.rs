//! What a scalar holds: as a number, as a text, and whether two hold the same.

use super::scalar::{Scalar, Scalars, as_number};
use staunch_ir::layout::usize_of;
use staunch_ir::{Program, Type, Value};

/// What a scalar holds, where that is a number.
pub fn number(program: &Program, scalar: &Scalar, state: &[u8]) -> Option<i128> {
    as_number(Value::read(program.repr(scalar.ty)?, &state[scalar.offset..]))
}

/// Whether two systems hold the same value, by its number and not by its bits; a reference by what it leads to.
pub fn equal(programs: [&Program; 2], all: [&Scalars; 2], scalars: [&Scalar; 2], states: [&[u8]; 2]) -> bool {
    let [a, b] = [0, 1].map(|side| &states[side][scalars[side].offset..scalars[side].offset + scalars[side].size]);
    if let [Type::Reference(_), Type::Reference(_)] = scalars.map(|it| it.ty) {
        let denoted = |side: usize, bytes| all[side].denoted(bytes).map(|it| (it.0.key.as_str(), it.1));
        return denoted(0, a) == denoted(1, b);
    }
    let reprs = [0, 1].map(|side| programs[side].repr(scalars[side].ty));
    match reprs {
        [Some(x), Some(y)] if x != y => {
            let (a, b) = (Value::read(x, a), Value::read(y, b));
            as_number(a).is_some() && as_number(a) == as_number(b)
        }
        [Some(_), Some(_)] => a == b,
        _ => a == b || text(scalars[0], a) == text(scalars[1], b),
    }
}

/// The bytes of a string's characters, without what is after its end.
fn text<'b>(scalar: &Scalar, bytes: &'b [u8]) -> &'b [u8] {
    let unit = scalar.ty.string_type().map_or(1, |it| usize_of(it.unit_size().into()));
    if scalar.is_shared {
        let end = bytes.chunks_exact(unit).position(|it| it.iter().all(|it| *it == 0));
        return end.map_or(bytes, |it| &bytes[..it * unit]);
    }
    let Some((length, rest)) = bytes.split_first_chunk::<2>() else { return bytes };
    rest.get(..usize::from(u16::from_ne_bytes(*length)) * unit).unwrap_or(rest)
}

fn characters(scalar: &Scalar, bytes: &[u8]) -> String {
    let bytes = text(scalar, bytes);
    if scalar.ty.string_type().is_none_or(|it| !it.wide) {
        return String::from_utf8_lossy(bytes).into_owned();
    }
    let units: Vec<u16> = bytes.chunks_exact(2).map(|it| u16::from_ne_bytes([it[0], it[1]])).collect();
    String::from_utf16_lossy(&units)
}

/// The value as a trace shows it.
pub fn show(program: &Program, all: &Scalars, scalar: &Scalar, state: &[u8]) -> String {
    let bytes = &state[scalar.offset..scalar.offset + scalar.size];
    if let Type::Reference(_) = scalar.ty {
        return match all.denoted(bytes) {
            Some((it, 0)) => it.path.clone(),
            Some((it, further)) => format!("{}+{further}", it.path),
            None => "NULL".to_owned(),
        };
    }
    match program.repr(scalar.ty) {
        Some(repr) => spell(program, scalar.ty, Value::read(repr, bytes)),
        None => characters(scalar, bytes),
    }
}

/// A value as a trace shows it and a stimulus takes it.
pub fn spell(program: &Program, ty: Type, value: Value) -> String {
    let named = match ty {
        Type::Enum(id) => program.enumeration(id).values.iter().find(|it| it.value == value),
        _ => None,
    };
    match (named, value) {
        (Some(named), _) => named.name.clone(),
        (None, Value::I64(time)) if let Some(ty) = ty.elementary().filter(|it| it.is_time()) => {
            staunch_host::format_time_as(ty, time)
        }
        (None, Value::U64(time)) if let Some(ty) = ty.elementary().filter(|it| it.is_time()) => {
            staunch_host::format_time_as(ty, time.cast_signed())
        }
        (None, other) if ty.elementary().is_some_and(staunch_ir::Elementary::is_char) => {
            staunch_host::format_character(other)
        }
        (None, Value::Bool(it)) => if it { "TRUE" } else { "FALSE" }.to_owned(),
        (None, Value::F32(it)) => format!("{it:?}"),
        (None, Value::F64(it)) => format!("{it:?}"),
        (None, other) => other.as_integer().map_or_else(String::new, |it| it.to_string()),
    }
}
