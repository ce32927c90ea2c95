//! How values read: the cells of a trace.

use crate::map::{Map, Type};
use staunch_runtime::{Elementary, Time, Value};
use std::fmt::Write;

/// Appends the value of type `ty` at the start of `bytes`; nothing for a composite type.
pub(crate) fn format(map: &Map, ty: Type, bytes: &[u8], out: &mut String) {
    match ty {
        Type::Elementary(it) => {
            let value = Value::read(it.lane(), bytes);
            match (it.is_time(), value) {
                (true, Value::I64(time)) => {
                    out.push_str(if it == Elementary::Ltime { "LTIME#" } else { "T#" });
                    write_duration(time, out);
                }
                _ => format_scalar(value, out),
            }
        }
        Type::String(_) => out.push_str(&text(bytes)),
        Type::Enum(id) => {
            let Some(enumeration) = map.enums.get(&id) else { return };
            let value = Value::read(enumeration.lane, bytes);
            match enumeration.values.iter().find(|(_, it)| Some(*it) == value.as_integer()) {
                Some((name, _)) => out.push_str(name),
                None => format_scalar(value, out),
            }
        }
        Type::Array(_) | Type::Struct(_) | Type::Block(_) => {}
    }
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

/// The value as a number, for diagrams; `None` for a string.
pub(crate) fn number(map: &Map, ty: Type, bytes: &[u8]) -> Option<f64> {
    let lane = match ty {
        Type::Elementary(it) => it.lane(),
        Type::Enum(id) => map.enums.get(&id)?.lane,
        Type::String(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => return None,
    };
    Some(match Value::read(lane, bytes) {
        Value::F32(it) => f64::from(it),
        Value::F64(it) => it,
        value => value.as_integer()? as f64,
    })
}

/// A string's characters; bytes that are not UTF-8 are read as Latin-1.
fn text(bytes: &[u8]) -> String {
    let Some((length, rest)) = bytes.split_at_checked(2) else { return String::new() };
    let length = usize::from(u16::from_ne_bytes([length[0], length[1]]));
    let used = rest.get(..length).unwrap_or(rest);
    match std::str::from_utf8(used) {
        Ok(text) => text.to_owned(),
        Err(_) => used.iter().map(|it| char::from(*it)).collect(),
    }
}

const UNITS: [(&str, u64); 7] = [
    ("d", 86_400_000_000_000),
    ("h", 3_600_000_000_000),
    ("m", 60_000_000_000),
    ("s", 1_000_000_000),
    ("ms", 1_000_000),
    ("us", 1_000),
    ("ns", 1),
];

/// `T#1s500ms`
pub fn format_time(time: Time) -> String {
    let mut out = String::from("T#");
    write_duration(time, &mut out);
    out
}

fn write_duration(time: Time, out: &mut String) {
    if time < 0 {
        out.push('-');
    }
    let mut rest = time.unsigned_abs();
    if rest == 0 {
        out.push_str("0s");
    }
    for (unit, size) in UNITS {
        if rest >= size {
            let _ = write!(out, "{}{unit}", rest / size);
            rest %= size;
        }
    }
}

/// Nanoseconds of `1d2h3m4s5ms6us7ns`, in any case, with fractions and underscores; `None` if it
/// does not read so, or does not fit.
pub(crate) fn parse_duration_text(text: &str) -> Option<Time> {
    let text = text.replace('_', "").to_ascii_lowercase();
    let (negative, mut rest) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(&text)),
    };
    let mut total: i128 = 0;
    let mut finest = u64::MAX;
    while !rest.is_empty() {
        let end = rest.find(|it: char| !it.is_ascii_digit() && it != '.')?;
        let unit_end = rest[end..].find(|it: char| !it.is_ascii_alphabetic()).map_or(rest.len(), |at| end + at);
        let (_, size) = UNITS.into_iter().find(|(name, _)| *name == &rest[end..unit_end])?;
        // From the longest unit to the shortest, each at most once.
        if size >= finest {
            return None;
        }
        finest = size;
        total = total.checked_add(scaled(&rest[..end], size)?)?;
        rest = &rest[unit_end..];
    }
    if finest == u64::MAX {
        return None;
    }
    i64::try_from(if negative { -total } else { total }).ok()
}

/// A decimal number times `size`, rounded down.
fn scaled(digits: &str, size: u64) -> Option<i128> {
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let fraction = fraction.get(..fraction.len().min(18))?;
    let power = 10_i128.checked_pow(u32::try_from(fraction.len()).ok()?)?;
    let part = if fraction.is_empty() { 0 } else { fraction.parse::<i128>().ok()? };
    let number = whole.parse::<i128>().ok()?.checked_mul(power)?.checked_add(part)?;
    Some(number.checked_mul(i128::from(size))? / power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::map;
    use crate::path::resolve;

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
            assert_eq!(parse_duration_text(&text[2..]), Some(time), "{text}");
        }
        assert_eq!(format_time(0), "T#0s");
        assert_eq!(parse_duration_text("1.5s"), Some(1_500_000_000));
        assert_eq!(parse_duration_text("0.25MS"), Some(250_000));
        for wrong in ["", "5", "1s1s", "1ms1s", "s", "1.2.3s", "1x", "999999999d"] {
            assert_eq!(parse_duration_text(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_string_is_its_characters() {
        assert_eq!(text(&[3, 0, b'a', b'b', b'c', 0]), "abc");
        assert_eq!(text(&[1, 0, 0xE9, 0]), "é");
    }
}
