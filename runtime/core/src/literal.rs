//! Literals as Structured Text spells them: text to value (IEC 61131-3, tables 5 and 8).
//!
//! The compiler reads them in sources and the host in the cells of a stimulus, so that both accept
//! and refuse the same literals.

use crate::calendar::{Clock, Day, days_of_month};
use crate::time::{DAY, SECOND};
use crate::{Elementary, Time};

/// What is wrong with a literal, and where in its text, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LiteralError {
    pub start: usize,
    pub end: usize,
    pub kind: LiteralErrorKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LiteralErrorKind {
    /// The base of a number is not 2, 8 or 16.
    Base,
    NoDigits,
    /// A character that is not a digit of the number's base.
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
    /// A fraction in a part that is not the last. `total` is the nanoseconds of all parts.
    InnerFraction {
        total: i128,
    },
    /// More than 64 bits of nanoseconds, about 292 years.
    DurationTooLong,
    UnsignedDuration,
    /// Not year, month and day.
    DateForm,
    /// Not hour, minute and second.
    TimeOfDayForm,
    /// Not a date with a time of day.
    DateAndTimeForm,
    Month,
    /// A day that its month does not have: the last one is `last`.
    Day {
        last: i64,
    },
    Hour,
    Minute,
    Second,
    /// A date that is out of the range of 64 bits of nanoseconds.
    DateTooFar,
}

impl LiteralErrorKind {
    /// The message, without a full stop.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Base => "a number's base is 2, 8 or 16",
            Self::NoDigits => "the number has no digits",
            Self::Digit { .. } => "a digit is not one of the number's base",
            Self::UnderscoreInNumber => "`_` is allowed only between two digits",
            Self::UnderscoreInDuration => "`_` is allowed only between two digits, or between two units",
            Self::NumberTooLarge => "the number does not fit 64 bits",
            Self::NoNumber => "expected a number before the unit",
            Self::NoUnit => "a duration needs a unit: d, h, m, s, ms, us or ns",
            Self::UnknownUnit => "the units of a duration are d, h, m, s, ms, us and ns",
            Self::UnitOrder => "a unit is after a shorter or the same unit",
            Self::InnerFraction { .. } => "only the last unit of a duration has a fraction",
            Self::DurationTooLong => {
                "a duration is at most 106751d 23h 47m 16s 854ms 775us 807ns: it counts nanoseconds in 64 bits with a sign"
            }
            Self::UnsignedDuration => "it is at least 0s, and at most 213503d 23h 34m 33s 709ms 551us 615ns",
            Self::DateForm => "a date is year, month and day, as in `2024-02-29`",
            Self::TimeOfDayForm => "a time of day is hour, minute and second, as in `23:59:59.5`",
            Self::DateAndTimeForm => "a DT is a date and a time of day, as in `2024-02-29-23:59:59.5`",
            Self::Month => "a year has the months 1 to 12",
            Self::Day { .. } => "the month has no such day",
            Self::Hour => "a day has the hours 0 to 23",
            Self::Minute => "an hour has the minutes 0 to 59",
            Self::Second => "a minute has the seconds 0 to 59",
            Self::DateTooFar => "dates go from 1677-09-22 to 2262-04-11",
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

/// Finds a character in text. `core` finds a `char` with code that can panic.
pub(crate) fn is(character: char) -> impl Fn(char) -> bool {
    move |it| it == character
}

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

/// Whether a real is spelled correctly: `1_000.5e-3`, after an optional sign; the fraction and the
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
    let total = nanoseconds(text)?;
    Time::try_from(total).map_err(|_| outside(text, LiteralErrorKind::DurationTooLong))
}

/// The same for an unsigned duration, which can be twice as long.
pub fn unsigned_duration(text: &str) -> Result<u64, LiteralError> {
    let total = nanoseconds(text)?;
    u64::try_from(total).map_err(|_| outside(text, LiteralErrorKind::UnsignedDuration))
}

const fn outside(text: &str, kind: LiteralErrorKind) -> LiteralError {
    LiteralError { start: 0, end: text.len(), kind }
}

fn nanoseconds(text: &str) -> Result<i128, LiteralError> {
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
    Ok(if text.starts_with('-') { -total } else { total })
}

/// The place of a unit in a duration that is not the first one, and overflows into a longer unit: `68s` in `5m68s`.
///
/// ```
/// use staunch_runtime::literal::lower_overflow;
/// assert_eq!(lower_overflow("5m68s"), Some((2, 5)));
/// assert_eq!(lower_overflow("100s12ms"), None);
/// ```
pub fn lower_overflow(text: &str) -> Option<(usize, usize)> {
    let mut at = usize::from(text.starts_with(['-', '+']));
    let first = at;
    while at < text.len() {
        let part = part(text, at).ok()?;
        let longer = part.unit.checked_sub(1).and_then(|it| UNITS.get(it)).map(|it| i128::from(it.1));
        if at > first && longer.is_some_and(|it| part.nanoseconds >= it) {
            return Some((at, part.end));
        }
        at = part.end;
    }
    None
}

/// The type that the prefix of such a literal names: `D`, `TIME`, `LDATE_AND_TIME`.
pub fn type_of_prefix(prefix: &str) -> Option<Elementary> {
    let short =
        [("T", Elementary::Time), ("LT", Elementary::Ltime), ("D", Elementary::Date), ("LD", Elementary::Ldate)];
    let short = short.into_iter().find(|it| it.0.eq_ignore_ascii_case(prefix)).map(|it| it.1);
    short.or_else(|| Elementary::named(prefix)).filter(|it| it.is_time())
}

/// The value of a literal of a duration, a date or a time of day, from the text after its `#`. For an
/// [unsigned LTIME](Elementary::Ultime) it is the bits.
pub fn time(ty: Elementary, text: &str) -> Result<Time, LiteralError> {
    match ty {
        Elementary::Date | Elementary::Ldate => date(text),
        Elementary::Tod | Elementary::Ltod => time_of_day(text),
        Elementary::Dt | Elementary::Ldt => date_and_time(text),
        Elementary::Ultime => unsigned_duration(text).map(|it| it as i64),
        _ => duration(text),
    }
}

/// The midnight of `2024-02-29`.
pub fn date(text: &str) -> Result<Time, LiteralError> {
    let too_far = LiteralError { start: 0, end: text.len(), kind: LiteralErrorKind::DateTooFar };
    day(text)?.checked_mul(DAY).ok_or(too_far)
}

/// Days from 1970-01-01 to `2024-02-29`.
fn day(text: &str) -> Result<i64, LiteralError> {
    let error = |start, end, kind| LiteralError { start, end, kind };
    let Fields { values: [year, month, day], ends, count } = Fields::of(text, '-', LiteralErrorKind::DateForm)?;
    if count < 3 {
        return Err(error(0, text.len(), LiteralErrorKind::DateForm));
    }
    if !(1..=12).contains(&month) {
        return Err(error(ends[0] + 1, ends[1], LiteralErrorKind::Month));
    }
    let last = days_of_month(year, month);
    if !(1..=last).contains(&day) {
        return Err(error(ends[1] + 1, ends[2], LiteralErrorKind::Day { last }));
    }
    Day { year, month, day }.number().ok_or(error(0, text.len(), LiteralErrorKind::DateTooFar))
}

/// Nanoseconds since midnight at `23:59:59.5`. The seconds may be left out; less than a nanosecond is
/// cut off.
pub fn time_of_day(text: &str) -> Result<Time, LiteralError> {
    let kind = LiteralErrorKind::TimeOfDayForm;
    let error = |start, end, kind| LiteralError { start, end, kind };
    let (whole, fraction) = text.split_once(is('.')).map_or((text, None), |(whole, fraction)| (whole, Some(fraction)));
    let Fields { values: [hour, minute, second], ends, count } = Fields::of(whole, ':', kind)?;
    let is_fraction = |it: &str| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit() || it == b'_');
    if count < 2 || fraction.is_some_and(|it| count < 3 || !is_fraction(it)) {
        return Err(error(0, text.len(), kind));
    }
    underscores(text, u8::is_ascii_digit, u8::is_ascii_digit, LiteralErrorKind::UnderscoreInNumber)?;
    let nanosecond = scaled("", fraction.unwrap_or_default(), i128::from(SECOND));
    let nanosecond = Time::try_from(nanosecond).unwrap_or(0);
    let limits = [
        (hour, 24, LiteralErrorKind::Hour),
        (minute, 60, LiteralErrorKind::Minute),
        (second, 60, LiteralErrorKind::Second),
    ];
    for (at, (value, limit, kind)) in limits.into_iter().enumerate() {
        if value >= limit {
            let end = |at: usize| ends.get(at).copied().unwrap_or(text.len());
            let start = at.checked_sub(1).map_or(0, |before| end(before) + 1);
            return Err(error(start, end(at), kind));
        }
    }
    Clock { hour, minute, second, nanosecond }.since_midnight().ok_or(error(0, text.len(), kind))
}

/// Nanoseconds from 1970-01-01 to `2024-02-29-23:59:59.5`.
pub fn date_and_time(text: &str) -> Result<Time, LiteralError> {
    let whole = |kind| LiteralError { start: 0, end: text.len(), kind };
    // The last of three `-` is between the day and the hour.
    let mut dashes = text.match_indices(is('-')).map(|it| it.0);
    let (Some(between), None) = (dashes.nth(2), dashes.next()) else {
        return Err(whole(LiteralErrorKind::DateAndTimeForm));
    };
    let (date, clock) = text.split_at_checked(between).unwrap_or_default();
    let clock = clock.strip_prefix('-').unwrap_or_default();
    let number = day(date)?;
    let shifted = |it: LiteralError| LiteralError { start: it.start + between + 1, end: it.end + between + 1, ..it };
    let clock = time_of_day(clock).map_err(shifted)?;
    let time = i128::from(number) * i128::from(DAY) + i128::from(clock);
    Time::try_from(time).map_err(|_| whole(LiteralErrorKind::DateTooFar))
}

/// Up to three numbers between separators, and the end of each.
struct Fields {
    values: [i64; 3],
    ends: [usize; 3],
    count: usize,
}

impl Fields {
    fn of(text: &str, separator: char, kind: LiteralErrorKind) -> Result<Self, LiteralError> {
        underscores(text, u8::is_ascii_digit, u8::is_ascii_digit, LiteralErrorKind::UnderscoreInNumber)?;
        let wrong = LiteralError { start: 0, end: text.len(), kind };
        let mut fields = Self { values: [0; 3], ends: [0; 3], count: 0 };
        let mut start = 0;
        for digits in text.split(is(separator)) {
            let (Some(value), Some(end)) = (fields.values.get_mut(fields.count), fields.ends.get_mut(fields.count))
            else {
                return Err(wrong);
            };
            if digits.is_empty() || digits.bytes().any(|it| !it.is_ascii_digit() && it != b'_') {
                return Err(wrong);
            }
            *value = i64::try_from(decimal(digits)).unwrap_or(i64::MAX);
            *end = start + digits.len();
            start = *end + separator.len_utf8();
            fields.count += 1;
        }
        Ok(fields)
    }
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
    let found = UNITS.iter().enumerate().find(|it| it.1.0.eq_ignore_ascii_case(name));
    let Some((unit, (_, scale))) = found else {
        let kind = if name.is_empty() { LiteralErrorKind::NoUnit } else { LiteralErrorKind::UnknownUnit };
        return Err(error(end.max(start + 1).min(text.len()), kind));
    };
    let (whole, fraction) = match number.split_once(is('.')) {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (number, None),
    };
    let is_number =
        |it: &str| it.bytes().any(|it| it.is_ascii_digit()) && it.bytes().all(|it| it.is_ascii_digit() || it == b'_');
    if !is_number(whole) || fraction.is_some_and(|it| !is_number(it)) {
        return Err(error(end, LiteralErrorKind::NoNumber));
    }
    let nanoseconds = scaled(whole, fraction.unwrap_or_default(), i128::from(*scale));
    Ok(Part { unit, nanoseconds, fraction: fraction.is_some(), end })
}

/// `whole.fraction` times `scale`, saturating, cut to whole nanoseconds.
fn scaled(whole: &str, fraction: &str, scale: i128) -> i128 {
    // No unit has more than 14 decimal digits of nanoseconds.
    let part = digits(fraction).take(15).fold(0, appended).saturating_mul(scale);
    let part = digits(fraction).take(15).fold(part, |it, _| tenth(it));
    decimal(whole).saturating_mul(scale).saturating_add(part)
}

/// A tenth of a non-negative number, rounded down. The compiler's own 128-bit division needs the
/// unwinder, which a C program that links this library does not have.
fn tenth(number: i128) -> i128 {
    let divide = |(quotient, rest): (i128, u64), shift: u32| {
        let limb = u64::try_from(number >> shift & 0xFFFF_FFFF).unwrap_or(0);
        let value = rest << 32 | limb;
        (quotient | i128::from(value / 10) << shift, value % 10)
    };
    [96, 64, 32, 0].into_iter().fold((0, 0), divide).0
}

/// The number with these digits, saturating; other characters between them are ignored.
fn decimal(text: &str) -> i128 {
    digits(text).fold(0, appended)
}

fn digits(text: &str) -> impl Iterator<Item = i128> {
    text.bytes().filter(u8::is_ascii_digit).map(|it| i128::from(it - b'0'))
}

fn appended(number: i128, digit: i128) -> i128 {
    number.saturating_mul(10).saturating_add(digit)
}

/// Whether each `_` in `text` comes after a byte for which `before` holds, and before a byte for which `after` holds.
fn underscores(text: &str, before: IsByte, after: IsByte, kind: LiteralErrorKind) -> Result<(), LiteralError> {
    let bytes = text.as_bytes();
    let is = |at: Option<usize>, what: IsByte| at.and_then(|it| bytes.get(it)).is_some_and(what);
    let loose = |at: usize| !(is(at.checked_sub(1), before) && is(at.checked_add(1), after));
    let mut places = bytes.iter().enumerate();
    let Some((start, _)) = places.find(|(at, it)| **it == b'_' && loose(*at)) else { return Ok(()) };
    let end = start + 1 + places.take_while(|it| *it.1 == b'_').count();
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
    fn dates_and_times_of_day_have_one_value() {
        for (text, value) in [
            ("1970-01-01", 0),
            ("1970-1-2", DAY),
            ("2024-02-29", 1_709_164_800 * SECOND),
            ("1969-12-31", -DAY),
            ("1677-09-22", -106_751 * DAY),
            ("2262-04-11", 106_751 * DAY),
        ] {
            assert_eq!(date(text), Ok(value), "{text}");
        }
        for (text, value) in [
            ("00:00:00", 0),
            ("23:59:59.999999999", DAY - 1),
            ("23:59:59.9999999999", DAY - 1),
            ("1:2:3", 3723 * SECOND),
            ("12:30", 45_000 * SECOND),
            ("0:0:0.25", SECOND / 4),
        ] {
            assert_eq!(time_of_day(text), Ok(value), "{text}");
        }
        for (text, value) in [
            ("2024-02-29-12:34:56.789", 1_709_210_096_789_000_000),
            ("1970-1-1-0:0", 0),
            ("1677-09-21-00:12:43.145224192", i64::MIN),
            ("2262-04-11-23:47:16.854775807", i64::MAX),
        ] {
            assert_eq!(date_and_time(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn dates_and_times_of_day_are_refused_at_the_place() {
        use LiteralErrorKind as Kind;
        type Read = fn(&str) -> Result<Time, LiteralError>;
        let all: &[(Read, &str, usize, usize, Kind)] = &[
            (date, "2024-02-30", 8, 10, Kind::Day { last: 29 }),
            (date, "2023-2-29", 7, 9, Kind::Day { last: 28 }),
            (date, "1900-02-29", 8, 10, Kind::Day { last: 28 }),
            (date, "2024-04-31", 8, 10, Kind::Day { last: 30 }),
            (date, "2024-13-01", 5, 7, Kind::Month),
            (date, "2024-00-01", 5, 7, Kind::Month),
            (date, "2024-01-00", 8, 10, Kind::Day { last: 31 }),
            (date, "70-01-01", 0, 8, Kind::DateTooFar),
            (date, "2262-04-12", 0, 10, Kind::DateTooFar),
            (date, "1677-09-21", 0, 10, Kind::DateTooFar),
            (date, "99999999999999999999-01-01", 0, 26, Kind::DateTooFar),
            (date, "2024-02", 0, 7, Kind::DateForm),
            (date, "2024-02-03-04", 0, 13, Kind::DateForm),
            (date, "2024:02:03", 0, 10, Kind::DateForm),
            (date, "2024-_2-03", 5, 6, Kind::UnderscoreInNumber),
            (date, "", 0, 0, Kind::DateForm),
            (time_of_day, "24:00:00", 0, 2, Kind::Hour),
            (time_of_day, "12:60:00", 3, 5, Kind::Minute),
            (time_of_day, "12:00:60", 6, 8, Kind::Second),
            (time_of_day, "12", 0, 2, Kind::TimeOfDayForm),
            (time_of_day, "12:30.5", 0, 7, Kind::TimeOfDayForm),
            (time_of_day, "12:30:5.", 0, 8, Kind::TimeOfDayForm),
            (time_of_day, "12:30:5.1.2", 0, 11, Kind::TimeOfDayForm),
            (date_and_time, "2024-02-30-12:00:00", 8, 10, Kind::Day { last: 29 }),
            (date_and_time, "2024-02-29-25:00:00", 11, 13, Kind::Hour),
            (date_and_time, "2024-02-29", 0, 10, Kind::DateAndTimeForm),
            (date_and_time, "2024-02-29-12:00:00-1", 0, 21, Kind::DateAndTimeForm),
            (date_and_time, "2262-04-11-23:47:16.854775808", 0, 29, Kind::DateTooFar),
        ];
        for (read, text, start, end, kind) in all {
            assert_eq!(read(text), Err(LiteralError { start: *start, end: *end, kind: *kind }), "{text}");
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
