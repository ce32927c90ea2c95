//! The calendar: days since 1970-01-01 and their dates, in the Gregorian calendar, even before
//! it was in use.

use crate::Time;
use crate::time::{DAY, SECOND};

/// Years are counted from March, so that a leap day is the last of its year; 400 of them are an era.
const DAYS_OF_ERA: i64 = 146_097;
/// Days from 0000-03-01 to 1970-01-01.
const TO_1970: i64 = 719_468;

/// A day by its year, month and day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Day {
    pub year: i64,
    /// 1 to 12.
    pub month: i64,
    /// 1 to 31.
    pub day: i64,
}

impl Day {
    /// The day of a point in time.
    pub const fn at(time: Time) -> Self {
        let from_start = time.div_euclid(DAY) + TO_1970;
        let day = from_start.rem_euclid(DAYS_OF_ERA);
        let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
        let day = day - (365 * year + year / 4 - year / 100);
        let month = (5 * day + 2) / 153;
        let is_next_year = month >= 10;
        Self {
            year: year + from_start.div_euclid(DAYS_OF_ERA) * 400 + is_next_year as i64,
            month: if is_next_year { month - 9 } else { month + 3 },
            day: day - (153 * month + 2) / 5 + 1,
        }
    }

    /// Whether the calendar has this day.
    pub const fn exists(self) -> bool {
        1 <= self.month && self.month <= 12 && 1 <= self.day && self.day <= days_of_month(self.year, self.month)
    }

    /// Days since 1970-01-01; `None` for a day that does not exist, or whose year has more than four digits.
    pub const fn number(self) -> Option<i64> {
        if !self.exists() || self.year < 0 || self.year > 9999 {
            return None;
        }
        let is_early = self.month <= 2;
        let year = self.year - is_early as i64;
        let month = if is_early { self.month + 9 } else { self.month - 3 };
        let of_era = year.rem_euclid(400);
        let day = 365 * of_era + of_era / 4 - of_era / 100 + (153 * month + 2) / 5 + self.day - 1;
        Some(year.div_euclid(400) * DAYS_OF_ERA + day - TO_1970)
    }

    /// Its first nanosecond; `None` for a day that does not exist, or starts beyond the range of a [`Time`].
    pub const fn start(self) -> Option<Time> {
        match self.number() {
            Some(number) => number.checked_mul(DAY),
            None => None,
        }
    }
}

/// The number of days, 28 to 31; 31 for a number that is not a month.
pub const fn days_of_month(year: i64, month: i64) -> i64 {
    match month {
        4 | 6 | 9 | 11 => 30,
        2 if year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) => 29,
        2 => 28,
        _ => 31,
    }
}

/// A time of day by its hour, minute, second and nanosecond; all are within their ranges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    /// 0 to 23.
    pub hour: i64,
    /// 0 to 59.
    pub minute: i64,
    /// 0 to 59.
    pub second: i64,
    /// 0 to 999 999 999.
    pub nanosecond: i64,
}

impl Clock {
    /// The time of day at a point in time.
    pub const fn at(time: Time) -> Self {
        let time = time.rem_euclid(DAY);
        let seconds = time / SECOND;
        Self { hour: seconds / 3600, minute: seconds / 60 % 60, second: seconds % 60, nanosecond: time % SECOND }
    }

    /// Nanoseconds since midnight; `None` for a time that is not valid.
    pub const fn since_midnight(self) -> Option<Time> {
        let Self { hour, minute, second, nanosecond } = self;
        if hour < 0 || hour >= 24 || minute < 0 || minute >= 60 || second < 0 || second >= 60 {
            return None;
        }
        if nanosecond < 0 || nanosecond >= SECOND {
            return None;
        }
        Some(((hour * 60 + minute) * 60 + second) * SECOND + nanosecond)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts day by day over the whole range of a `Time`, using only the rule of leap years.
    #[test]
    fn the_calendar_is_that_which_counts_day_by_day() {
        let is_leap = |year: i64| year % 4 == 0 && year % 100 != 0 || year % 400 == 0;
        let mut at = Day { year: 1970, month: 1, day: 1 };
        let lengths = |year: i64| [31, 28 + i64::from(is_leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
        let length = |it: Day| lengths(it.year)[usize::try_from(it.month - 1).expect("a month")];
        let mut time: Time = 0;
        loop {
            assert_eq!((Day::at(time), at.start()), (at, Some(time)));
            assert_eq!(Day::at(time.saturating_add(DAY - 1)), at);
            at.day += 1;
            if at.day > length(at) {
                assert_eq!((at.exists(), at.start()), (false, None));
                (at.day, at.month) = (1, at.month + 1);
            }
            if at.month > 12 {
                (at.month, at.year) = (1, at.year + 1);
            }
            let Some(next) = time.checked_add(DAY) else { break };
            time = next;
        }
        assert_eq!((at, at.start()), (Day { year: 2262, month: 4, day: 12 }, None));
        (at, time) = (Day { year: 1970, month: 1, day: 1 }, 0);
        while let Some(before) = time.checked_sub(DAY) {
            at.day -= 1;
            if at.day == 0 {
                at.month -= 1;
                if at.month == 0 {
                    (at.month, at.year) = (12, at.year - 1);
                }
                at.day = length(at);
            }
            time = before;
            assert_eq!((Day::at(time), at.start()), (at, Some(time)));
        }
        assert_eq!(at, Day { year: 1677, month: 9, day: 22 });
    }

    /// Dates that Python's `datetime` gives for these numbers of seconds.
    #[test]
    fn the_calendar_is_that_of_others() {
        for (seconds, year, month, day, hour, minute, second) in [
            (0, 1970, 1, 1, 0, 0, 0),
            (951_782_400, 2000, 2, 29, 0, 0, 0),
            (951_868_799, 2000, 2, 29, 23, 59, 59),
            (1_709_164_800, 2024, 2, 29, 0, 0, 0),
            (4_107_542_400, 2100, 3, 1, 0, 0, 0),
            (4_294_967_295, 2106, 2, 7, 6, 28, 15),
            (-1, 1969, 12, 31, 23, 59, 59),
            (-2_203_977_600, 1900, 2, 28, 0, 0, 0),
            (-2_203_891_200, 1900, 3, 1, 0, 0, 0),
            (9_223_372_036, 2262, 4, 11, 23, 47, 16),
            (-9_223_372_036, 1677, 9, 21, 0, 12, 44),
        ] {
            let time = seconds * SECOND;
            assert_eq!(Day::at(time), Day { year, month, day }, "{seconds}");
            assert_eq!(Clock::at(time), Clock { hour, minute, second, nanosecond: 0 }, "{seconds}");
        }
    }
}
