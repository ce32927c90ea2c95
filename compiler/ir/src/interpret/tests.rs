//! What hand-built statements do.

use super::*;
use crate::fixture::*;
use crate::{
    Arm, Chars, Const, Conversion, Elementary, Expr, ExprKind, FaultKind, FieldId, LocalId, Op, Repr, Statement,
    StatementKind, TextOp, Type, fold,
};

struct Run {
    end: Result<(), Stop>,
    count: i16,
    wide: i32,
    total: i32,
    values: [i16; 3],
    sum: i16,
    name: Vec<u8>,
    counted: i16,
}

fn run(body: Vec<Statement>) -> Run {
    scans(body, &[Context::at(0)], Some(10_000))
}

fn scans(body: Vec<Statement>, contexts: &[Context], budget: Option<u64>) -> Run {
    let program = sample(body);
    crate::verify::verify(&program).unwrap();
    let mut interpreter = Interpreter::new(&program);
    interpreter.set_budget(budget);
    let mut end = Ok(());
    for cx in contexts {
        end = interpreter.scan(0, cx);
    }
    let frame = interpreter.enter(RoutineId(3), usize_of(interpreter.layout.machine.instances[0]));
    let read = |place: &Place| {
        let at = interpreter.resolve(&frame, place).unwrap();
        let repr = program.repr(place.ty).unwrap();
        Value::read(repr, &interpreter.memory[at..]).as_integer().unwrap()
    };
    let int = |place: &Place| i16::try_from(read(place)).unwrap();
    let dint = |place: &Place| i32::try_from(read(place)).unwrap();
    let text = interpreter.resolve(&frame, &name()).unwrap();
    let length = Value::read(Repr::U16, &interpreter.memory[text..]).as_integer().unwrap();
    let length = usize::try_from(length).unwrap();
    Run {
        end,
        count: int(&count()),
        wide: dint(&wide()),
        total: dint(&total()),
        values: [1, 2, 3].map(|at| int(&value(lint(at), 1))),
        sum: int(&adder().field(FieldId(0), Type::INT)),
        name: interpreter.memory[text + 2..][..length].to_vec(),
        counted: int(&counter().field(FieldId::next(pin("CV")), Type::INT)),
    }
}

fn pin(name: &str) -> usize {
    ctu().info().pins.iter().position(|pin| pin.name == name).unwrap()
}

fn fault(kind: FaultKind, line: u32) -> Result<(), Stop> {
    Err(Stop::Fault(Fault { kind, at: at(line) }))
}

#[test]
fn starts_from_the_image_and_keeps_state_between_scans() {
    let body = || vec![assign(count(), add(load(count()), int(1)))];
    let run = scans(body(), &[Context::at(0), Context::at(1)], None);
    assert_eq!((run.count, run.values, run.sum), (2, [1, 1, 9], 10));
    assert_eq!(run.name, b"abc");

    let program = sample(body());
    let mut interpreter = Interpreter::new(&program);
    let before = interpreter.state().to_vec();
    interpreter.scan(0, &Context::at(0)).unwrap();
    assert_ne!(interpreter.state(), before);
    interpreter.init();
    assert_eq!(interpreter.state(), before);
}

#[test]
fn temporaries_start_at_their_initial_values_in_each_scan() {
    let body = vec![assign(temp(), add(load(temp()), int(1))), assign(count(), load(temp()))];
    assert_eq!(scans(body, &[Context::at(0), Context::at(1)], None).count, 5);
}

#[test]
fn an_index_outside_its_bounds_faults_where_it_stands() {
    let run = run(vec![assign(count(), int(1)), assign(value(lint(4), 30), int(1)), assign(count(), int(2))]);
    assert_eq!(run.end, fault(FaultKind::IndexOutOfRange, 30));
    assert_eq!(run.count, 1, "what was written before stays");
}

#[test]
fn the_first_fault_from_the_left_wins() {
    let divide = Expr::apply(Op::Div, Type::INT, vec![int(1), int(0)], at(40));
    let left = run(vec![assign(value(lint(0), 30), divide.clone())]);
    assert_eq!(left.end, fault(FaultKind::IndexOutOfRange, 30), "the target's indices come first");
    let operands = add(divide, load(value(lint(0), 30)));
    assert_eq!(run(vec![assign(count(), operands)]).end, fault(FaultKind::DivideByZero, 40));
}

#[test]
fn a_fault_statement_stops_the_scan() {
    let statement = Statement::new(StatementKind::Fault(FaultKind::ZeroStep), at(50));
    assert_eq!(run(vec![statement]).end, fault(FaultKind::ZeroStep, 50));
}

#[test]
fn loops_run_continuing_after_continue_and_leave_at_exit() {
    let is = |place, n| Expr::apply(Op::Eq, Type::BOOL, vec![load(place), int(n)], AT);
    let when = |condition, kind| stmt(StatementKind::If { condition, then: vec![stmt(kind)], otherwise: Vec::new() });
    let total_plus = Expr::apply(
        Op::Add,
        Type::DINT,
        vec![load(wide()), Expr::convert(Conversion::Value, Type::DINT, load(count()), AT)],
        AT,
    );
    // FOR count := 0 TO 5: skip 3; wide := wide + count
    let body =
        vec![stmt(StatementKind::Turn), when(is(count(), 3), StatementKind::Continue), assign(wide(), total_plus)];
    let continuing = vec![when(is(count(), 5), StatementKind::Exit), assign(count(), add(load(count()), int(1)))];
    let run = run(vec![stmt(StatementKind::Loop { body, continuing, count: None }), assign(total(), load(wide()))]);
    assert_eq!((run.count, run.wide, run.total), (5, 1 + 2 + 4 + 5, 12));
}

#[test]
fn return_leaves_loops_and_the_pou() {
    let body = vec![stmt(StatementKind::Turn), stmt(StatementKind::Return)];
    let endless = stmt(StatementKind::Loop { body, continuing: Vec::new(), count: None });
    let run = run(vec![endless, assign(count(), int(1))]);
    assert_eq!((run.end, run.count), (Ok(()), 0));
}

#[test]
fn an_endless_loop_runs_out_of_steps() {
    let endless =
        stmt(StatementKind::Loop { body: vec![stmt(StatementKind::Turn)], continuing: Vec::new(), count: None });
    assert_eq!(run(vec![endless]).end, Err(Stop::OutOfSteps));
}

#[test]
fn an_endless_loop_uses_up_its_turns() {
    let endless =
        stmt(StatementKind::Loop { body: vec![stmt(StatementKind::Turn)], continuing: Vec::new(), count: None });
    let run = scans(vec![endless], &[Context::at(0).with_turns(1000)], None);
    assert_eq!(run.end, fault(FaultKind::LoopBudget, 7));
}

#[test]
fn case_takes_the_arm_that_holds_the_selector() {
    let case = |selector: i16| {
        let arm = |labels, n| Arm { labels, body: vec![assign(count(), int(n))] };
        let arms = vec![arm(vec![(-5, -1), (3, 3)], 1), arm(vec![(0, 2)], 2)];
        let otherwise = vec![assign(count(), int(9))];
        run(vec![stmt(StatementKind::Case { selector: int(selector), arms, otherwise })]).count
    };
    assert_eq!([-6, -5, -1, 0, 2, 3, 4].map(case), [9, 1, 1, 2, 2, 1, 9]);
}

#[test]
fn a_function_gets_copies_and_gives_a_result_and_outputs() {
    let run = run(vec![call_double(int(21), value(lint(2), 1), Some(temp())), assign(count(), load(temp()))]);
    assert_eq!((run.count, run.values), (42, [1, 21, 9]));
}

#[test]
fn an_in_out_is_the_callers_variable() {
    let run = run(vec![call_adder(value(lint(3), 1)), call_adder(value(lint(3), 1))]);
    assert_eq!((run.values[2], run.sum), (11, 10 + 10 + 11));
}

#[test]
fn an_in_out_may_alias_the_instance() {
    let sum = adder().field(FieldId(0), Type::INT);
    assert_eq!(run(vec![call_adder(sum)]).sum, 22);
}

#[test]
fn a_function_block_runs_its_prescan_when_told() {
    let prescan = prescan_adder(RoutineId(2), adder());
    assert_eq!(run(vec![prescan]).sum, 100);
}

/// Gives the PROGRAM a prescan of one statement.
fn add_prescan(program: &mut Program, statement: Statement) {
    let prescan =
        Routine { body: vec![statement], ..routine(crate::RoutineKind::Prescan, "Main", Some(crate::StructId(1))) };
    program.classes[1].prescan = Some(RoutineId::next(program.routines.len()));
    program.routines.push(prescan);
}

#[test]
fn a_program_runs_its_prescan_in_the_first_scan_only() {
    let mut program = sample(vec![call_adder(count())]);
    add_prescan(&mut program, prescan_adder(RoutineId(2), adder()));
    let mut interpreter = Interpreter::new(&program);
    let sum = usize_of(interpreter.layout.machine.instances[0])
        + usize_of(interpreter.layout.field(crate::StructId(1), FieldId(3)));
    let mut scan = |cx| {
        interpreter.scan(0, &cx).unwrap();
        Value::read(Repr::I16, &interpreter.state()[sum..])
    };
    assert_eq!(scan(Context::at(0)), Value::I16(11));
    assert_eq!(scan(Context::first(0)), Value::I16(102));
    assert_eq!(scan(Context::at(0)), Value::I16(105));
}

#[test]
fn a_block_counts_in_its_instance() {
    let edge = |up| call_counter(Expr::bool(up, AT), 5);
    assert_eq!(run(vec![edge(true), edge(true), edge(false), edge(true)]).counted, 2);
}

#[test]
fn logix_instructions_take_a_rung_and_have_a_prescan() {
    let id = block("COUNTER", staunch_runtime::Family::Logix);
    let mut program = sample(Vec::new());
    program.structs[1].fields[5].ty = Type::Block(id);
    let tag = || Place { ty: Type::Block(id), ..counter() };
    let inputs = vec![Expr::bool(true, AT)];
    program.classes[1].variables.clear();
    add_prescan(&mut program, stmt(StatementKind::PrescanBlock { block: tag(), instruction: 0 }));
    program.routines[3].body = vec![stmt(StatementKind::CallBlock { block: tag(), instruction: 0, inputs })];
    crate::verify::verify(&program).unwrap();
    let acc = id.info().pin("ACC").unwrap();
    let count = |contexts: &[Context]| {
        let mut interpreter = Interpreter::new(&program);
        contexts.iter().for_each(|cx| interpreter.scan(0, cx).unwrap());
        let offset = usize_of(interpreter.layout.machine.instances[0])
            + usize_of(interpreter.layout.field(crate::StructId(1), FieldId(5)));
        Value::read(acc.repr(), &interpreter.state()[offset + acc.offset..]).as_integer()
    };
    assert_eq!(count(&[Context::at(0)]), Some(1));
    assert_eq!(count(&[Context::first(0)]), Some(0), "the prescan uses up an edge");
}

fn string(bytes: &[u8], capacity: u16) -> Expr {
    Expr::new(Type::string(capacity), ExprKind::Text(Chars::Narrow(bytes.to_vec())), AT)
}

fn concat(a: Expr, b: Expr, capacity: u16) -> Expr {
    Expr::new(Type::string(capacity), ExprKind::ApplyText(TextOp::Concat, vec![a, b]), AT)
}

#[test]
fn strings_are_cut_at_their_capacity() {
    let joined = concat(load(name()), string(b"defghij", 7), 20);
    let cut = Expr::convert(Conversion::Value, Type::string(8), joined, AT);
    assert_eq!(run(vec![assign(name(), cut)]).name, b"abcdefgh");
    assert_eq!(run(vec![assign(name(), concat(load(name()), load(name()), 8))]).name, b"abcabc");
}

#[test]
fn aggregates_are_copied_and_written_as_a_whole() {
    let constant = Expr::new(values().ty, ExprKind::Aggregate(Const::Array(vec![(3, int_const(7))])), AT);
    let run = run(vec![assign(values(), constant), assign(values(), load(values()))]);
    assert_eq!(run.values, [7, 7, 7]);
}

#[test]
fn folding_needs_no_program() {
    let sum = add(int(i16::MAX), int(1));
    assert_eq!(fold(&sum), Some(Ok(Const::Scalar(Value::I16(i16::MIN)))));
    let divide = Expr::apply(Op::Div, Type::INT, vec![int(1), int(0)], at(9));
    let fault = Fault { kind: FaultKind::DivideByZero, at: at(9) };
    assert_eq!(fold(&divide), Some(Err(fault)));
    assert_eq!(fold(&add(int(1), divide)), None);
    assert_eq!(fold(&add(int(1), load(Place::local(LocalId(0), Type::INT)))), None);
    assert_eq!(
        fold(&concat(string(b"ab", 2), string(b"cd", 2), 3)),
        Some(Ok(Const::Text(Chars::Narrow(b"abc".to_vec()))))
    );
    let half = Expr::constant(Elementary::Lreal, Value::F64(2.5), AT);
    let rounded = Expr::convert(Conversion::Value, Type::INT, half.clone(), AT);
    assert_eq!(fold(&rounded), Some(Ok(int_const(2))));
    let cut = Expr::convert(Conversion::Truncate, Type::INT, half, AT);
    assert_eq!(fold(&cut), Some(Ok(int_const(2))));
    let green = Expr::new(COLOR, ExprKind::Const(Value::I16(5)), AT);
    let equal = Expr::apply(Op::Eq, Type::BOOL, vec![green.clone(), green], AT);
    assert_eq!(fold(&equal), Some(Ok(Const::Scalar(Value::Bool(true)))));
}
