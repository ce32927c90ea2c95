//! Arithmetic, which wraps at the type of its operands.

use super::{Integer, Number};
use crate::FaultKind;

/// `a + b`. Integers wrap at their width; reals are IEEE.
///
/// ```
/// assert_eq!(staunch_runtime::ops::add(200_u8, 100), 44);
/// ```
#[inline]
pub fn add<T: Number>(a: T, b: T) -> T {
    a.plus(b)
}

/// `a - b`. Integers wrap at their width; reals are IEEE.
#[inline]
pub fn sub<T: Number>(a: T, b: T) -> T {
    a.minus(b)
}

/// `a * b`. Integers wrap at their width; reals are IEEE.
#[inline]
pub fn mul<T: Number>(a: T, b: T) -> T {
    a.times(b)
}

/// `a / b`. Integers truncate toward zero, `MIN / -1` wraps to `MIN`, and a zero divisor is
/// [`FaultKind::DivideByZero`]. Reals are IEEE and never fault.
///
/// ```
/// use staunch_runtime::{FaultKind, ops::div};
/// assert_eq!(div(-7_i16, 2), Ok(-3));
/// assert_eq!(div(i16::MIN, -1), Ok(i16::MIN));
/// assert_eq!(div(1_i16, 0), Err(FaultKind::DivideByZero));
/// assert_eq!(div(1.0_f32, 0.0), Ok(f32::INFINITY));
/// ```
#[inline]
pub fn div<T: Number>(a: T, b: T) -> Result<T, FaultKind> {
    a.quotient(b)
}

/// `a MOD b`: the remainder of [`div`], with the sign of `a`. `MIN MOD -1` is 0; a zero divisor
/// is [`FaultKind::DivideByZero`].
///
/// ```
/// use staunch_runtime::ops::modulo;
/// assert_eq!(modulo(-7_i16, 2), Ok(-1));
/// assert_eq!(modulo(7_i16, -2), Ok(1));
/// assert_eq!(modulo(i16::MIN, -1), Ok(0));
/// ```
#[inline]
pub fn modulo<T: Integer>(a: T, b: T) -> Result<T, FaultKind> {
    a.remainder(b)
}

/// [`div`] of integers on S7, where dividing by zero gives 0.
///
/// ```
/// use staunch_runtime::ops::div_or_zero;
/// assert_eq!(div_or_zero(-7_i16, 2), -3);
/// assert_eq!(div_or_zero(7_i16, 0), 0);
/// ```
#[inline]
pub fn div_or_zero<T: Number>(a: T, b: T) -> T {
    if b == T::ZERO { T::ZERO } else { a.quotient(b).unwrap_or(T::ZERO) }
}

/// [`modulo`] in OpenPLC and on S7, where the remainder for a zero divisor is 0.
///
/// ```
/// use staunch_runtime::ops::modulo_or_zero;
/// assert_eq!(modulo_or_zero(-7_i16, 2), -1);
/// assert_eq!(modulo_or_zero(7_i16, 0), 0);
/// ```
#[inline]
pub fn modulo_or_zero<T: Integer>(a: T, b: T) -> T {
    a.remainder(b).unwrap_or(T::ZERO)
}

/// `-value`. Integers wrap: `-MIN` is `MIN`, and an unsigned value becomes its two's complement.
/// For reals the sign flips, even for zero and NaN.
#[inline]
pub fn neg<T: Number>(value: T) -> T {
    value.negated()
}

/// The magnitude of `value`. Integers wrap: that of `MIN` is `MIN`. For reals the sign is
/// cleared, even for zero and NaN.
#[inline]
pub fn abs<T: Number>(value: T) -> T {
    value.magnitude()
}
