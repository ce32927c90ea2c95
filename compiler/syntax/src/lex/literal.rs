//! Values of literals, read from the text of their tokens.

use staunch_ir::Chars;
use staunch_runtime::Elementary;
use staunch_runtime::literal::{self, LiteralError, LiteralErrorKind as Kind, UNITS};

/// Why a literal has no value: a range of its text, and a sentence.
#[derive(Debug, PartialEq, Eq)]
pub struct Fault {
    pub start: usize,
    pub end: usize,
    pub message: String,
    /// The whole literal as it is meant.
    pub meant: Option<String>,
    /// What to write, where that is not known.
    pub help: Option<String>,
}

impl Fault {
    fn new(start: usize, end: usize, message: impl Into<String>) -> Self {
        Self { start, end, message: message.into(), meant: None, help: None }
    }
}

/// Before a decimal number, in CODESYS.
pub const DECIMAL: &str = "10#";

/// `1_000`, `16#FF`, and `10#15`: the magnitude.
pub fn integer(text: &str) -> Result<u64, Fault> {
    let first = if text.starts_with(DECIMAL) { DECIMAL.len() } else { 0 };
    let moved = |error: LiteralError| LiteralError { start: error.start + first, end: error.end + first, ..error };
    literal::integer(&text[first..]).map_err(|error| fault(text, 0, moved(error)))
}

/// The digits of a real, without `_`.
pub fn real(text: &str) -> Result<String, Fault> {
    literal::check_real(text).map_err(|error| fault(text, 0, error))?;
    Ok(text.chars().filter(|it| *it != '_').collect())
}

/// `T#-1h30m`, `LTIME#1.5s`: the type, and nanoseconds; one without a sign where that alone holds it.
pub fn duration(text: &str) -> Result<(Elementary, i64), Fault> {
    let is_long = text.starts_with(['l', 'L']);
    time(text, if is_long { Elementary::Ltime } else { Elementary::Time })
}

/// `D#2024-02-29`, `TIME_OF_DAY#12:30:00`, `LDT#…`: the type, and nanoseconds.
pub fn date(text: &str) -> Result<(Elementary, i64), Fault> {
    let prefix = text.split('#').next().unwrap_or_default();
    time(text, literal::type_of_prefix(prefix).unwrap_or(Elementary::Date))
}

fn time(text: &str, ty: Elementary) -> Result<(Elementary, i64), Fault> {
    let value = text.split_once('#').map_or(text, |it| it.1);
    let first = text.len() - value.len();
    let read = |ty| literal::time(ty, value).map(|it| (ty, it));
    let found = match read(ty) {
        Err(error) if ty == Elementary::Ltime && error.kind == Kind::DurationTooLong => {
            read(Elementary::Ultime).map_err(|_| error)
        }
        found => found,
    };
    found.map_err(|error| fault(text, first, error))
}

/// The sentence about what is wrong in `text`, in the part of it that starts at `first`.
fn fault(text: &str, first: usize, error: LiteralError) -> Fault {
    let (start, end) = (first + error.start, first + error.end);
    let wrong = &text[start..end];
    let message = match error.kind {
        Kind::Base => format!("{}, not {wrong}", error.kind.text()),
        Kind::Digit { base } => format!("`{wrong}` is not a digit of base {base}"),
        Kind::UnknownUnit => format!("`{}` is not a unit of time: expected d, h, m, s, ms, us or ns", unit(wrong)),
        Kind::UnitOrder => format!("`{}` comes after a shorter unit or the same unit", unit(wrong)),
        Kind::InnerFraction { .. } => format!("{}, but `{}` is not the last", error.kind.text(), unit(wrong)),
        Kind::Day { last } => format!("{}: it has {last} days", error.kind.text()),
        Kind::NoDigits
        | Kind::UnderscoreInNumber
        | Kind::UnderscoreInDuration
        | Kind::NumberTooLarge
        | Kind::NoNumber
        | Kind::NoUnit
        | Kind::DurationTooLong
        | Kind::UnsignedDuration
        | Kind::DateForm
        | Kind::TimeOfDayForm
        | Kind::DateAndTimeForm
        | Kind::Month
        | Kind::Hour
        | Kind::Minute
        | Kind::Second
        | Kind::DateTooFar => error.kind.text().to_owned(),
    };
    let (start, end) = if is_of_all(error.kind) { (0, text.len()) } else { (start, end) };
    Fault { start, end, message, meant: meant(text, first, error), help: help(text, error.kind) }
}

/// Whether the whole literal is what is wrong, its prefix too.
fn is_of_all(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::DurationTooLong
            | Kind::UnsignedDuration
            | Kind::DateForm
            | Kind::TimeOfDayForm
            | Kind::DateAndTimeForm
            | Kind::DateTooFar
    )
}

/// The letters of a part of a duration.
fn unit(part: &str) -> String {
    part.chars().filter(char::is_ascii_alphabetic).map(|it| it.to_ascii_lowercase()).collect()
}

/// The whole literal as it is meant, where that is known.
fn meant(text: &str, first: usize, error: LiteralError) -> Option<String> {
    match error.kind {
        Kind::UnknownUnit => {
            let (start, end) = (first + error.start, first + error.end);
            let word = unit(&text[start..end]);
            let number = text[start..end].trim_end_matches(|it: char| it.is_ascii_alphabetic());
            Some(format!("{}{number}{}{}", &text[..start], unit_of(&word)?, &text[end..]))
        }
        Kind::UnderscoreInNumber if text.contains('#') => {
            Some(respaced(text, u8::is_ascii_hexdigit, u8::is_ascii_hexdigit))
        }
        Kind::UnderscoreInNumber => Some(respaced(text, u8::is_ascii_digit, u8::is_ascii_digit)),
        Kind::UnderscoreInDuration => Some(respaced(text, u8::is_ascii_alphanumeric, u8::is_ascii_digit)),
        Kind::InnerFraction { total } => {
            let sign = if text[first..].starts_with('-') { "-" } else { "" };
            Some(format!("{}{sign}{}", &text[..first], spelled(total)))
        }
        Kind::Base
        | Kind::NoDigits
        | Kind::Digit { .. }
        | Kind::NumberTooLarge
        | Kind::NoNumber
        | Kind::NoUnit
        | Kind::UnitOrder
        | Kind::DurationTooLong
        | Kind::UnsignedDuration
        | Kind::DateForm
        | Kind::TimeOfDayForm
        | Kind::DateAndTimeForm
        | Kind::Month
        | Kind::Day { .. }
        | Kind::Hour
        | Kind::Minute
        | Kind::Second
        | Kind::DateTooFar => None,
    }
}

/// The unit that is spelled out, or abbreviated as elsewhere: `sec`.
fn unit_of(word: &str) -> Option<&'static str> {
    Some(match word {
        "sec" | "secs" | "second" | "seconds" => "s",
        "min" | "mins" | "minute" | "minutes" => "m",
        "hr" | "hrs" | "hour" | "hours" => "h",
        "day" | "days" => "d",
        "msec" | "msecs" | "millis" => "ms",
        "usec" | "micros" => "us",
        "nsec" | "nanos" => "ns",
        _ => return None,
    })
}

fn help(text: &str, kind: Kind) -> Option<String> {
    if kind == Kind::NoUnit {
        return Some(format!("write the unit: `{text}s` or `{text}ms`"));
    }
    let Kind::Digit { base } = kind else { return None };
    let digits = match base {
        2 => "0 and 1",
        8 => "0 to 7",
        16 => "0 to 9 and A to F",
        _ => return None,
    };
    Some(format!("the digits of base {base} are {digits}"))
}

/// `text` with a `_` only after a byte that is `before` one and before a byte that is `after` one.
fn respaced(text: &str, before: fn(&u8) -> bool, after: fn(&u8) -> bool) -> String {
    let mut meant = String::new();
    for part in text.split('_').filter(|it| !it.is_empty()) {
        if meant.as_bytes().last().is_some_and(before) && part.as_bytes().first().is_some_and(after) {
            meant.push('_');
        }
        meant.push_str(part);
    }
    meant
}

/// Nanoseconds in units.
fn spelled(mut nanoseconds: i128) -> String {
    let mut out = String::new();
    for (unit, scale) in UNITS {
        let count = nanoseconds / i128::from(scale);
        nanoseconds -= count * i128::from(scale);
        if count > 0 || (out.is_empty() && scale == 1) {
            out += &format!("{count}{unit}");
        }
    }
    out
}

/// `'…'` or `"…"`, escapes resolved; the second value names those that mean nothing.
pub fn string(text: &str, is_wide: bool) -> (Chars, Vec<Fault>) {
    let (quote, inner) = text.split_at(1);
    let inner = inner.strip_suffix(quote).unwrap_or(inner);
    let mut chars = if is_wide { Chars::Wide(Vec::new()) } else { Chars::Narrow(Vec::new()) };
    let mut faults = Vec::new();
    let mut at = 0;
    while let Some(escape) = inner[at..].find('$') {
        put(&inner[at..at + escape], &mut chars);
        at += escape;
        match resolve(&inner[at..], &mut chars) {
            Some(length) => at += length,
            None => {
                let length = 1 + inner[at + 1..].chars().next().map_or(0, char::len_utf8);
                let message = format!("`{}` is not an escape", &inner[at..at + length]);
                faults.push(Fault::new(1 + at, 1 + at + length, message));
                at += length;
            }
        }
    }
    put(&inner[at..], &mut chars);
    (chars, faults)
}

fn put(text: &str, chars: &mut Chars) {
    match chars {
        Chars::Narrow(bytes) => bytes.extend_from_slice(text.as_bytes()),
        Chars::Wide(units) => units.extend(text.encode_utf16()),
    }
}

/// Writes the character of the escape that `text` starts with; its length.
fn resolve(text: &str, chars: &mut Chars) -> Option<usize> {
    let plain = match text.as_bytes().get(1)? {
        letter @ (b'$' | b'\'' | b'"') => *letter,
        b'N' | b'n' | b'L' | b'l' => b'\n',
        b'P' | b'p' => 0x0c,
        b'R' | b'r' => b'\r',
        b'T' | b't' => b'\t',
        _ => return hexadecimal(text, chars),
    };
    match chars {
        Chars::Narrow(bytes) => bytes.push(plain),
        Chars::Wide(units) => units.push(plain.into()),
    }
    Some(2)
}

/// `$0A` is a byte; in a wide string `$00E4` is a UTF-16 code unit.
fn hexadecimal(text: &str, chars: &mut Chars) -> Option<usize> {
    match chars {
        Chars::Narrow(bytes) => {
            bytes.push(u8::from_str_radix(digits(text, 1, 2)?, 16).ok()?);
            Some(3)
        }
        Chars::Wide(units) => {
            units.push(u16::from_str_radix(digits(text, 1, 4)?, 16).ok()?);
            Some(5)
        }
    }
}

fn digits(text: &str, start: usize, len: usize) -> Option<&str> {
    let digits = text.get(start..start + len)?;
    digits.bytes().all(|it| it.is_ascii_hexdigit()).then_some(digits)
}
