//! Text in OpenPLC, as in the C code that MATIEC (thiagoralves/matiec, f9ca9ba) generates.

use super::{Destination, Unit, delete, insert, mid, replace, to_lreal};
use crate::decimal;
use crate::time::{DAY, SECOND};
use crate::{Elementary, Time};
use core::fmt::Write;

/// The order of two strings up to the end of the shorter one: a text equals every text that begins with it, and the empty
/// text equals all texts.
///
/// ```
/// use staunch_runtime::text::compare_start;
/// assert_eq!(compare_start(b"ABC", b"AB"), 0);
/// assert_eq!(compare_start(b"ABC", b"B"), -1);
/// ```
#[inline]
pub fn compare_start<U: Unit>(a: &[U], b: &[U]) -> i16 {
    let shared = a.len().min(b.len());
    a.get(..shared).unwrap_or(a).cmp(b.get(..shared).unwrap_or(b)) as i16
}

/// `FIND`: the characters of a partial match are not searched again. If the pattern is not found, the result is 0 if the text
/// ends with the pattern without its last character, otherwise the position after the text.
///
/// ```
/// use staunch_runtime::text::find_or_end;
/// assert_eq!(find_or_end(b"ABC", b"BC"), 2);
/// assert_eq!(find_or_end(b"ABC", b"X"), 0);
/// assert_eq!(find_or_end(b"ABC", b"XY"), 4);
/// ```
#[inline]
pub fn find_or_end<U: Unit>(text: &[U], pattern: &[U]) -> i16 {
    let (mut start, mut matching) = (0, 0);
    while let (Some(a), Some(b)) = (text.get(start + matching), pattern.get(matching)) {
        if a == b {
            matching += 1;
        } else {
            start += matching + 1;
            matching = 0;
        }
    }
    let lacks_one = matching + 1 == pattern.len();
    if lacks_one { 0 } else { i16::try_from(start + 1).unwrap_or(i16::MAX) }
}

/// `MID`: nothing for a negative count or position. Position 0 is the byte before the text, which holds its length.
///
/// ```
/// use staunch_runtime::{Text, text::mid_or_length};
/// let text = |count, position| Text::<8>::build(|out| mid_or_length(b"ABC", count, position, out));
/// assert_eq!(text(2, 0).as_bytes(), b"\x03A");
/// assert_eq!(text(2, 2).as_bytes(), b"BC");
/// assert_eq!(text(2, -1).as_bytes(), b"");
/// ```
#[inline]
pub fn mid_or_length<U: Unit>(text: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    match position {
        ..0 => {}
        0 if count > 0 => {
            out.write(&[U::ZERO.with_byte(0, text.len() as u8)]);
            mid(text, count - 1, 1, out);
        }
        _ => mid(text, count, position, out),
    }
}

/// `INSERT`: nothing for a negative position.
///
/// ```
/// use staunch_runtime::{Text, text::insert_from};
/// let text = |position| Text::<8>::build(|out| insert_from(b"ABC", b"X", position, out));
/// assert_eq!((text(1).as_bytes(), text(-1).as_bytes()), (b"AXBC".as_slice(), b"".as_slice()));
/// ```
#[inline]
pub fn insert_from<U: Unit>(text: &[U], inserted: &[U], position: i64, out: &mut Destination<'_, U>) {
    if position >= 0 {
        insert(text, inserted, position, out);
    }
}

/// `DELETE`: nothing for a negative count or position.
///
/// ```
/// use staunch_runtime::{Text, text::delete_from};
/// let text = |count| Text::<8>::build(|out| delete_from(b"ABC", count, 2, out));
/// assert_eq!((text(1).as_bytes(), text(-1).as_bytes()), (b"AC".as_slice(), b"".as_slice()));
/// ```
#[inline]
pub fn delete_from<U: Unit>(text: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    if count >= 0 && position >= 0 {
        delete(text, count, position, out);
    }
}

/// `REPLACE`: at most `count` units of `by` are used. Nothing for a negative count or position.
///
/// ```
/// use staunch_runtime::{Text, text::replace_up_to};
/// let text = Text::<8>::build(|out| replace_up_to(b"ABC", b"XY", 1, 1, out));
/// assert_eq!(text.as_bytes(), b"XBC");
/// ```
#[inline]
pub fn replace_up_to<U: Unit>(text: &[U], by: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    if count < 0 || position < 0 {
        return;
    }
    let taken = usize::try_from(count).unwrap_or(by.len()).min(by.len());
    // Beyond the text, all of it stays.
    let position = if position > text.len() as i64 { position.saturating_add(1) } else { position };
    replace(text, by.get(..taken).unwrap_or(by), count, position, out);
}

/// A bit string: `16#` and its hexadecimal digits.
#[inline]
pub fn from_bits(value: u64, out: &mut Destination<'_>) {
    let _ = write!(out, "16#{value:x}");
}

/// A real with ten significant digits, without trailing zeros: C's `%.10g`.
///
/// ```
/// use staunch_runtime::{Text, text::from_general};
/// let written = |value| Text::<24>::build(|out| from_general(value, out));
/// assert_eq!(written(f64::from(0.1_f32)).as_bytes(), b"0.1000000015");
/// assert_eq!(written(1.0).as_bytes(), b"1");
/// assert_eq!(written(1e21).as_bytes(), b"1e+21");
/// ```
#[inline]
pub fn from_general(value: f64, out: &mut Destination<'_>) {
    general(value, 10, out);
}

const ZERO: decimal::Digits = decimal::Digits { digits: [0; 17], count: 1, exponent: 1 };

/// C's `%.*g` with this number of significant digits, at most 17.
pub(super) fn general(value: f64, digits: usize, out: &mut Destination<'_>) {
    if value.is_sign_negative() {
        out.write(b"-");
    }
    if !value.is_finite() {
        return out.write(if value.is_nan() { b"nan" } else { b"inf" });
    }
    let magnitude = value.abs();
    let found = if magnitude == 0.0 { ZERO } else { decimal::rounded(magnitude, digits) };
    let (all, exponent) = (found.digits.map(|it| b'0' + it), found.exponent - 1);
    let kept = found.digits.iter().rposition(|it| *it != 0).map_or(1, |it| it + 1);
    let figures = all.get(..kept).unwrap_or_default();
    if exponent < -4 || exponent >= digits as i32 {
        with_point(figures, 1, out);
        let sign = if exponent < 0 { '-' } else { '+' };
        let _ = write!(out, "e{sign}{:02}", exponent.unsigned_abs());
    } else if exponent < 0 {
        out.write(b"0.");
        (1..-exponent).for_each(|_| out.write(b"0"));
        out.write(figures);
    } else {
        with_point(figures, exponent as usize + 1, out);
    }
}

/// Digits with a point after the first `whole` of them; missing ones are filled with zeros.
fn with_point(figures: &[u8], whole: usize, out: &mut Destination<'_>) {
    let (before, after) = figures.split_at_checked(whole).unwrap_or((figures, &[]));
    out.write(before);
    (before.len()..whole).for_each(|_| out.write(b"0"));
    if !after.is_empty() {
        out.write(b".");
        out.write(after);
    }
}

/// A TIME, date or point in time. `kind` is the index of its type in [`Elementary::ALL`].
///
/// ```
/// use staunch_runtime::{Elementary, Text, text::from_seconds};
/// let kind = Elementary::ALL.iter().position(|it| *it == Elementary::Time).map_or(0, |it| it as i64);
/// assert_eq!(Text::<40>::build(|out| from_seconds(1_500_000_000, kind, out)).as_bytes(), b"T#0d0h0m1s500ms");
/// ```
pub fn from_seconds(time: Time, kind: i64, out: &mut Destination<'_>) {
    let ty = usize::try_from(kind).ok().and_then(|it| Elementary::ALL.get(it)).copied();
    let _ = match ty {
        Some(it) if it.is_day() => write!(out, "D#").and_then(|()| write_date(time / SECOND, out)),
        Some(it) if it.is_time_of_day() => write!(out, "TOD#").and_then(|()| write_clock(time, out)),
        Some(Elementary::Dt | Elementary::Ldt) => write!(out, "DT#")
            .and_then(|()| write_date(time / SECOND, out))
            .and_then(|()| write!(out, "-"))
            .and_then(|()| write_clock(time, out)),
        Some(_) | None => write_duration(time, out),
    };
}

/// Days, and each smaller unit as long as anything is left; milliseconds with six digits.
fn write_duration(time: Time, out: &mut Destination<'_>) -> core::fmt::Result {
    let (seconds, rest) = (time / SECOND, time % SECOND);
    let units = [(86_400, 'd'), (3_600, 'h'), (60, 'm'), (1, 's')];
    let mut left = seconds;
    write!(out, "T#")?;
    for (unit, letter) in units {
        write!(out, "{}{letter}", left / unit)?;
        left %= unit;
        if left == 0 && rest == 0 {
            return Ok(());
        }
    }
    general(rest as f64 / 1e6, 6, out);
    write!(out, "ms")
}

fn write_clock(time: Time, out: &mut Destination<'_>) -> core::fmt::Result {
    let (of_day, rest) = ((time / SECOND).rem_euclid(DAY / SECOND), time % SECOND);
    let (hour, minute, second) = (of_day / 3_600, of_day / 60 % 60, of_day % 60);
    write!(out, "{hour:02}:{minute:02}:")?;
    match rest {
        0 => write!(out, "{second:02}"),
        _ => write_seconds(second as f64 + rest as f64 / 1e9, out),
    }
}

/// C's `%09.6f` of a number between -1 and 60.
fn write_seconds(seconds: f64, out: &mut Destination<'_>) -> core::fmt::Result {
    let millionths = millionths(seconds.abs());
    let (whole, part) = (millionths / 1_000_000, millionths % 1_000_000);
    match seconds.is_sign_negative() {
        true => write!(out, "-{whole}.{part:06}"),
        false => write!(out, "{whole:02}.{part:06}"),
    }
}

/// Rounded to the nearest, ties to even.
fn millionths(number: f64) -> u64 {
    if number < 1e-6 {
        return u64::from(number > 0.5e-6);
    }
    let places = 6 + decimal::rounded(number, 17).exponent;
    let found = decimal::rounded(number, usize::try_from(places).unwrap_or(0));
    let digits = found.digits.iter().take(found.count).fold(0, |all, digit| all * 10 + u64::from(*digit));
    // Where all digits were 9, there is one more before the point.
    if found.exponent + 6 > places { digits * 10 } else { digits }
}

/// The first day of a month, except January, is written as one day past the end of the month before: `1970-01-32`.
fn write_date(seconds: i64, out: &mut Destination<'_>) -> core::fmt::Result {
    let mut days = seconds.div_euclid(86_400);
    let is_leap = |year: i64| year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let length = |year| if is_leap(year) { 366 } else { 365 };
    let mut year = 1970;
    while days >= length(year) {
        days -= length(year);
        year += 1;
    }
    while days < 0 {
        year -= 1;
        days += length(year);
    }
    let february = if is_leap(year) { 29 } else { 28 };
    let lengths = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 1;
    for length in lengths {
        if days <= length {
            break;
        }
        days -= length;
        month += 1;
    }
    write!(out, "{year}-{month:02}-{:02}", days + 1)
}

/// `1`, or `TRUE` in upper or lower case.
#[inline]
pub fn to_bool_word(text: &[u8]) -> bool {
    text == b"1" || text.eq_ignore_ascii_case(b"TRUE")
}

/// The number, read from the end to the start. Characters other than digits are ignored, but those from `.` on in ASCII,
/// including letters, discard the digits read so far. At most 20 digits count. A `-` counts only at the start.
///
/// ```
/// use staunch_runtime::text::to_lint_back;
/// assert_eq!([b"12abc".as_slice(), b"-12", b"3.9", b"16#fF"].map(to_lint_back), [12, -12, 3, 255]);
/// ```
pub fn to_lint_back(text: &[u8]) -> i64 {
    let based = |prefix: &[u8], bits, base| Some(of_digits(text.strip_prefix(prefix)?, bits, base));
    let found = based(b"2#", 1, 2).or_else(|| based(b"8#", 3, 8)).or_else(|| based(b"16#", 4, 16));
    found.unwrap_or_else(|| decimal(text))
}

fn decimal(text: &[u8]) -> i64 {
    let sign = if text.first() == Some(&b'-') { -1_i64 } else { 1 };
    let (mut number, mut factor, mut count) = (0_i64, sign, 0);
    for byte in text.iter().rev() {
        match byte {
            _ if count >= 20 => break,
            b'0'..=b'9' => {
                number = number.wrapping_add(i64::from(byte - b'0').wrapping_mul(factor));
                factor = factor.wrapping_mul(10);
                count += 1;
            }
            b'.'..=b'\x7F' => (number, factor, count) = (0, sign, 0),
            _ => {}
        }
    }
    number
}

/// Digits of this number of bits each. Those of base 2 and 8 are shifted in 32 bits.
fn of_digits(text: &[u8], bits: u32, base: u32) -> i64 {
    let mut number = 0_i64;
    let mut shift = 0;
    for byte in text.iter().rev() {
        let Some(digit) = digit_of(*byte).filter(|it| *it < base) else { continue };
        if shift >= 64 {
            break;
        }
        number |= match base {
            16 => i64::from(digit) << shift,
            _ => i64::from((digit as i32).wrapping_shl(shift)),
        };
        shift += bits;
    }
    number
}

fn digit_of(byte: u8) -> Option<u32> {
    match byte {
        b'0'..=b'9' => Some(u32::from(byte - b'0')),
        b'a'..=b'f' => Some(u32::from(byte - b'a') + 10),
        b'A'..=b'F' => Some(u32::from(byte - b'A') + 10),
        _ => None,
    }
}

/// A number with a point after its first character; [`to_lint_back`] for a number without a point.
#[inline]
pub fn to_lreal_dot(text: &[u8]) -> f64 {
    let has_point = text.get(1..).is_some_and(|it| it.contains(&b'.'));
    let number = text.split(|it| *it == b'_').next().unwrap_or_default();
    if has_point { to_lreal(number) } else { to_lint_back(text) as f64 }
}
