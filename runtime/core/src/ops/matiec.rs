//! OpenPLC's conversions: a real is converted through a LINT, and a TIME through seconds. They follow the C code that MATIEC
//! (thiagoralves/matiec, f9ca9ba) generates, as compiled for x86-64 if C leaves a value undefined.

use super::convert::ConvertTo;
use super::{Number, Real, convert, from_bcd};
use crate::time::SECOND;
use crate::{Scalar, Time};

/// The nearest whole number, ties to even. Beyond 2^52, where a half is lost, odd numbers become even. A number that does not
/// fit a LINT, and NaN, give the least LINT.
///
/// ```
/// use staunch_runtime::ops::round_to_lint;
/// assert_eq!([2.5, -2.5, 3.5, 65535.0].map(round_to_lint::<f64>), [2, -2, 4, 65535]);
/// assert_eq!([1e19, -1e19, f64::NAN].map(round_to_lint::<f64>), [i64::MIN; 3]);
/// ```
#[inline]
pub fn round_to_lint<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    let value: f64 = convert(value);
    let moved = if value >= 0.0 { value + 0.5 } else { value - 0.5 };
    let whole = low_or_least(moved);
    // Only a number halfway between two numbers, or too large for a fraction, is whole after the move.
    if moved == moved.rounded_to_zero() && moved.is_finite() { whole / 2 * 2 } else { whole }
}

/// [`round_to_lint`] for an unsigned type: 0 for negative values and NaN.
#[inline]
pub fn round_to_ulint<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    let number: f64 = convert(value);
    if number >= 0.0 { round_to_lint(value) } else { 0 }
}

/// `TRUNC` to a type of at most 32 bits, except UDINT: the value as 32 bits with a sign, of which the type keeps the low
/// ones. A value that does not fit them, and NaN, give the least DINT.
///
/// ```
/// use staunch_runtime::ops::trunc_to_dint;
/// assert_eq!([-2.5, 65535.9, 3e9, f64::NAN].map(trunc_to_dint::<f64>), [-2, 65535, -2147483648, -2147483648]);
/// ```
#[inline]
pub fn trunc_to_dint<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    i64::from(int_or_least(convert(value)))
}

/// `TRUNC` to LINT, of which UDINT keeps the low bits.
///
/// ```
/// use staunch_runtime::ops::trunc_to_lint;
/// assert_eq!([-2.5, 3e9, 1e20].map(trunc_to_lint::<f64>), [-2, 3_000_000_000, i64::MIN]);
/// ```
#[inline]
pub fn trunc_to_lint<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    low_or_least(convert(value))
}

/// `TRUNC` to ULINT: from 2^63 on, only the part above 2^63 is converted, as the processor has no unsigned conversion.
///
/// ```
/// use staunch_runtime::ops::trunc_to_ulint;
/// assert_eq!([-2.5, 1e19, 1e20, -1e20].map(trunc_to_ulint::<f64>), [-2, 1e19 as u64 as i64, 0, i64::MIN]);
/// ```
#[inline]
pub fn trunc_to_ulint<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    const HALF: f64 = 9_223_372_036_854_775_808.0;
    let value: f64 = convert(value);
    if value >= HALF { low_or_least(value - HALF) ^ i64::MIN } else { low_or_least(value) }
}

/// The nearest whole number, ties away from zero: C's `round`.
///
/// ```
/// use staunch_runtime::ops::away_from_zero;
/// assert_eq!([2.5, -2.5, 2.4, 0.49999999999999994].map(away_from_zero::<f64>), [3.0, -3.0, 2.0, 0.0]);
/// ```
#[inline]
pub fn away_from_zero<T: Real + ConvertTo<f64>>(value: T) -> f64 {
    let value: f64 = convert(value);
    let whole = value.rounded_to_zero();
    let rest = value - whole;
    if rest >= 0.5 {
        whole + 1.0
    } else if rest <= -0.5 {
        whole - 1.0
    } else {
        whole
    }
}

/// `ABS`: negates a value below 0, so that -0.0 stays -0.0.
///
/// ```
/// use staunch_runtime::ops::abs_if_below;
/// assert_eq!(abs_if_below(-2.5), 2.5);
/// assert!(abs_if_below(-0.0_f64).is_sign_negative());
/// ```
#[inline]
pub fn abs_if_below<T: Number>(value: T) -> T {
    if value < T::ZERO { value.negated() } else { value }
}

/// `BCD_TO_…`: 0 if a digit is more than 9.
///
/// ```
/// use staunch_runtime::ops::from_bcd_or_zero;
/// assert_eq!((from_bcd_or_zero(0x369), from_bcd_or_zero(0x3A9)), (369, 0));
/// ```
#[inline]
pub fn from_bcd_or_zero(digits: i64) -> i64 {
    let is_decimal = (0..16).all(|at| (digits >> (4 * at)) & 0xF <= 9);
    if is_decimal { from_bcd(digits) } else { 0 }
}

/// `TO_BCD`: the digits after the sixteenth are combined with the first ones, to which x86-64 shifts them.
///
/// ```
/// use staunch_runtime::ops::bcd_of;
/// assert_eq!(bcd_of(369), 0x0369);
/// assert_eq!(bcd_of(20_000_000_000_000_001), 0x3);
/// ```
#[inline]
pub fn bcd_of(number: i64) -> i64 {
    let mut rest = number as u64;
    let (mut digits, mut shift) = (0, 0);
    while rest != 0 {
        digits |= (rest % 10).wrapping_shl(shift);
        rest /= 10;
        shift += 4;
    }
    digits as i64
}

/// TIME `+` TIME: only 32 bits of the seconds are kept.
///
/// ```
/// use staunch_runtime::ops::time_plus;
/// assert_eq!(time_plus(1_500_000_000, -2_000_000_000), -500_000_000);
/// assert_eq!(time_plus(2_147_483_647_000_000_000, 2_000_000_000), -2_147_483_647_000_000_000);
/// ```
#[inline]
pub fn time_plus(a: Time, b: Time) -> Time {
    let seconds = ((a / SECOND) as i32).wrapping_add((b / SECOND) as i32);
    normalized(seconds, a % SECOND + b % SECOND)
}

/// TIME `-` TIME, like [`time_plus`].
#[inline]
pub fn time_minus(a: Time, b: Time) -> Time {
    let seconds = ((a / SECOND) as i32).wrapping_sub((b / SECOND) as i32);
    normalized(seconds, a % SECOND - b % SECOND)
}

/// A second is carried if seconds and nanoseconds have different signs, or if the nanoseconds exceed one second.
#[inline]
fn normalized(mut seconds: i32, mut nanoseconds: i64) -> Time {
    if nanoseconds < -SECOND || seconds > 0 && nanoseconds < 0 {
        seconds = seconds.wrapping_sub(1);
        nanoseconds += SECOND;
    }
    if nanoseconds > SECOND || seconds < 0 && nanoseconds > 0 {
        seconds = seconds.wrapping_add(1);
        nanoseconds -= SECOND;
    }
    i64::from(seconds) * SECOND + nanoseconds
}

/// A TIME with this number of seconds: the fraction is cut to nanoseconds. Seconds that do not fit 32 bits become the least DINT.
///
/// ```
/// use staunch_runtime::ops::time_of_seconds;
/// assert_eq!(time_of_seconds(2.5_f64), 2_500_000_000);
/// assert_eq!(time_of_seconds(4.01_f64), 4_009_999_999);
/// assert_eq!(time_of_seconds(3.0e9_f64), -2_147_483_648_000_000_000);
/// ```
#[inline]
pub fn time_of_seconds<T: Real + ConvertTo<f64>>(value: T) -> Time {
    let value: f64 = convert(value);
    let fraction = (value - low_or_least(value) as f64) * 1e9;
    i64::from(int_or_least(value)) * SECOND + i64::from(int_or_least(fraction))
}

/// The seconds of a TIME: whole ones plus the fraction.
///
/// ```
/// use staunch_runtime::ops::seconds_of;
/// assert_eq!(seconds_of(1_500_000_000), 1.5);
/// ```
#[inline]
pub fn seconds_of(time: Time) -> f64 {
    (time / SECOND) as f64 + (time % SECOND) as f64 / 1e9
}

/// TIME times a number: seconds and nanoseconds are multiplied separately, each cut to 32 bits. So
/// `T#500ms * 5` is -2.147 s: its nanoseconds do not fit 32 bits.
///
/// ```
/// use staunch_runtime::ops::time_times;
/// assert_eq!(time_times(1_500_000_000, 1.5), 2_250_000_000);
/// assert_eq!(time_times(500_000_000, 5.0), -2_147_483_648);
/// ```
#[inline]
pub fn time_times(time: Time, by: f64) -> Time {
    let seconds = (time / SECOND) as i32 as f64 * by;
    let whole = low_or_least(seconds);
    let rest = i64::from(int_or_least((time % SECOND) as f64 * by));
    let fraction = int_or_least((rest % SECOND) as f64 + (seconds - whole as f64) * 1e9);
    of_timespec(whole.wrapping_add(rest / SECOND), fraction)
}

/// TIME divided by a number, each component separately, of which 32 bits are kept.
///
/// ```
/// use staunch_runtime::ops::time_over;
/// assert_eq!(time_over(1_500_000_000, 2.0), 750_000_000);
/// assert_eq!(time_over(250_000_000, 0.1), -1_794_967_296);
/// assert_eq!(time_over(250_000_000, 0.0), 0);
/// ```
#[inline]
pub fn time_over(time: Time, by: f64) -> Time {
    let seconds = (time / SECOND) as i32 as f64 / by;
    let whole = low_or_least(seconds);
    let fraction = low_or_least((time % SECOND) as f64 / by + (seconds - whole as f64) * 1e9);
    of_timespec(whole, fraction as i32)
}

/// `LIMIT`: MN for a value not above MN, MX for one not below MX, in this order; so NaN gives MN.
///
/// ```
/// use staunch_runtime::ops::limit_low_first;
/// assert_eq!(limit_low_first(10, 5, 3), 10);
/// assert_eq!(limit_low_first(1.0, f64::NAN, 2.0), 1.0);
/// ```
#[inline]
pub fn limit_low_first<T: Scalar>(min: T, value: T, max: T) -> T {
    let limited = if value < max { value } else { max };
    if value > min { limited } else { min }
}

#[inline]
fn of_timespec(seconds: i64, nanoseconds: i32) -> Time {
    i64::from(seconds as i32) * SECOND + i64::from(nanoseconds)
}

/// Toward zero; the least DINT for a value that a DINT cannot hold.
#[inline]
fn int_or_least(value: f64) -> i32 {
    let holds = value > -2_147_483_649.0 && value < 2_147_483_648.0;
    if holds { value as i32 } else { i32::MIN }
}

/// Toward zero; the least LINT for a value that a LINT cannot hold.
#[inline]
fn low_or_least(value: f64) -> i64 {
    let holds = (-9_223_372_036_854_775_808.0..9_223_372_036_854_775_808.0).contains(&value);
    if holds { value as i64 } else { i64::MIN }
}
