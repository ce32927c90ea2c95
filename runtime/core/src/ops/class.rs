//! The classes of reprs that `op_table.rs` names, as traits.

use core::ops::{BitAnd, BitOr, BitXor, Not};

use crate::{FaultKind, Scalar};

/// A repr with arithmetic: every repr except BOOL. The functions of [`ops`](crate::ops) define what
/// the operations mean.
pub trait Number: Scalar {
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn quotient(self, divisor: Self) -> Result<Self, FaultKind>;
    fn negated(self) -> Self;
    fn magnitude(self) -> Self;
}

/// A repr of whole numbers, signed or not, including the reprs of BYTE to LWORD, and of TIME.
pub trait Integer: Number + Ord {
    const BITS: u32;

    fn remainder(self, divisor: Self) -> Result<Self, FaultKind>;
    /// Fills with zeros; `count` is below [`BITS`](Self::BITS).
    fn shifted_left(self, count: u32) -> Self;
    /// Fills with zeros, even for a signed repr; `count` is below [`BITS`](Self::BITS).
    fn shifted_right(self, count: u32) -> Self;
    fn rotated_left(self, count: u32) -> Self;
    fn rotated_right(self, count: u32) -> Self;
    /// Its two's complement, extended to 64 bits.
    fn extended(self) -> u64;
    /// The value with these as its lowest bits.
    fn of_low_bits(bits: u64) -> Self;
}

/// A repr of IEEE 754 numbers. The functions are libm's, whose results do not depend on the
/// machine.
pub trait Real: Number {
    fn power(self, exponent: Self) -> Self;
    fn square_root(self) -> Self;
    fn natural_log(self) -> Self;
    fn decimal_log(self) -> Self;
    fn exponential(self) -> Self;
    fn sine(self) -> Self;
    fn cosine(self) -> Self;
    fn tangent(self) -> Self;
    fn arc_sine(self) -> Self;
    fn arc_cosine(self) -> Self;
    fn arc_tangent(self) -> Self;
    fn arc_tangent_over(self, x: Self) -> Self;
    fn rounded_up(self) -> Self;
    fn rounded_down(self) -> Self;
    fn rounded_to_zero(self) -> Self;
    fn rounded_to_even(self) -> Self;
}

/// A repr with bitwise operations; logical ones for BOOL.
pub trait Bits:
    Scalar + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
}

impl Bits for bool {}

macro_rules! integers {
    ($($rust:ident $unsigned:ident $magnitude:ident;)*) => { $(
        impl Number for $rust {
            #[inline]
            fn plus(self, other: Self) -> Self { self.wrapping_add(other) }
            #[inline]
            fn minus(self, other: Self) -> Self { self.wrapping_sub(other) }
            #[inline]
            fn times(self, other: Self) -> Self { self.wrapping_mul(other) }
            #[inline]
            fn quotient(self, divisor: Self) -> Result<Self, FaultKind> {
                if divisor == 0 { Err(FaultKind::DivideByZero) } else { Ok(self.wrapping_div(divisor)) }
            }
            #[inline]
            fn negated(self) -> Self { self.wrapping_neg() }
            #[inline]
            fn magnitude(self) -> Self { magnitude!($magnitude self) }
        }

        impl Integer for $rust {
            const BITS: u32 = <$rust>::BITS;

            #[inline]
            fn remainder(self, divisor: Self) -> Result<Self, FaultKind> {
                if divisor == 0 { Err(FaultKind::DivideByZero) } else { Ok(self.wrapping_rem(divisor)) }
            }
            #[inline]
            fn shifted_left(self, count: u32) -> Self { self.wrapping_shl(count) }
            #[inline]
            fn shifted_right(self, count: u32) -> Self { (self as $unsigned).wrapping_shr(count) as $rust }
            #[inline]
            fn rotated_left(self, count: u32) -> Self { self.rotate_left(count) }
            #[inline]
            fn rotated_right(self, count: u32) -> Self { self.rotate_right(count) }
            #[inline]
            fn extended(self) -> u64 { self as u64 }
            #[inline]
            fn of_low_bits(bits: u64) -> Self { bits as $rust }
        }

        impl Bits for $rust {}
    )* };
}

macro_rules! magnitude {
    (signed $value:ident) => {
        $value.wrapping_abs()
    };
    (unsigned $value:ident) => {
        $value
    };
}

integers! {
    i8 u8 signed;
    i16 u16 signed;
    i32 u32 signed;
    i64 u64 signed;
    u8 u8 unsigned;
    u16 u16 unsigned;
    u32 u32 unsigned;
    u64 u64 unsigned;
}

macro_rules! reals {
    ($($rust:ident: $abs:ident $pow:ident $sqrt:ident $log:ident $log10:ident $exp:ident
        $sin:ident $cos:ident $tan:ident $asin:ident $acos:ident $atan:ident $atan2:ident
        $ceil:ident $floor:ident $trunc:ident $rint:ident;)*) => { $(
        impl Number for $rust {
            #[inline]
            fn plus(self, other: Self) -> Self { self + other }
            #[inline]
            fn minus(self, other: Self) -> Self { self - other }
            #[inline]
            fn times(self, other: Self) -> Self { self * other }
            #[inline]
            fn quotient(self, divisor: Self) -> Result<Self, FaultKind> { Ok(self / divisor) }
            #[inline]
            fn negated(self) -> Self { -self }
            #[inline]
            fn magnitude(self) -> Self { libm::$abs(self) }
        }

        impl Real for $rust {
            #[inline]
            fn power(self, exponent: Self) -> Self { libm::$pow(self, exponent) }
            #[inline]
            fn square_root(self) -> Self { libm::$sqrt(self) }
            #[inline]
            fn natural_log(self) -> Self { libm::$log(self) }
            #[inline]
            fn decimal_log(self) -> Self { libm::$log10(self) }
            #[inline]
            fn exponential(self) -> Self { libm::$exp(self) }
            #[inline]
            fn sine(self) -> Self { libm::$sin(self) }
            #[inline]
            fn cosine(self) -> Self { libm::$cos(self) }
            #[inline]
            fn tangent(self) -> Self { libm::$tan(self) }
            #[inline]
            fn arc_sine(self) -> Self { libm::$asin(self) }
            #[inline]
            fn arc_cosine(self) -> Self { libm::$acos(self) }
            #[inline]
            fn arc_tangent(self) -> Self { libm::$atan(self) }
            #[inline]
            fn arc_tangent_over(self, x: Self) -> Self { libm::$atan2(self, x) }
            #[inline]
            fn rounded_up(self) -> Self { libm::$ceil(self) }
            #[inline]
            fn rounded_down(self) -> Self { libm::$floor(self) }
            #[inline]
            fn rounded_to_zero(self) -> Self { libm::$trunc(self) }
            #[inline]
            fn rounded_to_even(self) -> Self { libm::$rint(self) }
        }
    )* };
}

reals! {
    f32: fabsf powf sqrtf logf log10f expf sinf cosf tanf asinf acosf atanf atan2f ceilf floorf truncf rintf;
    f64: fabs pow sqrt log log10 exp sin cos tan asin acos atan atan2 ceil floor trunc rint;
}
