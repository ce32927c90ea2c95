//! Operands: typed expressions, and literals that take the type of their place.

use super::checker::Checker;
use super::real::Real;
use crate::diagnostic::Subject;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::narrow::is_narrow;
pub(crate) use staunch_ir::narrow::stored;
use staunch_ir::{Elementary, Expr, Op, Type, Value};

/// A checked expression, or a number that no type has been asked of yet.
#[derive(Clone, Debug)]
pub(crate) enum Operand {
    Typed(Expr),
    /// Computed at more bits than the type has that its operands give it.
    Promoted(Expr, Elementary),
    Integer(i128),
    /// With a fraction.
    Real {
        number: Real,
    },
}

impl Operand {
    /// A number without a type, negated; another operand as it is.
    pub fn negated(self) -> Self {
        match self {
            Self::Integer(value) => Self::Integer(-value),
            Self::Real { number } => Self::Real { number: Real::Apply(Op::Neg, vec![number]) },
            Self::Typed(_) | Self::Promoted(..) => self,
        }
    }

    /// A subrange's value counts as one of the type that it is made of.
    pub fn read(self) -> Self {
        match self {
            Self::Typed(value) => Self::Typed(value.read()),
            Self::Promoted(..) | Self::Integer(_) | Self::Real { .. } => self,
        }
    }

    pub(crate) fn typed(&self) -> Option<&Expr> {
        match self {
            Self::Typed(expr) | Self::Promoted(expr, _) => Some(expr),
            Self::Integer(_) | Self::Real { .. } => None,
        }
    }

    pub fn typed_mut(&mut self) -> Option<&mut Expr> {
        match self {
            Self::Typed(expr) | Self::Promoted(expr, _) => Some(expr),
            Self::Integer(_) | Self::Real { .. } => None,
        }
    }

    pub fn is_reference(&self) -> bool {
        matches!(self.ty(), Some(Type::Reference(_)))
    }

    /// The type that it counts as where it is stored, or meets another.
    pub fn ty(&self) -> Option<Type> {
        match self {
            Self::Typed(expr) => Some(expr.ty),
            Self::Promoted(_, ty) => Some(Type::Elementary(*ty)),
            Self::Integer(_) | Self::Real { .. } => None,
        }
    }

    /// The type that it is computed at.
    pub fn computed_at(&self) -> Option<Type> {
        self.typed().map(|it| it.ty)
    }

    /// A promoted value cut to the type that its operands give it.
    pub fn cut(self) -> Self {
        match self {
            Self::Promoted(value, ty) => Self::Typed(stored(value, ty)),
            Self::Typed(_) | Self::Integer(_) | Self::Real { .. } => self,
        }
    }
}

impl<'s> Checker<'_, 's> {
    /// The expression with a concrete type: what it is computed at, else the expected one, else the default.
    pub(crate) fn typed(&mut self, expr: &ast::Expr<'s>, expected: Option<Type>) -> Option<Expr> {
        let operand = self.operand(expr, expected)?;
        self.materialise(operand, expected, expr.span)
    }

    /// Gives an untyped number a type.
    pub(crate) fn materialise(&mut self, operand: Operand, expected: Option<Type>, span: Span) -> Option<Expr> {
        let ty = match &operand {
            Operand::Typed(_) | Operand::Promoted(..) => None,
            Operand::Integer(value) => Some(integer_type(*value, expected)),
            Operand::Real { .. } => Some(match expected {
                Some(Type::Elementary(it)) if it.is_real() => it,
                _ => Elementary::Lreal,
            }),
        };
        match ty {
            Some(ty) => self.coerce(operand, Type::Elementary(ty), span),
            None => match operand {
                Operand::Typed(expr) | Operand::Promoted(expr, _) => Some(expr),
                Operand::Integer(_) | Operand::Real { .. } => None,
            },
        }
    }

    /// An untyped number as a constant of `ty`.
    pub(crate) fn literal_as(&mut self, operand: &Operand, ty: Elementary, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let value = match operand {
            Operand::Typed(expr) | Operand::Promoted(expr, _) => return Some(expr.clone()),
            Operand::Integer(_) | Operand::Real { .. } if ty.is_char() => {
                let error = Diagnostic::new(Code::E0201, span, format!("expected {}, found a number", ty.name()));
                let character = if ty == Elementary::Char { "`'A'`, or `'$41'`" } else { "`\"A\"`, or `\"$0041\"`" };
                self.report(error.label(format!("write the character: {character}")));
                return None;
            }
            Operand::Integer(value) => self.integer_as(*value, ty, span)?,
            Operand::Real { number } => self.real_as(number, ty, span)?,
        };
        Some(Expr::constant(ty, value, at))
    }

    fn integer_as(&mut self, value: i128, ty: Elementary, span: Span) -> Option<Value> {
        if ty.is_real() {
            return self.real_as(&Real::Literal(value.to_string()), ty, span);
        }
        if ty.is_time() {
            self.report(
                Diagnostic::new(
                    Code::E0201,
                    span,
                    format!("expected {}, found a number", crate::diagnostic::wording::article(ty.name())),
                )
                .label(format!("expected {}", ty.name()))
                .help(self.example(ty, value, span)),
            );
            return None;
        }
        if let Some(it) = ty.repr().integer(value) {
            return Some(it);
        }
        if let Some(it) = self.wrapped_bits(value, ty, span) {
            return Some(it);
        }
        if self.decl.dialect(span).has_bits_of_integers()
            && self.decl.log.sources.text(span).contains('#')
            && let Some(of_bits) = pattern(value, ty)
        {
            return ty.repr().integer(of_bits);
        }
        let (low, high) = ty.repr().range()?;
        self.report(
            Diagnostic::new(Code::E0202, span, format!("{value} does not fit {}", ty.name()))
                .about(Subject::Beyond(ty))
                .label(format!("{} holds {low} to {high}", ty.name())),
        );
        None
    }

    /// CODESYS writes -1 to a WORD as 65535.
    fn wrapped_bits(&mut self, value: i128, ty: Elementary, span: Span) -> Option<Value> {
        let (_, high) = ty.repr().range()?;
        let mixes = self.decl.dialect(span).mixes_bits_and_integers();
        if !mixes || !value.is_negative() || ty == Elementary::Bool || !ty.repr().is_unsigned() || -value > high / 2 + 1
        {
            return None;
        }
        self.report(
            Diagnostic::new(Code::W0506, span, format!("{value} becomes {} in {}", value + high + 1, ty.name()))
                .label(format!("{} has no sign", ty.name())),
        );
        ty.repr().integer(value + high + 1)
    }

    fn real_as(&mut self, number: &Real, ty: Elementary, span: Span) -> Option<Value> {
        if !ty.is_real() {
            self.report(
                Diagnostic::new(Code::E0203, span, format!("a number with a fraction does not fit {}", ty.name()))
                    .label(format!("expected {}", ty.name()))
                    .help(format!("round it with `REAL_TO_{}(…)`, or cut it with `TRUNC(…)`", ty.name())),
            );
            return None;
        }
        if !number.fits(ty.repr()) {
            self.error(Code::E0202, span, format!("this number is too large for {}", ty.name()));
            return None;
        }
        if ty == Elementary::Real && self.literals_are_doubles(span) {
            let double = number.value(Elementary::Lreal.repr())?;
            return Some(staunch_runtime::ops::convert_value(double, ty.repr()));
        }
        number.value(ty.repr())
    }

    /// An example of a literal of a type that has no plain numbers.
    fn example(&self, ty: Elementary, number: i128, span: Span) -> String {
        let rules = self.decl.dialect(span).rules();
        match ty {
            Elementary::Date | Elementary::Ldate => "write the date: `D#2024-02-29`".to_owned(),
            Elementary::Tod | Elementary::Ltod => "write the time of day: `TOD#23:59:59.5`".to_owned(),
            Elementary::Dt | Elementary::Ldt => "write date and time of day: `DT#2024-02-29-23:59:59.5`".to_owned(),
            _ if rules.limits(ty).is_some_and(|it| number < it.0) => "a duration cannot be negative here".to_owned(),
            _ => format!("write the unit: `T#{number}ms`"),
        }
    }
}

/// The expected type where the value fits it, else the smallest of INT, DINT, LINT, ULINT.
fn integer_type(value: i128, expected: Option<Type>) -> Elementary {
    if let Some(Type::Elementary(expected)) = expected {
        let fits = expected.is_real() || (expected.is_integral() && expected.repr().integer(value).is_some());
        if fits && expected != Elementary::Bool {
            return expected;
        }
    }
    let candidates = [Elementary::Int, Elementary::Dint, Elementary::Lint];
    let fitting = candidates.into_iter().find(|it| it.repr().integer(value).is_some());
    fitting.unwrap_or(Elementary::Ulint)
}

/// A value of the type that its operands give it, whatever it was computed at.
pub(crate) fn computed(value: Expr, ty: Type) -> Operand {
    let may_be_wider = |it: Elementary| is_narrow(it) || matches!(it, Elementary::Dint | Elementary::Real);
    match ty {
        Type::Elementary(ty) if value.ty != Type::Elementary(ty) && may_be_wider(ty) => Operand::Promoted(value, ty),
        _ => Operand::Typed(value),
    }
}

/// The number that a type has for the bits of a literal, `16#FFFF_FFFF` is -1; `None` where they are too many.
pub(crate) fn pattern(value: i128, ty: Elementary) -> Option<i128> {
    let bits = ty.repr().size() * 8;
    let wrapped = if value >> bits == 0 && ty.repr().integer(value).is_none() { value - (1 << bits) } else { value };
    ty.repr().integer(wrapped).map(|_| wrapped)
}
