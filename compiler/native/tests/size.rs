//! Programs of unusual size compile to code that agrees with the interpreter.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use staunch_ir::interpret::Interpreter;
use staunch_ir::*;
use staunch_runtime::Context;
use support::*;

fn main_with(fields: Vec<Field>, locals: Vec<Local>, body: Block) -> Program {
    let main = Routine { locals, body, ..routine(RoutineKind::Body, "Main", Some(StructId(0))) };
    program(Vec::new(), vec![structure("Main", fields)], vec![main])
}

fn field_place(at: usize) -> Place {
    member(StructId(0), at, Type::INT)
}

fn agree(program: &Program) {
    let mut native = Native::new(program);
    let mut interpreter = Interpreter::new(program);
    assert_eq!(interpreter.state(), native.state());
    for scan in 0..3 {
        interpreter.scan(0, &Context::at(scan)).unwrap();
        native.scan(0, &Context::at(scan)).unwrap();
        assert_eq!(interpreter.state(), native.state());
    }
}

fn add(a: Expr, b: Expr) -> Expr {
    operation(Op::Add, Type::INT, vec![a, b])
}

#[test]
fn deep_expressions() {
    let depth = 1000;
    let leaf = || load(field_place(0));
    let left = (0..depth).fold(leaf(), |tree, _| add(tree, leaf()));
    let right = (0..depth).fold(leaf(), |tree, _| add(leaf(), tree));
    let zeros = (0..2).map(|_| field("x", Type::INT, Const::Scalar(Value::I16(3)))).collect();
    agree(&main_with(zeros, Vec::new(), vec![assign(field_place(1), left), assign(field_place(0), right)]));
}

#[test]
fn deep_statements() {
    let condition = || operation(Op::Ge, Type::BOOL, vec![load(field_place(0)), int(0)]);
    let innermost = assign(field_place(0), add(load(field_place(0)), int(1)));
    let nested = (0..200).fold(innermost, |inner, _| {
        stmt(StatementKind::If { condition: condition(), then: vec![inner], otherwise: Vec::new() })
    });
    agree(&main_with(vec![zero("x", Type::INT)], Vec::new(), vec![nested]));
}

#[test]
fn more_locals_than_the_code_generator_likes() {
    let locals: Vec<_> = (0..3000).map(|at| local("v", Type::INT, Const::Scalar(Value::I16(at)))).collect();
    let place = |at: usize| Place::local(LocalId::next(at), Type::INT);
    let mut body: Block =
        (1..locals.len()).map(|at| assign(place(at), add(load(place(at - 1)), load(place(at))))).collect();
    body.push(assign(field_place(0), load(place(2999))));
    agree(&main_with(vec![zero("x", Type::INT)], locals, body));
}

#[test]
fn many_statements() {
    let count = 20_000;
    let fields = (0..100).map(|_| field("x", Type::INT, Const::Scalar(Value::I16(1)))).collect();
    let statement = |at: usize| {
        let sum = add(load(field_place(at % 100)), load(field_place(at * 7 % 100)));
        if !at.is_multiple_of(10) {
            return assign(field_place(at * 3 % 100), sum);
        }
        let condition = operation(Op::Lt, Type::BOOL, vec![load(field_place(at % 99)), sum]);
        let then = vec![assign(field_place(at % 98), int(2))];
        stmt(StatementKind::If { condition, then, otherwise: Vec::new() })
    };
    agree(&main_with(fields, Vec::new(), (0..count).map(statement).collect()));
}

#[test]
fn a_large_state_is_zeroed_and_then_written() {
    let array = Array { low: 0, high: 99_999, element: Type::INT };
    let mut fields = vec![zero("x", Type::INT)];
    let runs = vec![
        (10, Const::Scalar(Value::I16(-1))),
        (40_000, Const::Zero),
        (1, Const::Scalar(Value::I16(7))),
        (49_000, Const::Zero),
        (10_989, Const::Scalar(Value::I16(5))),
    ];
    fields.push(field("values", Type::Array(ArrayId(0)), Const::Array(runs)));
    let program = Program { arrays: vec![array], ..main_with(fields, Vec::new(), Vec::new()) };
    agree(&program);
    let mut native = Native::new(&program);
    let start = native.state().to_vec();
    native.write(0, &vec![1; start.len()]);
    native.init();
    assert!(native.state() == start);
}

#[test]
fn labels_at_the_ends_of_every_repr() {
    for repr in Repr::ALL.into_iter().filter(|repr| repr.is_integer()) {
        let ty = elementary(repr);
        let (min, max) = repr.range().unwrap();
        let labels = [(min, min), (min + 1, min + 30), (max - 60, max - 31), (max - 1, max)];
        let arm = |(at, label): (i16, &(i128, i128))| Arm {
            labels: vec![*label],
            body: vec![assign(field_place(0), int(at))],
        };
        let arms = (1..).zip(&labels).map(arm).collect();
        let selector = load(member(StructId(0), 1, ty));
        let otherwise = vec![assign(field_place(0), int(9))];
        let body = vec![stmt(StatementKind::Case { selector, arms, otherwise })];
        let program = main_with(vec![zero("x", Type::INT), zero("selector", ty)], Vec::new(), body);
        let mut native = Native::new(&program);
        for number in [min, min + 1, min + 30, min + 31, max - 61, max - 60, max - 31, max - 30, max - 2, max - 1, max]
        {
            let expected =
                labels.iter().position(|(low, high)| (*low..=*high).contains(&number)).map_or(9, |at| at + 1);
            let offset = native.offset(&program, 0, 1);
            native.write_value(offset, repr.integer(number).unwrap());
            native.scan(0, &Context::at(0)).unwrap();
            let found = Value::read(Repr::I16, &native.state()[native.offset(&program, 0, 0)..]);
            assert_eq!(found.as_integer(), Some(i128::try_from(expected).unwrap()), "{repr:?} {number}");
        }
    }
}
