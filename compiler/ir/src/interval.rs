//! Arithmetic on what whole numbers may be.

use crate::{Expr, Op};

/// The least and the greatest that a number may be, inclusive.
pub type Range = (i128, i128);

/// What a number may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interval {
    pub range: Range,
    /// Though 0 lies between the least and the greatest, it is not that.
    pub is_not_zero: bool,
}

impl Interval {
    pub fn new(range: Range) -> Self {
        Self { range, is_not_zero: range.0 > 0 || range.1 < 0 }
    }

    pub fn only(number: i128) -> Self {
        Self::new((number, number))
    }

    /// The one number that it is.
    pub fn number(self) -> Option<i128> {
        (self.range.0 == self.range.1).then_some(self.range.0)
    }

    pub fn lies_in(self, (least, greatest): Range) -> bool {
        least <= self.range.0 && self.range.1 <= greatest
    }

    /// What either may be.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        let range = (self.range.0.min(other.range.0), self.range.1.max(other.range.1));
        Self { range, is_not_zero: self.is_not_zero && other.is_not_zero }
    }

    /// What both may be; `None` where that is nothing.
    pub fn and(self, (least, greatest): Range) -> Option<Self> {
        let mut range = (self.range.0.max(least), self.range.1.min(greatest));
        if self.is_not_zero {
            range = (range.0 + i128::from(range.0 == 0), range.1 - i128::from(range.1 == 0));
        }
        let is_not_zero = self.is_not_zero || range.0 > 0 || range.1 < 0;
        (range.0 <= range.1).then_some(Self { range, is_not_zero })
    }

    pub fn without_zero(self) -> Option<Self> {
        Self { is_not_zero: true, ..self }.and(self.range)
    }
}

/// The range of an operation's exact result, from the ranges of its operands.
pub(crate) fn of_operands(op: Op, operands: &[Expr], range: impl Fn(&Expr) -> Option<Range>) -> Option<Range> {
    let operands: Vec<Interval> = operands.iter().map(|it| range(it).map(Interval::new)).collect::<Option<_>>()?;
    Some(result(op, &operands)?.range)
}

/// What an operation has as its exact result; `None` where nothing is said of that.
pub fn result(op: Op, operands: &[Interval]) -> Option<Interval> {
    let range = match (op, operands) {
        (Op::Add, [a, b]) => (a.range.0.checked_add(b.range.0)?, a.range.1.checked_add(b.range.1)?),
        (Op::Sub, [a, b]) => (a.range.0.checked_sub(b.range.1)?, a.range.1.checked_sub(b.range.0)?),
        (Op::Mul, [a, b]) => of_corners(a.range, b.range, i128::checked_mul)?,
        (Op::Neg, [a]) => (a.range.1.checked_neg()?, a.range.0.checked_neg()?),
        (Op::Abs, [a]) => {
            let (low, high) = (a.range.0.checked_abs()?, a.range.1.checked_abs()?);
            let least = if a.range.0 <= 0 && a.range.1 >= 0 { 0 } else { low.min(high) };
            (least, low.max(high))
        }
        (Op::Min, [a, b]) => (a.range.0.min(b.range.0), a.range.1.min(b.range.1)),
        (Op::Max, [a, b]) => (a.range.0.max(b.range.0), a.range.1.max(b.range.1)),
        // Where the limits are crossed, the upper one is the result.
        (Op::Limit, [low, a, high]) => {
            let least = (a.range.0.max(low.range.0), a.range.1.max(low.range.1));
            (least.0.min(high.range.0), least.1.min(high.range.1))
        }
        (Op::Div, [a, b]) => quotient(a.range, *b)?,
        (Op::Mod, [a, b]) => remainder(a.range, *b)?,
        // A mask leaves some of the bits.
        (Op::And, [a, b]) => {
            let masks = [a, b].into_iter().filter(|it| it.range.0 >= 0);
            (0, masks.map(|it| it.range.1).min()?)
        }
        _ => return None,
    };
    Some(Interval::new(range))
}

fn of_corners(a: Range, b: Range, op: fn(i128, i128) -> Option<i128>) -> Option<Range> {
    let corners = [op(a.0, b.0)?, op(a.0, b.1)?, op(a.1, b.0)?, op(a.1, b.1)?];
    Some((*corners.iter().min()?, *corners.iter().max()?))
}

/// The quotient goes one way with the divisor on each side of 0.
fn quotient(a: Range, b: Interval) -> Option<Range> {
    if !b.is_not_zero {
        return None;
    }
    let sides = [b.and((i128::MIN, -1)), b.and((1, i128::MAX))];
    let found = sides.into_iter().flatten().map(|side| of_corners(a, side.range, i128::checked_div));
    found.reduce(|a, b| a.zip(b).map(|(a, b)| (a.0.min(b.0), a.1.max(b.1))))?
}

/// A remainder has the dividend's sign, is at most as far from 0, and smaller than the divisor.
fn remainder(a: Range, b: Interval) -> Option<Range> {
    if !b.is_not_zero {
        return None;
    }
    let most = b.range.0.checked_abs()?.max(b.range.1.checked_abs()?) - 1;
    Some((a.0.min(0).max(-most), a.1.max(0).min(most)))
}
