//! Reals to integers on systems that keep the low bits of a number that does not fit the type.

use super::convert::ConvertTo;
use super::{Real, convert};

/// The low 64 bits of the nearest whole number, ties to even; 0 for NaN and the infinities.
///
/// ```
/// use staunch_runtime::ops::low_bits_of_nearest;
/// assert_eq!([2.5, -2.5, 3.5, 65535.0].map(low_bits_of_nearest::<f64>), [2, -2, 4, 65535]);
/// assert_eq!(low_bits_of_nearest(9_223_372_036_854_775_808.0_f64) as u64, 1 << 63);
/// assert_eq!(low_bits_of_nearest(f64::INFINITY), 0);
/// ```
#[inline]
pub fn low_bits_of_nearest<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    low_bits(convert(value.rounded_to_even()))
}

/// The same with ties rounded away from zero.
///
/// ```
/// use staunch_runtime::ops::low_bits_of_half_away;
/// assert_eq!([2.5, -2.5, 0.49999999999999994, 1.4].map(low_bits_of_half_away::<f64>), [3, -3, 0, 1]);
/// assert_eq!(low_bits_of_half_away(4294967296.0_f32) as i32, 0);
/// ```
#[inline]
pub fn low_bits_of_half_away<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    let value: f64 = convert(value);
    let whole = value.rounded_to_zero();
    let rest = value - whole;
    // A number with a fraction is less than 2^52, so that 1 can be added.
    let nearest = if rest >= 0.5 {
        whole + 1.0
    } else if rest <= -0.5 {
        whole - 1.0
    } else {
        whole
    };
    low_bits(nearest)
}

/// The low 64 bits of the number without its fraction; 0 for NaN and the infinities.
///
/// ```
/// use staunch_runtime::ops::low_bits_of_whole;
/// assert_eq!([2.9, -2.9, 1e300].map(low_bits_of_whole::<f64>), [2, -2, 0]);
/// assert_eq!(low_bits_of_whole(-18_446_744_073_709_555_712.0_f64), -4096);
/// ```
#[inline]
pub fn low_bits_of_whole<T: Real + ConvertTo<f64>>(value: T) -> i64 {
    low_bits(convert(value.rounded_to_zero()))
}

/// The low bits of a whole number in two's complement.
#[inline]
fn low_bits(whole: f64) -> i64 {
    let holds = (-9_223_372_036_854_775_808.0..9_223_372_036_854_775_808.0).contains(&whole);
    if holds { whole as i64 } else { low_bits_beyond(whole) }
}

/// The low bits of a number of 2^63 or more, whose 53 significant bits may all be above them.
fn low_bits_beyond(whole: f64) -> i64 {
    const FRACTION: u32 = 52;
    if !whole.is_finite() {
        return 0;
    }
    let bits = whole.to_bits();
    let significant = bits & ((1 << FRACTION) - 1) | 1 << FRACTION;
    let exponent = (bits >> FRACTION & 0x7ff) as u32;
    let shift = exponent.saturating_sub(1023 + FRACTION);
    let magnitude = significant.checked_shl(shift).unwrap_or(0) as i64;
    if whole < 0.0 { magnitude.wrapping_neg() } else { magnitude }
}
