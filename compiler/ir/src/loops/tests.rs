//! Which counters are private, and which values expressions have in loops.

use super::*;
use crate::fixture::{AT, assign, call_adder, count, int, lint, load, local, sample, stmt, temp, total, value, values};
use crate::{Argument, Array, BoundsId, Const, Elementary, LocalId, RoutineId, Step, StructId, Taking, Type, apply};

const MAIN: usize = 3;

fn counted(counter: Place, first: i16, last: i16, step: i128) -> For {
    For {
        counter,
        first: int(first),
        last: int(last),
        step: Step::Constant(step),
        range: (i16::MIN.into(), i16::MAX.into()),
        is_private: true,
        body: Vec::new(),
        taking: Taking::Each,
        step_at: AT,
    }
}

fn private(counter: &Place, body: Vec<Statement>) -> bool {
    let program = sample(Vec::new());
    is_private(&Frame::of(&program, &program.routines[MAIN]), counter, &body)
}

#[test]
fn a_counter_is_private_while_nobody_else_can_write_it() {
    let [read, other] = [|| assign(temp(), load(count())), || assign(temp(), int(1))];
    assert!(private(&count(), vec![read(), other(), call_adder(temp())]));
    assert!(!private(&count(), vec![assign(count(), int(1))]));
    assert!(!private(&count(), vec![call_adder(count())]));
    let inner = stmt(StatementKind::If {
        condition: Expr::bool(true, AT),
        then: vec![assign(count(), int(1))],
        otherwise: vec![],
    });
    assert!(!private(&count(), vec![inner]));
    assert!(private(&temp(), vec![]) && !private(&temp(), vec![read()]));
    assert!(!private(&total(), vec![]), "globals are everybody's");
    assert!(!private(&value(lint(1), 1), vec![]), "elements are not known by a name");
    assert!(!private(&values(), vec![assign(value(lint(1), 1), int(1))]));
    assert!(private(&count(), vec![assign(value(load(count()), 1), int(1)), call_adder(value(lint(1), 1))]));
}

#[test]
fn a_variable_of_an_instance_that_is_come_back_to_is_private_where_nothing_is_called() {
    let mut program = sample(Vec::new());
    program.reentered.insert(StructId(1));
    let private = |body: &[Statement]| is_private(&Frame::of(&program, &program.routines[MAIN]), &count(), body);
    assert!(private(&[]) && private(&[assign(temp(), int(1))]));
    assert!(!private(&[call_adder(temp())]) && !private(&[assign(count(), int(1))]));
}

/// What an expression of two counters may be holds for each of their values.
#[test]
fn ranges_hold_for_every_value() {
    let program = sample(Vec::new());
    let other = crate::fixture::limit();
    for (first, last, step) in [(-3, 4, 1), (-3, 1, 1), (-1, 4, 1), (0, 7, 2), (5, -2, -3), (300, 310, 1)] {
        let (a, b) = (counted(temp(), first, last, step), counted(other.clone(), -2, 3, 1));
        let loops = [&a, &b];
        let known = Known { program: &program, loops: &loops, checked: &|_| false, seen: &[] };
        for op in [Op::Add, Op::Sub, Op::Mul, Op::Mod, Op::And, Op::Or, Op::Max] {
            for right in [load(other.clone()), int(0), int(1), int(6), int(-4), int(i16::MAX)] {
                let expr = Expr::apply(op, Type::INT, vec![load(temp()), right.clone()], AT);
                let (least, most) = known.range(&expr).unwrap();
                let mut x = first;
                while if step > 0 { x <= last } else { x >= last } {
                    for y in -2..=3_i16 {
                        let y = right.as_const().unwrap_or(Value::I16(y));
                        if let Some(Ok(found)) = apply(op, Repr::I16, &[Value::I16(x), y]) {
                            let found = found.as_integer().unwrap();
                            assert!(
                                (least..=most).contains(&found),
                                "{op:?} {x} {y:?}: {found} not in {least}..{most}"
                            );
                        }
                    }
                    x += i16::try_from(step).unwrap();
                }
            }
        }
    }
}

/// No wider than what the values may be, up to the limits of the type.
#[test]
fn ranges_are_as_narrow_as_they_can_be() {
    let program = sample(Vec::new());
    let other = counted(crate::fixture::limit(), -2, 3, 1);
    let range = |first, last, op, right: Expr| {
        let counter = counted(temp(), first, last, 1);
        let known = Known { program: &program, loops: &[&counter, &other], checked: &|_| false, seen: &[] };
        known.range(&Expr::apply(op, Type::INT, vec![load(temp()), right], AT)).unwrap()
    };
    let beside = || load(crate::fixture::limit());
    assert_eq!(range(-3, 4, Op::Add, beside()), (-5, 7));
    assert_eq!(range(-3, 4, Op::Sub, beside()), (-6, 6));
    assert_eq!(range(-3, 4, Op::Mul, beside()), (-9, 12));
    assert_eq!((range(-3, 4, Op::Mod, int(6)), range(-30, 40, Op::Mod, int(6))), ((-3, 4), (-5, 5)));
    assert_eq!((range(0, 9, Op::Mod, int(6)), range(-9, 0, Op::Mod, int(6))), ((0, 5), (-5, 0)));
    assert_eq!((range(-1, 9, Op::Mod, int(6)), range(-9, 1, Op::Mod, int(6))), ((-1, 5), (-5, 1)));
    assert_eq!((range(-3, 4, Op::And, int(6)), range(-3, 4, Op::And, int(0))), ((0, 6), (0, 0)));
    let (least, most) = (i128::from(i16::MIN), i128::from(i16::MAX));
    assert_eq!(range(0, i16::MAX - 1, Op::Add, int(1)), (1, most));
    assert_eq!(range(i16::MIN + 1, 0, Op::Sub, int(1)), (least, -1));
    assert_eq!(range(i16::MIN, 0, Op::Sub, int(1)), (least, most));
}

/// Where the inner loop starts and ends follows from what the outer counter may be, and not the other way round.
#[test]
fn an_inner_counter_is_bounded_by_the_loops_around() {
    let program = sample(Vec::new());
    let (outer, inner) = (temp(), crate::fixture::limit());
    let around = counted(outer.clone(), 0, 6, 1);
    let rest = Expr::apply(Op::Sub, Type::INT, vec![int(6), load(outer.clone())], AT);
    let range = |it: For, loops_around: &[&For]| {
        let loops: Vec<_> = loops_around.iter().copied().chain([&it]).collect();
        Known { program: &program, loops: &loops, checked: &|_| false, seen: &[] }.range(&load(inner.clone())).unwrap()
    };
    let up = || For { last: rest.clone(), ..counted(inner.clone(), 0, 0, 1) };
    assert_eq!(range(up(), &[&around]), (0, 6));
    assert_eq!(range(up(), &[]), (0, i16::MAX.into()), "the outer variable may be anything");
    let down = For { first: rest.clone(), ..counted(inner.clone(), 0, 0, -1) };
    assert_eq!(range(down, &[&around]), (0, 6));
    let beyond = Expr::apply(Op::Add, Type::INT, vec![int(i16::MAX), load(outer.clone())], AT);
    let wraps = For { last: beyond, ..counted(inner.clone(), 0, 0, 1) };
    assert_eq!(range(wraps, &[&around]), (0, i16::MAX.into()));
    let next = |limit: i16| Expr::apply(Op::Add, Type::INT, vec![load(outer.clone()), int(limit)], AT);
    let known = Known { program: &program, loops: &[&around], checked: &|_| false, seen: &[] };
    assert!(known.is_exact(&next(i16::MAX - 6)) && !known.is_exact(&next(i16::MAX - 5)));
}

#[test]
fn what_leaves_its_type_may_be_anything() {
    let program = sample(Vec::new());
    let counter = counted(temp(), 0, i16::MAX, 1);
    let known = Known { program: &program, loops: &[&counter], checked: &|_| false, seen: &[] };
    let next = Expr::apply(Op::Add, Type::INT, vec![load(temp()), int(1)], AT);
    assert_eq!(known.range(&next), Some((i16::MIN.into(), i16::MAX.into())));
    assert_eq!(known.range(&load(temp())), Some((0, i16::MAX.into())));
}

#[test]
fn a_loop_is_left_by_a_lone_exit() {
    let test = |then, otherwise| stmt(StatementKind::If { condition: Expr::bool(true, AT), then, otherwise });
    let exit = || stmt(StatementKind::Exit);
    assert!(exit_condition(&test(vec![exit()], vec![])).is_some());
    assert!(exit_condition(&test(vec![exit()], vec![assign(temp(), int(1))])).is_none());
    assert!(exit_condition(&test(vec![assign(temp(), int(1))], vec![])).is_none());
    assert!(exit_condition(&test(vec![assign(temp(), int(1)), exit()], vec![])).is_none());
    assert!(exit_condition(&test(vec![], vec![exit()])).is_none() && exit_condition(&exit()).is_none());
}

const INDEX: Type = Type::Subrange(Elementary::Lint, BoundsId(0));

/// Main with a local of LINT(1..9), and this body.
fn with_index(body: impl FnOnce(Place) -> Vec<Statement>) -> Program {
    let mut program = sample(Vec::new());
    let id = LocalId::next(program.routines[MAIN].locals.len());
    program.bounds = vec![(1, 9)];
    program.arrays.push(Array { low: 0, high: 9, element: Type::INT });
    let initial = Const::Scalar(Value::I64(1));
    program.routines[MAIN].locals.push(local("index", INDEX, initial));
    program.routines[MAIN].body = body(Place::local(id, INDEX));
    crate::verify::verify(&program).unwrap();
    program
}

fn check() -> Expr {
    Expr::apply(Op::CheckIndex, INDEX, vec![lint(1), lint(12), lint(9)], AT)
}

fn is_checked(body: impl FnOnce(Place) -> Vec<Statement>) -> bool {
    let program = with_index(body);
    let checked = checked_locals(&program.routines[MAIN]);
    assert!(!checked[0], "temp is of no subrange");
    let index = Expr::load(Place::local(LocalId(1), INDEX), AT).read();
    let known = Known { program: &program, loops: &[], checked: &|id| checked[id.index()], seen: &[] };
    let last = ArrayId::next(program.arrays.len() - 1);
    assert_eq!(known.is_within(&index, last), checked[1]);
    assert!(!known.is_within(&index, ArrayId(0)), "an array of other bounds");
    checked[1]
}

#[test]
fn a_local_is_checked_while_only_checks_are_written_to_it() {
    assert!(is_checked(|_| vec![]));
    assert!(is_checked(|index| vec![assign(index, check())]));
    assert!(!is_checked(|index| vec![assign(index.clone(), check()), assign(index.clone(), load(index))]));
    assert!(!is_checked(|index| vec![stmt(StatementKind::For(Box::new(For {
        counter: index,
        first: Expr::new(INDEX, ExprKind::Const(Value::I64(1)), AT),
        last: lint(2),
        step: Step::Constant(1),
        range: (1, 9),
        is_private: false,
        body: vec![stmt(StatementKind::Turn)],
        taking: Taking::Each,
        step_at: AT,
    })))]));
    let handed_on = with_index(|_| vec![]);
    let mut routine = handed_on.routines[MAIN].clone();
    let arguments = vec![Argument::Reference(Place::local(LocalId(1), INDEX))];
    routine.body = vec![stmt(StatementKind::Call { callee: RoutineId(0), instance: None, arguments, result: None })];
    assert!(!checked_locals(&routine)[1]);
}

/// A parameter's value is the caller's, who may have read it from a state.
#[test]
fn a_parameter_is_not_checked() {
    let mut routine = with_index(|_| vec![]).routines.remove(MAIN);
    routine.params = vec![crate::fixture::param("index", INDEX, Mode::Value(LocalId(1)))];
    assert!(!checked_locals(&routine)[1]);
}
