//! Text in OpenPLC from v4.1 on, as in STruC++ (0.6.1). Counts and positions are unsigned there, so a negative
//! one is beyond the end of every text.

use super::{Destination, Unit, general, insert, left, mid, replace, right};

/// The number of digits that C's `%g` writes.
const DIGITS: usize = 6;

/// `LEFT`: the whole text for a negative count.
#[inline]
pub fn left_or_all<U: Unit>(text: &[U], count: i64, out: &mut Destination<'_, U>) {
    left(text, without_sign(count), out);
}

/// `RIGHT`: the whole text for a negative count.
#[inline]
pub fn right_or_all<U: Unit>(text: &[U], count: i64, out: &mut Destination<'_, U>) {
    right(text, without_sign(count), out);
}

/// `MID`: nothing for a position outside the text; for a negative count everything from the position to the end.
///
/// ```
/// use staunch_runtime::{Text, text::mid_within};
/// let text = |count, position| Text::<8>::build(|out| mid_within(b"ABC", count, position, out));
/// assert_eq!(text(2, 0).as_bytes(), b"");
/// assert_eq!(text(-1, 2).as_bytes(), b"BC");
/// ```
#[inline]
pub fn mid_within<U: Unit>(text: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    if position > 0 {
        mid(text, without_sign(count), position, out);
    }
}

/// `INSERT`: puts `inserted` before the unit at `position`, where other systems put it after.
///
/// ```
/// use staunch_runtime::{Text, text::insert_before};
/// let text = |position| Text::<8>::build(|out| insert_before(b"ABC", b"X", position, out));
/// assert_eq!([0, 1, 2, 4, -1].map(|it| text(it)), [b"XABC", b"XABC", b"AXBC", b"ABCX", b"ABCX"].map(|it| Text::new(it)));
/// ```
#[inline]
pub fn insert_before<U: Unit>(text: &[U], inserted: &[U], position: i64, out: &mut Destination<'_, U>) {
    insert(text, inserted, without_sign(position).saturating_sub(1), out);
}

/// `DELETE`: like [`replace_within`] with an empty text, except for a count of -1, which is C++'s `npos`: it deletes up to the end.
#[inline]
pub fn delete_within<U: Unit>(text: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    replace_within(text, &[], if count == -1 { i64::MAX } else { count }, position, out);
}

/// `REPLACE`: all of the text stays for a position beyond it; 0 acts as 1. For a negative count, what follows begins so many
/// units before the position, or nothing follows where the text begins later than that.
///
/// ```
/// use staunch_runtime::{Text, text::replace_within};
/// let text = |count, position| Text::<8>::build(|out| replace_within(b"ABC", b"X", count, position, out));
/// assert_eq!(text(1, 4).as_bytes(), b"ABC");
/// assert_eq!(text(1, 0).as_bytes(), b"XBC");
/// assert_eq!(text(-1, 2).as_bytes(), b"AXABC");
/// assert_eq!(text(-2, 2).as_bytes(), b"AX");
/// ```
#[inline]
pub fn replace_within<U: Unit>(text: &[U], by: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    let position = without_sign(position);
    let before = position.max(1) - 1;
    match position > text.len() as i64 {
        true => out.write(text),
        false if text.is_empty() => {}
        false if count < 0 && before.saturating_add(count) >= 0 => {
            let rest = before.saturating_add(count);
            left(text, before, out);
            out.write(by);
            // What follows lies within the text.
            out.write(text.get(rest as usize..).unwrap_or_default());
        }
        false => replace(text, by, without_sign(count), position, out),
    }
}

#[inline]
const fn without_sign(count: i64) -> i64 {
    if count < 0 { i64::MAX } else { count }
}

/// A real with six significant digits, without trailing zeros: C's `%g`.
///
/// ```
/// use staunch_runtime::{Text, text::from_short};
/// let written = |value| Text::<24>::build(|out| from_short(value, out));
/// assert_eq!(written(0.1).as_bytes(), b"0.1");
/// assert_eq!(written(1_234_567.0).as_bytes(), b"1.23457e+06");
/// ```
#[inline]
pub fn from_short(value: f64, out: &mut Destination<'_>) {
    general(value, DIGITS, out);
}

/// `T`, `t` or `1` at the start is TRUE.
#[inline]
pub fn to_bool_letter(text: &[u8]) -> bool {
    matches!(text.first(), Some(b'T' | b't' | b'1'))
}

/// The decimal number that the text begins with: C's `strtoll`, which stops at the limits of its type.
///
/// ```
/// use staunch_runtime::text::to_lint_front;
/// assert_eq!([b" -12abc".as_slice(), b"16#FF", b"99999999999999999999"].map(to_lint_front), [-12, 16, i64::MAX]);
/// ```
#[inline]
pub fn to_lint_front(text: &[u8]) -> i64 {
    let (negative, digits) = front(text);
    let limit = if negative { i64::MIN } else { i64::MAX };
    let step = |number: i64, digit: i64| number.checked_mul(10)?.checked_add(if negative { -digit } else { digit });
    digits.iter().try_fold(0, |number, digit| step(number, i64::from(digit - b'0'))).unwrap_or(limit)
}

/// The same for an unsigned number: C's `strtoull`, where a negative number wraps.
///
/// ```
/// use staunch_runtime::text::to_ulint_front;
/// assert_eq!([b"12".as_slice(), b"-1", b"99999999999999999999"].map(to_ulint_front), [12, u64::MAX, u64::MAX]);
/// ```
#[inline]
pub fn to_ulint_front(text: &[u8]) -> u64 {
    let (negative, digits) = front(text);
    let step = |number: u64, digit: u64| number.checked_mul(10)?.checked_add(digit);
    let number = digits.iter().try_fold(0, |number, digit| step(number, u64::from(digit - b'0')));
    number.map_or(u64::MAX, |it| if negative { it.wrapping_neg() } else { it })
}

/// Whether the number has a minus sign, and its digits; leading spaces are ignored.
fn front(text: &[u8]) -> (bool, &[u8]) {
    let text = text.trim_ascii_start();
    let (negative, text) = match text.split_first() {
        Some((b'-', rest)) => (true, rest),
        Some((b'+', rest)) => (false, rest),
        _ => (false, text),
    };
    let count = text.iter().position(|it| !it.is_ascii_digit()).unwrap_or(text.len());
    (negative, text.get(..count).unwrap_or_default())
}
