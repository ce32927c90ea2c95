//! What routines of the sample program read, write and call.

use super::*;
use crate::fixture::{
    adder, assign, call_adder, call_counter, call_double, count, int, load, local, sample, stmt, temp, total, value,
    wide,
};
use crate::{Conversion, Count, External, ExternalCall, FieldId, For, RefKind, RefType, ReferenceId, Step, Taking};

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

#[test]
fn a_program_s_body_does_what_its_prescan_does_where_a_back_end_runs_both() {
    let mut program = sample(vec![assign(count(), int(1))]);
    program.routines[2].body.push(assign(total(), load(total())));
    program.classes[1].prescan = Some(RoutineId(2));
    let of = |rules: &Rules| effects(&program, rules).remove(MAIN);
    let plain = of(&Rules::PLAIN);
    assert!(!plain.context && !plain.names.holds(&total()) && !plain.writes.holds(&total()));
    let whole = of(&Rules { scans_take_all: true, ..Rules::PLAIN });
    assert!(whole.context && whole.names.holds(&total()));
    // That of a FUNCTION_BLOCK is another routine.
    program.classes[1].kind = ClassKind::FunctionBlock;
    let block = effects(&program, &Rules { scans_take_all: true, ..Rules::PLAIN }).remove(MAIN);
    assert!(!block.context && !block.names.holds(&total()));
}

#[test]
fn what_is_outside_may_do_anything_to_what_it_is_handed() {
    let external = External {
        name: "Read".to_owned(),
        symbol: "Read".to_owned(),
        doc: None,
        location: crate::fixture::AT,
        state: None,
        params: Vec::new(),
        result: None,
    };
    let handed = |instance: Option<Place>, arguments| {
        let external = external.clone();
        own(vec![stmt(StatementKind::External(Box::new(ExternalCall { external, instance, arguments, result: None })))])
    };
    assert_eq!(handed(None, vec![Argument::Reference(count())]), [[0], [0]]);
    assert_eq!(handed(Some(adder()), vec![Argument::Value(int(1))]), [[3], [3]]);
}

#[test]
fn a_loop_takes_turns_where_it_says_so() {
    let looped = |taking| {
        let count = Count { counter: count(), step: 1, bound: int(9), offset: 0, taking };
        let body = vec![stmt(StatementKind::Exit)];
        of_main(vec![stmt(StatementKind::Loop { body, continuing: Vec::new(), count: Some(Box::new(count)) })]).turns
    };
    assert_eq!([Taking::Each, Taking::Ahead(crate::fixture::AT)].map(looped), [false, true]);
}

#[test]
fn a_step_may_fault_where_it_may_leave_a_range() {
    let faults = |step, range| {
        let StatementKind::For(mut head) = counted(1, 7, true, Vec::new()).kind else { unreachable!() };
        (head.step, head.range) = (step, range);
        of_main(vec![stmt(StatementKind::For(head))]).faults
    };
    let whole = (i16::MIN.into(), i16::MAX.into());
    assert!(!faults(Step::Constant(1), whole) && faults(Step::Constant(4), (0, 7)));
    assert!(faults(Step::Variable(int(1)), whole));
}

/// The sample program whose body takes the address of `count` and runs these statements.
fn with_pointer(body: Vec<Statement>) -> Program {
    let mut program = sample(body);
    program.references = vec![RefType { kind: RefKind::PointerTo, target: Type::INT }];
    program.routines[MAIN].locals.push(local("way", POINTER, crate::Const::Zero));
    program.routines[MAIN].body.insert(0, assign(way(), address(count())));
    program
}

const POINTER: Type = Type::Reference(ReferenceId(0));

fn way() -> Place {
    Place::local(LocalId(1), POINTER)
}

fn address(place: Place) -> Expr {
    Expr { ty: POINTER, kind: ExprKind::AddressOf(Box::new(place)), at: crate::fixture::AT }
}

fn through_pointer() -> Place {
    way().deref(Type::INT, crate::fixture::AT)
}

#[test]
fn what_is_followed_may_be_any_variable_whose_address_is_taken() {
    let found = |body| effects(&with_pointer(body), &Rules::PLAIN).remove(MAIN);
    let own = |found: &Effects| [fields(|it| found.reads.has_own(it)), fields(|it| found.writes.has_own(it))];
    let taken = found(vec![]);
    assert!(taken.reaches && own(&taken) == [vec![], vec![]]);
    let element = |index: Expr| value(Expr::convert(Conversion::Value, Type::LINT, index, crate::fixture::AT), 1);
    for body in [
        vec![assign(through_pointer(), int(1))],
        vec![assign(temp(), load(through_pointer()))],
        vec![assign(temp(), load(element(load(through_pointer()))))],
        vec![assign(way(), address(element(load(through_pointer()))))],
    ] {
        let followed = found(body);
        let [reads, writes] = own(&followed);
        assert!(reads.contains(&0) && writes.contains(&0) && followed.names.has_own(FieldId(0)), "{followed:?}");
    }
    // What a parameter stands for, too.
    let mut program = with_pointer(vec![call_adder(temp())]);
    program.routines[1].locals.push(local("way", POINTER, crate::Const::Zero));
    let way = Place::local(LocalId(0), POINTER).deref(Type::INT, crate::fixture::AT);
    program.routines[1].body = vec![assign(way, int(1))];
    let all = effects(&program, &Rules::PLAIN);
    assert!(all[1].reads.has_param(ParamId(0)) && all[1].writes.has_param(ParamId(0)));
    assert_eq!(own(&all[MAIN]), [[0], [0]]);
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
