use super::convert::ConvertTo;
use super::{Bits, Integer};

/// `a AND b`, bit by bit.
#[inline]
pub fn and<T: Bits>(a: T, b: T) -> T {
    a & b
}

/// `a OR b`, bit by bit.
#[inline]
pub fn or<T: Bits>(a: T, b: T) -> T {
    a | b
}

/// `a XOR b`, bit by bit.
#[inline]
pub fn xor<T: Bits>(a: T, b: T) -> T {
    a ^ b
}

/// `NOT value`, bit by bit.
#[inline]
pub fn not<T: Bits>(value: T) -> T {
    !value
}

/// Moves the bits of `value` left by `count`; zeros come in. All are gone when `count` reaches
/// the width; a negative `count` moves nothing.
///
/// ```
/// use staunch_runtime::ops::shl;
/// assert_eq!(shl(0x81_u8, 1), 0x02);
/// assert_eq!(shl(0x81_u8, 8), 0);
/// assert_eq!(shl(0x81_u8, -1), 0x81);
/// ```
#[inline]
pub fn shl<T: Integer>(value: T, count: i64) -> T {
    shift(value, count, T::shifted_left)
}

/// Moves the bits of `value` right by `count`; zeros come in, also for signed types. All are
/// gone when `count` reaches the width; a negative `count` moves nothing.
///
/// ```
/// use staunch_runtime::ops::shr;
/// assert_eq!(shr(0x81_u8, 1), 0x40);
/// assert_eq!(shr(-2_i8, 1), 127);
/// ```
#[inline]
pub fn shr<T: Integer>(value: T, count: i64) -> T {
    shift(value, count, T::shifted_right)
}

/// Moves the bits of `value` right by `count`, and keeps the sign: copies of it come in. A negative
/// `count` moves nothing.
///
/// ```
/// use staunch_runtime::ops::sar;
/// assert_eq!(sar(-4_i8, 1), -2);
/// assert_eq!(sar(-4_i8, 9), -1);
/// assert_eq!(sar(0x81_u8, 1), 0x40);
/// ```
#[inline]
pub fn sar<T: Integer + Bits>(value: T, count: i64) -> T {
    if value < T::ZERO { !shr(!value, count) } else { shr(value, count) }
}

#[inline]
fn shift<T: Integer>(value: T, count: i64, by: fn(T, u32) -> T) -> T {
    if count >= i64::from(T::BITS) { T::ZERO } else { by(value, count.max(0) as u32) }
}

/// Turns the bits of `value` left by `count` modulo the width; a negative `count` turns right.
///
/// ```
/// use staunch_runtime::ops::rol;
/// assert_eq!(rol(0x81_u8, 1), 0x03);
/// assert_eq!(rol(0x81_u8, 9), 0x03);
/// assert_eq!(rol(0x81_u8, -1), 0xC0);
/// ```
#[inline]
pub fn rol<T: Integer>(value: T, count: i64) -> T {
    value.rotated_left(turns::<T>(count))
}

/// Turns the bits of `value` right by `count` modulo the width; a negative `count` turns left.
#[inline]
pub fn ror<T: Integer>(value: T, count: i64) -> T {
    value.rotated_right(turns::<T>(count))
}

/// The least non-negative count that turns a `T` as far as `count` does.
#[inline]
fn turns<T: Integer>(count: i64) -> u32 {
    // Every width is a power of two, so the mask is the euclidean remainder.
    count as u32 & (T::BITS - 1)
}

/// A [`Reference`](crate::Reference) after a step of `distance` bytes: the lower half of the bits moves,
/// and wraps; the upper half, the object's number, stays.
///
/// ```
/// use staunch_runtime::ops::advance;
/// assert_eq!(advance(0x0000_0001_0000_0004_u64, -4), 0x0000_0001_0000_0000);
/// assert_eq!(advance(0x0000_0001_0000_0000_u64, -1), 0x0000_0001_FFFF_FFFF);
/// ```
#[inline]
pub fn advance<T: Integer + Bits>(value: T, distance: i64) -> T
where
    i64: ConvertTo<T>,
{
    let position = shr(!T::ZERO, i64::from(T::BITS / 2));
    (value & !position) | (value.plus(super::convert(distance)) & position)
}
