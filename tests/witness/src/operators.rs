//! Operators: the type at which two operands meet, and the runtime's arithmetic there.

use crate::expressions::{Untyped, default_type, in_repr, literal_number, untyped};
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::references::{is_null, null};
use crate::storage::Value;
use crate::types::{Elementary, Type};
use staunch_frontend::Span;
use staunch_frontend::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use staunch_runtime::{Family, FaultKind, Outcome as _, Repr, Scalar as _, Value as Scalar, ops, with_repr};

impl<'a> Machine<'a> {
    pub(crate) fn binary(
        &mut self,
        frame: &Frame<'a>,
        op: BinaryOp,
        left: &'a Expr<'a>,
        right: &'a Expr<'a>,
        at: Span,
        asked: Option<&Type<'a>>,
    ) -> Outcome<Value<'a>> {
        if let BinaryOp::AndThen | BinaryOp::OrElse = op {
            // The right side is evaluated only where it decides.
            let first = self.value_as(frame, left, &Type::BOOL)?;
            let decided = first.as_bool()? == (op == BinaryOp::OrElse);
            return if decided { Ok(first) } else { self.value_as(frame, right, &Type::BOOL) };
        }
        let asked = asked.filter(|_| !compares(op));
        if op == BinaryOp::Power && self.declared.family == Family::Logix {
            match &left.kind {
                ExprKind::Unary(UnaryOp::Plus, base) => return self.binary(frame, op, base, right, at, asked),
                ExprKind::Unary(UnaryOp::Neg, base) => {
                    let power = self.binary(frame, op, base, right, at, asked)?;
                    let Some(ty) = power.ty.elementary() else { return unknown("a power that is not a number") };
                    return self.computed("NEG", ty, &[power.as_scalar()?], at);
                }
                ExprKind::Binary(_, BinaryOp::Power, _) => return unknown("a power of a power"),
                _ => {}
            }
        }
        let of_bits = matches!(op, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor);
        // A negative one is a DINT, with zeros above it next to a 64-bit operand.
        let is_filled = |it: &Expr<'_>| untyped(it).is_some() && literal_number(it).is_none_or(|it| it < 0);
        if of_bits && self.declared.family == Family::Logix && [left, right].into_iter().any(is_filled) {
            return unknown("the bits of an immediate value in Logix");
        }
        let (a, b) = self.sides(frame, left, right, asked)?;
        self.operate(op, a, b, at, asked)
    }

    /// Both sides, from left to right. A number without a type takes that of the other side; it
    /// does nothing, so that it does not matter when it is looked at.
    fn sides(
        &mut self,
        frame: &Frame<'a>,
        left: &'a Expr<'a>,
        right: &'a Expr<'a>,
        asked: Option<&Type<'a>>,
    ) -> Outcome<(Value<'a>, Value<'a>)> {
        match (untyped(left), untyped(right)) {
            // NOT of a number without a type has that of the bits on the other side.
            (None, None) if is_not_of_number(left) && asked.is_none() => {
                let b = self.value(frame, right, asked)?;
                let a = self.value(frame, left, Some(&b.ty.clone()))?;
                Ok((a, b))
            }
            (None, None) => {
                let a = self.value(frame, left, asked)?;
                let beside = match a.ty.base() {
                    Some(_) if is_not_of_number(right) && asked.is_none() => Some(a.ty.clone()),
                    Some(ty) if ty.is_integer() || ty.is_real() => Some(a.ty.clone()),
                    _ => asked.cloned(),
                };
                let b = self.value(frame, right, beside.as_ref())?;
                Ok((a, b))
            }
            (None, Some(kind)) => {
                let a = self.value(frame, left, asked)?;
                if matches!(a.ty, Type::Reference(_)) {
                    // What number a reference is nobody says.
                    return if is_null(right) { Ok((a, null())) } else { unknown("the number of a reference") };
                }
                let ty = self.beside(&a.ty, kind, literal_number(right), asked)?;
                let b = self.number(right, ty)?;
                Ok((a, b))
            }
            (Some(kind), None) => {
                let b = self.value(frame, right, asked)?;
                let ty = self.beside(&b.ty, kind, literal_number(left), asked)?;
                let a = self.number(left, ty)?;
                Ok((a, b))
            }
            (Some(a), Some(b)) => {
                let ty = default_type(if a == b { a } else { Untyped::Real }, asked);
                Ok((self.number(left, ty)?, self.number(right, ty)?))
            }
        }
    }

    pub(crate) fn operate(
        &mut self,
        op: BinaryOp,
        a: Value<'a>,
        b: Value<'a>,
        at: Span,
        asked: Option<&Type<'a>>,
    ) -> Outcome<Value<'a>> {
        let value = self.operated(op, a, b, at, asked)?;
        self.kept(value)
    }

    fn operated(
        &mut self,
        op: BinaryOp,
        a: Value<'a>,
        b: Value<'a>,
        at: Span,
        asked: Option<&Type<'a>>,
    ) -> Outcome<Value<'a>> {
        if a.is_text() && b.is_text() {
            // Unit by unit; a text comes after those that it begins with.
            let order = Scalar::I16(a.as_text()?.cmp(&b.as_text()?) as i16);
            return self.applied(name(op), Elementary::Int, &[order, Scalar::I16(0)], at);
        }
        if let (Type::Reference(_), Type::Reference(_)) = (&a.ty, &b.ty) {
            return self.same_place(op, &a, &b);
        }
        let (Some(x), Some(y)) = (a.ty.base(), b.ty.base()) else { return unknown("these operands") };
        if let Some(sum) = self.date_sum(op, &a, &b)? {
            return Ok(sum);
        }
        match op {
            BinaryOp::Power => {
                let long = |it: Elementary| it == Elementary::Lreal || (it.is_integer() && it.repr().size() > 2);
                let asks = asked.and_then(Type::elementary) == Some(Elementary::Lreal);
                let is_long = long(x) || long(y);
                // What gives a REAL to a REAL, and is no REAL, is a literal.
                let wanted = x.is_real() && asked.and_then(Type::elementary) == Some(Elementary::Real);
                let own = self.declared.family != Family::Codesys && (x == Elementary::Real || wanted);
                let ty = if is_long || (asks && !own) { Elementary::Lreal } else { Elementary::Real };
                let base = if own { in_repr(a.as_scalar()?, Elementary::Real) } else { a };
                let operands = [in_repr(base.as_scalar()?, ty).as_scalar()?, in_repr(b.as_scalar()?, ty).as_scalar()?];
                let power = self.applied("EXPT", ty, &operands, at)?;
                Ok(if own { in_repr(power.as_scalar()?, Elementary::Real) } else { power })
            }
            BinaryOp::Mul | BinaryOp::Div if x.is_time() && !y.is_time() => self.scaled(op, &a, &b, at),
            BinaryOp::Mul if y.is_time() => self.scaled(op, &b, &a, at),
            _ => {
                let Some(ty) = self.meeting(x, y) else { return unknown(&format!("{x:?} and {y:?}")) };
                self.computed(name(op), ty, &[a.as_scalar()?, b.as_scalar()?], at)
            }
        }
    }

    /// A TIME times or by a number: exactly by an integer, through LREAL by a real.
    fn scaled(&mut self, op: BinaryOp, time: &Value<'a>, by: &Value<'a>, at: Span) -> Outcome<Value<'a>> {
        let (Some(ty), Some(other)) = (time.ty.elementary(), by.ty.elementary()) else { return unknown("a TIME") };
        let wide = if other.is_real() { Elementary::Lreal } else { Elementary::Lint };
        if op == BinaryOp::Mul && !other.is_real() && ty == Elementary::Time && self.counts_milliseconds() {
            return kept_of(self.declared.family, time.as_integer()? * by.as_integer()?);
        }
        let operands = [in_repr(time.as_scalar()?, wide).as_scalar()?, in_repr(by.as_scalar()?, wide).as_scalar()?];
        let scaled = in_repr(self.applied(name(op), wide, &operands, at)?.as_scalar()?, ty);
        if self.declared.family == Family::Logix { self.kept(scaled) } else { Ok(scaled) }
    }

    pub(crate) fn counts_milliseconds(&self) -> bool {
        matches!(self.declared.family, Family::Codesys | Family::S7)
    }

    /// What CODESYS, S7 and Logix keep of a TIME.
    pub(crate) fn kept(&self, value: Value<'a>) -> Outcome<Value<'a>> {
        if value.ty.elementary() == Some(Elementary::Ltime) && self.is_codesys() && value.as_integer()? < 0 {
            return unknown("an LTIME of CODESYS beyond 292 years");
        }
        if value.ty.elementary() == Some(Elementary::Time) && self.declared.family == Family::Logix {
            // Whole microseconds.
            return match i64::try_from(value.as_integer()? / 1000 * 1000) {
                Ok(it) => Ok(Value::scalar(Elementary::Time, Scalar::I64(it))),
                Err(_) => unknown("a TIME"),
            };
        }
        if value.ty.elementary() != Some(Elementary::Time) || !self.counts_milliseconds() {
            return Ok(value);
        }
        kept_of(self.declared.family, value.as_integer()?)
    }

    /// One of the runtime's operations at a type. A comparison gives a BOOL.
    pub(crate) fn applied(&self, name: &str, ty: Elementary, operands: &[Scalar], at: Span) -> Outcome<Value<'a>> {
        // In Logix an integer that is divided by zero stays what it is (1756-RM003N, p. 277, 281); S7 gives 0.
        if let ("DIV" | "MOD", [a, b]) = (name, operands)
            && ty.is_integer()
            && in_repr(*b, Elementary::Lint).as_integer()? == 0
        {
            match self.declared.family {
                Family::Logix => return Ok(Value::scalar(ty, *a)),
                Family::S7 => return Ok(in_repr(Value::scalar(Elementary::Dint, Scalar::I32(0)).as_scalar()?, ty)),
                Family::Iec | Family::Cscape | Family::Codesys | Family::Openplc | Family::Openplc4 => {}
            }
        }
        match apply(name, ty.repr(), operands) {
            None => unknown(&format!("{name} of {ty:?}")),
            Some(Err(kind)) => Err(self.fault(kind, at)),
            Some(Ok(value)) => {
                let is_test = matches!(name, "EQ" | "NE" | "LT" | "LE" | "GT" | "GE");
                Ok(Value::scalar(if is_test { Elementary::Bool } else { ty }, value))
            }
        }
    }
}

fn compares(op: BinaryOp) -> bool {
    matches!(op, BinaryOp::Lt | BinaryOp::Gt | BinaryOp::Le | BinaryOp::Ge | BinaryOp::Eq | BinaryOp::Ne)
}

/// The function that an operator means.
fn name(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Power => "EXPT",
        BinaryOp::Mul => "MUL",
        BinaryOp::Div => "DIV",
        BinaryOp::Mod => "MOD",
        BinaryOp::Add => "ADD",
        BinaryOp::Sub => "SUB",
        BinaryOp::Lt => "LT",
        BinaryOp::Gt => "GT",
        BinaryOp::Le => "LE",
        BinaryOp::Ge => "GE",
        BinaryOp::Eq => "EQ",
        BinaryOp::Ne => "NE",
        BinaryOp::And | BinaryOp::AndThen => "AND",
        BinaryOp::Xor => "XOR",
        BinaryOp::Or | BinaryOp::OrElse => "OR",
    }
}

/// The operator that a standard function means.
pub(crate) fn operator(name: &str) -> Option<BinaryOp> {
    use BinaryOp::{Add, And, Div, Eq, Ge, Gt, Le, Lt, Mod, Mul, Ne, Or, Power, Sub, Xor};
    let all = [Power, Mul, Div, Mod, Add, Sub, Lt, Gt, Le, Ge, Eq, Ne, And, Xor, Or];
    all.into_iter().find(|it| self::name(*it).eq_ignore_ascii_case(name))
}

/// Calls a function of the runtime at the repr of its operands.
macro_rules! at {
    ($class:ident $repr:ident $operands:ident $function:ident $($operand:ident)*) => {
        with_repr!($class $repr, T => {
            let mut operands = $operands.iter().copied();
            $(let $operand = <T as staunch_runtime::Scalar>::from_value(operands.next()?)?;)*
            let _: Option<T> = None;
            Some(ops::$function($($operand),*).outcome().map(|it| it.into_value()))
        }, None)
    };
}

macro_rules! shifted {
    ($repr:ident $operands:ident $function:ident) => {
        with_repr!(integer $repr, T => {
            let [value, Scalar::I64(count)] = $operands else { return None };
            let value = <T as staunch_runtime::Scalar>::from_value(*value)?;
            Some(Ok(ops::$function(value, *count).into_value()))
        }, None)
    };
}

/// The runtime's operation with this name, at a repr.
fn apply(name: &str, repr: Repr, operands: &[Scalar]) -> Option<Result<Scalar, FaultKind>> {
    match name {
        "ADD" => at!(number repr operands add a b),
        "SUB" => at!(number repr operands sub a b),
        "MUL" => at!(number repr operands mul a b),
        "DIV" => at!(number repr operands div a b),
        "MOD" => at!(integer repr operands modulo a b),
        "NEG" => at!(number repr operands neg a),
        "ABS" => at!(number repr operands abs a),
        "EXPT" => at!(real repr operands expt a b),
        "SQRT" => at!(real repr operands sqrt a),
        "LN" => at!(real repr operands ln a),
        "LOG" => at!(real repr operands log a),
        "EXP" => at!(real repr operands exp a),
        "SIN" => at!(real repr operands sin a),
        "COS" => at!(real repr operands cos a),
        "TAN" => at!(real repr operands tan a),
        "ASIN" => at!(real repr operands asin a),
        "ACOS" => at!(real repr operands acos a),
        "ATAN" => at!(real repr operands atan a),
        "ATAN2" => at!(real repr operands atan2 a b),
        "AND" => at!(bits repr operands and a b),
        "OR" => at!(bits repr operands or a b),
        "XOR" => at!(bits repr operands xor a b),
        "NOT" => at!(bits repr operands not a),
        "SHL" => shifted!(repr operands shl),
        "SHR" => shifted!(repr operands shr),
        "ROL" => shifted!(repr operands rol),
        "ROR" => shifted!(repr operands ror),
        "EQ" => at!(any repr operands eq a b),
        "NE" => at!(any repr operands ne a b),
        "LT" => at!(any repr operands lt a b),
        "LE" => at!(any repr operands le a b),
        "GT" => at!(any repr operands gt a b),
        "GE" => at!(any repr operands ge a b),
        "MAX" => at!(any repr operands max a b),
        "MIN" => at!(any repr operands min a b),
        "LIMIT" => at!(any repr operands limit a b c),
        _ => None,
    }
}

impl Machine<'_> {
    /// The type of a number next to a typed operand: the operand's, or a wider one that holds it.
    fn beside(
        &self,
        ty: &Type<'_>,
        kind: Untyped,
        number: Option<i128>,
        asked: Option<&Type<'_>>,
    ) -> Outcome<Elementary> {
        let Some(ty) = ty.elementary() else { return unknown("a number with an operand that is not a number") };
        match kind {
            _ if ty.is_time() => Ok(if kind == Untyped::Integer { Elementary::Lint } else { Elementary::Lreal }),
            Untyped::Integer => Ok(number.map_or(ty, |it| ty.that_holds(it))),
            Untyped::Real if ty.is_real() => Ok(ty),
            Untyped::Real => {
                let asks = asked.and_then(Type::elementary) == Some(Elementary::Lreal);
                let real = if asks { Elementary::Lreal } else { Elementary::Real };
                // In CODESYS an LREAL, where they meet 64 bits.
                let long = ty.as_number().is_integer() && ty.repr().size() == 8 && self.is_codesys();
                Ok(ty.meets(real).unwrap_or(if long { Elementary::Lreal } else { real }))
            }
        }
    }
}

fn is_not_of_number(expr: &Expr<'_>) -> bool {
    matches!(&expr.bare().kind, ExprKind::Unary(UnaryOp::Not, inner) if untyped(inner).is_some())
}

/// Nanoseconds as 32 bits of milliseconds: with a sign in S7, without one in CODESYS.
pub(crate) fn kept_of<'a>(family: Family, nanoseconds: i128) -> Outcome<Value<'a>> {
    let low = (nanoseconds / 1_000_000).rem_euclid(1 << 32);
    let milliseconds = if family == Family::S7 && low >= 1 << 31 { low - (1 << 32) } else { low };
    match i64::try_from(milliseconds * 1_000_000) {
        Ok(it) => Ok(Value::scalar(Elementary::Time, Scalar::I64(it))),
        Err(_) => unknown("a TIME"),
    }
}
