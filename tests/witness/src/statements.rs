//! Statements, one after the other.

use crate::expressions::literal_number;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::storage::{Value, integer_cell};
use crate::types::Type;
use staunch_frontend::Span;
use staunch_frontend::ast::{Arm, Expr, ExprKind, Statement, StatementKind};
use staunch_runtime::FaultKind;

/// How a statement ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow<'a> {
    Next,
    Exit,
    Continue,
    Return,
    /// To a label, which may be further out.
    Jump(&'a str),
}

fn is_label(statement: &Statement<'_>, wanted: &str) -> bool {
    matches!(statement.kind, StatementKind::Label(name) if name.text.eq_ignore_ascii_case(wanted))
}

impl<'a> Machine<'a> {
    pub(crate) fn block(&mut self, frame: &Frame<'a>, statements: &'a [Statement<'a>]) -> Outcome<Flow<'a>> {
        let mut at = 0;
        while let Some(statement) = statements.get(at) {
            at += 1;
            match self.statement(frame, statement)? {
                Flow::Next => {}
                Flow::Jump(name) => match statements.iter().position(|it| is_label(it, name)) {
                    Some(label) => at = label,
                    None => return Ok(Flow::Jump(name)),
                },
                flow => return Ok(flow),
            }
        }
        Ok(Flow::Next)
    }

    fn statement(&mut self, frame: &Frame<'a>, statement: &'a Statement<'a>) -> Outcome<Flow<'a>> {
        self.step()?;
        match &statement.kind {
            StatementKind::Empty => Ok(Flow::Next),
            StatementKind::Assign { target, value } => self.assign(frame, target, value),
            StatementKind::AssignAll { .. } => unknown("assignments in a row"),
            StatementKind::Bind { target, value } => self.bind(frame, target, value),
            StatementKind::Attempt { target, value } => self.attempt(frame, target, value),
            StatementKind::SetReset { target, value, set } => self.set_reset(frame, &[(target, *set)], value),
            StatementKind::SetResetAll { targets, value } => {
                let targets: Vec<_> = targets.iter().map(|(target, set)| (target, *set)).collect();
                self.set_reset(frame, &targets, value)
            }
            StatementKind::Expr(expr) => self.lone_call(frame, expr),
            StatementKind::If { branches, otherwise } => self.choose(frame, branches, otherwise.as_deref()),
            StatementKind::Case { selector, arms, otherwise } => {
                self.select(frame, selector, arms, otherwise.as_deref())
            }
            StatementKind::For { counter, from, to, by, body } => {
                self.count(frame, counter, [from, to], by.as_deref(), body, statement.span)
            }
            StatementKind::While { condition, body } => self.repeat_while(frame, condition, body),
            StatementKind::Repeat { body, until } => self.repeat_until(frame, body, until),
            StatementKind::Try(it) => self.try_statement(frame, it),
            StatementKind::Label(_) => Ok(Flow::Next),
            StatementKind::Jump(name) => Ok(Flow::Jump(name.text)),
            StatementKind::Exit => Ok(Flow::Exit),
            StatementKind::Continue => Ok(Flow::Continue),
            StatementKind::Return => Ok(Flow::Return),
            StatementKind::ReturnIf(condition) => {
                Ok(if self.condition(frame, condition)? { Flow::Return } else { Flow::Next })
            }
            StatementKind::Error => unknown("a statement that did not parse"),
        }
    }

    /// The target is found before the value is computed: it is written first.
    fn assign(&mut self, frame: &Frame<'a>, target: &'a Expr<'a>, value: &'a Expr<'a>) -> Outcome<Flow<'a>> {
        if let ExprKind::Part(base, part) = &target.kind {
            let place = self.place(frame, base)?;
            return self.assign_part(frame, &place, part, value, target.span);
        }
        if let Some(property) = self.property(frame, target)? {
            self.set(frame, property, value)?;
            return Ok(Flow::Next);
        }
        let place = self.place(frame, target)?;
        if matches!(place.ty, Type::Array(_) | Type::Record(_) | Type::Union(_)) && self.is_variable(frame, value)? {
            // Of what is copied as a whole both sides are found before either is looked at.
            let source = self.place(frame, value)?;
            if place.window.is_some() || source.window.is_some() {
                // What shares its bytes is a value, which is known before it goes anywhere.
                let value = self.read(&self.checked(source)?);
                let place = self.checked(place)?;
                self.write(&place, &value);
                return Ok(Flow::Next);
            }
            let place = self.checked(place)?;
            let value = self.read(&self.checked(source)?);
            self.write(&place, &value);
            return Ok(Flow::Next);
        }
        let value = self.value_as(frame, value, &place.ty)?;
        let place = self.checked(place)?;
        self.write(&place, &value);
        Ok(Flow::Next)
    }

    /// `x S= c` sets x while c is TRUE, `x R= c` resets it.
    /// All targets are found, then the condition is asked, once.
    fn set_reset(
        &mut self,
        frame: &Frame<'a>,
        targets: &[(&'a Expr<'a>, bool)],
        value: &'a Expr<'a>,
    ) -> Outcome<Flow<'a>> {
        let mut places = Vec::new();
        for (target, set) in targets {
            places.push((self.place(frame, target)?, *set));
        }
        if self.value_as(frame, value, &Type::BOOL)?.as_bool()? {
            for (place, set) in places {
                let place = self.checked(place)?;
                self.write(&place, &Value::bool(set));
            }
        }
        Ok(Flow::Next)
    }

    fn lone_call(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<Flow<'a>> {
        match &expr.kind {
            ExprKind::Call(callee, arguments) => {
                self.raise(frame, callee, arguments, expr.span)?;
                self.call(frame, callee, arguments, None).map(|_| Flow::Next)
            }
            _ => unknown("an expression as a statement"),
        }
    }

    fn choose(
        &mut self,
        frame: &Frame<'a>,
        branches: &'a [(Expr<'a>, Vec<Statement<'a>>)],
        otherwise: Option<&'a [Statement<'a>]>,
    ) -> Outcome<Flow<'a>> {
        for (condition, body) in branches {
            if self.condition(frame, condition)? {
                return self.block(frame, body);
            }
        }
        self.block(frame, otherwise.unwrap_or_default())
    }

    fn condition(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<bool> {
        self.value_as(frame, expr, &Type::BOOL)?.as_bool()
    }

    /// CASE: the first arm with a label that is, or whose range holds, the selector.
    fn select(
        &mut self,
        frame: &Frame<'a>,
        selector: &'a Expr<'a>,
        arms: &'a [Arm<'a>],
        otherwise: Option<&'a [Statement<'a>]>,
    ) -> Outcome<Flow<'a>> {
        let selector = self.value(frame, selector, None)?;
        if let Type::Text(_) = selector.ty {
            return self.select_text(frame, &selector, arms, otherwise);
        }
        let number = selector.as_integer()?;
        for arm in arms {
            for label in &arm.labels {
                let low = self.value_as(frame, &label.low, &selector.ty)?.as_integer()?;
                let high = match &label.high {
                    Some(high) => self.value_as(frame, high, &selector.ty)?.as_integer()?,
                    None => low,
                };
                if (low..=high).contains(&number) {
                    return self.block(frame, &arm.body);
                }
            }
        }
        self.block(frame, otherwise.unwrap_or_default())
    }

    fn select_text(
        &mut self,
        frame: &Frame<'a>,
        selector: &Value<'a>,
        arms: &'a [Arm<'a>],
        otherwise: Option<&'a [Statement<'a>]>,
    ) -> Outcome<Flow<'a>> {
        for arm in arms {
            for label in &arm.labels {
                if self.value(frame, &label.low, None)?.as_text()? == selector.as_text()? {
                    return self.block(frame, &arm.body);
                }
            }
        }
        self.block(frame, otherwise.unwrap_or_default())
    }

    /// FOR goes by its variable: it is given the first value, then bound and step are evaluated, once.
    /// Before each turn it is compared with the bound; after it, it is stepped. A step that would
    /// leave its type or subrange ends the loop where it is past the bound, and faults where it is not.
    fn count(
        &mut self,
        frame: &Frame<'a>,
        counter: &'a Expr<'a>,
        [from, to]: [&'a Expr<'a>; 2],
        by: Option<&'a Expr<'a>>,
        body: &'a [Statement<'a>],
        at: Span,
    ) -> Outcome<Flow<'a>> {
        let place = self.place(frame, counter)?;
        let place = self.checked(place)?;
        let Some(base) = place.ty.elementary() else { return unknown("a counter that is not an integer") };
        let first = self.value_as(frame, from, &place.ty)?;
        self.write(&place, &first);
        let limit = self.value(frame, to, Some(&Type::Elementary(base)))?;
        // It is compared as it is computed, also beyond the counter's type; a number has the counter's type.
        let is_literal = literal_number(to).is_some();
        let last = match limit.ty.elementary().filter(|it| self.promotes(*it) && !is_literal) {
            Some(_) => limit.as_integer()?,
            None => self.converted(limit, &Type::Elementary(base), to.span)?.as_integer()?,
        };
        let step = match by {
            None => 1,
            // A negative literal steps down, also where the counter is unsigned.
            Some(by) => match literal_number(by) {
                Some(number) => number,
                None => {
                    // It counts as it is computed, also beyond the counter's type.
                    let step = self.value(frame, by, Some(&Type::Elementary(base)))?;
                    match step.ty.elementary().filter(|it| self.promotes(*it)) {
                        Some(_) => step.as_integer()?,
                        None => self.converted(step, &Type::Elementary(base), by.span)?.as_integer()?,
                    }
                }
            },
        };
        if let (Some(by), 0) = (by, step) {
            return Err(self.fault(FaultKind::ZeroStep, by.span));
        }
        let goes_on = |now: i128| if step > 0 { now <= last } else { now >= last };
        // What the bound's evaluation did to the variable counts too.
        let mut now = self.read(&place).as_integer()?;
        while goes_on(now) {
            self.step()?;
            match self.block(frame, body)? {
                Flow::Exit => break,
                flow @ (Flow::Return | Flow::Jump(_)) => return Ok(flow),
                Flow::Next | Flow::Continue => {}
            }
            now = self.read(&place).as_integer()? + step;
            let (low, high) = place.ty.range();
            if (low..=high).contains(&now) {
                self.write(&place, &Value { ty: place.ty.clone(), cells: vec![integer_cell(base, now)] });
            } else if goes_on(now) && base.holds(now) {
                return Err(self.fault(FaultKind::SubrangeViolated, at));
            } else {
                break;
            }
        }
        Ok(Flow::Next)
    }

    fn repeat_while(
        &mut self,
        frame: &Frame<'a>,
        condition: &'a Expr<'a>,
        body: &'a [Statement<'a>],
    ) -> Outcome<Flow<'a>> {
        while self.condition(frame, condition)? {
            self.step()?;
            match self.block(frame, body)? {
                Flow::Exit => break,
                flow @ (Flow::Return | Flow::Jump(_)) => return Ok(flow),
                Flow::Next | Flow::Continue => {}
            }
        }
        Ok(Flow::Next)
    }

    fn repeat_until(&mut self, frame: &Frame<'a>, body: &'a [Statement<'a>], until: &'a Expr<'a>) -> Outcome<Flow<'a>> {
        loop {
            self.step()?;
            match self.block(frame, body)? {
                Flow::Exit => break,
                flow @ (Flow::Return | Flow::Jump(_)) => return Ok(flow),
                Flow::Next | Flow::Continue => {}
            }
            if self.condition(frame, until)? {
                break;
            }
        }
        Ok(Flow::Next)
    }
}
