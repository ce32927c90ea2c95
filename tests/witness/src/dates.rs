//! Days, times of day and points in time: nanoseconds since midnight or 1970-01-01, of a day the midnight that it
//! starts at.

use crate::calls::is_enable;
use crate::expressions::in_repr;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::storage::Value;
use crate::types::{Elementary, Type};
use staunch_frontend::Span;
use staunch_frontend::ast::{Argument, ArgumentKind, BinaryOp, Expr};
use staunch_runtime::{Family, FaultKind, Value as Scalar};

use Elementary as E;

const SECOND: i128 = 1_000_000_000;
const DAY: i128 = 86_400 * SECOND;
/// Days of the months before each, in a year without a leap day.
const BEFORE_MONTH: [i128; 12] = [0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334];

/// 1990-01-01: 20 years of 365 days and five leap days after 1970, in nanoseconds.
pub(crate) const START_OF_S7: i64 = (20 * 365 + 5) * 86_400 * 1_000_000_000;

impl Elementary {
    fn is_long(self) -> bool {
        matches!(self, E::Ltime | E::Ldate | E::Ltod | E::Ldt)
    }

    fn lengthened(self) -> Self {
        match self {
            E::Time => E::Ltime,
            E::Date => E::Ldate,
            E::Tod => E::Ltod,
            E::Dt => E::Ldt,
            other => other,
        }
    }

    /// Nanoseconds that a number counts as one.
    fn unit(self) -> i128 {
        match self {
            E::Date | E::Dt => SECOND,
            E::Time | E::Tod => SECOND / 1000,
            _ => 1,
        }
    }
}

impl<'a> Machine<'a> {
    /// `+` and `-` where one side is a date.
    pub(crate) fn date_sum(&self, op: BinaryOp, a: &Value<'a>, b: &Value<'a>) -> Outcome<Option<Value<'a>>> {
        let (Some(x), Some(y)) = (a.ty.elementary(), b.ty.elementary()) else { return Ok(None) };
        if !x.is_date() || !matches!(op, BinaryOp::Add | BinaryOp::Sub) {
            return Ok(None);
        }
        let (p, q) = (a.as_integer()?, b.as_integer()?);
        let length = |ty: E| if x.is_long() || y.is_long() { ty.lengthened() } else { ty };
        if y.is_date() {
            return Ok(Some(at(length(E::Time), p - q)?));
        }
        let moved = if op == BinaryOp::Add { p + q } else { p - q };
        Ok(Some(at(length(x), moved)?))
    }

    /// Between dates, and between them and numbers and times.
    pub(crate) fn date_converted(&self, value: &Value<'a>, from: E, to: E, span: Span) -> Outcome<Value<'a>> {
        let temporal = |it: E| it.is_date() || it.is_time();
        if temporal(from) && temporal(to) {
            return at(to, value.as_integer()?);
        }
        if temporal(from) && to.is_real() {
            let parts = [value.as_scalar()?, Scalar::I64(unit(from))];
            let parts = parts.map(|it| in_repr(it, E::Lreal).as_scalar());
            let [number, unit] = parts;
            return Ok(in_repr(self.applied("DIV", E::Lreal, &[number?, unit?], span)?.as_scalar()?, to));
        }
        if self.declared.family == Family::S7 && (from == E::Date || to == E::Date) {
            return self.days_of_s7(value, from, to);
        }
        if temporal(from) {
            let count = value.as_integer()?.div_euclid(from.unit());
            if to == E::Bool {
                return Ok(Value::bool(count != 0));
            }
            return Ok(in_repr(Scalar::I64(wrapped(count)), to));
        }
        let wide = if from.is_real() { E::Lreal } else { E::Lint };
        let factor = in_repr(Scalar::I64(unit(to)), wide).as_scalar()?;
        let count = self.applied("MUL", wide, &[in_repr(value.as_scalar()?, wide).as_scalar()?, factor], span)?;
        at(to, i128::from(wrapped(in_repr(count.as_scalar()?, E::Lint).as_integer()?)))
    }

    /// A DATE of S7 as a number is the days since 1990-01-01 (S7-1200 System Manual, 11/2011, p. 89).
    fn days_of_s7(&self, value: &Value<'a>, from: E, to: E) -> Outcome<Value<'a>> {
        if from.is_real() || to.is_real() || to == E::Bool {
            return unknown("a DATE of S7 as a REAL or a BOOL");
        }
        let number = value.as_integer()?;
        if to == E::Date {
            return at(to, i128::from(START_OF_S7) + number * DAY);
        }
        let days = (number - i128::from(START_OF_S7)).div_euclid(DAY);
        Ok(in_repr(Scalar::I64(wrapped(days)), to))
    }

    /// `ADD_TOD_TIME`, `CONCAT_DATE`, `DAY_OF_WEEK`; `None` for another function.
    pub(crate) fn date_function(
        &mut self,
        frame: &Frame<'a>,
        name: &str,
        arguments: &'a [Argument<'a>],
        span: Span,
    ) -> Outcome<Option<Value<'a>>> {
        let operation = [("ADD_", BinaryOp::Add), ("SUB_", BinaryOp::Sub)];
        for (prefix, op) in operation {
            if let Some((a, b)) = name.strip_prefix(prefix).and_then(|it| it.split_once('_'))
                && let (Some(a), Some(b)) = (E::named(a), E::named(b))
            {
                let types = [("IN1", Some(a)), ("IN2", Some(b))];
                let values = self.given(frame, &types, arguments)?;
                return self.operate(op, values[0].clone(), values[1].clone(), span, None).map(Some);
            }
        }
        let made = match name {
            "DAY_OF_WEEK" => {
                let values = self.given(frame, &[("IN", None)], arguments)?;
                // 1970-01-01 was a Thursday.
                let day = (values[0].as_integer()?.div_euclid(DAY) + 4).rem_euclid(7);
                return Ok(Some(Value::scalar(E::Int, E::Int.repr().integer(day).unwrap_or(Scalar::I16(0)))));
            }
            "CONCAT_DATE_TOD" | "CONCAT_DATE_LTOD" => {
                let (long, to) = if name.ends_with("LTOD") { (E::Ltod, E::Ldt) } else { (E::Tod, E::Dt) };
                let values = self.given(frame, &[("IN1", Some(E::Date)), ("IN2", Some(long))], arguments)?;
                let point = values[0].as_integer()? + values[1].as_integer()?;
                if i64::try_from(point).is_err() {
                    return Err(self.fault(FaultKind::NoSuchDate, span));
                }
                return Ok(Some(at(to, point)?));
            }
            "CONCAT_DATE" => E::Date,
            "CONCAT_TOD" => E::Tod,
            "CONCAT_LTOD" => E::Ltod,
            "CONCAT_DT" => E::Dt,
            "CONCAT_LDT" => E::Ldt,
            _ => return Ok(None),
        };
        let day = [("YEAR", None), ("MONTH", None), ("DAY", None)];
        let clock = [("HOUR", None), ("MINUTE", None), ("SECOND", None), ("MILLISECOND", None)];
        let names = match made {
            E::Date => day.to_vec(),
            E::Dt | E::Ldt => [day.as_slice(), clock.as_slice()].concat(),
            _ => clock.to_vec(),
        };
        let values = self.given(frame, &names, arguments)?;
        let numbers = values.iter().map(Value::as_integer).collect::<Outcome<Vec<_>>>()?;
        let nanoseconds = match made {
            E::Date => midnight(&numbers),
            E::Dt | E::Ldt => midnight(&numbers[..3]).and_then(|it| Some(it + since_midnight(&numbers[3..])?)),
            _ => since_midnight(&numbers),
        };
        match nanoseconds.and_then(|it| i64::try_from(it).ok()) {
            Some(it) => Ok(Some(Value::scalar(made, Scalar::I64(it)))),
            None => Err(self.fault(FaultKind::NoSuchDate, span)),
        }
    }

    /// The arguments of a function in the order of its parameters, evaluated as they are written.
    fn given(
        &mut self,
        frame: &Frame<'a>,
        parameters: &[(&str, Option<Elementary>)],
        arguments: &'a [Argument<'a>],
    ) -> Outcome<Vec<Value<'a>>> {
        let mut values: Vec<Option<Value<'a>>> = vec![None; parameters.len()];
        for argument in arguments.iter().filter(|it| !is_enable(it)) {
            let (at, expr): (_, &'a Expr<'a>) = match &argument.kind {
                ArgumentKind::Positional(expr) => (values.iter().position(Option::is_none), expr),
                ArgumentKind::Input(name, expr) => {
                    (parameters.iter().position(|it| it.0.eq_ignore_ascii_case(name.text)), expr)
                }
                ArgumentKind::Output { .. } => return unknown("an output of a function of dates"),
            };
            let Some(at) = at else { return unknown("this argument of a function of dates") };
            values[at] = Some(match parameters[at].1 {
                Some(ty) => self.value_as(frame, expr, &Type::Elementary(ty))?,
                None => self.value(frame, expr, None)?,
            });
        }
        values.into_iter().map(|it| it.map_or_else(|| unknown("a date without one of its parts"), Ok)).collect()
    }
}

pub(crate) fn unit(ty: Elementary) -> i64 {
    wrapped(ty.unit())
}

/// The low 64 bits.
fn wrapped(number: i128) -> i64 {
    let low = number.rem_euclid(1 << 64);
    let signed = if low >= 1 << 63 { low - (1 << 64) } else { low };
    i64::try_from(signed).unwrap_or(0)
}

/// What is at a number of nanoseconds: the midnight before it, the time of day then, or the point itself.
fn at<'a>(ty: Elementary, nanoseconds: i128) -> Outcome<Value<'a>> {
    let reached = match ty {
        E::Tod | E::Ltod => nanoseconds.rem_euclid(DAY),
        E::Date | E::Ldate => {
            let point = i128::from(wrapped(nanoseconds));
            let before = point - point.rem_euclid(DAY);
            // The first day that is reached starts after the first point in time.
            if i64::try_from(before).is_ok() { before } else { before + DAY }
        }
        _ => nanoseconds,
    };
    Ok(Value::scalar(ty, Scalar::I64(wrapped(reached))))
}

fn is_leap(year: i128) -> bool {
    year % 4 == 0 && (year % 100 != 0 || year % 400 == 0)
}

/// The first nanosecond of a day, counted year by year; `None` where the calendar has none.
fn midnight(numbers: &[i128]) -> Option<i128> {
    let [year, month, day] = *numbers else { return None };
    let before = *BEFORE_MONTH.get(usize::try_from(month.checked_sub(1)?).ok()?)?;
    let length = match month {
        2 => 28 + i128::from(is_leap(year)),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    if !(1..=length).contains(&day) || !(1600..2400).contains(&year) {
        return None;
    }
    let days = |year: i128| 365 + i128::from(is_leap(year));
    let years: i128 = if year < 1970 { -(year..1970).map(days).sum::<i128>() } else { (1970..year).map(days).sum() };
    Some((years + before + i128::from(month > 2 && is_leap(year)) + day - 1) * DAY)
}

fn since_midnight(numbers: &[i128]) -> Option<i128> {
    let [hour, minute, second, millisecond] = *numbers else { return None };
    let is_one = (0..24).contains(&hour)
        && (0..60).contains(&minute)
        && (0..60).contains(&second)
        && (0..1000).contains(&millisecond);
    is_one.then_some(((hour * 60 + minute) * 60 + second) * SECOND + millisecond * 1_000_000)
}
