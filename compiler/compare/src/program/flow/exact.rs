//! The plain form of an expression: the one that says least of how a system computes it. Whole numbers are computed as LINTs,
//! and cut to a type only where that changes them, so that what two systems compute in other types has one form where it has
//! one value. It is printed, and never run.

use super::known::Known;
use staunch_ir::interval::{Range, result};
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, LocalId, Op, Place, Projection, Root, Type, Value};
use std::collections::HashMap;
use std::rc::Rc;

/// Expressions of more parts are not put in place of a variable.
const MOST_PARTS: usize = 64;

const LINT: Range = (i64::MIN as i128, i64::MAX as i128);

const LINT_TYPE: Type = Type::Elementary(Elementary::Lint);

/// What variables of a call hold, as far as nothing that they are computed of has changed since.
pub type Values = HashMap<LocalId, Rc<Expr>>;

/// Where an expression is.
#[derive(Clone, Copy)]
pub struct Here<'a, 'n, 'p> {
    pub known: &'a Known<'n, 'p>,
    pub values: &'a Values,
}

impl Here<'_, '_, '_> {
    pub fn plain(&self, expr: &Expr) -> Expr {
        if let Some(number) = self.exact(expr) {
            return self.cut(expr.ty, number);
        }
        let kind = match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => expr.kind.clone(),
            ExprKind::Load(place) => match self.value(place) {
                Some(value) => return value,
                None => ExprKind::Load(self.place(place)),
            },
            ExprKind::AddressOf(place) => ExprKind::AddressOf(Box::new(self.place(place))),
            ExprKind::Apply(op, operands) if is_comparison(*op) => match self.decided(expr) {
                Some(it) => ExprKind::Const(Value::Bool(it)),
                None => ExprKind::Apply(*op, self.numbers(operands)),
            },
            ExprKind::Apply(op, operands) => ExprKind::Apply(*op, self.each(operands)),
            ExprKind::ApplyText(op, operands) => {
                let text = Expr { ty: expr.ty, kind: ExprKind::ApplyText(*op, self.each(operands)), at: expr.at };
                // It is cut at the capacity of its type, which is printed so.
                ExprKind::Convert(Conversion::Value, Box::new(text))
            }
            ExprKind::Convert(Conversion::Value, inner) => {
                let inner = self.exact(inner).unwrap_or_else(|| self.plain(inner));
                ExprKind::Convert(Conversion::Value, Box::new(inner))
            }
            ExprKind::Convert(how, inner) => ExprKind::Convert(*how, Box::new(self.plain(inner))),
        };
        Expr { ty: expr.ty, kind, at: expr.at }
    }

    pub fn place(&self, place: &Place) -> Place {
        let projection = |it: &Projection| match it {
            Projection::Index { index, at } => Projection::Index { index: Box::new(self.plain(index)), at: *at },
            Projection::Field(_) | Projection::Deref { .. } => it.clone(),
        };
        Place { projections: place.projections.iter().map(projection).collect(), ..place.clone() }
    }

    /// A LINT as a number of a type.
    fn cut(&self, ty: Type, number: Expr) -> Expr {
        let at = number.at;
        match ty {
            Type::Enum(id) => {
                let base = Type::Elementary(self.known.names.program.enumeration(id).base);
                Expr::convert(Conversion::Same, ty, self.cut(base, number), at)
            }
            _ if ty == number.ty => number,
            _ => Expr::convert(Conversion::Value, ty, number, at),
        }
    }

    /// Whether a condition is met, if that is known.
    pub fn decided(&self, condition: &Expr) -> Option<bool> {
        match [true, false].map(|holds| self.known.when(condition, holds).is_some()) {
            [true, false] => Some(true),
            [false, true] => Some(false),
            [false, false] | [true, true] => None,
        }
    }

    fn each(&self, operands: &[Expr]) -> Vec<Expr> {
        operands.iter().map(|it| self.plain(it)).collect()
    }

    /// Whole numbers as LINTs, if all are.
    fn numbers(&self, operands: &[Expr]) -> Vec<Expr> {
        let exact: Option<Vec<Expr>> = operands.iter().map(|it| self.exact(it)).collect();
        exact.unwrap_or_else(|| self.each(operands))
    }

    /// What a variable of the call holds.
    fn value(&self, place: &Place) -> Option<Expr> {
        match place.root {
            Root::Local(local) if place.projections.is_empty() => self.values.get(&local).map(|it| (**it).clone()),
            Root::Local(_) | Root::Instance | Root::Globals | Root::Param(_) => None,
        }
    }

    /// A LINT of the same number; `None` where it is not a whole number that a LINT holds.
    fn exact(&self, expr: &Expr) -> Option<Expr> {
        let may_be = self.known.of(expr).filter(|it| it.lies_in(LINT))?;
        if let Some(number) = may_be.number() {
            return constant(number, expr);
        }
        match &expr.kind {
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) => match self.known.of(inner) {
                Some(own) if own.lies_in(self.known.whole(expr.ty)?) => self.exact(inner),
                Some(_) => Some(lint(self.cut(expr.ty, self.low_bits(expr, self.bits(expr)?)?))),
                None => self.as_it_is(expr),
            },
            ExprKind::Apply(op, operands) => self.operation(expr, self.known.standard(*op, operands), operands),
            ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::Load(_)
            | ExprKind::AddressOf(_)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => self.as_it_is(expr),
        }
    }

    fn operation(&self, expr: &Expr, op: Op, operands: &[Expr]) -> Option<Expr> {
        if let (Op::CheckIndex | Op::InRange, [low, it, high]) = (op, operands) {
            let limits = (self.known.of(low)?.range.1, self.known.of(high)?.range.0);
            let is_inside = self.known.of(it)?.lies_in(limits);
            return if is_inside { self.exact(it) } else { self.as_it_is(expr) };
        }
        if let (Op::Sel, [which, a, b]) = (op, operands) {
            let operands = vec![self.plain(which), self.exact(a)?, self.exact(b)?];
            return Some(applied(op, operands, expr));
        }
        let whole = self.known.whole(expr.ty)?;
        let exact = self.known.all(operands).and_then(|it| result(op, &it)).filter(|it| it.lies_in(LINT));
        match exact {
            Some(it) if it.lies_in(whole) => Some(applied(op, self.all_exact(operands)?, expr)),
            Some(_) if matches!(op, Op::Add | Op::Sub | Op::Mul | Op::Neg | Op::Div | Op::Mod) => {
                Some(lint(self.cut(expr.ty, self.low_bits(expr, self.bits(expr)?)?)))
            }
            Some(_) | None => self.as_it_is(expr),
        }
    }

    fn all_exact(&self, operands: &[Expr]) -> Option<Vec<Expr>> {
        operands.iter().map(|it| self.exact(it)).collect()
    }

    /// Bits of the numbers of an expression.
    fn bits(&self, expr: &Expr) -> Option<u32> {
        self.known.whole(expr.ty).map(|(least, greatest)| {
            let values = greatest.abs_diff(least);
            u128::BITS - values.leading_zeros()
        })
    }

    /// A LINT that has the same low bits.
    fn low_bits(&self, expr: &Expr, bits: u32) -> Option<Expr> {
        let keeps = |it: &Expr| self.bits(it).is_some_and(|it| it >= bits);
        match &expr.kind {
            ExprKind::Apply(op, operands) if keeps(expr) => match self.known.standard(*op, operands) {
                op @ (Op::Add | Op::Sub | Op::Mul | Op::Neg) => {
                    let operands: Option<Vec<Expr>> = operands.iter().map(|it| self.low_bits(it, bits)).collect();
                    Some(applied(op, operands?, expr))
                }
                // What a quotient of LINTs is cut to.
                op @ (Op::Div | Op::Mod)
                    if self.known.all(operands).and_then(|it| result(op, &it)).is_some_and(|it| it.lies_in(LINT)) =>
                {
                    Some(applied(op, self.all_exact(operands)?, expr))
                }
                _ => self.exact(expr),
            },
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) if keeps(expr) => {
                if keeps(inner) {
                    self.low_bits(inner, bits)
                } else {
                    self.exact(inner)
                }
            }
            ExprKind::Const(value) => {
                let number = value.as_integer()?;
                let size = 1_i128.checked_shl(bits)?;
                let low = number.rem_euclid(size);
                constant(if low >= size / 2 { low - size } else { low }, expr)
            }
            ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::Load(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => self.exact(expr),
        }
    }

    /// Computed in its own type, of plain parts.
    fn as_it_is(&self, expr: &Expr) -> Option<Expr> {
        let kind = match &expr.kind {
            ExprKind::Load(place) => match self.value(place) {
                // It has been cut to what the variable holds.
                Some(Expr { kind: ExprKind::Convert(Conversion::Value, number), .. }) if number.ty == LINT_TYPE => {
                    return Some(*number);
                }
                Some(value) => return Some(lint(value)),
                None => ExprKind::Load(self.place(place)),
            },
            ExprKind::Apply(op, operands) => ExprKind::Apply(*op, self.each(operands)),
            ExprKind::ApplyText(op, operands) => ExprKind::ApplyText(*op, self.each(operands)),
            ExprKind::Convert(how, inner) => ExprKind::Convert(*how, Box::new(self.plain(inner))),
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) | ExprKind::AddressOf(_) => return None,
        };
        Some(lint(Expr { ty: expr.ty, kind, at: expr.at }))
    }
}

/// Whether it is small enough to be put in place of a variable.
pub fn is_small(expr: &Expr) -> bool {
    parts(expr) <= MOST_PARTS
}

fn parts(expr: &Expr) -> usize {
    1 + match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => 0,
        ExprKind::Load(place) => place.indices().map(parts).sum(),
        ExprKind::AddressOf(place) => place.indices().map(parts).sum(),
        ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => operands.iter().map(parts).sum(),
        ExprKind::Convert(_, inner) => parts(inner),
    }
}

fn applied(op: Op, mut operands: Vec<Expr>, of: &Expr) -> Expr {
    // Systems take them in either order, which decides nothing of whole numbers.
    if matches!(op, Op::Min | Op::Max) {
        operands.sort_by_cached_key(|it| format!("{it:?}"));
    }
    Expr::apply(op, LINT_TYPE, operands, of.at)
}

fn constant(number: i128, of: &Expr) -> Option<Expr> {
    let value = Value::I64(number.try_into().ok()?);
    Some(Expr::constant(Elementary::Lint, value, of.at))
}

/// As a LINT.
fn lint(expr: Expr) -> Expr {
    let at = expr.at;
    if expr.ty == LINT_TYPE { expr } else { Expr::convert(Conversion::Value, LINT_TYPE, expr, at) }
}

fn is_comparison(op: Op) -> bool {
    matches!(op, Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne)
}
