//! The narrow form of an expression has the low bits of the wide one.

use super::*;
use crate::{Const, Location, Value};

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
    match crate::fold(&Expr::new(expr.ty, kind, AT))? {
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
