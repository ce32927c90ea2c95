//! Durations: their sums, what they are multiplied and divided by, and the number that the dialect keeps of a TIME.

use super::checker::Checker;
use super::operand::Operand;
use super::operator::{Meeting, Sides, arithmetic_op};
use crate::dialect::rules::TimeAsNumber;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Conversion, Elementary, Expr, Op, Part, Type, Use, Value};
use staunch_runtime::Time;
use staunch_runtime::literal::LiteralErrorKind;
use staunch_runtime::time::MILLISECOND;

const REAL: Type = Type::Elementary(Elementary::Real);

impl Checker<'_, '_> {
    pub(super) fn add_times(&mut self, sides: Sides) -> Option<Expr> {
        let op = arithmetic_op(sides.op);
        let (op_span, span) = (sides.op_span, sides.span);
        let Meeting { ty, a, b, .. } = self.meet(sides, |ty, _| ty.is_duration(), "both sides need to be times")?;
        let compute = if op == Op::Add { i128::checked_add } else { i128::checked_sub };
        self.refuse_overflow([&a, &b], compute, span)?;
        if self.decl.dialect(span).rules().time_is_seconds() {
            let op = if op == Op::Add { Op::TimePlus } else { Op::TimeMinus };
            let [a, b] = [a, b].map(|it| self.convert(Conversion::Same, Type::LINT, it));
            let sum = self.apply(op, Type::LINT, vec![a, b], Type::LINT, op_span)?;
            return Some(self.convert(Conversion::Same, ty, sum));
        }
        let sum = self.apply(op, ty, vec![a, b], ty, op_span)?;
        self.kept_duration(sum, op_span)
    }

    /// Reports a constant that its type does not hold in the dialect.
    fn refuse_overflow(
        &mut self,
        [duration, other]: [&Expr; 2],
        compute: fn(i128, i128) -> Option<i128>,
        span: Span,
    ) -> Option<()> {
        let number = |it: &Expr| it.as_const().and_then(Value::as_integer);
        let (Some(ty), Some(a), Some(b)) = (duration.ty.elementary(), number(duration), number(other)) else {
            return Some(());
        };
        let limits = self.decl.dialect(span).rules().limits(ty)?;
        let is_held = compute(a, b).is_some_and(|it| (limits.0..=limits.1).contains(&it));
        self.refuse_time_overflow(!is_held, ty, span)
    }

    pub(super) fn refuse_time_overflow(&mut self, overflows: bool, ty: Elementary, span: Span) -> Option<()> {
        if overflows {
            let message = format!("this constant {} overflows", ty.name());
            let label = self.limits_in_words(ty, span)?;
            self.report(Diagnostic::new(Code::E0209, span, message).label(label));
            return None;
        }
        Some(())
    }

    /// Which durations a type has.
    fn limits_in_words(&self, ty: Elementary, span: Span) -> Option<String> {
        let rules = self.decl.dialect(span).rules();
        let (least, greatest) = rules.limits(ty)?;
        let count = rules.time_count().filter(|_| ty == Elementary::Time);
        let unit = count.map_or_else(String::new, |it| format!("whole {}, ", it.words));
        Some(format!("{} holds {unit}{} to {} in this dialect", ty.name(), spelled(ty, least), spelled(ty, greatest)))
    }

    /// TIME `*` or `/` a number. An integer counts exactly, a real through LREAL; in OpenPLC from v4.1 on at its own type, and
    /// what is less than a nanosecond is cut.
    pub(super) fn scale_time(&mut self, sides: Sides) -> Option<Expr> {
        let by_integer = match sides.b.ty() {
            None => matches!(sides.b, Operand::Integer(_)),
            Some(Type::Elementary(it)) if it.is_integer() => true,
            Some(Type::Elementary(it)) if self.counts_as_integer(it, sides.span) => true,
            Some(Type::Elementary(it)) if it.is_real() => false,
            Some(_) => {
                self.report_operands(&sides, "a TIME is multiplied or divided by a number");
                return None;
            }
        };
        if self.decl.dialect(sides.span).rules().time_is_seconds() {
            return self.scale_seconds(sides);
        }
        if !by_integer {
            self.note_use(Use::Part(Part::TimeByReal), sides.op_span);
        }
        if by_integer { self.scale_by_integer(sides) } else { self.scale_by_real(sides) }
    }

    fn counts_as_integer(&self, ty: Elementary, span: Span) -> bool {
        self.decl.dialect(span).mixes_bits_and_integers() && ty.is_bits() && ty != Elementary::Bool
    }

    fn scale_seconds(&mut self, sides: Sides) -> Option<Expr> {
        let Operand::Typed(time) = sides.a else { return None };
        let ty = time.ty;
        let op = if arithmetic_op(sides.op) == Op::Mul { Op::TimeTimes } else { Op::TimeOver };
        let factor = self.side(sides.b, Elementary::Lreal, sides.right)?;
        let lint = self.convert(Conversion::Same, Type::LINT, time);
        let scaled = self.apply(op, Type::LINT, vec![lint, factor], Type::LINT, sides.op_span)?;
        Some(self.convert(Conversion::Same, ty, scaled))
    }

    fn scale_by_integer(&mut self, sides: Sides) -> Option<Expr> {
        let Operand::Typed(time) = sides.a else { return None };
        let (ty, op, op_span) = (time.ty, arithmetic_op(sides.op), sides.op_span);
        let count = match (sides.b.ty(), op) {
            // A quotient by more than a LINT holds is nothing.
            (Some(Type::Elementary(Elementary::Ulint)), Op::Div) if ty != Type::Elementary(Elementary::Ultime) => {
                let count = self.side(sides.b, Elementary::Ulint, sides.right)?;
                let held = self.signed_duration(count, op_span)?;
                self.convert(Conversion::Same, Type::LINT, held)
            }
            _ => self.side(sides.b, Elementary::Lint, sides.right)?,
        };
        if op == Op::Mul {
            self.refuse_overflow([&time, &count], i128::checked_mul, sides.span)?;
        }
        if ty == Type::TIME
            && let Some(counted) = self.decl.dialect(op_span).rules().time_count()
        {
            let nanoseconds = self.convert(Conversion::Same, Type::LINT, time);
            let units = self.scaled_by(Op::Div, nanoseconds, counted.unit, false, op_span)?;
            let scaled = self.apply(op, Type::LINT, vec![units, count], Type::LINT, op_span)?;
            return self.time_of_count(scaled, op_span);
        }
        let count = self.retyped(count, ty);
        self.apply(op, ty, vec![time, count], ty, op_span)
    }

    fn scale_by_real(&mut self, sides: Sides) -> Option<Expr> {
        let Operand::Typed(time) = sides.a else { return None };
        let (ty, op, op_span) = (time.ty, arithmetic_op(sides.op), sides.op_span);
        let cuts = self.decl.dialect(sides.span).rules().time_as_number.choice == TimeAsNumber::CutMilliseconds;
        let at_real = cuts && sides.b.computed_at() == Some(REAL);
        let computed = if at_real { Elementary::Real } else { Elementary::Lreal };
        let factor = self.side(sides.b, computed, sides.right)?;
        let computed = Type::Elementary(computed);
        let number = self.nanoseconds_of(time);
        let counted = number.ty;
        let time = self.convert(Conversion::Value, computed, number);
        let scaled = self.apply(op, computed, vec![time, factor], computed, op_span)?;
        let number = match cuts {
            true => self.apply(Op::TruncLint, computed, vec![scaled], Type::LINT, op_span)?,
            false if ty == Type::Elementary(Elementary::Ultime) => {
                self.number_as(scaled, Elementary::Ulint, op_span)?
            }
            false => self.convert(Conversion::Value, counted, scaled),
        };
        let scaled = self.convert(Conversion::Same, ty, number);
        self.kept_duration(scaled, op_span)
    }

    /// What the dialect keeps of a duration: of a TIME the number of its units, where it is one.
    pub(super) fn kept_duration(&mut self, duration: Expr, span: Span) -> Option<Expr> {
        let counted = self.decl.dialect(span).rules().time_count();
        let Some(counted) = counted.filter(|_| duration.ty == Type::TIME) else { return Some(duration) };
        let nanoseconds = self.convert(Conversion::Same, Type::LINT, duration);
        let units = self.scaled_by(Op::Div, nanoseconds, counted.unit, false, span)?;
        self.time_of_count(units, span)
    }

    /// The same bits as another type.
    pub(super) fn retyped(&mut self, value: Expr, ty: Type) -> Expr {
        let program = &self.decl.program;
        let how = if program.repr(value.ty) == program.repr(ty) { Conversion::Same } else { Conversion::Value };
        self.convert(how, ty, value)
    }

    /// The number of nanoseconds that a TIME or a point in time is.
    pub(super) fn nanoseconds_of(&mut self, time: Expr) -> Expr {
        let number = time.ty.elementary().map_or(Elementary::Lint, |it| Elementary::number(it.repr()));
        self.convert(Conversion::Same, Type::Elementary(number), time)
    }

    /// An LTIME without a sign as a TIME.
    pub(super) fn shortened(&mut self, long: Expr, span: Span) -> Option<Expr> {
        let nanoseconds = self.nanoseconds_of(long);
        let unit = self.decl.dialect(span).rules().time_count().map_or(MILLISECOND, |it| it.unit);
        let unit = Expr::constant(Elementary::Ulint, Value::U64(unit.unsigned_abs()), nanoseconds.at);
        let ulint = nanoseconds.ty;
        let units = self.apply(Op::Div, ulint, vec![nanoseconds, unit], ulint, span)?;
        let units = self.convert(Conversion::Value, Type::LINT, units);
        self.time_of_count(units, span)
    }

    /// An LTIME without a sign where one with a sign is taken, as the preset of a timer: 292 years at most.
    pub(super) fn signed_duration(&mut self, long: Expr, span: Span) -> Option<Expr> {
        let nanoseconds = self.nanoseconds_of(long);
        let greatest = Expr::constant(Elementary::Ulint, Value::U64(Time::MAX.unsigned_abs()), nanoseconds.at);
        let ulint = nanoseconds.ty;
        let held = self.apply(Op::Min, ulint, vec![nanoseconds, greatest], ulint, span)?;
        Some(self.convert(Conversion::Value, Type::Elementary(Elementary::Ltime), held))
    }

    /// What is as far below nothing as a duration is above it.
    pub(super) fn negative_duration(&mut self, duration: Expr, span: Span) -> Option<Expr> {
        let ty = duration.ty;
        if ty != Type::Elementary(Elementary::Ultime) {
            let negative = self.apply(Op::Neg, ty, vec![duration], ty, span)?;
            return self.kept_duration(negative, span);
        }
        let nothing = Expr::constant(Elementary::Ultime, Value::U64(0), duration.at);
        self.apply(Op::Sub, ty, vec![nothing, duration], ty, span)
    }

    /// A literal of a duration, as the dialect keeps it.
    pub(super) fn duration_literal(
        &mut self,
        ty: Elementary,
        nanoseconds: Time,
        span: Span,
    ) -> Option<(Elementary, Value)> {
        let kept = self.decl.dialect(span).rules().own(ty);
        if has_decimals(self.decl.log.sources.text(span)) {
            self.note_use(Use::Part(Part::ComparedTimes), span);
        }
        match (ty, kept) {
            (Elementary::Time, _) => self.refuse_unkept(nanoseconds, span)?,
            (Elementary::Ltime, Elementary::Ultime) if nanoseconds < 0 => {
                let message = format!("`{}` does not fit LTIME", self.decl.log.sources.text(span));
                let label = self.limits_in_words(Elementary::Ultime, span)?;
                self.report(Diagnostic::new(Code::E0202, span, message).label(label));
                return None;
            }
            (Elementary::Ultime, _) if self.decl.dialect(span).rules().own(Elementary::Ltime) != kept => {
                self.error(Code::E0006, span, LiteralErrorKind::DurationTooLong.text());
                return None;
            }
            _ => {}
        }
        let value =
            if kept == Elementary::Ultime { Value::U64(nanoseconds.cast_unsigned()) } else { Value::I64(nanoseconds) };
        Some((kept, value))
    }

    /// A LINT of milliseconds, or of the units that a TIME is a number of, as a TIME: what the dialect does not keep of it is cut off
    /// above.
    pub(super) fn time_of_count(&mut self, units: Expr, span: Span) -> Option<Expr> {
        let counted = self.decl.dialect(span).rules().time_count();
        let count = match counted {
            Some(counted) => {
                let kept = self.convert(Conversion::Value, Type::Elementary(counted.ty), units);
                self.convert(Conversion::Value, Type::LINT, kept)
            }
            None => units,
        };
        let unit = counted.map_or(MILLISECOND, |it| it.unit);
        let nanoseconds = self.scaled_by(Op::Mul, count, unit, false, span)?;
        Some(self.convert(Conversion::Same, Type::TIME, nanoseconds))
    }

    /// Reports a literal of a TIME that the dialect does not keep as it is.
    pub(super) fn refuse_unkept(&mut self, nanoseconds: Time, span: Span) -> Option<()> {
        let rules = self.decl.dialect(span).rules();
        let (least, greatest) = rules.limits(Elementary::Time)?;
        let is_whole = rules.time_count().is_none_or(|it| nanoseconds % it.unit == 0);
        if is_whole && (least..=greatest).contains(&i128::from(nanoseconds)) {
            return Some(());
        }
        let literal = self.decl.log.sources.text(span);
        let long = literal.split_once('#').map(|it| format!("LTIME#{}", it.1))?;
        let message = format!("`{literal}` does not fit TIME");
        let label = self.limits_in_words(Elementary::Time, span)?;
        let mut diagnostic = Diagnostic::new(Code::E0202, span, message).label(label);
        if nanoseconds >= 0 {
            diagnostic = diagnostic.help(format!("an LTIME holds it: declare one, and write `{long}`"));
        }
        self.report(diagnostic);
        None
    }
}

/// A number of nanoseconds as a literal of its type.
fn spelled(ty: Elementary, nanoseconds: i128) -> String {
    let bits = i64::try_from(nanoseconds).or_else(|_| u64::try_from(nanoseconds).map(u64::cast_signed));
    let mut text = String::new();
    // Writing to a String cannot fail.
    _ = staunch_runtime::format::time(&mut text, ty, bits.unwrap_or_default());
    text
}

/// Decimals of minutes, hours or days, as `T#1.15m`: a double does not hold most of them, whatever they come to in seconds.
fn has_decimals(literal: &str) -> bool {
    let unit = literal.trim_end_matches(|it: char| it.is_ascii_alphabetic()).len();
    let is_long = ["m", "h", "d"].iter().any(|it| literal[unit..].eq_ignore_ascii_case(it));
    is_long && literal.contains('.')
}
