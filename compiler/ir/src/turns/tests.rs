//! Which WHILE and REPEAT loops are known to end, and after how many turns.

use super::*;
use crate::fixture::{AT, add, assign, call_adder, count, flag, int, load, local, sample, stmt, temp, wide};
use crate::{Const, Elementary, LocalId, Repr, Step, Type};

const MAIN: usize = 3;

fn compare(op: Op, left: Expr, right: Expr) -> Expr {
    Expr::apply(op, Type::BOOL, vec![left, right], AT)
}

fn exit_where(leave: Expr) -> Statement {
    let then = vec![stmt(StatementKind::Exit)];
    stmt(StatementKind::If { condition: leave, then, otherwise: Vec::new() })
}

fn not(condition: Expr) -> Expr {
    Expr::apply(Op::Not, Type::BOOL, vec![condition], AT)
}

fn turn() -> Statement {
    stmt(StatementKind::Turn)
}

/// `WHILE stay DO … END_WHILE`
fn while_loop(stay: Expr, body: Vec<Statement>) -> Vec<Statement> {
    [exit_where(not(stay)), turn()].into_iter().chain(body).collect()
}

/// `place := place op by`
fn step(op: Op, place: &Place, by: i16) -> Statement {
    assign(place.clone(), Expr::apply(op, Type::INT, vec![load(place.clone()), int(by)], AT))
}

/// Step, offset, conditions besides, and which statement steps.
fn found(body: &[Statement]) -> Option<(i128, i128, usize, usize)> {
    let program = sample(Vec::new());
    let frame = Frame::of(&program, &program.routines[MAIN]);
    let known = Known { program: &program, loops: &[], checked: &|_| false };
    let linear = linear(&known, &frame, body, &|callee| callee == RoutineId(1))?;
    assert!(linear.counter.is_same_variable(&count()));
    Some((linear.step, linear.offset, linear.others.len(), linear.steps))
}

/// `WHILE count op bound DO count := count + by; END_WHILE`
fn counting(op: Op, bound: Expr, by: i16) -> Option<(i128, i128)> {
    let (stepping, by) = if by < 0 { (Op::Sub, -by) } else { (Op::Add, by) };
    let body = while_loop(compare(op, load(count()), bound), vec![step(stepping, &count(), by)]);
    found(&body).map(|it| (it.0, it.1))
}

#[test]
fn a_loop_toward_a_bound_is_linear_where_it_cannot_wrap() {
    let bound = || load(temp());
    assert_eq!(counting(Op::Lt, bound(), 1), Some((1, -1)));
    assert_eq!(counting(Op::Gt, bound(), -1), Some((-1, 1)));
    assert_eq!(counting(Op::Lt, int(100), 7), Some((7, -1)));
    assert_eq!(counting(Op::Ge, int(0), -3), Some((-3, 0)));
    // The bound may be the type's last value, and the step goes past it.
    assert_eq!((counting(Op::Le, bound(), 1), counting(Op::Ge, bound(), -1)), (None, None));
    assert_eq!((counting(Op::Lt, bound(), 2), counting(Op::Gt, bound(), -2)), (None, None));
    assert_eq!((counting(Op::Le, int(i16::MAX - 1), 1), counting(Op::Le, int(i16::MAX), 1)), (Some((1, 0)), None));
    assert_eq!((counting(Op::Ge, int(i16::MIN + 1), -1), counting(Op::Ge, int(i16::MIN), -1)), (Some((-1, 0)), None));
    // Away from the bound, or not at all.
    assert_eq!((counting(Op::Lt, bound(), -1), counting(Op::Gt, bound(), 1)), (None, None));
    assert_eq!((counting(Op::Le, int(9), -1), counting(Op::Ge, int(9), 1)), (None, None));
    assert_eq!((counting(Op::Lt, bound(), 0), counting(Op::Gt, bound(), 0)), (None, None));
    assert_eq!(counting(Op::Ne, bound(), 1), None);
}

#[test]
fn the_bound_may_stand_on_the_left() {
    let flipped = |op, bound, by: i16| {
        let (stepping, by) = if by < 0 { (Op::Sub, -by) } else { (Op::Add, by) };
        let body = while_loop(compare(op, bound, load(count())), vec![step(stepping, &count(), by)]);
        found(&body).map(|it| (it.0, it.1))
    };
    assert_eq!(flipped(Op::Gt, int(9), 1), Some((1, -1)));
    assert_eq!(flipped(Op::Ge, int(9), 1), Some((1, 0)));
    assert_eq!(flipped(Op::Lt, int(9), -1), Some((-1, 1)));
    assert_eq!((flipped(Op::Gt, load(temp()), 1), flipped(Op::Lt, load(temp()), -1)), (Some((1, -1)), Some((-1, 1))));
    assert_eq!((flipped(Op::Lt, int(9), 1), flipped(Op::Gt, int(9), -1)), (None, None));
}

fn below() -> Expr {
    compare(Op::Lt, load(count()), load(temp()))
}

fn up() -> Statement {
    step(Op::Add, &count(), 1)
}

#[test]
fn only_the_step_may_reach_the_counter_and_nothing_the_bound() {
    let other = || assign(wide(), load(wide()));
    let of = |body| found(&while_loop(below(), body));
    assert_eq!(of(vec![up()]), Some((1, -1, 0, 0)));
    assert_eq!(of(vec![other(), up(), other()]), Some((1, -1, 0, 1)));
    assert_eq!(of(vec![other()]), None);
    assert_eq!((of(vec![up(), up()]), of(vec![up(), call_adder(count())])), (None, None));
    assert_eq!(
        (of(vec![assign(count(), int(1)), up()]), of(vec![assign(count(), add(load(temp()), int(1)))])),
        (None, None)
    );
    assert_eq!((of(vec![assign(temp(), int(1)), up()]), of(vec![up(), step(Op::Sub, &temp(), 1)])), (None, None));
    assert_eq!(of(vec![assign(count(), Expr::apply(Op::Mul, Type::INT, vec![load(count()), int(2)], AT))]), None);
    let then = vec![up()];
    let inside = stmt(StatementKind::If { condition: load(flag()), then, otherwise: Vec::new() });
    assert_eq!(of(vec![inside]), None);
}

#[test]
fn what_else_takes_turns_or_leaves_a_turn_early_is_not_linear() {
    let of = |body| found(&while_loop(below(), body));
    assert_eq!(of(vec![up(), turn()]), None);
    // The callee takes turns.
    assert_eq!(of(vec![up(), call_adder(wide())]), None);
    assert!(of(vec![up(), stmt(StatementKind::Exit)]).is_some());
    assert_eq!(of(vec![stmt(StatementKind::Continue), up()]), None);
    assert_eq!(found(&[turn(), exit_where(not(below())), up()]), None);
    assert_eq!(found(&[exit_where(not(below())), up(), turn()]), None);
    // What is left on another condition, or does not only leave.
    assert_eq!(found(&[exit_where(below()), turn(), up()]), None);
    let test = |then: StatementKind, otherwise| {
        stmt(StatementKind::If { condition: not(below()), then: vec![stmt(then)], otherwise })
    };
    assert_eq!(found(&[test(StatementKind::Exit, vec![up()]), turn(), up()]), None);
    assert_eq!(found(&[test(StatementKind::Return, Vec::new()), turn(), up()]), None);
}

#[test]
fn conditions_that_fault_are_evaluated_in_each_turn() {
    let quotient = || Expr::apply(Op::Div, Type::INT, vec![int(100), load(temp())], AT);
    let both = |a, b| Expr::apply(Op::And, Type::BOOL, vec![a, b], AT);
    let of = |stay| found(&while_loop(stay, vec![up()]));
    assert_eq!(of(compare(Op::Lt, load(count()), quotient())), None);
    assert_eq!(of(both(load(flag()), below())), Some((1, -1, 1, 0)));
    assert_eq!(of(both(both(below(), load(flag())), load(flag()))), Some((1, -1, 2, 0)));
    assert_eq!(of(both(below(), compare(Op::Gt, quotient(), int(0)))), None);
    assert_eq!(of(Expr::apply(Op::Or, Type::BOOL, vec![below(), load(flag())], AT)), None);
}

const BITS: LocalId = LocalId(1);

fn bits() -> Place {
    Place::local(BITS, Type::Elementary(Elementary::Word))
}

fn word(value: u16) -> Expr {
    Expr::constant(Elementary::Word, Value::U16(value), AT)
}

fn is_divided_loop(body: &[Statement], continuing: &[Statement]) -> bool {
    let mut program = sample(Vec::new());
    program.routines[MAIN].locals.push(local("bits", Type::Elementary(Elementary::Word), Const::Zero));
    divides(&Frame::of(&program, &program.routines[MAIN]), body, continuing)
}

fn half() -> Statement {
    step(Op::Div, &count(), 2)
}

#[test]
fn a_loop_that_divides_ends_where_small_values_leave_it() {
    let stays = |op, limit| is_divided_loop(&while_loop(compare(op, load(count()), int(limit)), vec![half()]), &[]);
    assert!(stays(Op::Ne, 0) && stays(Op::Gt, 0) && stays(Op::Gt, 9) && stays(Op::Ge, 1) && stays(Op::Ge, 10));
    assert!(!stays(Op::Ne, 1) && !stays(Op::Ne, -1) && !stays(Op::Gt, -1) && !stays(Op::Ge, 0));
    assert!(!stays(Op::Eq, 0) && !stays(Op::Lt, 1) && !stays(Op::Le, 0));
    let until = |op, limit| is_divided_loop(&[half()], &[exit_where(compare(op, load(count()), int(limit)))]);
    assert!(until(Op::Eq, 0) && until(Op::Le, 0) && until(Op::Le, 5) && until(Op::Lt, 1) && until(Op::Lt, 10));
    assert!(!until(Op::Eq, 1) && !until(Op::Eq, -1) && !until(Op::Le, -1) && !until(Op::Lt, 0));
    assert!(!until(Op::Ne, 0) && !until(Op::Gt, 0) && !until(Op::Ge, 1));
    let flipped = |op, limit| is_divided_loop(&while_loop(compare(op, int(limit), load(count())), vec![half()]), &[]);
    assert!(flipped(Op::Ne, 0) && flipped(Op::Lt, 0) && flipped(Op::Le, 1));
    assert!(!flipped(Op::Lt, -1) && !flipped(Op::Le, 0) && !flipped(Op::Gt, 1) && !flipped(Op::Ge, 0));
    let flipped = |op, limit| is_divided_loop(&[half()], &[exit_where(compare(op, int(limit), load(count())))]);
    assert!(
        flipped(Op::Eq, 0) && flipped(Op::Gt, 1) && flipped(Op::Ge, 0) && !flipped(Op::Gt, 0) && !flipped(Op::Ge, -1)
    );
}

#[test]
fn a_condition_may_be_one_of_several() {
    let any = |op, condition| Expr::apply(op, Type::BOOL, vec![load(flag()), condition], AT);
    let (large, small) = (|| compare(Op::Ne, load(count()), int(0)), || compare(Op::Eq, load(count()), int(0)));
    assert!(is_divided_loop(&while_loop(any(Op::And, large()), vec![half()]), &[]));
    assert!(!is_divided_loop(&while_loop(any(Op::Or, large()), vec![half()]), &[]));
    assert!(is_divided_loop(&[half()], &[exit_where(any(Op::Or, small()))]));
    assert!(!is_divided_loop(&[half()], &[exit_where(any(Op::And, small()))]));
    // Without a condition at its start or end.
    assert!(!is_divided_loop(&[half()], &[]) && !is_divided_loop(&[exit_where(small()), half()], &[]));
}

#[test]
fn each_turn_divides_and_nothing_else_writes() {
    let of = |body| is_divided_loop(&while_loop(compare(Op::Ne, load(count()), int(0)), body), &[]);
    assert!(of(vec![half()]) && of(vec![step(Op::Div, &count(), 10), assign(temp(), load(count()))]));
    assert!(!of(vec![step(Op::Div, &count(), 1)]) && !of(vec![step(Op::Div, &count(), -2)]));
    assert!(!of(vec![step(Op::Shr, &count(), 1)]), "a sign is shifted in");
    assert!(!of(vec![step(Op::Sub, &count(), 2)]) && !of(vec![]));
    assert!(!of(vec![half(), up()]) && !of(vec![call_adder(count()), half()]));
    assert!(!of(vec![stmt(StatementKind::Continue), half()]));
    assert!(!of(vec![assign(count(), Expr::apply(Op::Div, Type::INT, vec![load(temp()), int(2)], AT))]));
    let then = vec![half()];
    assert!(!of(vec![stmt(StatementKind::If { condition: load(flag()), then, otherwise: Vec::new() })]));
    let shifted = |by| {
        let value = Expr::apply(Op::Shr, bits().ty, vec![load(bits()), int(by)], AT);
        let body = while_loop(compare(Op::Ne, load(bits()), word(0)), vec![assign(bits(), value)]);
        is_divided_loop(&body, &[])
    };
    assert!(shifted(1) && shifted(4) && !shifted(0));
}

/// No value of 16 bits takes more turns than its bits, and one.
#[test]
fn divided_values_are_small_soon() {
    for (op, by) in [(Op::Div, 2), (Op::Div, 10), (Op::Div, i16::MAX)] {
        for start in i16::MIN..=i16::MAX {
            let (mut value, mut turns) = (Value::I16(start), 0);
            while value != Value::I16(0) {
                value = crate::apply(op, Repr::I16, &[value, Value::I16(by)]).unwrap().unwrap();
                turns += 1;
            }
            assert!(turns <= 17, "{start} divided by {by}");
        }
    }
}

#[test]
fn a_counted_loop_says_its_turns_where_only_it_takes_any() {
    let counted = |is_private, step, body: Vec<Statement>| {
        let it = For {
            counter: temp(),
            first: int(1),
            last: int(9),
            step,
            range: (i16::MIN.into(), i16::MAX.into()),
            is_private,
            body,
            step_at: AT,
        };
        ahead(&it, &|callee| callee == RoutineId(1)).map(|it| it.body.len())
    };
    let one = || Step::Constant(1);
    assert_eq!(counted(true, one(), vec![turn(), assign(count(), int(1))]), Some(1));
    assert_eq!(counted(true, one(), vec![]), None);
    assert_eq!(counted(true, one(), vec![assign(count(), int(1))]), None);
    assert_eq!(counted(false, one(), vec![turn()]), None);
    assert_eq!(counted(true, one(), vec![turn(), turn()]), None);
    assert_eq!(counted(true, one(), vec![turn(), call_adder(wide())]), None);
    let variable = Step::Variable(load(count()));
    assert_eq!(counted(true, variable, vec![turn()]), Some(0));
}
