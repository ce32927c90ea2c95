//! REAL mathematics. Every function is libm's own code, so its bits are the same on every target.

use super::Real;

/// `base` to the power of `exponent`: IEEE `pow`. NaN for a negative base with a fractional exponent;
/// 1 for an exponent of 0, whatever the base.
#[inline]
pub fn expt<T: Real>(base: T, exponent: T) -> T {
    base.power(exponent)
}

/// The square root, correctly rounded; NaN for a negative value.
#[inline]
pub fn sqrt<T: Real>(value: T) -> T {
    value.square_root()
}

/// The natural logarithm; negative infinity for zero, NaN for a negative value.
#[inline]
pub fn ln<T: Real>(value: T) -> T {
    value.natural_log()
}

/// The logarithm to base 10; negative infinity for zero, NaN for a negative value.
#[inline]
pub fn log<T: Real>(value: T) -> T {
    value.decimal_log()
}

/// The natural exponential; infinity if the result exceeds the type.
#[inline]
pub fn exp<T: Real>(value: T) -> T {
    value.exponential()
}

/// The sine of an angle in radians; NaN for infinities.
#[inline]
pub fn sin<T: Real>(value: T) -> T {
    value.sine()
}

/// The cosine of an angle in radians; NaN for infinities.
#[inline]
pub fn cos<T: Real>(value: T) -> T {
    value.cosine()
}

/// The tangent of an angle in radians; NaN for infinities.
#[inline]
pub fn tan<T: Real>(value: T) -> T {
    value.tangent()
}

/// The angle in radians, `-pi/2..=pi/2`, whose sine is `value`; NaN outside `-1..=1`.
#[inline]
pub fn asin<T: Real>(value: T) -> T {
    value.arc_sine()
}

/// The angle in radians, `0..=pi`, whose cosine is `value`; NaN outside `-1..=1`.
#[inline]
pub fn acos<T: Real>(value: T) -> T {
    value.arc_cosine()
}

/// The angle in radians, `-pi/2..=pi/2`, whose tangent is `value`.
#[inline]
pub fn atan<T: Real>(value: T) -> T {
    value.arc_tangent()
}

/// The angle in radians, `-pi..=pi`, between the positive x axis and the point `(x, y)`: IEEE
/// `atan2`. With zeros, the signs decide: `atan2(0, -0)` is pi.
#[inline]
pub fn atan2<T: Real>(y: T, x: T) -> T {
    y.arc_tangent_over(x)
}

/// The least whole number that is not below the value; infinities and NaN are unchanged.
#[inline]
pub fn ceil<T: Real>(value: T) -> T {
    value.rounded_up()
}

/// The greatest whole number that is not above the value; infinities and NaN are unchanged.
#[inline]
pub fn floor<T: Real>(value: T) -> T {
    value.rounded_down()
}

/// The value without its fraction; infinities and NaN are unchanged.
#[inline]
pub fn whole<T: Real>(value: T) -> T {
    value.rounded_to_zero()
}

/// The nearest whole number, ties to even; infinities and NaN are unchanged.
#[inline]
pub fn nearest<T: Real>(value: T) -> T {
    value.rounded_to_even()
}

/// The fraction of the value, with its sign; NaN for infinities and NaN.
///
/// ```
/// use staunch_runtime::ops::fraction;
/// assert_eq!(fraction(-2.75_f64), -0.75);
/// ```
#[inline]
pub fn fraction<T: Real>(value: T) -> T {
    value.minus(value.rounded_to_zero())
}
