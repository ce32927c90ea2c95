//! Conversions between elementary types.

use crate::ops::Real;
use crate::{Repr, Scalar, Value, with_repr};

/// A repr that can be converted to repr `T`; every repr can.
pub trait ConvertTo<T> {
    /// See [`convert`].
    fn converted(self) -> T;
}

/// A real repr that can be truncated to integer repr `T`; every real repr can.
pub trait TruncateTo<T> {
    /// See [`trunc`].
    fn truncated(self) -> T;
}

/// Changes the repr of a value.
///
/// | from | to | result |
/// |---|---|---|
/// | integer | integer | the low bits |
/// | integer | real | the nearest, ties to even |
/// | real | integer | the nearest, ties to even; saturated; NaN gives 0 |
/// | real | real | the nearest, ties to even |
/// | BOOL | number | 0 or 1 |
/// | number | BOOL | whether it is `<> 0`, so TRUE for NaN |
///
/// ```
/// use staunch_runtime::ops::convert;
/// assert_eq!(convert::<i16, i8>(200), -56);
/// assert_eq!(convert::<f32, i32>(2.5), 2);
/// assert_eq!(convert::<f32, i32>(3.5), 4);
/// assert_eq!(convert::<f32, i32>(-2.5), -2);
/// assert_eq!(convert::<f64, u8>(1e9), 255);
/// assert_eq!(convert::<f64, bool>(f64::NAN), true);
/// ```
#[inline]
pub fn convert<F: ConvertTo<T>, T>(value: F) -> T {
    value.converted()
}

/// Truncates a real to an integer, toward zero; saturated; NaN gives 0.
///
/// ```
/// use staunch_runtime::ops::trunc;
/// assert_eq!(trunc::<f32, i16>(-2.9), -2);
/// assert_eq!(trunc::<f32, i16>(1e9), i16::MAX);
/// ```
#[inline]
pub fn trunc<F: TruncateTo<T>, T>(value: F) -> T {
    value.truncated()
}

macro_rules! conversions {
    ($($from:ident $kind:ident;)*) => { $(
        conversions!(@from $kind $from:
            bool bool, i8 integer, i16 integer, i32 integer, i64 integer,
            u8 integer, u16 integer, u32 integer, u64 integer, f32 real, f64 real);
    )* };
    (@from $kind:ident $from:ident: $($to:ident $to_kind:ident),*) => { $(
        impl ConvertTo<$to> for $from {
            #[inline]
            fn converted(self) -> $to { conversions!(@ $kind $to_kind self $from $to) }
        }
    )* };
    (@ bool bool $value:ident $from:ident $to:ident) => { $value };
    (@ bool $any:ident $value:ident $from:ident $to:ident) => { u8::from($value) as $to };
    (@ $any:ident bool $value:ident $from:ident $to:ident) => { $value != <$from>::ZERO };
    (@ real integer $value:ident $from:ident $to:ident) => { Real::rounded_to_even($value) as $to };
    (@ $any:ident $other:ident $value:ident $from:ident $to:ident) => { $value as $to };
}

conversions! {
    bool bool;
    i8 integer;
    i16 integer;
    i32 integer;
    i64 integer;
    u8 integer;
    u16 integer;
    u32 integer;
    u64 integer;
    f32 real;
    f64 real;
}

macro_rules! truncations {
    ($from:ident: $($to:ident)*) => { $(
        impl TruncateTo<$to> for $from {
            #[inline]
            fn truncated(self) -> $to { self as $to }
        }
    )* };
}

truncations!(f32: i8 i16 i32 i64 u8 u16 u32 u64);
truncations!(f64: i8 i16 i32 i64 u8 u16 u32 u64);

/// The bits of a real as an unsigned number of its width, and the reverse; any other value is unchanged.
pub fn same_bits(value: Value, to: Repr) -> Value {
    match (value, to) {
        (Value::F32(it), Repr::U32) => Value::U32(it.to_bits()),
        (Value::F64(it), Repr::U64) => Value::U64(it.to_bits()),
        (Value::U32(it), Repr::F32) => Value::F32(f32::from_bits(it)),
        (Value::U64(it), Repr::F64) => Value::F64(f64::from_bits(it)),
        (other, _) => other,
    }
}

/// [`convert`] for a value whose repr is known at run time.
pub fn convert_value(value: Value, to: Repr) -> Value {
    match value {
        Value::Bool(it) => converted(it, to),
        Value::I8(it) => converted(it, to),
        Value::I16(it) => converted(it, to),
        Value::I32(it) => converted(it, to),
        Value::I64(it) => converted(it, to),
        Value::U8(it) => converted(it, to),
        Value::U16(it) => converted(it, to),
        Value::U32(it) => converted(it, to),
        Value::U64(it) => converted(it, to),
        Value::F32(it) => converted(it, to),
        Value::F64(it) => converted(it, to),
    }
}

/// [`trunc`] for a value whose repr is known at run time. A case without anything to truncate (a value
/// that is not a real, a target that is not an integer) is [converted](convert_value).
pub fn trunc_value(value: Value, to: Repr) -> Value {
    match value {
        Value::F32(it) => with_repr!(integer to, T => trunc::<f32, T>(it).into_value(), converted(it, to)),
        Value::F64(it) => with_repr!(integer to, T => trunc::<f64, T>(it).into_value(), converted(it, to)),
        Value::Bool(_)
        | Value::I8(_)
        | Value::I16(_)
        | Value::I32(_)
        | Value::I64(_)
        | Value::U8(_)
        | Value::U16(_)
        | Value::U32(_)
        | Value::U64(_) => convert_value(value, to),
    }
}

/// A repr that can be converted to every repr.
trait ConvertToAny:
    Scalar
    + ConvertTo<bool>
    + ConvertTo<i8>
    + ConvertTo<i16>
    + ConvertTo<i32>
    + ConvertTo<i64>
    + ConvertTo<u8>
    + ConvertTo<u16>
    + ConvertTo<u32>
    + ConvertTo<u64>
    + ConvertTo<f32>
    + ConvertTo<f64>
{
}

macro_rules! convert_to_any {
    ($($from:ident)*) => { $(impl ConvertToAny for $from {})* };
}

convert_to_any!(bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64);

fn converted<F: ConvertToAny>(value: F, to: Repr) -> Value {
    with_repr!(any to, T => convert::<F, T>(value).into_value(), value.into_value())
}
