//! What routines of the sample program read, write and call.

use super::*;
use crate::fixture::{
    adder, assign, call_adder, call_counter, call_double, count, int, load, sample, stmt, temp, total, value, wide,
};
use crate::{Conversion, FieldId, For, Step, Taking};

const MAIN: usize = 3;

fn of_main(body: Vec<Statement>) -> Effects {
    effects(&sample(body), &Rules::PLAIN).remove(MAIN)
}

fn fields(has: impl Fn(FieldId) -> bool) -> Vec<usize> {
    (0..9).filter(|it| has(FieldId::next(*it))).collect()
}

/// The variables of its own that a body with these statements reads and writes.
fn own(body: Vec<Statement>) -> [Vec<usize>; 2] {
    let found = of_main(body);
    [fields(|it| found.reads.has_own(it)), fields(|it| found.writes.has_own(it))]
}

#[test]
fn an_assignment_reads_and_writes() {
    assert_eq!(own(vec![assign(count(), load(count()))]), [vec![0], vec![0]]);
    assert_eq!(own(vec![assign(count(), int(1))]), [vec![], vec![0]]);
    assert_eq!(own(vec![assign(temp(), load(count()))]), [vec![0], vec![]]);
}

#[test]
fn a_callee_does_to_its_arguments_what_it_does_to_its_parameters() {
    // Double's output is written, and not read.
    assert_eq!(own(vec![call_double(int(1), count(), None)]), [vec![], vec![0]]);
    // The adder does both, to its instance and to its in-out.
    assert_eq!(own(vec![call_adder(count())]), [vec![0, 3], vec![0, 3]]);
    let found = of_main(vec![call_adder(temp()), call_adder(temp())]);
    assert_eq!(found.borrowed, [true]);
    assert_eq!(found.calls, [RoutineId(1)]);
    assert!(found.names.holds(&adder()) && !found.names.holds(&count()));
}

#[test]
fn a_standard_block_reads_and_writes_itself() {
    let [reads, writes] = own(vec![call_counter(Expr::bool(true, crate::fixture::AT), 3)]);
    assert_eq!([reads, writes], [[5], [5]]);
}

#[test]
fn globals_are_passed_up() {
    let sum = Expr::convert(Conversion::Value, Type::DINT, load(count()), crate::fixture::AT);
    let mut program = sample(vec![call_adder(count())]);
    program.routines[1].body.push(assign(total(), load(total())));
    let found = effects(&program, &Rules::PLAIN).remove(MAIN);
    assert!(found.uses_globals() && found.reads.any_global() && found.writes.any_global());
    let found = of_main(vec![assign(wide(), load(total()))]);
    assert!(found.uses_globals() && found.reads.any_global() && !found.writes.any_global());
    assert_eq!(found.names.globals().collect::<Vec<_>>(), [FieldId(0)]);
    let found = of_main(vec![assign(total(), sum)]);
    assert!(found.uses_globals() && !found.reads.any_global() && found.writes.any_global());
    assert!(!of_main(vec![assign(count(), int(1))]).uses_globals());
}

#[test]
fn turns_and_faults_are_passed_up() {
    let mut program = sample(vec![call_adder(temp())]);
    program.routines[1].body.push(stmt(StatementKind::Turn));
    let all = effects(&program, &Rules::PLAIN);
    for found in [&all[1], &all[MAIN]] {
        assert_eq!([found.turns, found.context, found.faults, found.reaches], [true, true, true, false]);
    }
    assert_eq!([all[0].turns, all[0].context, all[0].faults], [false; 3]);
    let mut program = sample(vec![call_adder(temp())]);
    let way = Expr { ty: Type::DINT, kind: ExprKind::AddressOf(Box::new(total())), at: crate::fixture::AT };
    program.routines[1].body.push(assign(total(), way));
    let all = effects(&program, &Rules::PLAIN);
    assert_eq!([all[0].reaches, all[1].reaches, all[MAIN].reaches], [false, true, true]);
}

#[test]
fn callees_are_named_once_in_their_order() {
    let found = of_main(vec![call_adder(temp()), call_double(int(1), temp(), None), call_adder(temp())]);
    assert_eq!(found.calls, [RoutineId(0), RoutineId(1)]);
}

/// A FOR loop whose counter goes from `first` to `last`, over a body.
fn counted(first: i16, last: i16, is_private: bool, body: Vec<Statement>) -> Statement {
    stmt(StatementKind::For(Box::new(For {
        counter: count(),
        first: int(first),
        last: int(last),
        step: Step::Constant(1),
        range: (i16::MIN.into(), i16::MAX.into()),
        is_private,
        body,
        taking: Taking::Each,
        step_at: crate::fixture::AT,
    })))
}

#[test]
fn a_check_is_dropped_within_the_loop_that_bounds_its_index_and_nowhere_else() {
    let rules = Rules { drops_checks: true, ..Rules::PLAIN };
    let faults = |body| effects(&sample(body), &rules).remove(MAIN).faults;
    let element = || {
        let index = Expr::convert(Conversion::Value, Type::LINT, load(count()), crate::fixture::AT);
        assign(value(index, 1), int(1))
    };
    assert!(!faults(vec![counted(1, 3, true, vec![element()])]));
    assert!(faults(vec![counted(1, 4, true, vec![element()])]));
    assert!(faults(vec![counted(1, 3, false, vec![element()])]));
    assert!(faults(vec![counted(1, 3, true, vec![]), element()]));
    assert!(faults(vec![element()]));
}
