//! Durations and dates: signed 64-bit nanoseconds in every dialect.

use crate::calendar::Day;

/// Nanoseconds: for a TIME or LTIME its length; on the scan clock since the start; for a TOD or LTOD since
/// midnight; for a DT or LDT since 1970-01-01, and for a DATE or LDATE from then to the midnight at which it starts.
pub type Time = i64;

/// Nanoseconds in a microsecond.
pub const MICROSECOND: Time = 1_000;

/// Nanoseconds in a millisecond, the unit of IEC conversions between TIME and numbers.
pub const MILLISECOND: Time = 1_000_000;

/// Nanoseconds in a second, the unit of conversions between DATE or DT and numbers.
pub const SECOND: Time = 1_000_000_000;

/// Nanoseconds in a day.
pub const DAY: Time = 86_400 * SECOND;

/// `count` milliseconds.
pub const fn ms(count: i64) -> Time {
    count.wrapping_mul(MILLISECOND)
}

/// The midnight at which a day starts; 0 for a day that does not exist.
pub const fn date(year: i64, month: i64, day: i64) -> Time {
    match (Day { year, month, day }).start() {
        Some(time) => time,
        None => 0,
    }
}
