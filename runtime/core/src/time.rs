//! Durations and dates: signed 64-bit nanoseconds in every dialect.

use crate::calendar::Day;

/// Nanoseconds: of a TIME or LTIME; since the start, on the scan clock; since midnight, of a TOD or
/// LTOD; since 1970-01-01, of a DT or LDT; and of a DATE or LDATE, which is the midnight it starts at.
pub type Time = i64;

/// Nanoseconds in a microsecond.
pub const MICROSECOND: Time = 1_000;

/// Nanoseconds in a millisecond: the unit in which IEC conversions between TIME and numbers count.
pub const MILLISECOND: Time = 1_000_000;

/// Nanoseconds in a second: the unit in which conversions between DATE or DT and numbers count.
pub const SECOND: Time = 1_000_000_000;

/// Nanoseconds in a day.
pub const DAY: Time = 86_400 * SECOND;

/// `count` milliseconds.
pub const fn ms(count: i64) -> Time {
    count.wrapping_mul(MILLISECOND)
}

/// The midnight at which a day starts; 0 for one that does not exist.
pub const fn date(year: i64, month: i64, day: i64) -> Time {
    match (Day { year, month, day }).start() {
        Some(time) => time,
        None => 0,
    }
}
