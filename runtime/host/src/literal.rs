//! Cells of a stimulus: values as people write them.

use crate::map::{Enum, Map, Type};
use crate::path::{Place, nearest, same};
use crate::value::format_time;
use staunch_runtime::literal::{self, LiteralError, LiteralErrorKind, check_real, duration, unsigned_duration};
use staunch_runtime::time::MILLISECOND;
use staunch_runtime::{Elementary, Repr, StringType, Value, ops};

/// The bytes that `text` stands for in a variable; the error is a sentence without a full stop.
pub fn parse(map: &Map, place: Place, text: &str) -> Result<Vec<u8>, String> {
    let value = match place.ty {
        Type::String(it) => return string(text, it),
        Type::Characters(it) => return string(text, it).map(|it| without_length(it, map.size_of(place.ty))),
        Type::Elementary(Elementary::Ultime) => Value::U64(unsigned_time(text)?),
        Type::Elementary(Elementary::Time) => Value::I64(time_of(map, text)?),
        Type::Elementary(Elementary::Ltime) => Value::I64(long_time(text)?),
        Type::Elementary(it) if it.is_time() => Value::I64(date(text, it)?),
        Type::Elementary(Elementary::Bool) | Type::Bit(_) => Value::Bool(boolean(text)?),
        Type::Elementary(it) if it.repr().is_float() => float(text, it.name(), it.repr())?,
        Type::Elementary(it) if it.is_char() => character(text, it)?,
        Type::Elementary(it) => integer(text, it.name(), it.repr())?,
        Type::Enum(id) => {
            let found = map.enums.get(&id).map(|it| enumerator(text, it));
            found.unwrap_or_else(|| Err("the type is not in the map".to_owned()))?
        }
        Type::Reference if text.eq_ignore_ascii_case("null") => Value::U64(0),
        Type::Reference => return Err("it is a reference: it can only be set to null".to_owned()),
        Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
            return Err(format!("it is a whole {}: name a member or an element", map.type_name(place.ty)));
        }
    };
    if let (Some((low, high)), Some(number)) = (place.range, value.as_integer()) {
        if !(low..=high).contains(&number) {
            return Err(format!("`{text}` is outside the subrange {low}..{high}"));
        }
    }
    let mut bytes = vec![0; value.repr().size() as usize];
    value.write(&mut bytes);
    Ok(bytes)
}

/// A string as it is stored in a UNION, with zeros up to the end.
fn without_length(mut text: Vec<u8>, size: usize) -> Vec<u8> {
    text.drain(..2);
    text.resize(size, 0);
    text
}

fn string(text: &str, ty: StringType) -> Result<Vec<u8>, String> {
    let units: Vec<u8> =
        if ty.wide { text.encode_utf16().flat_map(u16::to_ne_bytes).collect() } else { text.as_bytes().to_vec() };
    let length = units.len() / ty.unit_size() as usize;
    let Some(header) = u16::try_from(length).ok().filter(|it| *it <= ty.capacity) else {
        return Err(format!("the text has {length} {}, but a {ty} holds {}", ty.units(), ty.capacity));
    };
    let mut bytes = header.to_ne_bytes().to_vec();
    bytes.extend(units);
    bytes.resize(2 + usize::from(ty.capacity) * ty.unit_size() as usize, 0);
    Ok(bytes)
}

/// `A`, `'A'`, `CHAR#'A'`, `$0A`.
fn character(text: &str, ty: Elementary) -> Result<Value, String> {
    let (name, quote, digits) = if ty == Elementary::Char { ("CHAR", '\'', 2) } else { ("WCHAR", '"', 4) };
    let wrong = || format!("`{text}` is not a {name}: write `A` or `${}`", &"0041"[4 - digits..]);
    let bare = untyped(text, &[name]);
    let inner = bare.strip_prefix(quote).and_then(|it| it.strip_suffix(quote)).filter(|it| !it.is_empty());
    let bare = inner.unwrap_or(bare);
    let hexadecimal = bare.strip_prefix('$').filter(|it| it.len() == digits).map(|it| u32::from_str_radix(it, 16));
    let number = match (hexadecimal, bare) {
        (Some(number), _) => number.map_err(|_| wrong())?,
        (None, "$$") => u32::from('$'),
        (None, _) => {
            let mut characters = bare.chars();
            let first = characters.next().filter(|it| *it != '$').ok_or_else(wrong)?;
            if characters.next().is_some() {
                return Err(wrong());
            }
            u32::from(first)
        }
    };
    ty.repr().integer(number.into()).ok_or_else(wrong)
}

/// `text` without the prefix `NAME#`, if it has that one.
fn untyped<'t>(text: &'t str, names: &[&str]) -> &'t str {
    match text.split_once('#') {
        Some((prefix, rest)) if names.iter().any(|it| same(it, prefix)) => rest,
        _ => text,
    }
}

fn boolean(text: &str) -> Result<bool, String> {
    let value = untyped(text, &["BOOL"]);
    match value {
        "1" => Ok(true),
        "0" => Ok(false),
        _ if same(value, "TRUE") => Ok(true),
        _ if same(value, "FALSE") => Ok(false),
        _ => Err(format!("`{text}` is not a BOOL: write TRUE or FALSE")),
    }
}

pub(crate) fn time(text: &str) -> Result<i64, String> {
    duration_of(text, "TIME", duration)
}

/// A TIME that the program's dialect has.
fn time_of(map: &Map, text: &str) -> Result<i64, String> {
    let time = time(text)?;
    let Some((least, greatest)) = map.milliseconds else { return Ok(time) };
    if time % MILLISECOND == 0 && (least..=greatest).contains(&(time / MILLISECOND)) {
        return Ok(time);
    }
    let [least, greatest] = [least, greatest].map(|it| format_time(it * MILLISECOND));
    Err(format!("`{text}` is not a TIME of this dialect: expected whole milliseconds from {least} to {greatest}"))
}

fn long_time(text: &str) -> Result<i64, String> {
    duration_of(text, "LTIME", duration)
}

/// An LTIME without a sign.
fn unsigned_time(text: &str) -> Result<u64, String> {
    duration_of(text, "LTIME", unsigned_duration)
}

/// `T#500ms`, `500ms` or `0`.
fn duration_of<T>(text: &str, ty: &str, read: fn(&str) -> Result<T, LiteralError>) -> Result<T, String> {
    let wrong = |why: &str| format!("`{text}` is not {} {ty}: {why}", article(ty));
    let is_prefix = |it: &str| ["T", "TIME", "LT", "LTIME"].iter().any(|prefix| same(prefix, it));
    match text.split_once('#') {
        Some((prefix, rest)) if is_prefix(prefix) => read(rest).map_err(|error| wrong(error.kind.text())),
        Some(_) => Err(wrong("write `T#500ms`")),
        None if text == "0" => read("0s").map_err(|_| wrong("write `T#0s`")),
        None => read(text).map_err(|_| wrong("write `T#500ms` or `500ms`")),
    }
}

/// A date or a time of day, with the prefix of its type or of the long form of it.
fn date(text: &str, ty: Elementary) -> Result<i64, String> {
    let wrong = || format!("`{text}` is not {} {}: ", article(ty.name()), ty.name());
    let Some((prefix, rest)) = text.split_once('#') else { return Err(wrong() + &example(ty)) };
    let found = literal::type_of_prefix(prefix);
    let kind = |it: Elementary| (it.is_day(), it.is_time_of_day(), it.is_date_and_time());
    if found.is_none_or(|it| kind(it) != kind(ty)) {
        return Err(wrong() + &example(ty));
    }
    literal::time(ty, rest).map_err(|error| wrong() + error.kind.text())
}

fn example(ty: Elementary) -> String {
    // Noon of a leap day, as each type has it.
    let noon = 1_709_208_000_000_000_000;
    let value = if ty.is_day() { ops::start_of_day(noon) } else { noon };
    format!("write `{}`", crate::format_time_as(ty, value))
}

fn float(text: &str, name: &str, repr: Repr) -> Result<Value, String> {
    let wrong = || format!("`{text}` is not {} {name}", article(name));
    let spelled = untyped(text, &[name]);
    // A trace can hold these; no literal has such a value.
    if !["NaN", "inf", "-inf"].iter().any(|it| same(it, spelled)) {
        check_real(spelled).map_err(|error| because(wrong(), error.kind))?;
    }
    let digits = spelled.replace('_', "");
    let number = digits.parse::<f64>().map_err(|_| wrong())?;
    let value = match repr {
        // Read as an f32 at once: by way of an f64 it could be rounded twice.
        Repr::F32 => Value::F32(digits.parse().map_err(|_| wrong())?),
        _ => Value::F64(number),
    };
    let infinite =
        matches!(value, Value::F32(it) if it.is_infinite()) || matches!(value, Value::F64(it) if it.is_infinite());
    match infinite && digits.contains(|it: char| it.is_ascii_digit()) {
        true => Err(format!("`{text}` does not fit {name}")),
        false => Ok(value),
    }
}

fn integer(text: &str, name: &str, repr: Repr) -> Result<Value, String> {
    let number = number(untyped(text, &[name]))
        .map_err(|kind| because(format!("`{text}` is not {} {name}", article(name)), kind))?;
    repr.integer(number).ok_or_else(|| match repr.range() {
        Some((low, high)) => format!("`{text}` does not fit {name}, which holds {low} to {high}"),
        None => format!("`{text}` does not fit {name}"),
    })
}

fn article(name: &str) -> &'static str {
    if name.starts_with(['I', 'L']) { "an" } else { "a" }
}

/// `message`, with the reason where that is not seen at once.
fn because(message: String, kind: LiteralErrorKind) -> String {
    let telling = matches!(kind, LiteralErrorKind::UnderscoreInNumber | LiteralErrorKind::NumberTooLarge);
    if telling { format!("{message}: {}", kind.text()) } else { message }
}

/// `-12`, `1_000`, `16#FF`, `2#1010`.
fn number(text: &str) -> Result<i128, LiteralErrorKind> {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let number = i128::from(literal::integer(digits).map_err(|error| error.kind)?);
    Ok(if negative { -number } else { number })
}

fn enumerator(text: &str, enumeration: &Enum) -> Result<Value, String> {
    let name = untyped(text, &[&enumeration.name]);
    let found = enumeration.values.iter().find(|(it, _)| same(it, name));
    let by_number = || number(name).ok().and_then(|number| enumeration.values.iter().find(|(_, it)| *it == number));
    let value = found.or_else(by_number).and_then(|(_, number)| enumeration.repr.integer(*number));
    value.ok_or_else(|| {
        let near = nearest(name, enumeration.values.iter().map(|(it, _)| it.as_str()));
        format!("{} has no value `{name}`{near}", enumeration.name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::map;
    use crate::path::resolve;

    fn read(name: &str, text: &str) -> Result<Vec<u8>, String> {
        let map = map();
        parse(&map, resolve(&map, &[0], name).unwrap(), text)
    }

    #[test]
    fn a_value_has_many_spellings() {
        for text in ["TRUE", "true", "1", "BOOL#1"] {
            assert_eq!(read("up", text).unwrap(), [1]);
        }
        for text in ["255", "16#FF", "INT#255", "INT#16#ff", "2#1111_1111", "+255"] {
            assert_eq!(read("c.CV", text).unwrap(), 255_i16.to_ne_bytes());
        }
        for text in ["1.5", "REAL#1.5", "15e-1", "1.500"] {
            assert_eq!(read("speed", text).unwrap(), 1.5_f32.to_ne_bytes());
        }
        for text in ["T#1s500ms", "TIME#1.5s", "LTIME#1500ms", "1500ms", "1.5s"] {
            assert_eq!(read("pause", text).unwrap(), 1_500_000_000_i64.to_ne_bytes());
        }
        for text in ["Green", "color#GREEN", "5"] {
            assert_eq!(read("colour", text).unwrap(), 5_i16.to_ne_bytes());
        }
        assert_eq!(read("name", "ab").unwrap(), [2, 0, b'a', b'b', 0, 0]);
    }

    #[test]
    fn a_time_is_one_of_the_dialect() {
        let codesys = Map { milliseconds: Some((0, 5000)), ..map() };
        let place = resolve(&codesys, &[0], "pause").unwrap();
        assert_eq!(parse(&codesys, place, "T#5s").unwrap(), 5_000_000_000_i64.to_ne_bytes());
        for text in ["T#-1ms", "T#500us", "T#5001ms"] {
            let error = parse(&codesys, place, text).unwrap_err();
            let range = "expected whole milliseconds from T#0s to T#5s";
            assert_eq!(error, format!("`{text}` is not a TIME of this dialect: {range}"));
            assert!(read("pause", text).is_ok());
        }
    }

    #[test]
    fn what_does_not_fit_is_told() {
        let error = |name, text| read(name, text).unwrap_err();
        assert_eq!(error("up", "2"), "`2` is not a BOOL: write TRUE or FALSE");
        assert_eq!(error("c.CV", "40000"), "`40000` does not fit INT, which holds -32768 to 32767");
        assert_eq!(error("c.CV", "1.5"), "`1.5` is not an INT");
        assert_eq!(error("c.CV", "UINT#5"), "`UINT#5` is not an INT");
        assert_eq!(error("level", "11"), "`11` is outside the subrange 0..10");
        assert_eq!(error("speed", "1e99"), "`1e99` does not fit REAL");
        assert_eq!(error("c.CV", "1__0"), "`1__0` is not an INT: `_` is allowed only between two digits");
        assert_eq!(error("speed", "1_.5"), "`1_.5` is not a REAL: `_` is allowed only between two digits");
        assert_eq!(error("speed", "infinity"), "`infinity` is not a REAL");
        assert_eq!(
            error("pause", "T#1_s"),
            "`T#1_s` is not a TIME: `_` is allowed only between two digits, or between two units"
        );
        assert_eq!(
            error("pause", "T#1.5s200ms"),
            "`T#1.5s200ms` is not a TIME: only the last unit of a duration has a fraction"
        );
        assert_eq!(error("pause", "5"), "`5` is not a TIME: write `T#500ms` or `500ms`");
        assert_eq!(error("colour", "Gren"), "Color has no value `Gren`; did you mean `Green`?");
        assert_eq!(error("name", "abcde"), "the text has 5 bytes, but a STRING[4] holds 4");
        assert_eq!(error("c", "1"), "it is a whole CTU: name a member or an element");
    }
}
