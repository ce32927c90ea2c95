//! TIME and LTIME: signed 64-bit nanoseconds in every dialect.

/// A duration, or a point on the scan clock, in nanoseconds.
pub type Time = i64;

/// Nanoseconds in a millisecond: the unit in which IEC conversions between TIME and numbers count.
pub const MILLISECOND: Time = 1_000_000;

/// `count` milliseconds.
pub const fn ms(count: i64) -> Time {
    count.wrapping_mul(MILLISECOND)
}
