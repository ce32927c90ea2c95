//! Promotion: where a dialect computes integers of fewer than 32 bits at 32, a value is a DINT until
//! it is stored. Until then it has the type that its operands give it in addition to the one it is computed at.

use super::checker::Checker;
use crate::Span;
use crate::types::coercion::is_narrow;
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, Location, Op, Type};

impl Checker<'_, '_> {
    pub(crate) fn promotes(&self, ty: Elementary, span: Span) -> bool {
        is_narrow(ty) && self.decl.dialect(span).rules().promotes_integers()
    }

    /// Whether functions, too, compute values of this type at DINT.
    pub(crate) fn promotes_in_functions(&self, ty: Elementary, span: Span) -> bool {
        self.promotes(ty, span) && !self.decl.dialect(span).rules().promotes_as_c()
    }

    /// The value at DINT, where the dialect computes those of its type there.
    pub(crate) fn promote(&mut self, value: Expr, span: Span) -> Expr {
        match value.ty {
            Type::Elementary(it) if self.promotes(it, span) => self.convert(Conversion::Value, Type::DINT, value),
            _ => value,
        }
    }
}

/// A promoted value where it is stored: its low bits. They are computed at the type of the store where
/// that gives the same ones.
pub(crate) fn stored(value: Expr, to: Elementary) -> Expr {
    if is_narrow(to)
        && let ExprKind::Apply(..) = value.kind
        && let Some(narrow) = low_bits(&value, to)
    {
        return narrow;
    }
    converted(value, to)
}

/// What gives the same low bits at `to`: no higher bit of an operand changes them.
fn low_bits(value: &Expr, to: Elementary) -> Option<Expr> {
    match &value.kind {
        ExprKind::Const(_) => Some(converted(value.clone(), to)),
        ExprKind::Convert(Conversion::Value, inner) => {
            let from = inner.ty.elementary().filter(|it| is_narrow(*it) && it.repr().size() <= to.repr().size())?;
            let is_read = inner.ty == Type::Elementary(from);
            is_read.then(|| converted((**inner).clone(), to))
        }
        ExprKind::Apply(op @ (Op::Add | Op::Sub | Op::Mul | Op::Neg | Op::And | Op::Or | Op::Xor), operands) => {
            let operands = operands.iter().map(|it| low_bits(it, to)).collect::<Option<_>>()?;
            Some(Expr::apply(*op, Type::Elementary(to), operands, value.at))
        }
        ExprKind::Apply(..)
        | ExprKind::ApplyText(..)
        | ExprKind::Convert(Conversion::Same | Conversion::Truncate | Conversion::Bits, _)
        | ExprKind::Load(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Text(_)
        | ExprKind::Aggregate(_) => None,
    }
}

/// An integer at another type, folded where it is constant.
fn converted(value: Expr, to: Elementary) -> Expr {
    let (at, ty): (Location, _) = (value.at, Type::Elementary(to));
    if value.ty == ty {
        return value;
    }
    if let Some(constant) = value.as_const() {
        return Expr::constant(to, staunch_runtime::ops::convert_value(constant, to.repr()), at);
    }
    let same = value.ty.elementary().is_some_and(|it| it.repr() == to.repr());
    Expr::convert(if same { Conversion::Same } else { Conversion::Value }, ty, value, at)
}

#[cfg(test)]
mod tests {
    use super::{low_bits, stored};
    use crate::types::coercion::is_narrow;
    use staunch_ir::{Const, Conversion, Elementary, Expr, ExprKind, Location, Op, Type, Value};

    const AT: Location = Location { file: 0, column: 0, line: 0 };

    fn value(expr: &Expr) -> Option<Value> {
        let constant = |it: &Expr| Some(Expr::constant(it.ty.elementary()?, value(it)?, AT));
        let kind = match &expr.kind {
            ExprKind::Apply(op, operands) => {
                ExprKind::Apply(*op, operands.iter().map(constant).collect::<Option<Vec<_>>>()?)
            }
            ExprKind::Convert(how, operand) => ExprKind::Convert(*how, Box::new(constant(operand)?)),
            other => other.clone(),
        };
        match staunch_ir::fold(&Expr::new(expr.ty, kind, AT))? {
            Ok(Const::Scalar(value)) => Some(value),
            Ok(_) | Err(_) => None,
        }
    }

    /// A value of a narrow type at 32 bits.
    fn leaf(ty: Elementary, number: i128) -> Option<Expr> {
        let value = Expr::constant(ty, ty.repr().integer(number)?, AT);
        Some(Expr::convert(Conversion::Value, Type::DINT, value, AT))
    }

    fn edges(ty: Elementary) -> Vec<Expr> {
        let (low, high) = ty.repr().range().unwrap_or_default();
        let numbers = [low, low + 1, -1, 0, 1, 2, 7, high / 2 + 1, high - 1, high];
        numbers.into_iter().filter_map(|it| leaf(ty, it)).collect()
    }

    #[test]
    fn narrow_operations_give_the_low_bits_of_wide_ones() {
        let narrow = || Elementary::ALL.iter().copied().filter(|it| is_narrow(*it));
        let dint = |op, operands| Expr::apply(op, Type::DINT, operands, AT);
        let mut compared = 0;
        for to in narrow() {
            let from = narrow().filter(|it| it.repr().size() <= to.repr().size());
            let leaves: Vec<_> = from.flat_map(edges).collect();
            let mut wide: Vec<_> = leaves.iter().map(|it| dint(Op::Neg, vec![it.clone()])).collect();
            for (at, a) in leaves.iter().enumerate() {
                for (b, op) in leaves.iter().zip([Op::Add, Op::Sub, Op::Mul, Op::And, Op::Or, Op::Xor].iter().cycle()) {
                    let inner = dint(*op, vec![a.clone(), b.clone()]);
                    let again = leaves[at / 2].clone();
                    wide.push(dint(Op::Mul, vec![dint(Op::Neg, vec![inner.clone()]), again.clone()]));
                    wide.extend([Op::Add, Op::Sub, Op::Mul].map(|op| dint(op, vec![inner.clone(), again.clone()])));
                    wide.extend([Op::Add, Op::Sub, Op::Mul].map(|op| dint(op, vec![a.clone(), b.clone()])));
                    wide.push(inner);
                }
            }
            for wide in wide {
                let narrow = stored(wide.clone(), to);
                assert!(low_bits(&wide, to).is_some() && matches!(narrow.kind, ExprKind::Apply(..)));
                let cut = Expr::convert(Conversion::Value, Type::Elementary(to), wide, AT);
                assert!(value(&narrow).is_some());
                assert_eq!(value(&narrow), value(&cut), "{narrow:?} and {cut:?}");
                compared += 1;
            }
        }
        assert!(compared > 10_000);
    }

    #[test]
    fn what_depends_on_higher_bits_stays_wide() {
        for op in [Op::Div, Op::Mod, Op::Shr, Op::Max] {
            let operands = vec![edges(Elementary::Int)[0].clone(), edges(Elementary::Int)[3].clone()];
            let wide = Expr::apply(op, Type::DINT, operands, AT);
            assert!(low_bits(&wide, Elementary::Int).is_none());
        }
        let word = leaf(Elementary::Word, 256).map(|it| Expr::apply(Op::Neg, Type::DINT, vec![it], AT));
        assert!(word.is_some_and(|it| low_bits(&it, Elementary::Usint).is_none()), "a wider operand");
    }
}
