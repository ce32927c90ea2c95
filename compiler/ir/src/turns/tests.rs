//! Which WHILE and REPEAT loops are known to end, and after how many turns.

use super::*;
use crate::fixture::{AT, add, assign, call_adder, count, flag, int, load, local, sample, stmt, temp, value, wide};
use crate::{Const, Elementary, For, LocalId, Repr, Step, Taking, Type};

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

/// Step, offset, and whether there are conditions besides.
fn found(body: &[Statement]) -> Option<(i128, i128, bool)> {
    let program = sample(Vec::new());
    let frame = Frame::of(&program, &program.routines[MAIN]);
    let linear = linear(&frame, body)?;
    assert!(linear.counter.is_same_variable(&count()));
    Some((linear.step, linear.offset, linear.has_others))
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
    assert_eq!((counting(Op::Lt, int(9), 0), counting(Op::Gt, int(9), 0)), (None, None));
    // A bound at the end of the type that the counter comes from.
    assert_eq!(
        (counting(Op::Ge, int(i16::MAX), -1), counting(Op::Le, int(i16::MIN), 1)),
        (Some((-1, 0)), Some((1, 0)))
    );
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
    assert_eq!(of(vec![up()]), Some((1, -1, false)));
    assert_eq!(of(vec![other(), up(), other()]), Some((1, -1, false)));
    assert_eq!(of(vec![other()]), None);
    assert_eq!((of(vec![up(), up()]), of(vec![up(), call_adder(count())])), (None, None));
    assert_eq!(
        (of(vec![assign(count(), int(1)), up()]), of(vec![assign(count(), add(load(temp()), int(1)))])),
        (None, None)
    );
    assert_eq!((of(vec![assign(temp(), int(1)), up()]), of(vec![up(), step(Op::Sub, &temp(), 1)])), (None, None));
    // A value computed from another variable is not a step.
    let above = |body| found(&while_loop(compare(Op::Gt, load(count()), load(temp())), body));
    let one_less = |place| Expr::apply(Op::Sub, Type::INT, vec![load(place), int(1)], AT);
    assert_eq!(above(vec![assign(count(), one_less(count()))]), Some((-1, 1, false)));
    assert_eq!(above(vec![assign(count(), one_less(temp()))]), None);
    assert_eq!(of(vec![assign(count(), Expr::apply(Op::Mul, Type::INT, vec![load(count()), int(2)], AT))]), None);
    let then = vec![up()];
    let inside = stmt(StatementKind::If { condition: load(flag()), then, otherwise: Vec::new() });
    assert_eq!(of(vec![inside]), None);
}

#[test]
fn what_leaves_a_turn_early_is_not_linear() {
    let of = |body| found(&while_loop(below(), body));
    assert!(of(vec![up(), turn()]).is_some() && of(vec![up(), call_adder(wide())]).is_some());
    assert!(of(vec![up(), stmt(StatementKind::Exit)]).is_some());
    assert_eq!(of(vec![stmt(StatementKind::Continue), up()]), None);
    assert_eq!(found(&[turn(), exit_where(not(below())), up()]), None);
    // What is left on another condition, or does not only leave.
    assert_eq!(found(&[exit_where(below()), turn(), up()]), None);
    let test = |then: StatementKind, otherwise| {
        stmt(StatementKind::If { condition: not(below()), then: vec![stmt(then)], otherwise })
    };
    assert_eq!(found(&[test(StatementKind::Exit, vec![up()]), turn(), up()]), None);
    assert_eq!(found(&[test(StatementKind::Return, Vec::new()), turn(), up()]), None);
}

#[test]
fn a_bound_does_not_fault_and_what_holds_besides_may() {
    let quotient = || Expr::apply(Op::Div, Type::INT, vec![int(100), load(temp())], AT);
    let both = |a, b| Expr::apply(Op::And, Type::BOOL, vec![a, b], AT);
    let of = |stay| found(&while_loop(stay, vec![up()]));
    assert_eq!(of(compare(Op::Lt, load(count()), quotient())), None);
    assert_eq!(of(both(load(flag()), below())), Some((1, -1, true)));
    assert_eq!(of(both(both(below(), load(flag())), load(flag()))), Some((1, -1, true)));
    assert_eq!(of(both(below(), compare(Op::Gt, quotient(), int(0)))), Some((1, -1, true)));
    assert_eq!(of(Expr::apply(Op::Or, Type::BOOL, vec![below(), load(flag())], AT)), None);
}

/// `i < n AND_THEN flag`, and `i < n OR_ELSE flag`.
#[test]
fn a_condition_may_be_a_chain_of_statements() {
    let chain = |condition: Expr, then: Vec<Statement>, otherwise| {
        let more = stmt(StatementKind::If { condition, then, otherwise });
        vec![assign(flag(), below()), more, exit_where(not(load(flag()))), turn(), up()]
    };
    let other = || assign(flag(), compare(Op::Gt, load(temp()), int(0)));
    let is = |body: &[Statement]| found(body) == Some((1, -1, true));
    assert!(is(&chain(load(flag()), vec![other()], Vec::new())));
    assert!(!is(&chain(not(load(flag())), vec![other()], Vec::new())));
    assert!(!is(&chain(load(flag()), vec![other()], vec![other()])));
    assert!(!is(&chain(load(flag()), vec![up(), other()], Vec::new())), "the counter is stepped elsewhere too");
    assert!(!is(&chain(load(flag()), vec![assign(temp(), int(9))], Vec::new())), "the bound is another then");
    let mut read_late = chain(load(flag()), vec![other()], Vec::new());
    read_late.insert(2, assign(flag(), compare(Op::Gt, load(temp()), int(0))));
    assert!(!is(&read_late));
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

fn counted(is_private: bool, step: Step, body: Vec<Statement>) -> For {
    let range = (i16::MIN.into(), i16::MAX.into());
    let taking = Taking::Each;
    For { counter: temp(), first: int(1), last: load(count()), step, range, is_private, body, taking, step_at: AT }
}

/// The statement, when its loop takes its turns, and how many statements its body keeps.
fn settled(statement: Statement) -> (Taking, usize) {
    let mut program = sample(vec![statement]);
    crate::taking::settle(&mut program);
    match &program.routines[MAIN].body[0].kind {
        StatementKind::For(it) => (it.taking, it.body.len()),
        StatementKind::Loop { body, count, .. } => (count.as_ref().map_or(Taking::Each, |it| it.taking), body.len()),
        _ => unreachable!("a loop"),
    }
}

#[test]
fn a_loop_that_nothing_ends_early_takes_its_turns_ahead() {
    let of = |is_private, body: Vec<Statement>| {
        settled(stmt(StatementKind::For(Box::new(counted(is_private, Step::Constant(1), body)))))
    };
    let inner = || counted(true, Step::Constant(1), vec![turn()]).statement(AT);
    let exit = || exit_where(load(flag()));
    assert_eq!(of(true, vec![turn(), assign(wide(), load(wide()))]), (Taking::AheadOfMany(AT), 1));
    assert_eq!(of(false, vec![turn()]), (Taking::Each, 1));
    assert_eq!(of(true, vec![]), (Taking::Each, 0));
    assert_eq!(of(true, vec![turn(), exit()]), (Taking::EachOfMany, 2));
    assert_eq!(of(true, vec![turn(), stmt(StatementKind::Return)]), (Taking::EachOfMany, 2));
    // What takes turns within.
    assert_eq!(of(true, vec![turn(), inner()]), (Taking::Ahead(AT), 1));
    assert_eq!(of(true, vec![turn(), inner(), exit()]), (Taking::Each, 3));
    let exits_within = counted(true, Step::Constant(1), vec![turn(), exit()]);
    let within = stmt(StatementKind::For(Box::new(exits_within)));
    assert_eq!(of(true, vec![turn(), within]), (Taking::Ahead(AT), 1), "that EXIT is the inner loop's");
    let variable = counted(true, Step::Variable(load(count())), vec![turn()]);
    assert_eq!(settled(stmt(StatementKind::For(Box::new(variable)))), (Taking::AheadOfMany(AT), 0));

    let of = |stay, body| {
        let body = while_loop(stay, body);
        settled(stmt(StatementKind::Loop { body, continuing: Vec::new(), count: None }))
    };
    assert_eq!(of(below(), vec![up()]), (Taking::AheadOfMany(AT), 2));
    assert_eq!(of(below(), vec![up(), exit()]), (Taking::EachOfMany, 4));
    let below_nine = compare(Op::Lt, load(count()), int(9));
    assert_eq!(of(below_nine, vec![up(), inner()]), (Taking::Ahead(AT), 3));
    assert_eq!(of(below(), vec![]), (Taking::Each, 2));
    let both = Expr::apply(Op::And, Type::BOOL, vec![below(), load(flag())], AT);
    assert_eq!(of(both.clone(), vec![up()]), (Taking::EachOfMany, 3));
    assert_eq!(of(both, vec![up(), inner()]), (Taking::Each, 4));
}

#[test]
fn a_body_is_as_large_as_what_it_does() {
    let size = |statement: Statement| size::size(&[statement]);
    assert_eq!(size(assign(count(), int(1))), 1);
    assert_eq!(size(assign(count(), add(load(temp()), int(1)))), 3);
    assert_eq!(size(assign(value(load(temp()), 1), int(1))), 1 + 4 + 1);
    assert_eq!(size(assign(count(), load(value(int(1), 1)))), 1 + 1 + 4);
    assert_eq!(size(call_adder(count())), 16);
    assert_eq!(size(turn()), 0);
}
