//! Values as Structured Text spells them: the reverse of [`literal`](crate::literal).

use crate::calendar::{Clock, Day};
use crate::literal::UNITS;
use crate::{Elementary, Time};
use core::fmt::{Result, Write};

/// A duration, a date or a time of day as a literal: `T#1s500ms`, `D#2024-02-29`, `TOD#23:59:59.5`. For an
/// [unsigned LTIME](Elementary::Ultime), `time` holds its bits.
pub fn time(out: &mut impl Write, ty: Elementary, time: Time) -> Result {
    out.write_str(match ty {
        Elementary::Time => "T#",
        Elementary::Date => "D#",
        Elementary::Ldate => "LD#",
        _ => ty.name(),
    })?;
    if !matches!(ty, Elementary::Time | Elementary::Date | Elementary::Ldate) {
        out.write_char('#')?;
    }
    match ty {
        Elementary::Date | Elementary::Ldate => date(out, time),
        Elementary::Tod | Elementary::Ltod => time_of_day(out, time),
        Elementary::Dt | Elementary::Ldt => {
            date(out, time)?;
            out.write_char('-')?;
            time_of_day(out, time)
        }
        Elementary::Ultime => magnitude(out, time as u64),
        _ => duration(out, time),
    }
}

/// `1d2h3m4s5ms6us7ns`, without the units that are 0; `0s` if all are.
pub fn duration(out: &mut impl Write, time: Time) -> Result {
    if time < 0 {
        out.write_char('-')?;
    }
    magnitude(out, time.unsigned_abs())
}

fn magnitude(out: &mut impl Write, nanoseconds: u64) -> Result {
    let mut rest = nanoseconds;
    if rest == 0 {
        return out.write_str("0s");
    }
    for (unit, size) in UNITS {
        let size = size.unsigned_abs();
        let count = rest.checked_div(size).unwrap_or(0);
        if count > 0 {
            number(out, count, 1)?;
            out.write_str(unit)?;
            rest -= count * size;
        }
    }
    Ok(())
}

/// `2024-02-29`
fn date(out: &mut impl Write, time: Time) -> Result {
    let Day { year, month, day } = Day::at(time);
    number(out, year.unsigned_abs(), 4)?;
    out.write_char('-')?;
    number(out, month.unsigned_abs(), 2)?;
    out.write_char('-')?;
    number(out, day.unsigned_abs(), 2)
}

/// `23:59:59.5`, with as many digits of the fraction as it needs.
fn time_of_day(out: &mut impl Write, time: Time) -> Result {
    let Clock { hour, minute, second, nanosecond } = Clock::at(time);
    number(out, hour.unsigned_abs(), 2)?;
    out.write_char(':')?;
    number(out, minute.unsigned_abs(), 2)?;
    out.write_char(':')?;
    number(out, second.unsigned_abs(), 2)?;
    if nanosecond == 0 {
        return Ok(());
    }
    let (mut fraction, mut digits) = (nanosecond.unsigned_abs(), 9);
    while fraction % 10 == 0 {
        (fraction, digits) = (fraction / 10, digits - 1);
    }
    out.write_char('.')?;
    number(out, fraction, digits)
}

/// In decimal, with leading zeros if it has fewer digits than `least`.
fn number(out: &mut impl Write, value: u64, least: usize) -> Result {
    let mut buffer = [0; MOST_DIGITS];
    out.write_str(core::str::from_utf8(digits(value, least, &mut buffer)).unwrap_or_default())
}

/// The number of digits of the greatest number.
pub(crate) const MOST_DIGITS: usize = 20;

/// The decimal digits of a number, with leading zeros if there are fewer than `least`.
pub(crate) fn digits(value: u64, least: usize, buffer: &mut [u8; MOST_DIGITS]) -> &[u8] {
    let (mut rest, mut start) = (value, MOST_DIGITS);
    for (at, place) in buffer.iter_mut().enumerate().rev() {
        *place = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest > 0 || at + least > MOST_DIGITS {
            continue;
        }
        start = at;
        break;
    }
    buffer.get(start..).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::literal;
    use std::string::String;

    fn spelled(ty: Elementary, value: Time) -> String {
        let mut out = String::new();
        time(&mut out, ty, value).expect("writing to a String");
        out
    }

    #[test]
    fn numbers_have_their_digits() {
        for (value, least, text) in
            [(0, 1, "0"), (7, 3, "007"), (10, 1, "10"), (99, 2, "99"), (u64::MAX, 1, "18446744073709551615")]
        {
            let mut out = String::new();
            number(&mut out, value, least).expect("writing to a String");
            assert_eq!(out, text);
        }
    }

    #[test]
    fn what_is_spelled_reads_back() {
        use Elementary as E;
        let values = [0, 1, -1, 951_782_400_000_000_000, 1_709_210_096_789_000_000, i64::MAX, i64::MIN, i64::MIN + 1];
        for value in values {
            for ty in [E::Time, E::Ltime, E::Dt, E::Ldt] {
                let text = spelled(ty, value);
                let (_, inner) = text.split_once('#').expect("a prefix");
                assert_eq!(literal::time(ty, inner), Ok(value), "{text}");
            }
        }
        assert_eq!(spelled(E::Dt, 1_709_210_096_789_000_000), "DT#2024-02-29-12:34:56.789");
        assert_eq!(spelled(E::Date, 1_709_164_800_000_000_000), "D#2024-02-29");
        assert_eq!(spelled(E::Ltod, 86_399_999_999_999), "LTOD#23:59:59.999999999");
        assert_eq!(spelled(E::Tod, 0), "TOD#00:00:00");
        assert_eq!(spelled(E::Ltime, 0), "LTIME#0s");
    }
}
