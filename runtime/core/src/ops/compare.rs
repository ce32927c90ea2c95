//! Comparisons.

use crate::Scalar;

/// `a = b`. FALSE when one of them is NaN; `-0.0 = 0.0`.
#[inline]
pub fn eq<T: Scalar>(a: T, b: T) -> bool {
    a == b
}

/// `a <> b`. TRUE when one of them is NaN.
#[inline]
pub fn ne<T: Scalar>(a: T, b: T) -> bool {
    a != b
}

/// `a < b`: unsigned for bit strings and unsigned integers, FALSE before TRUE; FALSE when one of
/// them is NaN.
#[inline]
pub fn lt<T: Scalar>(a: T, b: T) -> bool {
    a < b
}

/// `a <= b`, ordered as [`lt`]; FALSE when one of them is NaN.
#[inline]
pub fn le<T: Scalar>(a: T, b: T) -> bool {
    a <= b
}

/// `a > b`, ordered as [`lt`]; FALSE when one of them is NaN.
#[inline]
pub fn gt<T: Scalar>(a: T, b: T) -> bool {
    a > b
}

/// `a >= b`, ordered as [`lt`]; FALSE when one of them is NaN.
#[inline]
pub fn ge<T: Scalar>(a: T, b: T) -> bool {
    a >= b
}
