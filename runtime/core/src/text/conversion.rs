//! Conversions between values and text.
//!
//! Text is read as CODESYS and TwinCAT document it: spaces before a value are ignored, and so is everything
//! after a number; text that is not a value gives 0.

use super::{Destination, characters};
use crate::decimal::{self, Format, LREAL, REAL};
use crate::{Elementary, Time, format, literal};
use core::fmt::Write;

impl Write for Destination<'_> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        self.write(text.as_bytes());
        Ok(())
    }
}

/// A STRING's characters as UTF-16.
///
/// ```
/// use staunch_runtime::{WideText, text::widen, utf16};
/// let text = WideText::<2>::build(|out| widen("aé€".as_bytes(), out));
/// assert_eq!(text.as_units(), utf16!("aé"));
/// ```
#[inline]
pub fn widen(text: &[u8], out: &mut Destination<'_, u16>) {
    for character in characters(text) {
        let mut units = [0; 2];
        out.write(character.encode_utf16(&mut units));
    }
}

/// A WSTRING's characters as UTF-8; an unpaired surrogate becomes `?`.
///
/// ```
/// use staunch_runtime::{Text, text::narrow, utf16};
/// let text = Text::<6>::build(|out| narrow(&utf16!("aé€"), out));
/// assert_eq!(text.as_bytes(), "aé€".as_bytes());
/// ```
#[inline]
pub fn narrow(text: &[u16], out: &mut Destination<'_>) {
    for character in char::decode_utf16(text.iter().copied()) {
        let mut bytes = [0; 4];
        out.write(character.unwrap_or('?').encode_utf8(&mut bytes).as_bytes());
    }
}

/// A STRING of one character.
#[inline]
pub fn from_char(value: u8, out: &mut Destination<'_>) {
    out.write(&[value]);
}

/// A WSTRING of one character.
#[inline]
pub fn from_wchar(value: u16, out: &mut Destination<'_, u16>) {
    out.write(&[value]);
}

/// The first character; 0 of an empty string.
#[inline]
pub fn to_char(text: &[u8]) -> u8 {
    text.first().copied().unwrap_or_default()
}

/// The first character; 0 of an empty string.
#[inline]
pub fn to_wchar(text: &[u16]) -> u16 {
    text.first().copied().unwrap_or_default()
}

/// The CHAR with this number; `?` if the number does not fit a byte.
#[inline]
pub fn narrow_char(value: u16) -> u8 {
    u8::try_from(value).unwrap_or(b'?')
}

/// `TRUE` or `FALSE`.
#[inline]
pub fn from_bool(value: bool, out: &mut Destination<'_>) {
    out.write(if value { b"TRUE" } else { b"FALSE" });
}

/// In decimal: `-12`.
#[inline]
pub fn from_lint(value: i64, out: &mut Destination<'_>) {
    if value < 0 {
        out.write(b"-");
    }
    from_ulint(value.unsigned_abs(), out);
}

/// In decimal.
#[inline]
pub fn from_ulint(value: u64, out: &mut Destination<'_>) {
    out.write(format::digits(value, 1, &mut [0; format::MOST_DIGITS]));
}

/// The fewest digits that read back the same: `0.1`, `1.0`, `1e21`.
#[inline]
pub fn from_real(value: f32, out: &mut Destination<'_>) {
    real(f64::from(value), REAL, out);
}

/// The fewest digits that read back the same: `0.1`, `1.0`, `1e21`.
#[inline]
pub fn from_lreal(value: f64, out: &mut Destination<'_>) {
    real(value, LREAL, out);
}

/// The REAL that the text spells without an exponent; commas are ignored, as on S7.
///
/// ```
/// use staunch_runtime::text::to_fixed_real;
/// assert_eq!(to_fixed_real(b"1.23E-4"), 1.23);
/// assert_eq!(to_fixed_real(b"12,345.67"), 12345.67);
/// ```
#[inline]
pub fn to_fixed_real(text: &[u8]) -> f32 {
    fixed_number(text, REAL) as f32
}

/// Like [`to_fixed_real`], for an LREAL.
#[inline]
pub fn to_fixed_lreal(text: &[u8]) -> f64 {
    fixed_number(text, LREAL)
}

/// A value of the type with index `kind` in [`Elementary::ALL`], as its literal; a TIME of 0 is
/// `T#0ms`, as in CODESYS.
#[inline]
pub fn from_time(value: Time, kind: i64, out: &mut Destination<'_>) {
    let ty = time_type(kind);
    if value == 0 && ty.is_duration() {
        out.write(if ty == Elementary::Time { b"T#0ms" } else { b"LTIME#0ms" });
        return;
    }
    _ = format::time(out, ty, value);
}

/// TRUE for `TRUE`, in upper or lower case, and for a number whose whole part is not 0.
///
/// ```
/// use staunch_runtime::text::to_bool;
/// assert!(to_bool(b"true") && to_bool(b" 1") && !to_bool(b"FALSE") && !to_bool(b"yes"));
/// ```
#[inline]
pub fn to_bool(text: &[u8]) -> bool {
    let text = without_spaces(text);
    let text = after_prefix(text, b"BOOL#").unwrap_or(text);
    starts_with(text, b"TRUE") || to_ulint(text) != 0
}

/// A whole number, in decimal or after its base, with a sign; 0 if the text has no number. It wraps like an
/// assignment to fewer bits, so that every integer type can take its low bits.
///
/// ```
/// use staunch_runtime::text::to_lint;
/// assert_eq!(to_lint(b" -12 m"), -12);
/// assert_eq!(to_lint(b"16#FF"), 255);
/// assert_eq!(to_lint(b"abc34"), 0);
/// ```
#[inline]
pub fn to_lint(text: &[u8]) -> i64 {
    to_ulint(text) as i64
}

/// Like [`to_lint`].
#[inline]
pub fn to_ulint(text: &[u8]) -> u64 {
    let (is_negative, digits) = sign(without_spaces(text));
    let (base, digits) = based(digits);
    let mut value = 0_u64;
    for byte in digits {
        match digit(*byte) {
            Some(digit) if digit < base => value = value.wrapping_mul(base).wrapping_add(digit),
            None if *byte == b'_' => {}
            Some(_) | None => break,
        }
    }
    if is_negative { value.wrapping_neg() } else { value }
}

/// [`to_lint`] on S7, for decimal digits: 0 for a number that does not fit a LINT.
///
/// ```
/// use staunch_runtime::text::to_lint_or_0;
/// assert_eq!(to_lint_or_0(b"-00456"), -456);
/// assert_eq!(to_lint_or_0(b"9223372036854775808"), 0);
/// ```
#[inline]
pub fn to_lint_or_0(text: &[u8]) -> i64 {
    let (is_negative, digits) = sign(without_spaces(text));
    let magnitude = i128::from(whole_or_0(digits));
    i64::try_from(if is_negative { -magnitude } else { magnitude }).unwrap_or(0)
}

/// The same for a ULINT: a negative number gives 0, too.
///
/// ```
/// use staunch_runtime::text::to_ulint_or_0;
/// assert_eq!(to_ulint_or_0(b"18446744073709551615"), u64::MAX);
/// assert_eq!(to_ulint_or_0(b"18446744073709551616"), 0);
/// assert_eq!(to_ulint_or_0(b"-5"), 0);
/// ```
#[inline]
pub fn to_ulint_or_0(text: &[u8]) -> u64 {
    let (is_negative, digits) = sign(without_spaces(text));
    if is_negative { 0 } else { whole_or_0(digits) }
}

/// The nearest REAL; infinity beyond the greatest, 0 for text that is not a number.
///
/// ```
/// use staunch_runtime::text::to_real;
/// assert_eq!(to_real(b" 1.25e1 V"), 12.5);
/// ```
#[inline]
pub fn to_real(text: &[u8]) -> f32 {
    // What is nearest among the REALs is exact as an LREAL.
    number(text, REAL) as f32
}

/// The nearest LREAL; infinity beyond the greatest, 0 for text that is not a number.
#[inline]
pub fn to_lreal(text: &[u8]) -> f64 {
    number(text, LREAL)
}

/// A value of the type with index `kind` in [`Elementary::ALL`], from a literal with the prefix of that type
/// or of its long or short form; otherwise 0.
#[inline]
pub fn to_time(text: &[u8], kind: i64) -> Time {
    let ty = time_type(kind);
    let text = core::str::from_utf8(trimmed(text)).unwrap_or_default();
    let Some((prefix, value)) = text.split_once(literal::is('#')) else { return 0 };
    let named = literal::type_of_prefix(prefix);
    let kind = |it: Elementary| (it.is_duration(), it.is_day(), it.is_time_of_day(), it.is_date_and_time());
    if named.is_none_or(|it| kind(it) != kind(ty)) {
        return 0;
    }
    literal::time(ty, value).unwrap_or(0)
}

fn time_type(kind: i64) -> Elementary {
    usize::try_from(kind).ok().and_then(|it| Elementary::ALL.get(it).copied()).unwrap_or(Elementary::Time)
}

fn real(value: f64, format: Format, out: &mut Destination<'_>) {
    if value.is_nan() {
        return out.write(b"NaN");
    }
    if value.is_sign_negative() {
        out.write(b"-");
    }
    let value = f64::from_bits(value.to_bits() & !(1 << 63));
    if value.is_infinite() {
        return out.write(b"inf");
    }
    if value == 0.0 {
        return out.write(b"0.0");
    }
    let found = decimal::shortest(value, format);
    let mut figures = found.digits.map(|it| b'0' + it);
    let figures = figures.get_mut(..found.count).unwrap_or_default();
    // Between 0.0001 and 10^16 without an exponent, as traces write it.
    match found.exponent {
        exponent @ -3..=0 => {
            out.write(b"0.");
            (exponent..0).for_each(|_| out.write(b"0"));
            out.write(figures);
        }
        exponent @ 1..=16 => {
            let (whole, fraction) = figures.split_at_checked(exponent as usize).unwrap_or((figures, &[]));
            out.write(whole);
            (whole.len()..exponent as usize).for_each(|_| out.write(b"0"));
            out.write(b".");
            out.write(if fraction.is_empty() { b"0" } else { fraction });
        }
        exponent => {
            let (first, rest) = figures.split_at_checked(1).unwrap_or((figures, &[]));
            out.write(first);
            if !rest.is_empty() {
                out.write(b".");
                out.write(rest);
            }
            out.write(b"e");
            from_lint(i64::from(exponent) - 1, out);
        }
    }
}

/// A number with a fraction and an exponent, as far as it goes.
fn number(text: &[u8], format: Format) -> f64 {
    let (is_negative, text) = sign(without_spaces(text));
    let mut digits = Significant::default();
    let mut rest = digits.take(text, false, b'_');
    if let Some((b'.', fraction)) = rest.split_first() {
        rest = digits.take(fraction, true, b'_');
    }
    if let Some((b'e' | b'E', exponent)) = rest.split_first() {
        let (is_below, exponent) = sign(exponent);
        let mut power = 0_i32;
        for byte in exponent.iter().take_while(|it| it.is_ascii_digit()) {
            power = power.saturating_mul(10).saturating_add(i32::from(*byte - b'0'));
        }
        let power = power.min(100_000);
        digits.exponent = digits.exponent.saturating_add(if is_below { -power } else { power });
    }
    let value = digits.nearest(format);
    if is_negative { -value } else { value }
}

/// A number with a fraction and commas, as far as it goes.
fn fixed_number(text: &[u8], format: Format) -> f64 {
    let (is_negative, text) = sign(without_spaces(text));
    let mut digits = Significant::default();
    if let Some((b'.', fraction)) = digits.take(text, false, b',').split_first() {
        digits.take(fraction, true, b',');
    }
    let value = digits.nearest(format);
    if is_negative { -value } else { value }
}

/// The digits of a number that decide which real is nearest.
#[derive(Default)]
struct Significant {
    number: u128,
    count: u32,
    exponent: i32,
    /// Whether any digit that is not kept is other than 0.
    is_more: bool,
}

impl Significant {
    /// As many digits as fit 128 bits together with one more digit for those that are not kept. A number halfway between two
    /// reals that is written with still more digits may be rounded to either.
    const MOST: u32 = 37;

    /// The nearest real. Digits that are not kept decide only by their existence: they make the number slightly greater than the kept ones.
    fn nearest(&self, format: Format) -> f64 {
        match self.is_more {
            true => decimal::nearest(self.number * 10 + 1, self.exponent.saturating_sub(1), format),
            false => decimal::nearest(self.number, self.exponent, format),
        }
    }

    /// Takes digits from the start of `text`, and ignores the character `passed`. Returns the rest of the text.
    fn take<'t>(&mut self, text: &'t [u8], is_fraction: bool, passed: u8) -> &'t [u8] {
        let mut rest = text;
        while let Some((byte, after)) = rest.split_first() {
            if !byte.is_ascii_digit() && *byte != passed {
                break;
            }
            rest = after;
            if *byte == passed {
                continue;
            }
            let is_kept = self.count < Self::MOST;
            if is_kept {
                self.number = self.number * 10 + u128::from(*byte - b'0');
                self.count += u32::from(self.number > 0);
            } else {
                self.is_more |= *byte != b'0';
            }
            let shift = i32::from(!is_kept) - i32::from(is_fraction);
            self.exponent = self.exponent.saturating_add(shift);
        }
        rest
    }
}

/// The number that the leading digits spell; 0 if it does not fit 64 bits.
fn whole_or_0(digits: &[u8]) -> u64 {
    let digits = digits.iter().take_while(|it| it.is_ascii_digit());
    let next = |value: u64, digit: &u8| value.checked_mul(10)?.checked_add(u64::from(*digit - b'0'));
    digits.into_iter().try_fold(0, next).unwrap_or(0)
}

fn without_spaces(text: &[u8]) -> &[u8] {
    text.trim_ascii_start()
}

fn trimmed(text: &[u8]) -> &[u8] {
    text.trim_ascii()
}

fn sign(text: &[u8]) -> (bool, &[u8]) {
    match text.split_first() {
        Some((b'-', rest)) => (true, rest),
        Some((b'+', rest)) => (false, rest),
        _ => (false, text),
    }
}

/// The base before a `#`, and the digits.
fn based(text: &[u8]) -> (u64, &[u8]) {
    let bases: [(&[u8], u64); 3] = [(b"16#", 16), (b"8#", 8), (b"2#", 2)];
    let found = bases.into_iter().find_map(|(prefix, base)| Some((base, text.strip_prefix(prefix)?)));
    found.unwrap_or((10, text))
}

fn digit(byte: u8) -> Option<u64> {
    Some(u64::from(match byte {
        b'0'..=b'9' => byte - b'0',
        b'A'..=b'F' => byte - b'A' + 10,
        b'a'..=b'f' => byte - b'a' + 10,
        _ => return None,
    }))
}

fn starts_with(text: &[u8], word: &[u8]) -> bool {
    after_prefix(text, word).is_some()
}

fn after_prefix<'t>(text: &'t [u8], word: &[u8]) -> Option<&'t [u8]> {
    let (start, rest) = text.split_at_checked(word.len())?;
    start.eq_ignore_ascii_case(word).then_some(rest)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::Text;
    use std::string::String;

    fn written(write: impl FnOnce(&mut Destination<'_>)) -> String {
        String::from_utf8_lossy(Text::<64>::build(write).as_bytes()).into_owned()
    }

    #[test]
    fn reals_have_the_spelling_of_traces() {
        for value in [0.0, -0.0, 1.0, -1.5, 0.1, 0.0001, 0.000_099, 1e15, 1e16, 1.25e21, 123_456.789, f64::MAX, 5e-324]
        {
            let text = written(|out| from_lreal(value, out));
            assert_eq!(text, std::format!("{value:?}"));
            assert_eq!(to_lreal(text.as_bytes()).to_bits(), value.to_bits(), "{text}");
        }
        for value in [0.1_f32, 16_777_216.0, f32::MAX, 1e-45, -3.25] {
            let text = written(|out| from_real(value, out));
            assert_eq!(text, std::format!("{value:?}"));
            assert_eq!(to_real(text.as_bytes()).to_bits(), value.to_bits(), "{text}");
        }
        for (value, text) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (f64::NEG_INFINITY, "-inf")] {
            assert_eq!(written(|out| from_lreal(value, out)), text);
        }
    }

    #[test]
    fn numbers_are_read_as_far_as_they_go() {
        for (text, value) in [
            ("12", 12),
            ("  -12", -12),
            ("+7", 7),
            ("34abc", 34),
            ("abc34", 0),
            ("", 0),
            ("-", 0),
            ("1_000", 1000),
            ("16#ff", 255),
            ("2#1010 2", 10),
            ("8#17", 15),
            ("3.9", 3),
            ("18446744073709551615", -1),
        ] {
            assert_eq!(to_lint(text.as_bytes()), value, "{text}");
        }
        // Half the way between two REALs: the even one.
        assert_eq!(to_real(b"1273929092349135316908359527587890625e-41").to_bits(), 928_365_270);
        for (text, value) in [
            ("1.5", 1.5),
            (" -2", -2.0),
            ("1.2E-3x", 0.0012),
            ("9,5", 9.0),
            (".5", 0.5),
            ("5.", 5.0),
            ("x", 0.0),
            ("1.7E+400", f64::INFINITY),
            ("1e99999999999", f64::INFINITY),
            ("1e-99999999999", 0.0),
            ("1_0.2_5", 10.25),
            ("0.1000000000000000055511151231257827021181583404541015625", 0.1),
            ("9007199254740993.00000000000000000000000000000000000000000001", 9_007_199_254_740_994.0),
            // More digits than are kept, and no half way between two reals.
            ("9007199254740993.000000000000000000000000000000000000000", 9_007_199_254_740_992.0),
        ] {
            assert_eq!(to_lreal(text.as_bytes()), value, "{text}");
        }
    }

    #[test]
    fn times_are_read_by_their_literals() {
        let at = |ty: Elementary| Elementary::ALL.iter().position(|it| *it == ty).map_or(0, |it| it as i64);
        let read = |text: &str, ty| to_time(text.as_bytes(), at(ty));
        use Elementary as E;
        assert_eq!(read(" T#1.5s ", E::Time), 1_500_000_000);
        assert_eq!(read("LTIME#7ns", E::Time), 7);
        assert_eq!(read("DATE#2019-9-9", E::Date), crate::time::date(2019, 9, 9));
        assert_eq!(read("DT#1970-1-1-0:0:1", E::Ldt), 1_000_000_000);
        for (text, ty) in
            [("1.5s", E::Time), ("D#2019-02-29", E::Date), ("T#5s", E::Tod), ("DT#", E::Dt), ("é#1", E::Dt)]
        {
            assert_eq!(read(text, ty), 0, "{text}");
        }
        assert_eq!(written(|out| from_time(0, at(E::Time), out)), "T#0ms");
        assert_eq!(written(|out| from_time(86_399_999_000_000, at(E::Tod), out)), "TOD#23:59:59.999");
    }
}
