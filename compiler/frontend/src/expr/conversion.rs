//! Conversion functions: `INT_TO_REAL`, `TO_REAL`, `REAL_TRUNC_DINT`, `TRUNC`.

use super::checker::Checker;
use super::operand::Operand;
use crate::dialect::rules::{DateAsNumber, Functions, Halves, TimeAsNumber, ToBool};
use crate::names::functions::{self, Converted, How, Rounding};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Chars, Conversion, Elementary, Expr, Op, Type, Value};
use staunch_runtime::time::{DAY, MILLISECOND, SECOND};
use staunch_runtime::{Class, Time};

impl<'s> Checker<'_, 's> {
    pub(crate) fn conversion(
        &mut self,
        parsed: functions::Conversion,
        value: &ast::Expr<'s>,
        name: ast::Name<'s>,
    ) -> Option<Expr> {
        let value_expr = match parsed.from {
            Some(Converted::Elementary(from)) => {
                let from = self.decl.dialect(name.span).rules().own(from);
                self.value_converted(value, from)?
            }
            Some(Converted::Text { wide }) => self.text(value, Some(wide), name)?,
            None if self.is_character(value, parsed.to) => self.value(value, Type::Elementary(Elementary::Char))?,
            None => {
                let given = self.typed(value, None)?;
                self.address_as_number(given, value.span)
            }
        };
        let to = match parsed.to {
            Converted::Elementary(to) => self.decl.dialect(name.span).rules().own(to),
            Converted::Text { wide } => {
                let value_expr = self.plain_bool_as_number(value_expr, value);
                return self.text_of(value_expr, wide, value.span, name);
            }
        };
        match parsed.how {
            How::Value => {}
            How::Rounds(how) => return self.round(value_expr, how, to, value.span, name),
            How::FromBcd => return self.decimal(Op::FromBcd, Class::Bit, value_expr, to, value.span, name),
            How::ToBcd => return self.decimal(Op::ToBcd, Class::Unsigned, value_expr, to, value.span, name),
        }
        if to == Elementary::Bool && self.is_pointer_in_strucpp(value) {
            return Some(Expr::constant(Elementary::Bool, Value::Bool(true), value_expr.at));
        }
        if let Type::String(_) = value_expr.ty {
            return self.value_of_text(value_expr, to, name.span);
        }
        let (number, from) = self.as_elementary(value_expr, value.span, name)?;
        self.between(number, from, to, name.span)
    }

    /// What `UDINT_TO_INT` is given. In CODESYS what is computed of integers keeps the low bits of a UDINT, where it is
    /// computed at a greater width.
    fn value_converted(&mut self, value: &ast::Expr<'s>, from: Elementary) -> Option<Expr> {
        let is_computed = matches!(value.bare().kind, ast::ExprKind::Binary(..) | ast::ExprKind::Unary(..));
        let ty = Type::Elementary(from);
        if self.has_functions_of_strucpp(value.span) {
            // All of STruC++'s are templates, which take a number at the type that it was computed at, whatever their names say.
            let is_number = |it: Elementary| it.is_real() || it.is_integer() || it.is_bits();
            let is_given = |it: Elementary| it != Elementary::Bool && is_number(it);
            return match self.operand(value, Some(ty))? {
                Operand::Typed(given) | Operand::Promoted(given, _)
                    if is_number(from) && given.ty.elementary().is_some_and(is_given) =>
                {
                    Some(given)
                }
                other => self.coerce(other, ty, value.span),
            };
        }
        if !is_computed || !from.is_integer() || !self.decl.dialect(value.span).binds_by_assignment() {
            return self.value(value, ty);
        }
        let operand = self.operand(value, Some(ty))?;
        let is_wide =
            |it: &Expr| it.ty.elementary().is_some_and(|it| it.is_integer() && it.repr().size() > from.repr().size());
        match operand.typed().filter(|it| is_wide(it)).cloned() {
            Some(wide) => Some(self.convert(Conversion::Value, ty, wide)),
            None => self.coerce(operand, ty, value.span),
        }
    }

    /// An address counts as an integer in CODESYS.
    fn address_as_number(&mut self, value: Expr, span: Span) -> Expr {
        let counts = matches!(value.ty, Type::Reference(_)) && self.decl.interface_of(value.ty).is_none();
        match counts && self.decl.dialect(span).binds_by_assignment() {
            true => self.address_bits(value),
            false => value,
        }
    }

    /// Whether what `TO_x` is given is one character, whose number is meant: SIMATIC AX converts no texts to numbers.
    fn is_character(&self, value: &ast::Expr<'s>, to: Converted) -> bool {
        let counts = matches!(to, Converted::Elementary(it) if it.is_integral() && it != Elementary::Bool);
        let is_one = |it: &Chars| matches!(it, Chars::Narrow(bytes) if bytes.len() == 1);
        counts
            && self.decl.dialect(value.span).takes_literals_as_characters()
            && matches!(&value.bare().kind, ast::ExprKind::Literal(ast::Literal { prefix: None, value: ast::LiteralValue::String(it) }) if is_one(it))
    }

    /// What is converted as a value of an elementary type: an enumeration's is its number.
    pub(super) fn as_elementary(&mut self, value: Expr, span: Span, name: ast::Name<'s>) -> Option<(Expr, Elementary)> {
        match value.ty {
            Type::Elementary(from) => Some((value, from)),
            Type::Enum(id) => {
                let base = self.decl.program.enumeration(id).base;
                Some((self.convert(Conversion::Same, Type::Elementary(base), value), base))
            }
            other => {
                let found = self.type_name(other);
                self.report(
                    Diagnostic::new(Code::E0204, span, format!("`{}` does not take {found}", name.text))
                        .label(format!("this is {found}")),
                );
                None
            }
        }
    }

    /// What a TIME carries and numbers meet at the unit in which such numbers count.
    pub(super) fn between(&mut self, value: Expr, from: Elementary, to: Elementary, span: Span) -> Option<Expr> {
        let target = Type::Elementary(to);
        let rules = self.decl.dialect(span).rules();
        self.note_conversion(value.ty, target, span);
        if from.is_char() || to.is_char() {
            return self.character_and_number(value, from, to, span);
        }
        match (from.counted_in(), to.counted_in()) {
            (Some(_), Some(_)) if is_the_same(from, to) && (from == to || to != Elementary::Time) => {
                Some(self.retyped(value, target))
            }
            (Some(_), Some(_)) if from == Elementary::Ultime && to == Elementary::Time => self.shortened(value, span),
            (Some(_), Some(_)) => {
                let nanoseconds = self.retyped(value, Type::LINT);
                self.as_time(nanoseconds, to, span)
            }
            (None, None) if to == Elementary::Bool && from.is_real() && rules.rounds_by_c() => {
                let whole = self.apply(Op::AwayFromZero, value.ty, vec![value], Type::LREAL, span)?;
                Some(self.convert(Conversion::Value, Type::BOOL, whole))
            }
            (None, None) if to == Elementary::Bool => self.truth(value, from, span),
            (None, None) if are_the_same_bits(from, to) && rules.copies_bits() => {
                Some(self.convert(Conversion::Bits, target, value))
            }
            (None, None) if from.is_real() && !to.is_real() && rules.rounds_to_lint() => {
                let op = if to.repr().is_unsigned() { Op::RoundToUlint } else { Op::RoundToLint };
                let lint = self.apply(op, value.ty, vec![value], Type::LINT, span)?;
                Some(self.convert(Conversion::Value, target, lint))
            }
            (None, None) if from.is_real() && !to.is_real() && rules.rounds_by_c() => {
                let whole = self.apply(Op::AwayFromZero, value.ty, vec![value], Type::LREAL, span)?;
                let lint = self.apply(truncated_by(to), Type::LREAL, vec![whole], Type::LINT, span)?;
                Some(self.convert(Conversion::Value, target, lint))
            }
            (None, None) => self.number_as(value, to, span),
            (Some(_), None) if rules.time_is_seconds() => self.seconds(value, to, span),
            (None, Some(_)) if rules.time_is_seconds() => self.time_of_seconds(value, from, to, span),
            (Some(_), None)
                if to == Elementary::Bool
                    && from.is_duration()
                    && rules.time_as_number.choice != TimeAsNumber::CutMilliseconds =>
            {
                let nanoseconds = self.nanoseconds_of(value);
                Some(self.convert(Conversion::Value, Type::BOOL, nanoseconds))
            }
            (Some(unit), None) => {
                let (unit, since) = self.counted_by(from, unit, span);
                let nanoseconds = self.nanoseconds_of(value);
                let nanoseconds = self.since_epoch(Op::Sub, nanoseconds, since, span)?;
                let real = to.is_real() && rules.time_as_number.choice != TimeAsNumber::CutMilliseconds;
                let count = self.scaled_by(Op::Div, nanoseconds, unit, real, span)?;
                Some(self.convert(Conversion::Value, target, count))
            }
            (None, Some(_)) if to == Elementary::Ultime => {
                let nanoseconds = self.number_as(value, Elementary::Ulint, span)?;
                Some(self.convert(Conversion::Same, target, nanoseconds))
            }
            (None, Some(unit)) => {
                let (unit, since) = self.counts_from(to, unit, span);
                let real = from.is_real() && rules.time_as_number.choice == TimeAsNumber::Milliseconds;
                let wide = match rules.time_as_number.choice {
                    _ if real => self.number_as(value, Elementary::Lreal, span)?,
                    TimeAsNumber::CutMilliseconds if from.is_real() => {
                        self.apply(Op::TruncLint, value.ty, vec![value], Type::LINT, span)?
                    }
                    _ => self.number_as(value, Elementary::Lint, span)?,
                };
                if to == Elementary::Time && !real {
                    return self.time_of_count(wide, span);
                }
                let nanoseconds = self.scaled_by(Op::Mul, wide, unit, real, span)?;
                let count = self.convert(Conversion::Value, Type::LINT, nanoseconds);
                let count = self.since_epoch(Op::Add, count, since, span)?;
                self.as_time(count, to, span)
            }
        }
    }

    /// What a number counts that becomes `ty`, and the point in time that it counts from.
    fn counts_from(&self, ty: Elementary, unit: Time, span: Span) -> (Time, Time) {
        match (self.decl.dialect(span).rules().date_as_number.choice, ty) {
            (DateAsNumber::DaysSince1990, Elementary::Date) => (DAY, staunch_runtime::time::date(1990, 1, 1)),
            (DateAsNumber::AsStored, Elementary::Date) => (DAY, 0),
            (_, Elementary::Time) => (self.decl.dialect(span).rules().time_count().map_or(unit, |it| it.unit), 0),
            (DateAsNumber::AsStored, Elementary::Tod | Elementary::Dt) => (1, 0),
            _ => (unit, 0),
        }
    }

    /// The same of the number that `ty` becomes.
    fn counted_by(&self, ty: Elementary, unit: Time, span: Span) -> (Time, Time) {
        match (self.decl.dialect(span).rules().date_as_number.choice, ty) {
            (DateAsNumber::AsStored, Elementary::Tod | Elementary::Dt) => (MILLISECOND, 0),
            _ => self.counts_from(ty, unit, span),
        }
    }

    /// What STruC++ keeps of a TIME or a point in time, which is what it writes as text.
    pub(super) fn stored_count(&mut self, value: Expr, ty: Elementary, span: Span) -> Option<Expr> {
        let nanoseconds = self.convert(Conversion::Same, Type::LINT, value);
        match ty {
            Elementary::Date => self.scaled_by(Op::Div, nanoseconds, DAY, false, span),
            _ => Some(nanoseconds),
        }
    }

    fn since_epoch(&mut self, op: Op, value: Expr, by: Time, span: Span) -> Option<Expr> {
        if by == 0 {
            return Some(value);
        }
        let by = Expr::constant(Elementary::Lint, Value::I64(by), value.at);
        self.apply(op, Type::LINT, vec![value, by], Type::LINT, span)
    }

    /// A number as one of another type. A real becomes an integer as the dialect rounds halves, and cuts what the type does
    /// not hold.
    pub(super) fn number_as(&mut self, value: Expr, to: Elementary, span: Span) -> Option<Expr> {
        self.note_conversion(value.ty, Type::Elementary(to), span);
        let is_real = value.ty.elementary().is_some_and(Elementary::is_real);
        let rules = self.decl.dialect(span).rules();
        let is_cut = is_real && to.is_integral() && to != Elementary::Bool && rules.keeps_low_bits();
        let value = match (is_cut, rules.halves.choice) {
            (false, _) => value,
            (true, Halves::ToEven) => self.apply(Op::BitsOfNearest, value.ty, vec![value], Type::LINT, span)?,
            (true, Halves::AwayFromZero) => self.apply(Op::BitsOfHalfAway, value.ty, vec![value], Type::LINT, span)?,
        };
        Some(self.convert(Conversion::Value, Type::Elementary(to), value))
    }

    /// A TIME, or a point in time, as its seconds: whole ones, or with a fraction as a real. A BOOL is whether it is not 0.
    fn seconds(&mut self, value: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let nanoseconds = self.convert(Conversion::Same, Type::LINT, value);
        if to == Elementary::Bool {
            return Some(self.convert(Conversion::Value, Type::BOOL, nanoseconds));
        }
        let count = match to.is_real() {
            true => self.apply(Op::SecondsOf, Type::LINT, vec![nanoseconds], Type::LREAL, span)?,
            false => {
                let second = Expr::constant(Elementary::Lint, Value::I64(SECOND), nanoseconds.at);
                self.apply(Op::Div, Type::LINT, vec![nanoseconds, second], Type::LINT, span)?
            }
        };
        Some(self.convert(Conversion::Value, Type::Elementary(to), count))
    }

    /// Seconds, of which 32 bits are kept, as a TIME or a point in time.
    fn time_of_seconds(&mut self, value: Expr, from: Elementary, to: Elementary, span: Span) -> Option<Expr> {
        let nanoseconds = if from.is_real() {
            self.apply(Op::TimeOfSeconds, value.ty, vec![value], Type::LINT, span)?
        } else {
            let seconds = self.convert(Conversion::Value, Type::DINT, value);
            let seconds = self.convert(Conversion::Value, Type::LINT, seconds);
            self.scaled_by(Op::Mul, seconds, SECOND, false, span)?
        };
        self.as_time(nanoseconds, to, span)
    }

    /// A number as a BOOL, as the dialect's rule for its class says; a real is TRUE where it is not 0.
    fn truth(&mut self, value: Expr, from: Elementary, span: Span) -> Option<Expr> {
        let rules = self.decl.dialect(span).rules();
        let rule = if from.is_bits() { rules.bits_to_bool } else { rules.integer_to_bool };
        let one = from.repr().integer(1).filter(|_| from != Elementary::Bool && rule.choice == ToBool::RightmostBit);
        let number = match one {
            Some(one) => {
                let (ty, one) = (value.ty, Expr::constant(from, one, value.at));
                self.apply(Op::And, ty, vec![value, one], ty, span)?
            }
            None => value,
        };
        Some(self.convert(Conversion::Value, Type::BOOL, number))
    }

    /// Nanoseconds to a unit or back, in LREAL where fractions matter, else in LINT.
    pub(super) fn scaled_by(&mut self, op: Op, value: Expr, unit: Time, real: bool, span: Span) -> Option<Expr> {
        let at = value.at;
        if real {
            let value = self.convert(Conversion::Value, Type::LREAL, value);
            if unit == 1 {
                return Some(value);
            }
            let factor = staunch_runtime::ops::convert::<i64, f64>(unit);
            let factor = Expr::constant(Elementary::Lreal, Value::F64(factor), at);
            return self.apply(op, Type::LREAL, vec![value, factor], Type::LREAL, span);
        }
        if unit == 1 {
            return Some(value);
        }
        let factor = Expr::constant(Elementary::Lint, Value::I64(unit), at);
        let op = if op == Op::Div && unit == SECOND { Op::WholeUnits } else { op };
        self.apply(op, Type::LINT, vec![value, factor], Type::LINT, span)
    }

    /// Decimal digits of four bits each to their number, or back: what is more than `to` holds is cut.
    fn decimal(
        &mut self,
        op: Op,
        class: Class,
        value: Expr,
        to: Elementary,
        span: Span,
        name: ast::Name<'s>,
    ) -> Option<Expr> {
        if value.ty == Type::BOOL || !self.admits(class, value.ty, span) {
            let wanted = if class == Class::Bit { "a bit string of digits" } else { "an unsigned integer" };
            let found = self.type_name(value.ty);
            let message = format!("`{}` takes {wanted}, but this is {found}", name.text);
            self.report(Diagnostic::new(Code::E0204, span, message).label(format!("this is {found}")));
            return None;
        }
        let wide = self.convert(Conversion::Value, Type::LINT, value);
        let matiec = self.decl.dialect(span).rules().functions.choice == Functions::OfMatiec;
        let op = match op {
            Op::ToBcd if matiec => Op::BcdOf,
            Op::FromBcd if matiec => Op::OfBcdOrZero,
            op => op,
        };
        let made = self.apply(op, Type::LINT, vec![wide], Type::LINT, span)?;
        Some(self.convert(Conversion::Value, Type::Elementary(to), made))
    }

    /// `TRUNC(x)`, `ROUND(x)`: to the integer type that its place asks for, DINT without one.
    pub(crate) fn round_as_asked(
        &mut self,
        value: &ast::Expr<'s>,
        how: Rounding,
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Expr> {
        let to = match expected {
            Some(Type::Elementary(it)) if it.is_integer() => it,
            _ => Elementary::Dint,
        };
        let number = self.typed(value, None)?;
        let is_whole = matches!(number.ty, Type::Elementary(it) if it.is_integer());
        if is_whole && self.decl.dialect(name.span).truncates_integers() {
            return Some(self.convert(Conversion::Value, Type::Elementary(to), number));
        }
        self.round(number, how, to, value.span, name)
    }

    fn round(&mut self, value: Expr, how: Rounding, to: Elementary, span: Span, name: ast::Name<'s>) -> Option<Expr> {
        let from = value.ty;
        if !matches!(from, Type::Elementary(it) if it.is_real()) {
            let found = self.type_name(from);
            self.report(
                Diagnostic::new(
                    Code::E0204,
                    span,
                    format!("`{}` takes a REAL or LREAL, but this is {found}", name.text),
                )
                .label(format!("this is {found}")),
            );
            return None;
        }
        self.note_conversion(from, Type::Elementary(to), name.span);
        let low_bits = self.decl.dialect(name.span).rules().keeps_low_bits();
        let rules = self.decl.dialect(name.span).rules();
        if how == Rounding::ToZero && (rules.functions.choice == Functions::OfMatiec || rules.rounds_by_c()) {
            let lint = self.apply(truncated_by(to), from, vec![value], Type::LINT, name.span)?;
            return Some(self.convert(Conversion::Value, Type::Elementary(to), lint));
        }
        let op = match how {
            Rounding::ToZero if low_bits => {
                let whole = self.apply(Op::BitsOfWhole, from, vec![value], Type::LINT, span)?;
                return Some(self.convert(Conversion::Value, Type::Elementary(to), whole));
            }
            Rounding::ToZero => return Some(self.convert(Conversion::Truncate, Type::Elementary(to), value)),
            Rounding::ToEven => Op::Nearest,
            Rounding::Up => Op::Ceil,
            Rounding::Down => Op::Floor,
        };
        let whole = self.apply(op, from, vec![value], from, span)?;
        self.number_as(whole, to, span)
    }
}

/// By which conversion x86-64 cuts a real to a type.
pub(super) fn truncated_by(to: Elementary) -> Op {
    match (to.repr().size(), to.repr().is_unsigned()) {
        (8, true) => Op::TruncUlint,
        (8, false) | (4, true) => Op::TruncLint,
        _ => Op::TruncDint,
    }
}

/// A real and a bit string of its size.
fn are_the_same_bits(from: Elementary, to: Elementary) -> bool {
    let pairs = [(Elementary::Real, Elementary::Dword), (Elementary::Lreal, Elementary::Lword)];
    pairs.iter().any(|it| *it == (from, to) || *it == (to, from))
}

/// Whether every value of the one is a value of the other, where a [`Time`] carries both.
fn is_the_same(from: Elementary, to: Elementary) -> bool {
    from == to
        || from.is_day() && to.is_day()
        || from.is_time_of_day() && to.is_time_of_day()
        || !to.is_day() && !to.is_time_of_day()
}
