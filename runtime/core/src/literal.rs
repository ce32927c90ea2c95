//! Literals as Structured Text spells them: text to value (IEC 61131-3, tables 5 and 8).
//!
//! The compiler reads them in sources and the host in the cells of a stimulus, so that both take
//! and refuse the same.

use crate::Time;

/// What is wrong with a literal, and the bytes of its text where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LiteralError {
    pub start: usize,
    pub end: usize,
    pub kind: LiteralErrorKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LiteralErrorKind {
    /// The base of a number is none of 2, 8 and 16.
    Base,
    NoDigits,
    /// A character that is no digit of the number's base.
    Digit {
        base: u32,
    },
    /// A `_` that is not between two digits.
    UnderscoreInNumber,
    /// A `_` that is neither between two digits nor between two parts of a duration.
    UnderscoreInDuration,
    /// More than 64 bits.
    NumberTooLarge,
    /// A part of a duration without its number.
    NoNumber,
    NoUnit,
    UnknownUnit,
    /// A unit after a shorter one, or after itself.
    UnitOrder,
    /// A fraction in a part that is not the last. `total` has the nanoseconds of all parts.
    InnerFraction {
        total: i128,
    },
    /// More than 64 bits of nanoseconds, about 292 years.
    DurationTooLong,
}

impl LiteralErrorKind {
    /// A sentence without its full stop.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Base => "a number's base is 2, 8 or 16",
            Self::NoDigits => "the number has no digits",
            Self::Digit { .. } => "a digit is not one of the number's base",
            Self::UnderscoreInNumber => "`_` is only between two digits",
            Self::UnderscoreInDuration => "`_` is only between two digits, or between two units",
            Self::NumberTooLarge => "the number does not fit 64 bits",
            Self::NoNumber => "expected a number before the unit",
            Self::NoUnit => "a duration needs a unit: d, h, m, s, ms, us or ns",
            Self::UnknownUnit => "the units of a duration are d, h, m, s, ms, us and ns",
            Self::UnitOrder => "a unit is after a shorter or the same unit",
            Self::InnerFraction { .. } => "only the last unit of a duration has a fraction",
            Self::DurationTooLong => "the duration does not fit 64 bits of nanoseconds (about 292 years)",
        }
    }
}

/// The units of a duration in nanoseconds, from the longest to the shortest.
pub const UNITS: [(&str, Time); 7] = [
    ("d", 86_400_000_000_000),
    ("h", 3_600_000_000_000),
    ("m", 60_000_000_000),
    ("s", 1_000_000_000),
    ("ms", 1_000_000),
    ("us", 1_000),
    ("ns", 1),
];

type IsByte = fn(&u8) -> bool;

/// The magnitude of `1_000`, `2#1010`, `8#17` or `16#FF`.
pub fn integer(text: &str) -> Result<u64, LiteralError> {
    let error = |start, end, kind| Err(LiteralError { start, end, kind });
    let (base, digits) = match text.split_once('#') {
        None => (10, text),
        Some(("2", digits)) => (2, digits),
        Some(("8", digits)) => (8, digits),
        Some(("16", digits)) => (16, digits),
        Some((base, _)) => return error(0, base.len(), LiteralErrorKind::Base),
    };
    if digits.bytes().all(|it| it == b'_') {
        return error(0, text.len(), LiteralErrorKind::NoDigits);
    }
    let is_digit: IsByte = if base == 16 { u8::is_ascii_hexdigit } else { u8::is_ascii_digit };
    underscores(text, is_digit, is_digit, LiteralErrorKind::UnderscoreInNumber)?;
    let first = text.len() - digits.len();
    let mut value = 0_u64;
    for (at, character) in digits.char_indices().filter(|(_, it)| *it != '_') {
        let Some(digit) = character.to_digit(base) else {
            return error(first + at, first + at + character.len_utf8(), LiteralErrorKind::Digit { base });
        };
        let next = value.checked_mul(u64::from(base)).and_then(|it| it.checked_add(u64::from(digit)));
        let Some(next) = next else { return error(0, text.len(), LiteralErrorKind::NumberTooLarge) };
        value = next;
    }
    Ok(value)
}

/// Whether a real is spelled right: `1_000.5e-3`, after an optional sign; the fraction and the
/// exponent may be left out.
pub fn check_real(text: &str) -> Result<(), LiteralError> {
    underscores(text, u8::is_ascii_digit, u8::is_ascii_digit, LiteralErrorKind::UnderscoreInNumber)?;
    let signed = |it: &str| it.len() - it.strip_prefix(['+', '-']).unwrap_or(it).len();
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.get(signed(exponent)..)),
        None => (text, Some("0")),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, "0"));
    for part in [whole.get(signed(whole)..), Some(fraction), exponent] {
        let digits = part.unwrap_or_default();
        if digits.is_empty() || digits.bytes().any(|it| !it.is_ascii_digit() && it != b'_') {
            return Err(LiteralError { start: 0, end: text.len(), kind: LiteralErrorKind::Digit { base: 10 } });
        }
    }
    Ok(())
}

/// Nanoseconds of `-1h30m`, `1.5s` or `1d_2h`: what follows `T#`. Less than a nanosecond is cut off.
pub fn duration(text: &str) -> Result<Time, LiteralError> {
    let sign = text.starts_with(['-', '+']);
    let mut at = usize::from(sign);
    let mut total = 0_i128;
    // Index of the longest unit that the next part may have.
    let mut next_unit = 0;
    let mut inner_fraction = None;
    loop {
        let part = part(text, at)?;
        if part.unit < next_unit {
            return Err(LiteralError { start: at, end: part.end, kind: LiteralErrorKind::UnitOrder });
        }
        next_unit = part.unit + 1;
        total = total.saturating_add(part.nanoseconds);
        if part.fraction && part.end < text.len() {
            inner_fraction = inner_fraction.or(Some((at, part.end)));
        }
        at = part.end;
        if at >= text.len() {
            break;
        }
    }
    if let Some((start, end)) = inner_fraction {
        return Err(LiteralError { start, end, kind: LiteralErrorKind::InnerFraction { total } });
    }
    underscores(text, u8::is_ascii_alphanumeric, u8::is_ascii_digit, LiteralErrorKind::UnderscoreInDuration)?;
    let total = if text.starts_with('-') { -total } else { total };
    let long = LiteralError { start: 0, end: text.len(), kind: LiteralErrorKind::DurationTooLong };
    Time::try_from(total).map_err(|_| long)
}

/// One number of a duration with its unit.
struct Part {
    /// Index in [`UNITS`].
    unit: usize,
    nanoseconds: i128,
    fraction: bool,
    end: usize,
}

fn part(text: &str, start: usize) -> Result<Part, LiteralError> {
    let rest = text.get(start..).unwrap_or_default();
    let number_end = rest.find(|it: char| it.is_ascii_alphabetic()).unwrap_or(rest.len());
    let (number, after) = rest.split_at_checked(number_end).unwrap_or_default();
    let name_end = after.find(|it: char| !it.is_ascii_alphabetic()).unwrap_or(after.len());
    let (name, next) = after.split_at_checked(name_end).unwrap_or_default();
    // `1h_30m`: the `_` is a part of neither.
    let end = text.len() - next.trim_start_matches('_').len();
    let error = |end, kind| LiteralError { start, end, kind };
    let Some(unit) = UNITS.iter().position(|(it, _)| it.eq_ignore_ascii_case(name)) else {
        let kind = if name.is_empty() { LiteralErrorKind::NoUnit } else { LiteralErrorKind::UnknownUnit };
        return Err(error(end.max(start + 1).min(text.len()), kind));
    };
    let (whole, fraction) = match number.split_once('.') {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (number, None),
    };
    let is_number =
        |it: &str| it.bytes().any(|it| it.is_ascii_digit()) && it.bytes().all(|it| it.is_ascii_digit() || it == b'_');
    if !is_number(whole) || fraction.is_some_and(|it| !is_number(it)) {
        return Err(error(end, LiteralErrorKind::NoNumber));
    }
    let nanoseconds = scaled(whole, fraction.unwrap_or_default(), i128::from(UNITS[unit].1));
    Ok(Part { unit, nanoseconds, fraction: fraction.is_some(), end })
}

/// `whole.fraction` times `scale`, saturating, cut to whole nanoseconds.
fn scaled(whole: &str, fraction: &str, scale: i128) -> i128 {
    fn digits(text: &str) -> impl Iterator<Item = i128> {
        text.bytes().filter(u8::is_ascii_digit).map(|it| i128::from(it - b'0'))
    }
    let add = |sum: i128, digit| sum.saturating_mul(10).saturating_add(digit);
    let whole = digits(whole).fold(0, add).saturating_mul(scale);
    // No unit has more than 14 decimal digits of nanoseconds.
    let (part, tenths) = digits(fraction).take(15).fold((0, 1), |(sum, tenths), digit| (add(sum, digit), tenths * 10));
    whole.saturating_add(part * scale / tenths)
}

/// `text` holds no `_` but after a byte that is `before` one and before a byte that is `after` one.
fn underscores(text: &str, before: IsByte, after: IsByte, kind: LiteralErrorKind) -> Result<(), LiteralError> {
    let bytes = text.as_bytes();
    let is = |at: Option<usize>, what: IsByte| at.and_then(|it| bytes.get(it)).is_some_and(what);
    let loose = |at: &usize| bytes[*at] == b'_' && !(is(at.checked_sub(1), before) && is(Some(at + 1), after));
    let Some(start) = (0..bytes.len()).find(loose) else { return Ok(()) };
    let end = start + bytes[start..].iter().take_while(|it| **it == b'_').count();
    Err(LiteralError { start, end, kind })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_one_value() {
        for (text, nanoseconds) in [
            ("1h30m", 5_400_000_000_000),
            ("-1d_2h3m4s5ms6us7ns", -93_784_005_006_007),
            ("1.5S", 1_500_000_000),
            ("+1_000ms", 1_000_000_000),
            ("0.000000001s", 1),
            ("0.0000000019s", 1),
            ("1s0.25ms", 1_000_250_000),
            ("90m", 5_400_000_000_000),
            ("9223372036854775807ns", i64::MAX),
            ("-9223372036854775808ns", i64::MIN),
        ] {
            assert_eq!(duration(text), Ok(nanoseconds), "{text}");
        }
    }

    #[test]
    fn durations_are_refused_at_the_place() {
        use LiteralErrorKind as Kind;
        for (text, start, end, kind) in [
            ("", 0, 0, Kind::NoUnit),
            ("5", 0, 1, Kind::NoUnit),
            ("5s1", 2, 3, Kind::NoUnit),
            ("5x", 0, 2, Kind::UnknownUnit),
            ("s", 0, 1, Kind::NoNumber),
            ("--5s", 1, 4, Kind::NoNumber),
            (".5s", 0, 3, Kind::NoNumber),
            ("1.2.3s", 0, 6, Kind::NoNumber),
            ("1s1s", 2, 4, Kind::UnitOrder),
            ("1ms1s", 3, 5, Kind::UnitOrder),
            ("1.5s200ms", 0, 4, Kind::InnerFraction { total: 1_700_000_000 }),
            ("1_s", 1, 2, Kind::UnderscoreInDuration),
            ("1__0s", 1, 3, Kind::UnderscoreInDuration),
            ("1s_", 2, 3, Kind::UnderscoreInDuration),
            ("_1s", 0, 1, Kind::UnderscoreInDuration),
            ("999999999d", 0, 10, Kind::DurationTooLong),
            ("9223372036854775808ns", 0, 21, Kind::DurationTooLong),
        ] {
            assert_eq!(duration(text), Err(LiteralError { start, end, kind }), "{text}");
        }
    }

    #[test]
    fn numbers_have_bases() {
        for (text, value) in [("1_000", 1000), ("2#1010_1010", 170), ("8#17", 15), ("16#fF", 255), ("0", 0)] {
            assert_eq!(integer(text), Ok(value), "{text}");
        }
        assert_eq!(integer("18446744073709551615"), Ok(u64::MAX));
        use LiteralErrorKind as Kind;
        for (text, start, end, kind) in [
            ("", 0, 0, Kind::NoDigits),
            ("16#", 0, 3, Kind::NoDigits),
            ("16#_", 0, 4, Kind::NoDigits),
            ("7#1", 0, 1, Kind::Base),
            ("2#102", 4, 5, Kind::Digit { base: 2 }),
            ("12a", 2, 3, Kind::Digit { base: 10 }),
            ("-1", 0, 1, Kind::Digit { base: 10 }),
            ("1__0", 1, 3, Kind::UnderscoreInNumber),
            ("16#_F", 3, 4, Kind::UnderscoreInNumber),
            ("18446744073709551616", 0, 20, Kind::NumberTooLarge),
        ] {
            assert_eq!(integer(text), Err(LiteralError { start, end, kind }), "{text}");
        }
    }

    #[test]
    fn reals_have_digits_on_both_sides() {
        for text in ["1.5", "-1_0.5e-3", "+2E+10", "15", "0.0"] {
            assert_eq!(check_real(text), Ok(()), "{text}");
        }
        for text in ["", "1.", ".5", "1.5e", "1e+", "inf", "NaN", "1_.5", "1.5.5", "1e5e5", "--1", "0x1", "_"] {
            assert!(check_real(text).is_err(), "{text}");
        }
    }
}
