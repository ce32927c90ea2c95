//! Expressions: each operand in its turn, from left to right.

use crate::classes::is_this;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::references::{is_null, null};
use crate::storage::{Cell, Value, integer_cell};
use crate::texts::units;
use crate::types::{Elementary, Type};
use staunch_frontend::Span;
use staunch_frontend::ast::{BinaryOp, Chars, Expr, ExprKind, Literal, LiteralValue, Name, UnaryOp};
use staunch_runtime::{Value as Scalar, ops};

/// A number without a type of its own: it takes the one that its place asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Untyped {
    Integer,
    Real,
}

impl<'a> Machine<'a> {
    /// The value for a place of type `ty`.
    pub(crate) fn value_as(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>, ty: &Type<'a>) -> Outcome<Value<'a>> {
        if let Type::Reference(_) = ty {
            return self.reference_value(frame, expr, ty);
        }
        let value = self.value(frame, expr, Some(ty))?;
        self.converted(value, ty, expr.span)
    }

    /// What a variable holds.
    fn stored(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<Value<'a>> {
        let place = self.place(frame, expr)?;
        let place = self.checked(place)?;
        Ok(self.read(&place))
    }

    /// The value, of its own type. Only what has none takes the type that is `asked` for.
    pub(crate) fn value(
        &mut self,
        frame: &Frame<'a>,
        expr: &'a Expr<'a>,
        asked: Option<&Type<'a>>,
    ) -> Outcome<Value<'a>> {
        if let Some(kind) = untyped(expr) {
            let ty = default_type(kind, asked);
            return self.number(expr, ty);
        }
        match &expr.kind {
            ExprKind::Paren(inner) => self.value(frame, inner, asked),
            ExprKind::Literal(literal) => self.literal(literal),
            ExprKind::Name(name) => match self.variable(frame, name) {
                Some(_) => self.stored(frame, expr),
                None if is_null(expr) => Ok(null()),
                None if is_this(expr) => {
                    let place = self.place(frame, expr)?;
                    Ok(Value { cells: vec![Cell::Reference(Some(Box::new(place)))], ..null() })
                }
                None => match self.property(frame, expr)? {
                    Some((name, class, instance)) => self.got(name, class, &instance),
                    None => self
                        .declared
                        .bare_enumerator(name.text, asked)
                        .map_or_else(|| unknown(&format!("the name {}", name.text)), Ok),
                },
            },
            ExprKind::Member(base, name) => self.of_member(frame, expr, base, name),
            ExprKind::Index(..) | ExprKind::Deref(_) | ExprKind::Address(_) => self.stored(frame, expr),
            ExprKind::Part(base, part) => self.part(frame, base, part),
            ExprKind::Call(callee, arguments) => match self.call(frame, callee, arguments, asked)? {
                Some(value) => Ok(value),
                None => unknown("the value of a call without one"),
            },
            ExprKind::Unary(op, inner) => self.unary(frame, *op, inner, asked),
            ExprKind::Binary(sides, op, at) => self.binary(frame, *op, &sides[0], &sides[1], *at, asked),
            ExprKind::Assign(..) | ExprKind::Error(_) => unknown("this expression"),
        }
    }

    /// `a.b`: an enumerator of the type `a`, what a PROPERTY gives, or a part of a variable.
    fn of_member(
        &mut self,
        frame: &Frame<'a>,
        expr: &'a Expr<'a>,
        base: &'a Expr<'a>,
        name: &Name<'a>,
    ) -> Outcome<Value<'a>> {
        if let Some(ty) = self.outer_path(frame, base)
            && let Some(value) = self.declared.enumerator(&ty, name.text)
        {
            return Ok(value);
        }
        match self.property(frame, expr)? {
            Some((name, class, instance)) => self.got(name, class, &instance),
            None => self.stored(frame, expr),
        }
    }

    fn unary(
        &mut self,
        frame: &Frame<'a>,
        op: UnaryOp,
        inner: &'a Expr<'a>,
        asked: Option<&Type<'a>>,
    ) -> Outcome<Value<'a>> {
        if let (UnaryOp::Neg, ExprKind::Literal(Literal { prefix: Some(prefix), value })) = (op, &inner.kind)
            && let Some(ty) = Elementary::named(prefix.text)
        {
            return typed_number(value, true, ty);
        }
        let value = self.value(frame, inner, asked)?;
        let Some(ty) = value.ty.elementary() else { return unknown("this operand of NOT or -") };
        match op {
            UnaryOp::Plus => Ok(value),
            UnaryOp::Neg => {
                let negative = self.computed("NEG", ty, &[value.as_scalar()?], inner.span)?;
                self.kept(negative)
            }
            // Which of its operands' types a selection has does not show but here.
            UnaryOp::Not if matches!(inner.kind, ExprKind::Call(..)) && self.promotes(ty) => {
                unknown("NOT of a narrow value that a function chooses")
            }
            UnaryOp::Not => self.applied("NOT", ty, &[in_repr(value.as_scalar()?, ty).as_scalar()?], inner.span),
        }
    }

    fn literal(&mut self, literal: &'a Literal<'a>) -> Outcome<Value<'a>> {
        match (&literal.prefix, &literal.value) {
            (Some(ty), LiteralValue::Enumerator(name)) => {
                self.declared.enumerator(&[**ty], name.text).map_or_else(|| unknown("this enumerator"), Ok)
            }
            (_, LiteralValue::Bool(it)) => Ok(Value::bool(*it)),
            (_, LiteralValue::Time { ty, nanoseconds }) => match Elementary::named(ty.name()) {
                Some(ty) => Ok(Value::scalar(ty, Scalar::I64(*nanoseconds))),
                None => unknown("literals of dates"),
            },
            (prefix, LiteralValue::String(chars)) => {
                let value = Value::text(units(chars), matches!(**chars, Chars::Wide(_)));
                match prefix.as_ref().and_then(|it| Elementary::named(it.text)) {
                    Some(ty) => self.converted(value, &Type::Elementary(ty), Span::default()),
                    None => Ok(value),
                }
            }
            (Some(ty), value) => match Elementary::named(ty.text) {
                Some(ty) => typed_number(value, false, ty),
                None => unknown("the type of a literal"),
            },
            (None, _) => unknown("this literal"),
        }
    }

    /// Numbers without types, and what is computed of them, at one type.
    pub(crate) fn number(&mut self, expr: &'a Expr<'a>, ty: Elementary) -> Outcome<Value<'a>> {
        match &expr.kind {
            // Whole numbers are computed as such, whatever their place asks for: 7 / 2 is 3.
            ExprKind::Binary(..) if ty.is_real() && untyped(expr) == Some(Untyped::Integer) => {
                let whole = self.number(expr, Elementary::Lint)?;
                Ok(in_repr(whole.as_scalar()?, ty))
            }
            ExprKind::Paren(inner) => self.number(inner, ty),
            ExprKind::Literal(literal) => typed_number(&literal.value, false, ty),
            ExprKind::Unary(UnaryOp::Neg, inner) => match &inner.kind {
                // The sign belongs to the number: -128 is a SINT.
                ExprKind::Literal(literal) => typed_number(&literal.value, true, ty),
                _ => {
                    let value = self.number(inner, ty)?;
                    self.applied("NEG", ty, &[value.as_scalar()?], expr.span)
                }
            },
            ExprKind::Unary(_, inner) => self.number(inner, ty),
            ExprKind::Binary(..) if let Some(number) = literal_number(expr).filter(|_| ty.is_integer()) => {
                Ok(typed_integer(number, ty))
            }
            ExprKind::Binary(sides, op, at) => {
                let a = self.number(&sides[0], ty)?;
                let b = self.number(&sides[1], ty)?;
                self.operate(*op, a, b, *at, None)
            }
            _ => unknown("this number"),
        }
    }
}

/// A literal's own number, with its sign.
pub(crate) fn literal_number(expr: &Expr<'_>) -> Option<i128> {
    match &expr.kind {
        ExprKind::Paren(inner) => literal_number(inner),
        ExprKind::Unary(UnaryOp::Neg, inner) => literal_number(inner).map(|it| -it),
        ExprKind::Literal(Literal { prefix: None, value: LiteralValue::Integer { value, .. } }) => {
            Some(i128::from(*value))
        }
        ExprKind::Binary(sides, op, _) => exactly(*op, literal_number(&sides[0])?, literal_number(&sides[1])?),
        _ => None,
    }
}

/// Numbers without a type are computed exactly.
fn exactly(op: BinaryOp, a: i128, b: i128) -> Option<i128> {
    match op {
        BinaryOp::Add => a.checked_add(b),
        BinaryOp::Sub => a.checked_sub(b),
        BinaryOp::Mul => a.checked_mul(b),
        BinaryOp::Div => a.checked_div(b),
        BinaryOp::Mod => a.checked_rem(b),
        _ => None,
    }
}

/// Whether an expression is made of numbers without a type alone.
pub(crate) fn untyped(expr: &Expr<'_>) -> Option<Untyped> {
    match &expr.kind {
        ExprKind::Paren(inner) | ExprKind::Unary(UnaryOp::Neg | UnaryOp::Plus, inner) => untyped(inner),
        ExprKind::Literal(Literal { prefix: None, value }) => match value {
            LiteralValue::Integer { .. } => Some(Untyped::Integer),
            LiteralValue::Real(_) => Some(Untyped::Real),
            _ => None,
        },
        ExprKind::Binary(sides, op, _) => {
            let (a, b) = (untyped(&sides[0])?, untyped(&sides[1])?);
            let computes = matches!(op, BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div | BinaryOp::Mod);
            let kind = if a == b { a } else { Untyped::Real };
            computes.then_some(kind)
        }
        _ => None,
    }
}

/// The type of numbers that meet no typed operand.
pub(crate) fn default_type(kind: Untyped, asked: Option<&Type<'_>>) -> Elementary {
    let asked = asked.and_then(Type::elementary);
    match kind {
        Untyped::Integer => asked.filter(|it| it.takes_integers()).unwrap_or(Elementary::Int),
        Untyped::Real => asked.filter(|it| it.is_real()).unwrap_or(Elementary::Lreal),
    }
}

/// A literal at its type.
fn typed_number<'a>(value: &LiteralValue<'_>, negative: bool, ty: Elementary) -> Outcome<Value<'a>> {
    let sign = if negative { "-" } else { "" };
    match value {
        // There is one integer 0.
        LiteralValue::Integer { value: 0, .. } if ty.is_real() => real("0", ty),
        LiteralValue::Integer { value, .. } if ty.is_real() => real(&format!("{sign}{value}"), ty),
        LiteralValue::Real(digits) if ty.is_real() => real(&format!("{sign}{digits}"), ty),
        LiteralValue::Integer { value, .. } => {
            let number = i128::from(*value) * if negative { -1 } else { 1 };
            Ok(typed_integer(number, ty))
        }
        _ => unknown("this literal"),
    }
}

/// A number that is too large for its place makes it a wider one.
fn typed_integer<'a>(number: i128, ty: Elementary) -> Value<'a> {
    let wider = [ty, Elementary::Int, Elementary::Dint, Elementary::Lint, Elementary::Ulint];
    let ty = wider.into_iter().find(|it| it.holds(number)).unwrap_or(ty);
    Value { ty: Type::Elementary(ty), cells: vec![integer_cell(ty, number)] }
}

fn real<'a>(digits: &str, ty: Elementary) -> Outcome<Value<'a>> {
    let value = match ty {
        Elementary::Real => digits.parse().map(Scalar::F32),
        _ => digits.parse().map(Scalar::F64),
    };
    match value {
        Ok(it) => Ok(Value { ty: Type::Elementary(ty), cells: vec![Cell::Scalar(it)] }),
        Err(_) => unknown("these digits"),
    }
}

/// A scalar in another repr.
pub(crate) fn in_repr<'a>(value: Scalar, ty: Elementary) -> Value<'a> {
    Value::scalar(ty, ops::convert_value(value, ty.repr()))
}
