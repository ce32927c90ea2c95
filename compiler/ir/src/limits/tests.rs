//! What lengths and constants say of an expression, and of a loop over a string.

use super::*;
use crate::fixture::{AT, add, int, load, name, temp, wide};
use crate::{For, Op, Place, Step, StringType, Taking};

fn len(place: Place) -> Expr {
    Expr::new(Type::INT, ExprKind::ApplyText(TextOp::Len, vec![load(place)]), AT)
}

/// A string of so many units in place of `name`, which is of 8.
fn of(capacity: u16) -> Place {
    Place { ty: Type::String(StringType { wide: false, capacity }), ..name() }
}

fn less(a: Expr, b: Expr) -> Expr {
    Expr::apply(Op::Sub, Type::INT, vec![a, b], AT)
}

#[test]
fn a_length_is_within_the_capacity() {
    assert_eq!(limits(&len(name())), Some((0, 8)));
    assert_eq!(limits(&add(len(name()), int(1))), Some((1, 9)));
    assert_eq!(limits(&less(len(of(20)), len(name()))), Some((-8, 20)));
    assert_eq!(limits(&len(of(40_000))), Some((0, 32_767)), "LEN saturates");
}

#[test]
fn variables_and_what_wraps_may_be_anything() {
    assert_eq!(limits(&load(temp())), None);
    assert_eq!(limits(&add(len(name()), load(temp()))), None);
    assert_eq!(limits(&add(int(i16::MAX), int(1))), None);
    assert_eq!(limits(&add(len(of(40_000)), int(1))), None);
    let narrow = |from| Expr::convert(Conversion::Value, Type::Elementary(crate::Elementary::Sint), from, AT);
    assert_eq!((limits(&narrow(len(of(127)))), limits(&narrow(len(of(128))))), (Some((0, 127)), None));
    assert_eq!(limits(&Expr::convert(Conversion::Truncate, Type::INT, load(wide()), AT)), None);
}

fn counted(first: Expr, last: Expr, step: i128) -> For {
    let range = (i16::MIN.into(), i16::MAX.into());
    let (body, taking, step) = (Vec::new(), Taking::Each, Step::Constant(step));
    For { counter: temp(), first, last, step, range, is_private: true, body, taking, step_at: AT }
}

#[test]
fn a_loop_over_a_string_is_as_short_as_the_string() {
    let up = |capacity| counted(int(1), len(of(capacity)), 1);
    assert_eq!(up(1024).bounds(), (1, 1024));
    assert_eq!((up(1024).is_short(), up(1025).is_short()), (true, false));
    assert_eq!((up(32_766).may_leave_range(), up(32_767).may_leave_range()), (false, true));
    let down = counted(len(of(9)), less(int(0), len(of(5))), -2);
    assert_eq!((down.bounds(), down.may_leave_range()), ((-5, 9), false));
    let far = counted(int(0), less(int(-32_760), len(of(7))), -2);
    assert_eq!((far.bounds(), far.may_leave_range()), ((-32_767, 0), true));
    let unknown = counted(load(temp()), len(name()), 1);
    assert_eq!((unknown.bounds(), unknown.is_short()), ((i16::MIN.into(), 8), false));
}
