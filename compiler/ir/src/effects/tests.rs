//! What routines of the sample program read, write and call.

use super::*;
use crate::fixture::{
    adder, assign, call_adder, call_counter, call_double, count, int, load, sample, temp, total, wide,
};
use crate::{Conversion, FieldId};

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
