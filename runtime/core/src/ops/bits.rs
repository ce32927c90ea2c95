//! Bitwise operations, shifts, rotations, and the order of bytes.

use super::convert::ConvertTo;
use super::{Bits, Integer};
use crate::{FaultKind, Scalar, Value};

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

/// Shifts the bits of `value` left by `count`, filling with zeros. The result is 0 when `count` reaches
/// the width; a negative `count` shifts nothing.
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

/// Shifts the bits of `value` right by `count`, filling with zeros, even for signed types. The result is
/// 0 when `count` reaches the width; a negative `count` shifts nothing.
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

/// Shifts the bits of `value` right by `count`, filling with copies of the sign bit. A negative
/// `count` shifts nothing.
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

/// Rotates the bits of `value` left by `count` modulo the width; a negative `count` rotates right.
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

/// Rotates the bits of `value` right by `count` modulo the width; a negative `count` rotates left.
#[inline]
pub fn ror<T: Integer>(value: T, count: i64) -> T {
    value.rotated_right(turns::<T>(count))
}

/// The smallest non-negative count that rotates a `T` in the same way as `count` does.
#[inline]
fn turns<T: Integer>(count: i64) -> u32 {
    // Every width is a power of two, so the mask is the euclidean remainder.
    count as u32 & (T::BITS - 1)
}

/// A [`Reference`](crate::Reference) after a step of `distance` bytes: `distance` is added to the lower half of the
/// bits, which wraps; the upper half, the object's number, stays.
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

/// The bytes of `value` in reverse order; a value of one byte is unchanged.
///
/// ```
/// use staunch_runtime::ops::swap_bytes;
/// assert_eq!(swap_bytes(0x1234_u16), 0x3412);
/// assert_eq!(swap_bytes(true), true);
/// ```
#[inline]
pub fn swap_bytes<T: Scalar>(value: T) -> T {
    let own = value.into_value();
    let swapped = match own {
        Value::Bool(_) | Value::I8(_) | Value::U8(_) => own,
        Value::I16(it) => Value::I16(it.swap_bytes()),
        Value::I32(it) => Value::I32(it.swap_bytes()),
        Value::I64(it) => Value::I64(it.swap_bytes()),
        Value::U16(it) => Value::U16(it.swap_bytes()),
        Value::U32(it) => Value::U32(it.swap_bytes()),
        Value::U64(it) => Value::U64(it.swap_bytes()),
        Value::F32(it) => Value::F32(f32::from_bits(it.to_bits().swap_bytes())),
        Value::F64(it) => Value::F64(f64::from_bits(it.to_bits().swap_bytes())),
    };
    T::from_value(swapped).unwrap_or(value)
}

/// The number with 16 decimal digits, of four bits each; four bits that are not a digit count with their value.
///
/// ```
/// use staunch_runtime::ops::from_bcd;
/// assert_eq!(from_bcd(0x0369), 369);
/// ```
#[inline]
pub fn from_bcd(digits: i64) -> i64 {
    (0..16).rev().fold(0, |number, at| number * 10 + ((digits >> (4 * at)) & 0xF))
}

/// The last 16 decimal digits of an unsigned number, of four bits each.
///
/// ```
/// use staunch_runtime::ops::to_bcd;
/// assert_eq!(to_bcd(369), 0x0369);
/// ```
#[inline]
pub fn to_bcd(number: i64) -> i64 {
    let mut rest = number as u64;
    let mut digits = 0;
    for at in 0..16 {
        digits |= (rest % 10) << (4 * at);
        rest /= 10;
    }
    digits as i64
}

/// The number with `count` decimal digits, of four bits each. It is negative if the highest of the four bits above
/// them is set: BCD16 of S7 has 3 digits, BCD32 has 7.
///
/// # Errors
/// [`FaultKind::NotDecimal`] if four bits are above 9.
///
/// ```
/// use staunch_runtime::ops::from_signed_bcd;
/// assert_eq!(from_signed_bcd(0xF123, 3), Ok(-123));
/// ```
#[inline]
pub fn from_signed_bcd(digits: i64, count: i64) -> Result<i64, FaultKind> {
    let count = most_digits(count);
    let digit = |at: u32| (digits >> (4 * at)) & 0xF;
    let mut number = 0;
    for at in (0..count).rev() {
        if digit(at) > 9 {
            return Err(FaultKind::NotDecimal);
        }
        number = number * 10 + digit(at);
    }
    Ok(if digit(count) < 8 { number } else { -number })
}

/// The `count` decimal digits of a number, of four bits each, below four bits that are set if it is negative.
///
/// # Errors
/// [`FaultKind::NotDecimal`] if it has more digits.
///
/// ```
/// use staunch_runtime::ops::to_signed_bcd;
/// assert_eq!(to_signed_bcd(-123, 3), Ok(0xF123));
/// ```
#[inline]
pub fn to_signed_bcd(number: i64, count: i64) -> Result<i64, FaultKind> {
    let count = most_digits(count);
    let magnitude = number.unsigned_abs();
    if magnitude >= 10_u64.pow(count) {
        return Err(FaultKind::NotDecimal);
    }
    let sign = if number < 0 { 0xF << (4 * count) } else { 0 };
    Ok(to_bcd(magnitude as i64) | sign)
}

/// The maximum number of digits that fit 64 bits together with a sign.
#[inline]
fn most_digits(count: i64) -> u32 {
    count.clamp(0, 15) as u32
}

/// The number of the lowest set bit; 0 if none is set.
///
/// ```
/// use staunch_runtime::ops::first_bit;
/// assert_eq!((first_bit(0b1010_0000_u8), first_bit(0_u8)), (5, 0));
/// ```
#[inline]
pub fn first_bit<T: Integer>(value: T) -> i16 {
    if value == T::ZERO { 0 } else { value.extended().trailing_zeros() as i16 }
}
