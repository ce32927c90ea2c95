//! MAX, MIN, LIMIT, SEL, and the check of a subrange.

use super::Integer;
use crate::{FaultKind, Scalar};

/// The greater of two values; `a` if neither is greater. So `MAX(-0.0, 0.0)` is `-0.0`, and
/// when one of them is NaN the result is `a`.
#[inline]
pub fn max<T: Scalar>(a: T, b: T) -> T {
    if a < b { b } else { a }
}

/// The lesser of two values; `a` when neither is less. So `MIN(0.0, -0.0)` is `0.0`, and when
/// one of them is NaN the result is `a`.
#[inline]
pub fn min<T: Scalar>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

/// `MIN(MAX(value, min), max)` (IEC 61131-3, table 32): with crossed bounds the result is `max`. A NaN value stays,
/// a NaN bound has no effect.
///
/// ```
/// use staunch_runtime::ops::limit;
/// assert_eq!(limit(0, 5, 3), 3);
/// assert_eq!(limit(10, 5, 3), 3);
/// assert_eq!(limit(10, 12, 3), 3);
/// ```
#[inline]
pub fn limit<T: Scalar>(min: T, value: T, max: T) -> T {
    let raised = if value < min { min } else { value };
    if raised > max { max } else { raised }
}

/// LIMIT in OpenPLC from v4.1 on: `min` if the value is below it, even if `min` is above `max`.
///
/// ```
/// use staunch_runtime::ops::limit_first;
/// assert_eq!([1, 7, 8].map(|it| limit_first(7, it, 5)), [7, 5, 5]);
/// ```
#[inline]
pub fn limit_first<T: Scalar>(min: T, value: T, max: T) -> T {
    if value < min {
        min
    } else if value > max {
        max
    } else {
        value
    }
}

/// LIMIT on S7: the value if the bounds are crossed, and NaN if one of the three is NaN.
///
/// ```
/// use staunch_runtime::ops::limit_in_order;
/// assert_eq!([5, 12, -1].map(|it| limit_in_order(0, it, 10)), [5, 10, 0]);
/// assert_eq!(limit_in_order(10, 5, 3), 5);
/// assert!(limit_in_order(0.0, 1.0, f32::NAN).is_nan());
/// ```
#[inline]
pub fn limit_in_order<T: Scalar>(min: T, value: T, max: T) -> T {
    for it in [min, max] {
        // Only NaN is not equal to itself.
        if it.partial_cmp(&it).is_none() {
            return it;
        }
    }
    if min > max { value } else { limit(min, value, max) }
}

/// `SEL`: `in0` when `g` is FALSE, `in1` when it is TRUE. Both have been evaluated.
#[inline]
pub fn sel<T: Scalar>(g: bool, in0: T, in1: T) -> T {
    if g { in1 } else { in0 }
}

/// `value` if it is in `min..=max`, otherwise [`FaultKind::SubrangeViolated`].
#[inline]
pub fn in_range<T: Integer>(min: T, value: T, max: T) -> Result<T, FaultKind> {
    if value < min || value > max { Err(FaultKind::SubrangeViolated) } else { Ok(value) }
}
