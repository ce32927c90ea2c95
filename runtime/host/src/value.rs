//! Values as text, for the cells of a trace.

use crate::map::{Map, Type};
use crate::path::{path_at, resolve, view_at};
use staunch_runtime::reference::ORIGIN;
use staunch_runtime::text::characters;
use staunch_runtime::{Elementary, Reference, Repr, StringType, Time, Value, format};
use std::fmt::Write;

/// The value of the variable that `path` names, seen from the instances `running`, as a cell of a trace.
pub fn value_at(map: &Map, running: &[usize], state: &[u8], path: &str) -> Result<String, String> {
    let place = resolve(map, running, path)?;
    let mut text = String::new();
    format(map, place.ty, &state[place.offset..], &mut text);
    Ok(text)
}

/// Appends the value of type `ty` at the start of `bytes`; nothing for a composite type.
pub(crate) fn format(map: &Map, ty: Type, bytes: &[u8], out: &mut String) {
    match ty {
        Type::Elementary(it) => {
            let value = Value::read(it.repr(), bytes);
            match value {
                // Writing to a String cannot fail.
                Value::I64(time) if it.is_time() => _ = format::time(out, it, time),
                Value::U64(time) if it.is_time() => _ = format::time(out, it, time as i64),
                _ if it.is_char() => out.push_str(&format_character(value)),
                _ => format_scalar(value, out),
            }
        }
        Type::Bit(number) => format_scalar(Value::Bool(bit(bytes, number)), out),
        Type::String(it) => out.push_str(&text(it, bytes)),
        Type::Characters(it) => out.push_str(&text_before_zero(it, bytes)),
        Type::Enum(id) => {
            let Some(enumeration) = map.enums.get(&id) else { return };
            let value = Value::read(enumeration.repr, bytes);
            match enumeration.values.iter().find(|(_, it)| Some(*it) == value.as_integer()) {
                Some((name, _)) => out.push_str(name),
                None => format_scalar(value, out),
            }
        }
        Type::Reference => format_reference(map, bytes, out),
        Type::Array(_) | Type::Struct(_) | Type::Block(_) => {}
    }
}

/// `null`, or the variable that is named: `&Main.buffer`, and how many bytes after its start.
fn format_reference(map: &Map, bytes: &[u8], out: &mut String) {
    let Value::U64(bits) = Value::read(Repr::U64, bytes) else { return };
    if bits == 0 {
        return out.push_str("null");
    }
    let reference = Reference::from_bits(bits);
    let object = usize::try_from(reference.object).ok().and_then(|it| map.objects.get(it.checked_sub(1)?));
    let named = object.and_then(|(offset, size)| {
        let address = i64::from(reference.address) - i64::from(ORIGIN);
        if let Some((path, start)) = usize::try_from(address).ok().and_then(|it| view_at(map, (*offset, *size), it)) {
            return Some((path, address - i64::try_from(start).ok()?));
        }
        let position = address - i64::try_from(*offset).ok()?;
        Some((path_at(map, *offset, *size)?, position))
    });
    let _ = match named {
        Some((path, 0)) => write!(out, "&{path}"),
        Some((path, position)) => write!(out, "&{path}{position:+}"),
        None => write!(out, "16#{bits:X}"),
    };
}

fn format_scalar(value: Value, out: &mut String) {
    // Writing to a String cannot fail. `{:?}` of a float is the shortest text that reads back.
    let _ = match value {
        Value::Bool(it) => write!(out, "{}", if it { "TRUE" } else { "FALSE" }),
        Value::I8(it) => write!(out, "{it}"),
        Value::I16(it) => write!(out, "{it}"),
        Value::I32(it) => write!(out, "{it}"),
        Value::I64(it) => write!(out, "{it}"),
        Value::U8(it) => write!(out, "{it}"),
        Value::U16(it) => write!(out, "{it}"),
        Value::U32(it) => write!(out, "{it}"),
        Value::U64(it) => write!(out, "{it}"),
        Value::F32(it) => write!(out, "{it:?}"),
        Value::F64(it) => write!(out, "{it:?}"),
    };
}

fn bit(bytes: &[u8], number: u8) -> bool {
    bytes.first().is_some_and(|byte| byte >> number & 1 == 1)
}

/// The value as a number, for diagrams; `None` for a string.
pub(crate) fn number(map: &Map, ty: Type, bytes: &[u8]) -> Option<f64> {
    let repr = match ty {
        Type::Elementary(it) => it.repr(),
        Type::Bit(number) => return Some(f64::from(u8::from(bit(bytes, number)))),
        Type::Enum(id) => map.enums.get(&id)?.repr,
        Type::Reference => return None,
        Type::String(_) | Type::Characters(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => return None,
    };
    Some(match Value::read(repr, bytes) {
        Value::F32(it) => f64::from(it),
        Value::F64(it) => it,
        value => value.as_integer()? as f64,
    })
}

/// A string's characters.
fn text(ty: StringType, bytes: &[u8]) -> String {
    let Some((length, rest)) = bytes.split_at_checked(2) else { return String::new() };
    let length = usize::from(u16::from_ne_bytes([length[0], length[1]])) * ty.unit_size() as usize;
    decoded(ty, rest.get(..length).unwrap_or(rest))
}

/// The characters of a text in a UNION.
fn text_before_zero(ty: StringType, bytes: &[u8]) -> String {
    let size = ty.unit_size() as usize;
    let most = bytes.get(..usize::from(ty.capacity) * size).unwrap_or(bytes);
    let is_zero = |it: &[u8]| it.iter().all(|it| *it == 0);
    let length = most.chunks_exact(size).position(is_zero).map_or(most.len(), |it| it * size);
    decoded(ty, &most[..length])
}

fn decoded(ty: StringType, units: &[u8]) -> String {
    if ty.wide {
        let units = units.chunks_exact(2).map(|it| u16::from_ne_bytes([it[0], it[1]]));
        return char::decode_utf16(units).map(|it| it.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    }
    characters(units).collect()
}

/// `A`, or the number of a character that is hard to see: `$00`, `$D83D`.
pub fn format_character(value: Value) -> String {
    let (number, digits) = match value {
        Value::U8(it) => (u32::from(it), 2),
        Value::U16(it) => (u32::from(it), 4),
        _ => {
            let mut out = String::new();
            format_scalar(value, &mut out);
            return out;
        }
    };
    match char::from_u32(number) {
        Some('$') => "$$".to_owned(),
        Some(it) if it.is_ascii_graphic() => it.to_string(),
        Some(it) if !it.is_ascii() && !it.is_control() && !it.is_whitespace() => it.to_string(),
        _ => format!("${number:0digits$X}"),
    }
}

/// `T#1s500ms`
pub fn format_time(time: Time) -> String {
    format_time_as(Elementary::Time, time)
}

/// `DT#2024-02-29-12:34:56`: a value of a duration's or a date's type as its literal.
pub fn format_time_as(ty: Elementary, time: Time) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail.
    _ = format::time(&mut out, ty, time);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::map;
    use crate::path::resolve;
    use staunch_runtime::literal::duration;

    fn shown(name: &str, value: Value) -> String {
        let map = map();
        let mut bytes = [0; 8];
        value.write(&mut bytes);
        let mut out = String::new();
        format(&map, resolve(&map, &[0], name).unwrap().ty, &bytes, &mut out);
        out
    }

    #[test]
    fn values_read_as_they_are_written_in_structured_text() {
        assert_eq!(shown("up", Value::Bool(true)), "TRUE");
        assert_eq!(shown("c.CV", Value::I16(-3)), "-3");
        assert_eq!(shown("speed", Value::F32(0.1)), "0.1");
        assert_eq!(shown("speed", Value::F32(1.0)), "1.0");
        assert_eq!(shown("speed", Value::F32(1e21)), "1e21");
        assert_eq!(shown("speed", Value::F32(f32::NAN)), "NaN");
        assert_eq!(shown("speed", Value::F32(f32::NEG_INFINITY)), "-inf");
        assert_eq!(shown("colour", Value::I16(5)), "Green");
        assert_eq!(shown("colour", Value::I16(4)), "4");
        assert_eq!(shown("pause", Value::I64(1_500_000_000)), "T#1s500ms");
    }

    #[test]
    fn durations_read_back() {
        for time in [0, 1, -1, 1_500_000_000, 90_061_001_001_001, i64::MAX, i64::MIN + 1] {
            let text = format_time(time);
            assert_eq!(duration(&text[2..]), Ok(time), "{text}");
        }
        assert_eq!(format_time(0), "T#0s");
    }

    #[test]
    fn a_string_is_its_characters() {
        let narrow = |bytes: &[u8]| text(StringType::narrow(4), bytes);
        assert_eq!(narrow(&[3, 0, b'a', b'b', b'c', 0]), "abc");
        assert_eq!(narrow(&[1, 0, 0xE9, 0]), "é");
        assert_eq!(narrow(&[3, 0, 0xC3, 0xA9, 0xE9, 0]), "éé");
        let wide: Vec<u8> = [3_u16, 0x20AC, 0xD83D, 0xDE00].into_iter().flat_map(u16::to_ne_bytes).collect();
        assert_eq!(text(StringType::wide(3), &wide), "€😀");
    }
}
