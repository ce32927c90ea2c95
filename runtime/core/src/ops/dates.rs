//! Dates and times of day, and their parts. All are nanoseconds, see [`Time`](crate::Time).

use crate::calendar::{Clock, Day};
use crate::time::{DAY, MILLISECOND, SECOND};
use crate::{FaultKind, Time};

/// The number of whole units from 1970-01-01 to a point in time, rounded down even before 1970. A unit below 1
/// counts as 1.
#[inline]
pub fn whole_units(time: Time, unit: Time) -> i64 {
    time.div_euclid(unit.max(1))
}

/// The midnight before or at a point in time. If that is out of range, which is so only on 1677-09-21,
/// the midnight after it.
#[inline]
pub fn start_of_day(time: Time) -> Time {
    let past = time.rem_euclid(DAY);
    time.checked_sub(past).unwrap_or(time.wrapping_add(DAY - past))
}

/// Nanoseconds since the midnight before a point in time, so that a sum with a time of day starts again from 0
/// at midnight.
#[inline]
pub fn time_of_day(time: Time) -> Time {
    time.rem_euclid(DAY)
}

/// The midnight of a day; [`FaultKind::NoSuchDate`] if the calendar has no such day, or it is out of the range
/// of a [`Time`].
#[inline]
pub fn day_of(year: i64, month: i64, day: i64) -> Result<Time, FaultKind> {
    Day { year, month, day }.start().ok_or(FaultKind::NoSuchDate)
}

/// Nanoseconds since midnight; [`FaultKind::NoSuchDate`] if a number is out of its range.
#[inline]
pub fn clock_of(hour: i64, minute: i64, second: i64, millisecond: i64) -> Result<Time, FaultKind> {
    let nanosecond = millisecond.checked_mul(MILLISECOND).unwrap_or(SECOND);
    Clock { hour, minute, second, nanosecond }.since_midnight().ok_or(FaultKind::NoSuchDate)
}

/// A time of day on a given day; [`FaultKind::NoSuchDate`] if it is out of the range of a [`Time`].
#[inline]
pub fn point_of(day: Time, clock: Time) -> Result<Time, FaultKind> {
    day.checked_add(clock).ok_or(FaultKind::NoSuchDate)
}

/// The year of a point in time.
#[inline]
pub fn year(time: Time) -> i64 {
    Day::at(time).year
}

/// The month of a point in time, 1 to 12.
#[inline]
pub fn month(time: Time) -> i64 {
    Day::at(time).month
}

/// The day of the month of a point in time, 1 to 31.
#[inline]
pub fn day(time: Time) -> i64 {
    Day::at(time).day
}

/// The day of the week of a point in time: Sunday is 0, Saturday 6.
///
/// ```
/// use staunch_runtime::{ops::weekday, time::date};
/// assert_eq!(weekday(date(2024, 2, 29)), 4);
/// ```
#[inline]
pub fn weekday(time: Time) -> i64 {
    // 1970-01-01 was a Thursday.
    (time.div_euclid(DAY) + 4).rem_euclid(7)
}
