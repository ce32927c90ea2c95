//! Conversions of OpenPLC: a real passes through a LINT, and a TIME through seconds. They follow C compiled by MATIEC
//! (thiagoralves/matiec, f9ca9ba), on x86-64 where C leaves a value undefined.

use super::convert::ConvertTo;
use super::{Real, convert};
use crate::time::SECOND;
use crate::{Scalar, Time};

/// The nearest whole number, of two the even one. Beyond 2^52, where a half is lost, odd numbers become even. What a LINT
/// does not hold, and NaN, give the least LINT.
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
    // Only what lies in the middle of two numbers, and what is too large for a fraction, is whole after the move.
    if moved == moved.rounded_to_zero() && moved.is_finite() { whole / 2 * 2 } else { whole }
}

/// [`round_to_lint`] for a type without a sign: 0 for what is negative, and for NaN.
#[inline]
pub fn round_to_ulint<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    let number: f64 = convert(value);
    if number >= 0.0 { round_to_lint(value) } else { 0 }
}

/// A TIME of so many seconds: the fraction is cut at nanoseconds, and whole seconds at 32 bits.
///
/// ```
/// use staunch_runtime::ops::time_of_seconds;
/// assert_eq!(time_of_seconds(2.5_f64), 2_500_000_000);
/// assert_eq!(time_of_seconds(4.01_f64), 4_009_999_999);
/// ```
#[inline]
pub fn time_of_seconds<T: Real + ConvertTo<f64>>(value: T) -> Time {
    let value: f64 = convert(value);
    let whole = low_or_least(value);
    let fraction = (value - whole as f64) * 1e9;
    i64::from(whole as i32) * SECOND + i64::from(fraction as i32)
}

/// The seconds of a TIME: whole ones, and to them what is less than one.
///
/// ```
/// use staunch_runtime::ops::seconds_of;
/// assert_eq!(seconds_of(1_500_000_000), 1.5);
/// ```
#[inline]
pub fn seconds_of(time: Time) -> f64 {
    (time / SECOND) as f64 + (time % SECOND) as f64 / 1e9
}

/// TIME times a number: seconds and nanoseconds are multiplied by themselves, each cut to 32 bits. So
/// `T#500ms * 5` is -2.147 s: its nanoseconds are more than 32 bits hold.
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

/// TIME divided by a number, each part by itself.
///
/// ```
/// use staunch_runtime::ops::time_over;
/// assert_eq!(time_over(1_500_000_000, 2.0), 750_000_000);
/// ```
#[inline]
pub fn time_over(time: Time, by: f64) -> Time {
    let seconds = (time / SECOND) as i32 as f64 / by;
    let whole = low_or_least(seconds);
    let fraction = int_or_least((time % SECOND) as f64 / by + (seconds - whole as f64) * 1e9);
    of_timespec(whole, fraction)
}

/// `LIMIT`: MN for what is not above it, MX for what is not below that, in this order; so NaN gives MN.
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

/// Toward zero; the least DINT for what a DINT does not hold.
#[inline]
fn int_or_least(value: f64) -> i32 {
    let holds = value > -2_147_483_649.0 && value < 2_147_483_648.0;
    if holds { value as i32 } else { i32::MIN }
}

/// Toward zero; the least LINT for what a LINT does not hold.
#[inline]
fn low_or_least(value: f64) -> i64 {
    let holds = (-9_223_372_036_854_775_808.0..9_223_372_036_854_775_808.0).contains(&value);
    if holds { value as i64 } else { i64::MIN }
}
