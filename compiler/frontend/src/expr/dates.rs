//! Dates and times of day: what is added and subtracted, and the functions that make them of their
//! parts.

use super::checker::Checker;
use super::operator::{Sides, arithmetic_op};
use crate::names::functions::DateFunction;
use crate::{Code, Diagnostic, Span, ast};
use ast::BinaryOp;
use staunch_ir::{Conversion, Elementary, Expr, Op, Type, Value};

impl<'s> Checker<'_, 's> {
    /// Two of a kind give the TIME between them; what has a time of day and a TIME give another of its kind.
    pub(super) fn date_arithmetic(&mut self, sides: Sides) -> Option<Expr> {
        let (a, b) = (sides.a.ty().and_then(Type::elementary), sides.b.ty().and_then(Type::elementary));
        let adds_to_days = self.decl.dialect(sides.span).adds_times_to_days();
        let Some(result) = a.zip(b).and_then(|(a, b)| result_of(sides.op, a, b, adds_to_days)) else {
            self.report_operands(&sides, "a TIME is added to a TOD or DT; two of a kind are subtracted");
            return None;
        };
        let result = self.decl.dialect(sides.span).rules().own(result);
        let (op, op_span, span) = (arithmetic_op(sides.op), sides.op_span, sides.span);
        let mut number = |operand, span| {
            let value = self.side(operand, Elementary::Lint, span)?;
            Some(self.retyped(value, Type::LINT))
        };
        let (a, b) = (number(sides.a, sides.left)?, number(sides.b, sides.right)?);
        if let (Some(Value::I64(a)), Some(Value::I64(b))) = (a.as_const(), b.as_const()) {
            let sum = if op == Op::Add { a.checked_add(b) } else { a.checked_sub(b) };
            self.refuse_date_overflow(sum.is_none() && !result.is_time_of_day(), result, span)?;
        }
        let sum = self.apply(op, Type::LINT, vec![a, b], Type::LINT, op_span)?;
        self.as_time(sum, result, span)
    }

    fn refuse_date_overflow(&mut self, overflows: bool, result: Elementary, span: Span) -> Option<()> {
        if overflows && result.is_date_and_time() {
            let message = format!("this constant {} overflows", result.name());
            self.report(Diagnostic::new(Code::E0209, span, message).label("dates go from 1677-09-22 to 2262-04-11"));
            return None;
        }
        self.refuse_time_overflow(overflows, result, span)
    }

    /// Nanoseconds as a value of this type: a day is its midnight, a time of day less than a day.
    pub(super) fn as_time(&mut self, nanoseconds: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let settle = match to {
            _ if to.is_day() => Some(Op::StartOfDay),
            _ if to.is_time_of_day() => Some(Op::TimeOfDay),
            _ => None,
        };
        let settled = match settle {
            Some(op) => self.apply(op, Type::LINT, vec![nanoseconds], Type::LINT, span)?,
            None => nanoseconds,
        };
        let settled = self.retyped(settled, Type::Elementary(to));
        self.kept_duration(settled, span)
    }

    pub(super) fn date_function(
        &mut self,
        function: DateFunction,
        to: Elementary,
        operands: Vec<Expr>,
        span: Span,
    ) -> Option<Expr> {
        let mut numbers = Vec::new();
        for operand in operands {
            let how = if is_time(operand.ty) { Conversion::Same } else { Conversion::Value };
            numbers.push(self.convert(how, Type::LINT, operand));
        }
        let lint = match function {
            DateFunction::Concat => self.apply(Op::PointOf, Type::LINT, numbers, Type::LINT, span)?,
            DateFunction::Day => self.apply(Op::DayOf, Type::LINT, numbers, Type::LINT, span)?,
            DateFunction::Clock => self.apply(Op::ClockOf, Type::LINT, numbers, Type::LINT, span)?,
            DateFunction::Point => {
                let clock = numbers.split_off(3);
                let day = self.apply(Op::DayOf, Type::LINT, numbers, Type::LINT, span)?;
                let clock = self.apply(Op::ClockOf, Type::LINT, clock, Type::LINT, span)?;
                self.apply(Op::PointOf, Type::LINT, vec![day, clock], Type::LINT, span)?
            }
            DateFunction::Weekday => {
                let day = self.apply(Op::Weekday, Type::LINT, numbers, Type::LINT, span)?;
                return Some(self.convert(Conversion::Value, Type::Elementary(to), day));
            }
        };
        Some(self.convert(Conversion::Same, Type::Elementary(to), lint))
    }
}

fn is_time(ty: Type) -> bool {
    ty.elementary().is_some_and(Elementary::is_time)
}

/// The type that a sum or difference has; long if one side is.
fn result_of(op: BinaryOp, a: Elementary, b: Elementary, adds_to_days: bool) -> Option<Elementary> {
    let is_long = [a, b].into_iter().any(|it| it.name().starts_with('L'));
    let of = |short, long| Some(if is_long { long } else { short });
    let between = |is: fn(Elementary) -> bool| is(a) && is(b);
    match op {
        BinaryOp::Add | BinaryOp::Sub if a.is_time_of_day() && b.is_duration() => of(Elementary::Tod, Elementary::Ltod),
        BinaryOp::Add | BinaryOp::Sub if a.is_date_and_time() && b.is_duration() => of(Elementary::Dt, Elementary::Ldt),
        BinaryOp::Add if adds_to_days && a.is_day() && b.is_duration() => of(Elementary::Date, Elementary::Ldate),
        BinaryOp::Sub
            if between(Elementary::is_day)
                || between(Elementary::is_time_of_day)
                || between(Elementary::is_date_and_time) =>
        {
            of(Elementary::Time, Elementary::Ltime)
        }
        _ => None,
    }
}
