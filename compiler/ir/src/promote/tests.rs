//! Which loops keep their variables in locals.

use super::{Gain, MOST_LOCALS, promoted};
use crate::fixture::{
    AT, assign, call_adder, call_counter, count, counter, int, load, sample, stmt, temp, total, value, wide,
};
use crate::verify::verify;
use crate::{
    Block, Conversion, Elementary, Expr, ExprKind, FieldId, For, Op, Place, Program, Root, Statement, StatementKind,
    Step, Taking, Type, Value,
};

const MAIN: usize = 3;

/// `FOR count := 1 TO last DO … END_FOR`
fn count_to(last: i16, body: Block) -> Statement {
    count_to_end(int(last), body)
}

fn count_to_end(last: Expr, body: Block) -> Statement {
    let range = (i16::MIN.into(), i16::MAX.into());
    let (first, step) = (int(1), Step::Constant(1));
    let it =
        For { counter: count(), first, last, step, range, is_private: true, body, taking: Taking::Each, step_at: AT };
    it.statement(AT)
}

/// `values[of]`
fn element(of: Place) -> Place {
    value(Expr::convert(Conversion::Value, Type::LINT, load(of), AT), 1)
}

fn dint(value: i32) -> Expr {
    Expr::constant(Elementary::Dint, Value::I32(value), AT)
}

/// `total := total + 1`
fn step_total() -> Statement {
    assign(total(), Expr::apply(Op::Add, Type::DINT, vec![load(total()), dint(1)], AT))
}

fn pass(body: Block) -> Program {
    let before = sample(body);
    verify(&before).unwrap();
    let after = promoted(&before, Gain::WHOLE);
    verify(&after).unwrap();
    after
}

/// What the PROGRAM's statements and those in them write, besides locals.
fn stored(program: &Program) -> Vec<String> {
    let mut names = Vec::new();
    let mut see = |place: &Place| match place.root {
        Root::Local(_) => {}
        Root::Instance | Root::Globals | Root::Param(_) => names.push(format!("{:?}", place.projections.first())),
    };
    crate::visit::statements(&program.routines[MAIN].body, &mut |it| crate::visit::targets(it, &mut see));
    names
}

/// Loads, the loop, and stores.
fn kinds(program: &Program) -> Vec<&'static str> {
    let name = |it: &Statement| match &it.kind {
        StatementKind::Assign { target, .. } if matches!(target.root, Root::Local(_)) => "load",
        StatementKind::Assign { .. } => "store",
        StatementKind::For(it) if matches!(it.counter.root, Root::Local(_)) => "for of a local",
        StatementKind::For(_) => "for",
        StatementKind::Finally { .. } => "finally",
        _ => "other",
    };
    program.routines[MAIN].body.iter().map(name).collect()
}

#[test]
fn a_counter_and_a_sum_are_in_locals() {
    let after = pass(vec![count_to(3, vec![assign(element(count()), int(7)), step_total()])]);
    assert_eq!(kinds(&after), ["load", "for of a local", "store", "store"]);
    assert_eq!(stored(&after).len(), 3, "the element, and each variable once");
    let names: Vec<_> = after.routines[MAIN].locals.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["temp", "count", "total"]);
}

#[test]
fn a_loop_that_can_fault_stores_after_that_too() {
    let outside = pass(vec![count_to(4, vec![assign(element(count()), int(7))])]);
    assert_eq!(kinds(&outside), ["load", "finally"], "the counter");
    let unknown = pass(vec![count_to(3, vec![assign(element(wide()), int(7)), step_total()])]);
    assert_eq!(kinds(&unknown), ["load", "load", "load", "finally"], "what is only read as well");
    let takes_turns = pass(vec![count_to(30000, vec![step_total()])]);
    assert_eq!(kinds(&takes_turns), ["load", "load", "finally"]);
    let StatementKind::Finally { body, last } = &takes_turns.routines[MAIN].body[2].kind else { panic!("it is one") };
    assert_eq!((body.len(), last.len()), (1, 2));
    let looped = StatementKind::Loop {
        body: vec![step_total(), stmt(StatementKind::Turn)],
        continuing: Vec::new(),
        count: None,
    };
    let looped = sample(vec![stmt(looped)]);
    assert_eq!(kinds(&promoted(&looped, Gain::WHOLE)), ["other"], "a WHILE of scalars alone");
    assert_eq!(kinds(&promoted(&looped, Gain { of_scalars: true, ..Gain::WHOLE })), ["load", "finally"]);
}

#[test]
fn a_loop_that_returns_stays() {
    assert_eq!(kinds(&pass(vec![count_to(3, vec![step_total(), stmt(StatementKind::Return)])])), ["for"]);
}

#[test]
fn what_a_block_writes_stays() {
    let cv = counter().field(FieldId(4), Type::INT);
    let body =
        vec![call_counter(Expr::bool(true, AT), 3), assign(temp(), load(cv.clone())), assign(cv, int(1)), step_total()];
    let after = pass(vec![count_to(3, body)]);
    assert_eq!(kinds(&after), ["load", "for of a local", "store", "store"], "the counter of the loop, and total");
}

#[test]
fn an_inner_loop_is_taken_where_the_outer_one_stays() {
    let inner = count_to(3, vec![step_total()]);
    let outer = stmt(StatementKind::If {
        condition: Expr::bool(true, AT),
        then: vec![call_adder(temp()), inner],
        otherwise: Vec::new(),
    });
    let after = pass(vec![outer]);
    let StatementKind::If { then, .. } = &after.routines[MAIN].body[0].kind else { panic!("it is still an IF") };
    assert_eq!(then.len(), 5);
}

/// A FUNCTION that knows none of them. A loop with a call takes turns.
#[test]
fn what_no_callee_sees_is_in_locals() {
    let after = pass(vec![count_to(3, vec![call_adder(temp()), step_total()])]);
    assert_eq!(kinds(&after), ["load", "load", "finally"]);
}

/// `temp := ADR(total)`, as far as the pass knows.
#[test]
fn a_variable_whose_address_is_taken_stays() {
    let way = Expr { ty: Type::INT, kind: ExprKind::AddressOf(Box::new(total())), at: AT };
    let program = sample(vec![count_to(3, vec![assign(temp(), way), step_total()])]);
    assert_eq!(kinds(&promoted(&program, Gain::WHOLE)), ["for of a local", "store"]);
}

#[test]
fn what_is_set_first_is_not_loaded() {
    let clear = || assign(total(), dint(0));
    assert_eq!(kinds(&pass(vec![count_to(3, vec![clear(), step_total()])])), ["for of a local", "store", "store"]);
    let none = pass(vec![count_to(0, vec![clear(), step_total()])]);
    assert_eq!(kinds(&none), ["load", "for of a local", "store", "store"], "no turn sets it");
    let leave = || stmt(StatementKind::Exit);
    let if_true =
        |then: Block, otherwise: Block| stmt(StatementKind::If { condition: Expr::bool(true, AT), then, otherwise });
    for (first, loads) in [
        (if_true(vec![clear()], vec![clear()]), false),
        (if_true(vec![clear()], Vec::new()), true),
        (if_true(vec![leave()], Vec::new()), true),
        (if_true(vec![clear(), leave()], vec![clear()]), false),
    ] {
        let found = kinds(&pass(vec![count_to(3, vec![first.clone(), clear()])]));
        assert_eq!(found[0] == "load", loads, "{first:?}");
    }
}

#[test]
fn a_back_end_says_what_it_gains_by() {
    let body = || vec![count_to(3, vec![assign(element(count()), load(wide())), step_total()])];
    let of = |gain| promoted(&sample(body()), gain).routines[MAIN].locals.len();
    assert_eq!(of(Gain::WHOLE), of(Gain { of_reads: false, ..Gain::WHOLE }) + 1);
    let nothing = Gain { suits: &|it| !matches!(it.kind, StatementKind::Assign { .. }), ..Gain::WHOLE };
    assert_eq!(kinds(&promoted(&sample(body()), nothing)), ["for"]);
}

/// The locals of loops before are used again.
#[test]
fn a_routine_gets_so_many_locals() {
    let after = pass(vec![count_to(3, vec![step_total()]); 2 * MOST_LOCALS]);
    let locals = after.routines[MAIN].locals.len();
    assert_eq!(locals, sample(Vec::new()).routines[MAIN].locals.len() + MOST_LOCALS);
    assert!(kinds(&after).iter().all(|it| *it != "for"));
}

#[test]
fn a_loop_whose_ends_show_its_indices_is_there_twice() {
    let gain = Gain { of_ends: true, ..Gain::WHOLE };
    let doubled = |last: Expr, index: Place| {
        let before = sample(vec![count_to_end(last, vec![assign(element(index), int(7))])]);
        let after = promoted(&before, gain);
        verify(&after).unwrap();
        after.routines[MAIN].body.iter().any(|it| matches!(it.kind, StatementKind::If { .. }))
    };
    assert!(doubled(load(temp()), count()));
    assert!(doubled(Expr::apply(Op::Sub, Type::INT, vec![load(temp()), int(1)], AT), count()));
    assert!(!doubled(int(3), count()), "its indices are known");
    assert!(!doubled(int(4), count()), "it faults in all cases");
    assert!(!doubled(load(temp()), wide()), "an index that is not the counter");
    assert!(!doubled(load(count()), count()), "an end that is the counter");
    assert!(
        !doubled(Expr::apply(Op::Div, Type::INT, vec![int(9), load(temp())], AT), count()),
        "an end that can fault"
    );
}

#[test]
fn what_is_read_again_after_an_element_is_read_once() {
    let int_type = count().ty;
    let step = assign(count(), Expr::apply(Op::Add, int_type, vec![load(count()), int(1)], AT));
    let stored = assign(element(count()), int(7));
    let after = pass(vec![stored.clone(), step.clone()]);
    assert_eq!(kinds(&after), ["load", "store", "store"]);
    assert!(matches!(reads(&after, 1).as_slice(), [Root::Local(_)]), "the index");
    assert!(matches!(reads(&after, 2).as_slice(), [Root::Local(_)]), "what is added to");
    let written_between = pass(vec![stored.clone(), assign(count(), int(2)), step.clone()]);
    assert_eq!(kinds(&written_between), ["store", "store", "store"]);
    let constant = assign(value(Expr::constant(Elementary::Lint, Value::I64(2), AT), 1), int(7));
    let known = pass(vec![
        assign(total(), Expr::convert(Conversion::Value, Type::DINT, load(count()), AT)),
        constant,
        step.clone(),
    ]);
    assert_eq!(kinds(&known), ["store", "store", "store"], "no variable is in doubt");
    let native = Gain { of_repeats: false, ..Gain::WHOLE };
    assert_eq!(kinds(&promoted(&sample(vec![stored, step]), native)), ["store", "store"]);
}

/// The roots of what a statement of the PROGRAM reads.
fn reads(program: &Program, at: usize) -> Vec<Root> {
    let mut roots = Vec::new();
    crate::visit::accesses(&program.routines[MAIN].body[at], &mut |place, access| {
        if access == crate::visit::Access::Read {
            roots.push(place.root);
        }
    });
    roots
}
