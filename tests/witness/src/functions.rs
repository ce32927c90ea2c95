//! The standard's functions. Arguments are evaluated as they are written, then the function runs.

use crate::calls::is_enable;
use crate::dates::unit;
use crate::expressions::{Untyped, default_type, in_repr, literal_number, untyped};
use crate::machine::{Frame, Machine, Outcome, Stop, unknown};
use crate::operators::{kept_of, operator};
use crate::storage::{Cell, Value, integer_cell};
use crate::types::{Elementary, Type};
use staunch_frontend::Span;
use staunch_frontend::ast::{Argument, ArgumentKind, BinaryOp, Expr, ExprKind, Name};
use staunch_runtime::{Family, FaultKind, Value as Scalar, ops};

/// An argument, and the position of its parameter.
pub(crate) type Given<'a> = (usize, &'a Expr<'a>);

impl<'a> Machine<'a> {
    pub(crate) fn standard(
        &mut self,
        frame: &Frame<'a>,
        name: &Name<'a>,
        arguments: &'a [Argument<'a>],
        asked: Option<&Type<'a>>,
    ) -> Outcome<Value<'a>> {
        let upper = name.text.to_ascii_uppercase();
        let at = name.span;
        if arguments.iter().any(leads_to_a_part) {
            return unknown("when the target of an ENO is found among the arguments of this function");
        }
        if let Some(value) = self.reference_function(frame, &upper, arguments, at)? {
            return Ok(value);
        }
        if let Some(value) = self.date_function(frame, &upper, arguments, at)? {
            return Ok(value);
        }
        match upper.as_str() {
            "MOVE" => self.value(frame, self.only(arguments)?, asked),
            "TO_LITTLE_ENDIAN" | "FROM_LITTLE_ENDIAN" | "LITTLE_ENDIAN_TO" => {
                self.value(frame, self.only(arguments)?, asked)
            }
            "TO_BIG_ENDIAN" | "FROM_BIG_ENDIAN" | "BIG_ENDIAN_TO" => {
                let argument = self.only(arguments)?;
                let is_place = matches!(argument.kind, ExprKind::Name(_) | ExprKind::Member(..) | ExprKind::Index(..));
                if self.declared.family == Family::Codesys && !is_place {
                    return unknown("how many bytes a sum has");
                }
                turned(self.value(frame, argument, asked)?)
            }
            "NOT" => {
                let value = self.value(frame, self.only(arguments)?, asked)?;
                self.of_one("NOT", &value, at)
            }
            "ABS" => {
                let value = self.value(frame, self.only(arguments)?, asked)?;
                self.of_one("ABS", &value, at)
            }
            "SQRT" | "LN" | "LOG" | "EXP" | "SIN" | "COS" | "TAN" | "ASIN" | "ACOS" | "ATAN" => {
                let argument = self.only(arguments)?;
                let value = match untyped(argument) {
                    Some(_) => self.number(argument, default_type(Untyped::Real, asked))?,
                    None => self.value(frame, argument, asked)?,
                };
                let ty = value.ty.elementary().and_then(|it| it.meets(Elementary::Real)).unwrap_or(Elementary::Lreal);
                self.applied(&upper, ty, &[in_repr(value.as_scalar()?, ty).as_scalar()?], at)
            }
            "LOWER_BOUND" | "UPPER_BOUND" => self.bound_of(frame, &upper, &positions(&["ARR", "DIM"], arguments)?),
            "ASSERT" => {
                if self.value_as(frame, self.only(arguments)?, &Type::BOOL)?.as_bool()? {
                    return Ok(Value::bool(true));
                }
                Err(self.fault(FaultKind::AssertionFailed, at))
            }
            "ATAN2" => {
                let real = Type::Elementary(default_type(Untyped::Real, asked));
                let values = self.of_one_type(frame, &positions(&["Y", "X"], arguments)?, Some(&real))?;
                let ty = values
                    .iter()
                    .filter_map(|it| it.ty.elementary()?.meets(Elementary::Real))
                    .max_by_key(|it| it.repr().size());
                let ty = ty.unwrap_or(Elementary::Lreal);
                let operands: Outcome<Vec<Scalar>> =
                    values.iter().map(|it| in_repr(it.as_scalar()?, ty).as_scalar()).collect();
                self.applied("ATAN2", ty, &operands?, at)
            }
            "SHL" | "SHR" | "ROL" | "ROR" => self.shift(frame, &upper, &positions(&["IN", "N"], arguments)?, asked, at),
            "MAX" | "MIN" => self.extreme(frame, &upper, &positions(&["IN1", "IN2"], arguments)?, asked, at),
            "LIMIT" => self.limit(frame, &positions(&["MN", "IN", "MX"], arguments)?, asked, at),
            "SEL" => self.choice(frame, &positions(&["G", "IN0", "IN1"], arguments)?, asked, false, at),
            "MUX" => self.choice(frame, &positions(&["K", "IN0", "IN1"], arguments)?, asked, true, at),
            "LEN" | "FIND" | "LEFT" | "RIGHT" | "MID" | "CONCAT" | "INSERT" | "DELETE" | "REPLACE" => {
                self.text_function(frame, &upper, arguments)
            }
            "WLEN" | "WFIND" | "WLEFT" | "WRIGHT" | "WMID" | "WCONCAT" | "WINSERT" | "WDELETE" | "WREPLACE" => {
                self.text_function(frame, &upper[1..], arguments)
            }
            _ => match operator(&upper) {
                Some(op) => self.operator_function(frame, op, &positions(&["IN1", "IN2"], arguments)?, asked, at),
                None if typed(&upper).is_some() => self.typed_function(frame, &upper, arguments, at),
                None if !upper.contains("TO_") && !upper.contains("TRUNC") => unknown(&format!("the function {upper}")),
                None => self.conversion(frame, &upper, self.only(arguments)?, asked, at),
            },
        }
    }

    /// `ADD_DINT`: operands become the type that the name says.
    fn typed_function(
        &mut self,
        frame: &Frame<'a>,
        name: &str,
        arguments: &'a [Argument<'a>],
        at: Span,
    ) -> Outcome<Value<'a>> {
        let Some((op, ty)) = typed(name) else { return unknown("a typed function") };
        let mut values = Vec::new();
        for (position, expr) in positions(&["IN1", "IN2"], arguments)? {
            values.push((position, self.value_as(frame, expr, &Type::Elementary(ty))?));
        }
        values.sort_by_key(|it| it.0);
        let values: Vec<_> = values.into_iter().map(|it| it.1).collect();
        self.folded(op, values, at, None)
    }

    fn bound_of(&mut self, frame: &Frame<'a>, name: &str, given: &[Given<'a>]) -> Outcome<Value<'a>> {
        let (mut ty, mut dimension) = (None, 1);
        for (position, expr) in given {
            match position {
                0 => ty = Some(self.place(frame, expr)?.ty),
                _ => dimension = self.value(frame, expr, None)?.as_integer()?,
            }
        }
        for _ in 1..dimension {
            ty = match ty {
                Some(Type::Array(array)) => Some(array.element.ty.clone()),
                other => other,
            };
        }
        let Some(Type::Array(array)) = ty else { return unknown("a bound of something other than an array") };
        let number = if name == "LOWER_BOUND" { array.low } else { array.high };
        Ok(Value { ty: Type::Elementary(Elementary::Dint), cells: vec![integer_cell(Elementary::Dint, number)] })
    }

    fn only(&self, arguments: &'a [Argument<'a>]) -> Outcome<&'a Expr<'a>> {
        match positions(&["IN"], arguments)?.as_slice() {
            [(_, expr)] => Ok(expr),
            _ => unknown("a function of one argument with others"),
        }
    }

    fn of_one(&self, name: &str, value: &Value<'a>, at: Span) -> Outcome<Value<'a>> {
        let Some(ty) = value.ty.elementary() else { return unknown("this argument") };
        match name {
            "ABS" => self.computed(name, ty, &[value.as_scalar()?], at),
            _ => self.applied(name, ty, &[in_repr(value.as_scalar()?, ty).as_scalar()?], at),
        }
    }

    /// Arguments that have one type between them, in the order of the parameters.
    fn of_one_type(
        &mut self,
        frame: &Frame<'a>,
        given: &[Given<'a>],
        asked: Option<&Type<'a>>,
    ) -> Outcome<Vec<Value<'a>>> {
        let mut values: Vec<(usize, Option<Value<'a>>, &'a Expr<'a>)> = Vec::new();
        for (position, expr) in given {
            let value = if untyped(expr).is_some() { None } else { Some(self.value(frame, expr, asked)?) };
            values.push((*position, value, *expr));
        }
        values.sort_by_key(|it| it.0);
        let ty = self.common(&values, asked)?;
        let mut made = Vec::new();
        for (_, value, expr) in values {
            made.push(match (value, ty) {
                (Some(value), Some(ty)) if value.ty.elementary().is_some() => self.unstored(value.as_scalar()?, ty),
                (Some(value), _) => value,
                (None, Some(ty)) => self.number(expr, ty)?,
                (None, None) => return unknown("a number among others"),
            });
        }
        Ok(made)
    }

    fn extreme(
        &mut self,
        frame: &Frame<'a>,
        name: &str,
        given: &[Given<'a>],
        asked: Option<&Type<'a>>,
        at: Span,
    ) -> Outcome<Value<'a>> {
        let values = self.of_one_type(frame, given, asked)?;
        let mut values = values.into_iter();
        let Some(mut best) = values.next() else { return unknown("a function without arguments") };
        for value in values {
            let ty = value.ty.elementary().filter(|_| !value.is_text());
            best = match ty {
                Some(ty) => self.computed(name, ty, &[best.as_scalar()?, value.as_scalar()?], at)?,
                None if value.is_text() && best.is_text() => {
                    let order = value.as_text()?.cmp(&best.as_text()?);
                    let is_better = if name == "MAX" { order.is_gt() } else { order.is_lt() };
                    if is_better { value } else { best }
                }
                _ => return unknown("MAX of this type"),
            };
        }
        Ok(best)
    }

    fn limit(
        &mut self,
        frame: &Frame<'a>,
        given: &[Given<'a>],
        asked: Option<&Type<'a>>,
        at: Span,
    ) -> Outcome<Value<'a>> {
        let values = self.of_one_type(frame, given, asked)?;
        let [low, value, high] = values.as_slice() else { return unknown("LIMIT without three arguments") };
        let ty = value.ty.elementary().filter(|_| !values.iter().any(Value::is_text));
        match ty {
            Some(ty) => self.computed("LIMIT", ty, &[low.as_scalar()?, value.as_scalar()?, high.as_scalar()?], at),
            None => {
                // MIN(MAX(IN, MN), MX)
                let raised = if value.as_text()? < low.as_text()? { low } else { value };
                Ok(if raised.as_text()? > high.as_text()? { high.clone() } else { raised.clone() })
            }
        }
    }

    /// SEL and MUX: selector and inputs are evaluated in their turn, then one of them is chosen.
    fn choice(
        &mut self,
        frame: &Frame<'a>,
        given: &[Given<'a>],
        asked: Option<&Type<'a>>,
        by_number: bool,
        at: Span,
    ) -> Outcome<Value<'a>> {
        let Some(turn) = given.iter().position(|it| it.0 == 0) else { return unknown("no selector") };
        if self.declared.is_codesys() {
            return self.chosen(frame, given, asked, by_number, at);
        }
        let inputs = given.len() - 1;
        // What is written before the selector is evaluated before it.
        let mut evaluated = Vec::new();
        let mut selected = 0;
        for (number, (position, expr)) in given.iter().enumerate() {
            if number == turn && by_number {
                selected = usize::try_from(self.value(frame, expr, None)?.as_integer()?).unwrap_or(inputs);
            } else if number == turn {
                selected = usize::from(self.value_as(frame, expr, &Type::BOOL)?.as_bool()?);
            } else {
                let value = if untyped(expr).is_some() { None } else { Some(self.value(frame, expr, asked)?) };
                evaluated.push((*position, value, *expr));
            }
        }
        if selected >= inputs {
            return Err(self.fault(FaultKind::IndexOutOfRange, at));
        }
        self.selected(evaluated, selected, asked)
    }

    /// In CODESYS the selector is evaluated, then what it chooses; a number beyond the inputs takes the last.
    fn chosen(
        &mut self,
        frame: &Frame<'a>,
        given: &[Given<'a>],
        asked: Option<&Type<'a>>,
        by_number: bool,
        at: Span,
    ) -> Outcome<Value<'a>> {
        let Some((_, selector)) = given.iter().find(|it| it.0 == 0) else { return unknown("no selector") };
        let number = match by_number {
            true => self.value(frame, selector, None)?.as_integer()?,
            false => i128::from(self.value_as(frame, selector, &Type::BOOL)?.as_bool()?),
        };
        let Ok(number) = usize::try_from(number) else { return Err(self.fault(FaultKind::IndexOutOfRange, at)) };
        let selected = number.min(given.len() - 2);
        let mut evaluated = Vec::new();
        for (position, expr) in given.iter().filter(|it| it.0 > 0) {
            let value = match untyped(expr) {
                Some(_) => None,
                None if *position == selected + 1 => Some(self.value(frame, expr, asked)?),
                None => Some(self.tried(frame, expr, asked)?),
            };
            evaluated.push((*position, value, *expr));
        }
        self.selected(evaluated, selected, asked)
    }

    /// A value that only its type is asked of: what evaluating it does is undone.
    fn tried(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>, asked: Option<&Type<'a>>) -> Outcome<Value<'a>> {
        let before = self.memory.clone();
        let value = self.value(frame, expr, asked);
        self.memory = before;
        match value {
            Err(Stop::Fault(_)) => unknown("the type of an input that faults"),
            other => other,
        }
    }

    /// One of the inputs, at the type that all have in common.
    fn selected(
        &mut self,
        mut evaluated: Vec<(usize, Option<Value<'a>>, &'a Expr<'a>)>,
        selected: usize,
        asked: Option<&Type<'a>>,
    ) -> Outcome<Value<'a>> {
        evaluated.sort_by_key(|it| it.0);
        let ty = self.common(&evaluated, asked)?;
        let (_, value, expr) = evaluated.swap_remove(selected);
        match (value, ty) {
            (Some(value), Some(ty)) if value.ty.elementary().is_some() => Ok(self.unstored(value.as_scalar()?, ty)),
            (Some(value), _) => Ok(value),
            (None, Some(ty)) => self.number(expr, ty),
            (None, None) => unknown("a number among others"),
        }
    }

    fn shift(
        &mut self,
        frame: &Frame<'a>,
        name: &str,
        given: &[Given<'a>],
        asked: Option<&Type<'a>>,
        at: Span,
    ) -> Outcome<Value<'a>> {
        if self.is_codesys() && name.starts_with("RO") && given.iter().any(|it| it.0 == 0 && untyped(it.1).is_some()) {
            return unknown("ROL and ROR of a constant in CODESYS");
        }
        let mut value = None;
        let mut count = None;
        for (position, expr) in given {
            match position {
                0 => value = Some(self.value(frame, expr, asked)?),
                _ => count = Some(self.value_as(frame, expr, &Type::LINT)?),
            }
        }
        let (Some(value), Some(count)) = (value, count) else { return unknown("a shift without a count") };
        let Some(ty) = value.ty.elementary() else { return unknown("a shift of this type") };
        let value = in_repr(value.as_scalar()?, ty);
        if let ("SHR", false, (..0, _)) = (name, self.is_codesys(), ty.range()) {
            return unknown("SHR of a signed integer");
        }
        if let ("SHR", true, (..0, _)) = (name, self.is_codesys(), ty.range()) {
            // The sign is kept.
            let count = count.as_integer()?.clamp(0, 127);
            return Ok(Value { ty: value.ty.clone(), cells: vec![integer_cell(ty, value.as_integer()? >> count)] });
        }
        self.applied(name, ty, &[value.as_scalar()?, count.as_scalar()?], at)
    }

    /// `ADD(a, b, …)` is `a + b + …`; `GT(a, b, …)` holds when each is greater than the next.
    fn operator_function(
        &mut self,
        frame: &Frame<'a>,
        op: BinaryOp,
        given: &[Given<'a>],
        asked: Option<&Type<'a>>,
        at: Span,
    ) -> Outcome<Value<'a>> {
        let compares =
            matches!(op, BinaryOp::Lt | BinaryOp::Gt | BinaryOp::Le | BinaryOp::Ge | BinaryOp::Eq | BinaryOp::Ne);
        let times = given.iter().any(|it| untyped(it.1).is_none()) && matches!(op, BinaryOp::Mul | BinaryOp::Div);
        let values = if times && given.len() == 2 {
            let mut values = Vec::new();
            for (position, expr) in given {
                values.push((*position, self.value(frame, expr, asked)?));
            }
            values.sort_by_key(|it| it.0);
            values.into_iter().map(|it| it.1).collect()
        } else {
            self.of_one_type(frame, given, asked.filter(|_| !compares))?
        };
        self.folded(op, values, at, asked)
    }

    /// An operator between all values.
    fn folded(
        &mut self,
        op: BinaryOp,
        values: Vec<Value<'a>>,
        at: Span,
        asked: Option<&Type<'a>>,
    ) -> Outcome<Value<'a>> {
        let compares =
            matches!(op, BinaryOp::Lt | BinaryOp::Gt | BinaryOp::Le | BinaryOp::Ge | BinaryOp::Eq | BinaryOp::Ne);
        if compares {
            let mut all = true;
            for pair in values.windows(2) {
                all &= self.operate(op, pair[0].clone(), pair[1].clone(), at, None)?.as_bool()?;
            }
            return Ok(Value::bool(all));
        }
        let mut values = values.into_iter();
        let Some(mut result) = values.next() else { return unknown("a function without arguments") };
        for value in values {
            result = self.operate(op, result, value, at, asked)?;
        }
        Ok(result)
    }

    /// `INT_TO_REAL`, `TO_REAL`, `TRUNC`, `TRUNC_INT`, `REAL_TRUNC_INT`.
    fn conversion(
        &mut self,
        frame: &Frame<'a>,
        name: &str,
        expr: &'a Expr<'a>,
        asked: Option<&Type<'a>>,
        at: Span,
    ) -> Outcome<Value<'a>> {
        let named = |it: &str| Elementary::named(it).map_or_else(|| unknown(&format!("the function {name}")), Ok);
        if name == "TRUNC" {
            let to = asked.and_then(Type::elementary).filter(|it| it.is_integer()).unwrap_or(Elementary::Dint);
            let value = self.value(frame, expr, None)?;
            return self.truncated(&value, to);
        }
        if let Some(to) = name.strip_prefix("TRUNC_") {
            let value = self.value(frame, expr, None)?;
            return self.truncated(&value, named(to)?);
        }
        if let Some((from, to)) = name.split_once("_TRUNC_") {
            let value = self.value_as(frame, expr, &Type::Elementary(named(from)?))?;
            return self.truncated(&value, named(to)?);
        }
        if let Some(to) = name.strip_prefix("TO_") {
            let value = self.value(frame, expr, None)?;
            if let Some(converted) = self.text_converted(&value, to)? {
                return self.kept(converted);
            }
            return self.converted_by_name(&value, named(to)?, at);
        }
        let Some((from, to)) = name.split_once("_TO_") else { return unknown(&format!("the function {name}")) };
        let value = match Elementary::named(from) {
            Some(from) => self.value_as(frame, expr, &Type::Elementary(from))?,
            None if from == "STRING" || from == "WSTRING" => self.value(frame, expr, None)?,
            None => return unknown(&format!("the function {name}")),
        };
        if let Some(converted) = self.text_converted(&value, to)? {
            return self.kept(converted);
        }
        self.converted_by_name(&value, named(to)?, at)
    }

    /// TIMEs and numbers meet at the [unit] of the TIME, of which CODESYS takes whole ones; of a bit string BOOL takes the
    /// rightmost bit, but for CODESYS; of an integer it is whether it is 0.
    fn converted_by_name(&self, value: &Value<'a>, to: Elementary, at: Span) -> Outcome<Value<'a>> {
        let is_integer = value.ty.base().is_some_and(|it| it.is_integer() || it.is_bits());
        if to == Elementary::Time && is_integer && self.counts_milliseconds() {
            return kept_of(self.declared.family, value.as_integer()? * 1_000_000);
        }
        let value = self.converted_to(value, to, at)?;
        self.kept(value)
    }

    fn converted_to(&self, value: &Value<'a>, to: Elementary, at: Span) -> Outcome<Value<'a>> {
        let scalar = value.as_scalar()?;
        let Some(from) = value.ty.base() else { return unknown("a conversion of this type") };
        if to.is_date() && from.is_real() && self.is_codesys() {
            return unknown("a REAL as a date in CODESYS");
        }
        if from.is_date() || to.is_date() {
            return self.date_converted(value, from, to, at);
        }
        let real = from.is_real() || to.is_real();
        let wide = if real { Elementary::Lreal } else { Elementary::Lint };
        let time = if from.is_time() { from } else { to };
        let of_logix = time == Elementary::Time && self.declared.family == Family::Logix;
        let factor = in_repr(Scalar::I64(if of_logix { 1000 } else { unit(time) }), wide).as_scalar()?;
        match (from.is_time(), to.is_time()) {
            (true, false) if to == Elementary::Bool => Ok(Value::bool(value.as_integer()? != 0)),
            (true, false) => {
                let count = self.applied("DIV", wide, &[in_repr(scalar, wide).as_scalar()?, factor], at)?;
                Ok(in_repr(count.as_scalar()?, to))
            }
            (false, true) if from.is_real() && self.is_codesys() => {
                let whole = self.whole(scalar, Elementary::Lint).as_scalar()?;
                let factor = Scalar::I64(unit(to));
                let count = self.applied("MUL", Elementary::Lint, &[whole, factor], at)?;
                Ok(in_repr(count.as_scalar()?, to))
            }
            (false, true) => {
                let count = self.applied("MUL", wide, &[in_repr(scalar, wide).as_scalar()?, factor], at)?;
                Ok(in_repr(count.as_scalar()?, to))
            }
            _ if to == Elementary::Bool && from.is_bits() && from != Elementary::Bool && !self.is_codesys() => {
                Ok(Value::bool(value.as_integer()? & 1 == 1))
            }
            _ if to == Elementary::Bool && !real => Ok(Value::bool(value.as_integer()? != 0)),
            _ => Ok(self.whole(scalar, to)),
        }
    }

    /// A number of another type. What an integer type does not hold of a real is cut in Logix, CODESYS and OpenPLC from v4.1; the latter
    /// two round halves away from zero.
    fn whole(&self, value: Scalar, to: Elementary) -> Value<'a> {
        let real = match value {
            Scalar::F32(it) => f64::from(it),
            Scalar::F64(it) => it,
            _ => return in_repr(value, to),
        };
        let nearest = match self.declared.family {
            Family::Logix => real.round_ties_even(),
            Family::Codesys | Family::Openplc4 => real.round(),
            Family::Iec | Family::Cscape | Family::Openplc | Family::S7 => return in_repr(value, to),
        };
        if to == Elementary::Bool || to.is_real() { in_repr(value, to) } else { low_bits(nearest, to) }
    }

    fn truncated(&self, value: &Value<'a>, to: Elementary) -> Outcome<Value<'a>> {
        let scalar = value.as_scalar()?;
        let is_cut = matches!(self.declared.family, Family::Logix | Family::Codesys | Family::Openplc4);
        Ok(match scalar {
            Scalar::F32(it) if is_cut => low_bits(f64::from(it).trunc(), to),
            Scalar::F64(it) if is_cut => low_bits(it.trunc(), to),
            _ => Value::scalar(to, ops::trunc_value(scalar, to.repr())),
        })
    }

    /// The type that arguments have between them, where they are elementary.
    fn common(
        &self,
        values: &[(usize, Option<Value<'a>>, &'a Expr<'a>)],
        asked: Option<&Type<'a>>,
    ) -> Outcome<Option<Elementary>> {
        let typed: Vec<Elementary> = values.iter().filter_map(|it| it.1.as_ref()?.ty.elementary()).collect();
        let kinds: Vec<Untyped> = values.iter().filter_map(|it| untyped(it.2)).collect();
        let real = kinds.contains(&Untyped::Real);
        let Some(first) = typed.first() else {
            let kind = if real { Untyped::Real } else { Untyped::Integer };
            return Ok((!kinds.is_empty()).then(|| default_type(kind, asked)));
        };
        let mut ty = *first;
        for other in &typed {
            ty = self.meeting(ty, *other).map_or_else(|| unknown("arguments of different types"), Ok)?;
        }
        if real && !ty.is_real() {
            ty = ty.meets(Elementary::Real).unwrap_or(Elementary::Lreal);
        }
        for (_, _, expr) in values {
            ty = literal_number(expr).map_or(ty, |it| ty.that_holds(it));
        }
        Ok(Some(ty))
    }
}

/// The operator and the type of `ADD_DINT`.
fn typed(name: &str) -> Option<(BinaryOp, Elementary)> {
    let (name, ty) = name.split_once('_')?;
    Some((operator(name)?, Elementary::named(ty)?))
}

/// The low bits of a whole number. From 2^117 on the lowest 64 bits are 0.
fn low_bits<'a>(whole: f64, to: Elementary) -> Value<'a> {
    let number = if whole.abs() < 2.0_f64.powi(117) { whole as i128 } else { 0 };
    in_repr(Scalar::U64((number & i128::from(u64::MAX)) as u64), to)
}

/// Whether it is an ENO whose target has something to evaluate.
fn leads_to_a_part(argument: &Argument<'_>) -> bool {
    match &argument.kind {
        ArgumentKind::Output { target: Some(target), .. } => !matches!(target.kind, ExprKind::Name(_)),
        ArgumentKind::Output { target: None, .. } | ArgumentKind::Input(..) | ArgumentKind::Positional(_) => false,
    }
}

/// The arguments as they are written, with the positions of their parameters.
pub(crate) fn positions<'a>(names: &[&str], arguments: &'a [Argument<'a>]) -> Outcome<Vec<Given<'a>>> {
    let mut given: Vec<Given<'a>> = Vec::new();
    for argument in arguments.iter().filter(|it| !is_enable(it)) {
        let (position, expr) = match &argument.kind {
            ArgumentKind::Positional(expr) => {
                let free = (0..).find(|at| !given.iter().any(|it| it.0 == *at));
                (free.unwrap_or(0), expr)
            }
            ArgumentKind::Input(name, expr) => {
                let position = names.iter().position(|it| it.eq_ignore_ascii_case(name.text));
                // IN1, IN2 and IN0, IN1 continue as far as arguments do.
                let numbered = name.text.trim_start_matches(|it: char| it.is_ascii_alphabetic()).parse::<usize>();
                let position = position.or_else(|| {
                    let last = names.last()?.trim_start_matches(|it: char| it.is_ascii_alphabetic());
                    Some(names.len() - 1 + numbered.ok()? - last.parse::<usize>().ok()?)
                });
                let Some(position) = position else { return unknown(&format!("the parameter {}", name.text)) };
                (position, expr)
            }
            ArgumentKind::Output { .. } => return unknown("an output of a standard function"),
        };
        given.push((position, expr));
    }
    Ok(given)
}

/// With the bytes of each number in the other order; a text stays as it is.
fn turned(mut value: Value<'_>) -> Outcome<Value<'_>> {
    for cell in &mut value.cells {
        match cell {
            Cell::Scalar(number) => {
                let mut bytes = [0; 8];
                let size = usize::try_from(number.repr().size()).unwrap_or(8);
                number.write(&mut bytes[..size]);
                bytes[..size].reverse();
                *number = Scalar::read(number.repr(), &bytes[..size]);
            }
            Cell::Text(_) => {}
            _ => return unknown("the bytes of this"),
        }
    }
    Ok(value)
}
