//! Each invariant is broken once.

use super::{Violation, verify};
use crate::fixture::*;
use crate::*;

/// The program passes until `damage` is done to it, and then fails with a message that says
/// `expected`.
#[track_caller]
fn broken(expected: &str, damage: impl FnOnce(&mut Program)) {
    let mut program = sample(vec![assign(count(), int(1)), call_adder(count())]);
    verify(&program).unwrap();
    damage(&mut program);
    let violations = verify(&program).unwrap_err();
    let found = violations.iter().any(|violation| violation.to_string().contains(expected));
    assert!(found, "expected {expected:?}, found {violations:#?}");
}

#[track_caller]
fn bad(expected: &str, statement: Statement) {
    broken(expected, |program| program.routines[3].body.push(statement));
}

#[track_caller]
fn bad_expr(expected: &str, expr: Expr) {
    bad(expected, assign(count(), expr));
}

#[track_caller]
fn good(statement: Statement) {
    verify(&sample(vec![statement])).unwrap();
}

const SUBRANGE: Type = Type::Subrange(Elementary::Int, BoundsId(0));

fn elementary(it: Elementary) -> Type {
    Type::Elementary(it)
}

fn apply(op: Op, ty: Type, operands: Vec<Expr>) -> Expr {
    Expr::apply(op, ty, operands, AT)
}

fn green() -> Expr {
    Expr::new(COLOR, ExprKind::Const(Value::I16(5)), AT)
}

fn string(bytes: &[u8], capacity: u16) -> Expr {
    Expr::new(Type::string(capacity), ExprKind::Text(Chars::Narrow(bytes.to_vec())), AT)
}

#[test]
fn enumerations() {
    broken("base type is not an integer", |program| program.enums[0].base = Elementary::Real);
    broken("no values", |program| program.enums[0].values.clear());
    broken("a value that is not of the base", |program| program.enums[0].values[0].value = Value::I8(0));
}

#[test]
fn arrays_and_structures() {
    broken("lower bound is above", |program| program.arrays[0].low = 9);
    broken("not declared before", |program| program.arrays[0].element = Type::Array(ArrayId(0)));
    broken("not declared before", |program| program.arrays[0].element = Type::Enum(EnumId(1)));
    broken("not declared before", |program| program.structs[0].fields[0].ty = Type::Struct(StructId(0)));
    broken("not declared before", |program| program.structs[0].fields[0].ty = Type::Block(BlockId(9999)));
    broken("not declared before", |program| {
        program.arrays[0].element = Type::Struct(StructId(1));
        program.structs[0].fields[0].ty = Type::Array(ArrayId(0));
    });
    broken("no such structure", |program| program.globals = StructId(9));
    broken("subrange", |program| {
        program.bounds[0].1 = 40_000;
        program.structs[0].fields[0].ty = SUBRANGE;
    });
    broken("subrange", |program| program.structs[0].fields[0].ty = Type::Subrange(Elementary::Real, BoundsId(0)));
    broken("subrange", |program| program.structs[0].fields[0].ty = Type::Subrange(Elementary::Int, BoundsId(7)));
}

#[test]
fn sizes() {
    let huge = |program: &mut Program| {
        program.arrays[0].high = i64::MAX;
        program.structs[1].fields[2].initial = Const::Zero;
    };
    broken("larger than the limit", huge);
    broken("larger than the limit", |program| {
        program.arrays.push(Array { low: 1, high: 1 << 29, element: Type::BOOL });
        let big = || local("big", Type::Array(ArrayId(1)), Const::Zero);
        program.routines[0].locals.extend([big(), big(), big()]);
    });
}

#[test]
fn constants() {
    let main = |position: usize, initial: Const| {
        move |program: &mut Program| program.structs[1].fields[position].initial = initial
    };
    broken("not of type INT", main(0, Const::Scalar(Value::I32(0))));
    broken("not of type INT", main(0, Const::Text(Chars::Narrow(Vec::new()))));
    broken("not of type STRING[8]", main(4, Const::Text(Chars::Narrow(vec![b'a'; 9]))));
    broken("wrong length", main(2, Const::Array(vec![(2, Const::Zero)])));
    broken("wrong length", main(2, Const::Array(vec![(u64::MAX, Const::Zero), (4, Const::Zero)])));
    broken("not of type INT", main(2, Const::Array(vec![(3, Const::Scalar(Value::Bool(true)))])));
    broken("array constant of another type", main(0, Const::Array(Vec::new())));
    broken("wrong length", main(3, Const::Struct(Vec::new())));
    broken("not of type INT", main(3, Const::Struct(vec![Const::Scalar(Value::U8(0))])));
    broken("wrong length", main(5, Const::Struct(Vec::new())));
    broken("structure constant of another type", main(0, Const::Struct(Vec::new())));
    broken("not of type INT", |program| program.routines[0].locals[0].initial = Const::Text(Chars::Narrow(Vec::new())));
}

#[test]
fn routines() {
    broken("no such state", |program| program.classes[0].state = StructId(9));
    broken("belongs to another", |program| program.classes[0].state = StructId(1));
    broken("belongs to another", |program| program.classes[0].state = program.globals);
    broken("its Body is none", |program| program.routines[1].state = None);
    broken("a prescan has no parameters", |program| {
        program.routines[2].params.push(param("p", Type::INT, Mode::Reference));
    });
    broken("a FUNCTION has no state", |program| program.routines[0].state = Some(StructId(0)));
    broken("its Prescan is none", |program| program.classes[0].prescan = Some(RoutineId(0)));
    broken("not declared before", |program| program.routines[0].locals[0].ty = Type::Struct(StructId(9)));
    broken("a PROGRAM has no parameters", |program| {
        program.routines[3].params.push(param("p", Type::INT, Mode::Reference));
    });
    broken("by value to an instance", |program| program.routines[1].params[0].mode = Mode::Value(LocalId(0)));
    broken("no local of its own", |program| program.routines[0].params[0].mode = Mode::Value(LocalId(7)));
    broken("no local of its own", |program| program.routines[0].params[0].ty = Type::DINT);
    broken("no local of its own", |program| {
        program.routines[0].params[1].mode = Mode::Value(LocalId(0));
    });
    broken("a result that is not", |program| program.routines[0].result = Some(LocalId(5)));
    broken("a result that is not", |program| program.routines[3].result = Some(LocalId(0)));
    broken("file that does not exist", |program| program.routines[0].location.file = 1);
}

#[test]
fn instances() {
    broken("not a PROGRAM", |program| program.instances[0].program = ClassId(0));
    broken("not a PROGRAM", |program| program.instances[0].program = ClassId(9));
    broken("not above 0", |program| program.instances[0].interval = Some(0));
}

#[test]
fn variables() {
    broken("of another type", |program| program.classes[1].variables[0].place = value(lint(99), 1));
    broken("of another type", |program| program.classes[1].variables[0].place.ty = Type::BOOL);
    broken("not part of what it is a view of", |program| {
        let address = Address { area: Area::Memory, module: Module::default(), bit: 0, width: 64 };
        program.classes[1].variables[0].view = Some(View { ty: Type::Elementary(Elementary::Lword), bit: 0, address });
    });
    broken("of another type", |program| {
        program.classes[1].variables[0].place = Place::root(Root::Param(ParamId(0)), Type::INT);
    });
}

#[test]
fn places() {
    bad("no such storage", assign(Place::local(LocalId(5), Type::INT), int(1)));
    bad("no such storage", assign(Place::root(Root::Param(ParamId(0)), Type::INT), int(1)));
    broken("no such storage", |program| {
        let place = Place::root(Root::Instance, Type::Struct(StructId(0)));
        program.routines[0].body.push(assign(place.field(FieldId(0), Type::INT), int(1)));
    });
    broken("no such storage: Param", |program| {
        let value_param = Place::root(Root::Param(ParamId(0)), Type::INT);
        program.routines[0].body.push(assign(value_param, int(1)));
    });
    broken("no such storage: Param", |program| {
        let in_out = Place::root(Root::Param(ParamId(0)), Type::INT);
        program.routines[2].body.push(assign(in_out, int(1)));
    });
    bad("has no member", assign(count().field(FieldId(0), Type::INT), int(1)));
    bad("has no member", assign(adder().field(FieldId(4), Type::INT), int(1)));
    bad("has no member", assign(counter().field(FieldId(99), Type::INT), int(1)));
    bad("an index into", assign(count().index(lint(1), Type::INT, AT), int(1)));
    bad("expected Elementary(Lint)", assign(value(int(1), 1), int(1)));
    bad(
        "that says",
        assign(Place { ty: Type::DINT, ..count() }, Expr::convert(Conversion::Value, Type::DINT, int(1), AT)),
    );
    bad("file that does not exist", assign(values().index(lint(1), Type::INT, Location { file: 3, ..AT }), int(1)));
    let pin = |ty| counter().field(FieldId(2), ty);
    good(assign(pin(elementary(Elementary::Int)), int(1)));
    bad("that says", assign(pin(Type::BOOL), Expr::bool(true, AT)));
}

#[test]
fn constants_are_not_written() {
    bad("a write to a constant", assign(limit(), int(1)));
    bad("a write to a constant", call_adder(limit()));
    bad("a write to a constant", call_double(int(1), limit(), None));
    for (field, statement) in
        [(2, assign(value(lint(1), 1), int(1))), (3, call_adder(count())), (5, call_counter(Expr::bool(true, AT), 1))]
    {
        broken("a write to a constant", |program| {
            program.structs[1].fields[field].constant = true;
            program.routines[3].body.push(statement);
        });
    }
}

#[test]
fn constant_expressions() {
    bad_expr("not of its type", Expr::new(Type::INT, ExprKind::Const(Value::I32(1)), AT));
    bad_expr("not of its type", Expr::new(Type::Enum(EnumId(7)), ExprKind::Const(Value::I16(1)), AT));
    bad("longer than its type", assign(name(), string(b"123456789", 8)));
    bad_expr("longer than its type", Expr::new(Type::INT, ExprKind::Text(Chars::Narrow(Vec::new())), AT));
    bad_expr("aggregate of a simple", Expr::new(Type::INT, ExprKind::Aggregate(Const::Zero), AT));
    let short = ExprKind::Aggregate(Const::Array(vec![(1, Const::Zero)]));
    bad("wrong length", assign(values(), Expr::new(values().ty, short, AT)));
    bad_expr("a read of another type", Expr { ty: Type::DINT, ..load(count()) });
}

#[test]
fn operations() {
    bad_expr("ADD: operand count", apply(Op::Add, Type::INT, vec![int(1)]));
    bad_expr("SEL: an operand of the wrong repr", apply(Op::Sel, Type::INT, vec![int(1), int(1), int(1)]));
    bad_expr("ADD: operands of", apply(Op::Add, Type::INT, vec![int(1), lint(1)]));
    bad_expr("ADD: operands of", apply(Op::Add, Type::INT, vec![green(), green()]));
    bad_expr("ADD: operands of", apply(Op::Add, Type::INT, vec![string(b"", 1), string(b"", 1)]));
    bad_expr("SQRT does not exist", apply(Op::Sqrt, Type::INT, vec![int(1)]));
    bad_expr("ADD: a result", apply(Op::Add, Type::DINT, vec![int(1), int(1)]));
    bad("EQ: a result", assign(count(), apply(Op::Eq, Type::INT, vec![int(1), int(1)])));
    bad("EQ: operands of", assign(flag(), apply(Op::Eq, Type::BOOL, vec![green(), int(5)])));
    good(assign(flag(), apply(Op::Lt, Type::BOOL, vec![green(), load(color_place())])));
    bad_expr("expected Elementary(Int)", lint(1));
    bad_expr("file that does not exist", Expr { at: Location { file: 1, ..AT }, ..int(1) });
}

/// A write to a local of `-3..7`.
#[track_caller]
fn written_to_subrange(value: Expr) -> Result<(), Vec<Violation>> {
    let mut program = sample(Vec::new());
    let id = LocalId::next(program.routines[3].locals.len());
    program.routines[3].locals.push(local("small", SUBRANGE, Const::Zero));
    program.routines[3].body.push(assign(Place::local(id, SUBRANGE), value));
    verify(&program)
}

#[test]
fn subranges() {
    let checked = |low, high| apply(Op::InRange, SUBRANGE, vec![int(low), load(count()), int(high)]);
    let constant = |value| Expr::new(SUBRANGE, ExprKind::Const(Value::I16(value)), AT);
    for value in [checked(-3, 7), constant(7), constant(-3)] {
        written_to_subrange(value).unwrap();
    }
    for value in [load(count()), int(0), checked(-3, 8), checked(-4, 7), constant(8), constant(-4)] {
        written_to_subrange(value).unwrap_err();
    }
    let index = |low, high| apply(Op::CheckIndex, SUBRANGE, vec![int(low), load(count()), int(high)]);
    written_to_subrange(index(-3, 7)).unwrap();
    written_to_subrange(index(-3, 8)).unwrap_err();
    let sum = apply(Op::Add, SUBRANGE, vec![int(1), load(count())]);
    let same = Expr::convert(Conversion::Same, SUBRANGE, load(count()), AT);
    for value in [sum, same] {
        written_to_subrange(value).unwrap_err();
    }
    broken("a constant that is not of type INT(1..9)", |program| {
        program.routines[3].locals.push(local("small", Type::Subrange(Elementary::Int, BoundsId(1)), Const::Zero));
    });
}

#[test]
fn text_operations() {
    let text = |op, ty, operands| Expr::new(ty, ExprKind::ApplyText(op, operands), AT);
    bad_expr("LEN: operand count", text(TextOp::Len, Type::INT, Vec::new()));
    bad_expr("LEN: an operand", text(TextOp::Len, Type::INT, vec![int(1)]));
    bad_expr("LEFT: an operand", text(TextOp::Left, Type::string(8), vec![string(b"", 1), int(1)]));
    bad_expr("LEN: a result", text(TextOp::Len, Type::DINT, vec![string(b"", 1)]));
    good(assign(name(), text(TextOp::Left, Type::string(8), vec![string(b"abc", 3), lint(1)])));
}

#[test]
fn conversions() {
    let convert = |how, ty, value| Expr::convert(how, ty, value, AT);
    bad_expr("no conversion", convert(Conversion::Value, Type::INT, green()));
    bad_expr("no conversion", convert(Conversion::Value, Type::INT, string(b"", 1)));
    bad_expr("no conversion", convert(Conversion::Truncate, Type::INT, int(1)));
    bad_expr("no conversion", convert(Conversion::Same, Type::INT, lint(1)));
    bad_expr("no conversion", convert(Conversion::Same, Type::string(3), string(b"", 3)));
    good(assign(count(), convert(Conversion::Same, Type::INT, green())));
    good(assign(name(), convert(Conversion::Value, Type::string(8), string(b"", 30))));
}

#[test]
fn control_flow() {
    let block = |kind| vec![stmt(kind)];
    bad("EXIT outside", stmt(StatementKind::Exit));
    bad("CONTINUE outside", stmt(StatementKind::Continue));
    let turn = |inside: Vec<Statement>, continuing| {
        let body = [vec![stmt(StatementKind::Turn)], inside].concat();
        stmt(StatementKind::Loop { body, continuing, count: None })
    };
    bad(
        "takes no turns",
        stmt(StatementKind::Loop { body: Vec::new(), continuing: block(StatementKind::Exit), count: None }),
    );
    bad("CONTINUE outside", turn(Vec::new(), block(StatementKind::Continue)));
    good(turn(block(StatementKind::Continue), block(StatementKind::Exit)));
    good(turn(Vec::new(), vec![turn(block(StatementKind::Continue), Vec::new())]));
    let condition = int(1);
    bad("expected Elementary(Bool)", stmt(StatementKind::If { condition, then: Vec::new(), otherwise: Vec::new() }));
    bad("file that does not exist", Statement::new(StatementKind::Return, Location { file: 2, ..AT }));
}

#[test]
fn case_labels() {
    let case = |selector: Expr, labels: Vec<Vec<(i128, i128)>>| {
        let arms = labels.into_iter().map(|labels| Arm { labels, body: Vec::new() }).collect();
        stmt(StatementKind::Case { selector, arms, otherwise: Vec::new() })
    };
    bad("not an integer", case(Expr::bool(true, AT), Vec::new()));
    bad("not an integer", case(string(b"", 1), Vec::new()));
    bad("label outside", case(int(1), vec![vec![(0, 40_000)]]));
    bad("label outside", case(int(1), vec![vec![(2, 1)]]));
    bad("overlap", case(int(1), vec![vec![(1, 5)], vec![(5, 9)]]));
    bad("overlap", case(int(1), vec![vec![(1, 9), (3, 3)]]));
    good(case(green(), vec![vec![(5, 5), (0, 0)], vec![(1, 4)]]));
}

#[test]
fn calls() {
    let call = |callee: u32, instance, arguments, result| {
        stmt(StatementKind::Call { callee: RoutineId(callee), instance, arguments, result })
    };
    let by_value = || Argument::Value(int(1));
    let by_reference = || Argument::Reference(count());
    bad("before its caller", call(3, None, Vec::new(), None));
    bad("before its caller", call(7, None, Vec::new(), None));
    bad("not called on", call(1, None, vec![by_reference()], None));
    bad("not called on", call(1, Some(count()), vec![by_reference()], None));
    bad("not called on", call(0, Some(adder()), vec![by_value(), by_reference()], None));
    broken("not called on", |program| {
        program.routines.push(Routine { body: vec![call(2, None, Vec::new(), None)], ..program.routines[0].clone() });
    });
    bad("argument count", call(0, None, vec![by_value()], None));
    bad("passed the wrong way", call(0, None, vec![by_reference(), by_reference()], None));
    bad("passed the wrong way", call(0, None, vec![by_value(), by_value()], None));
    bad("expected Elementary(Int)", call(0, None, vec![Argument::Value(lint(1)), by_reference()], None));
    bad("place of another type", call(0, None, vec![by_value(), Argument::Reference(wide())], None));
    bad("does not go to a local", call_double(int(1), count(), Some(count())));
    bad("result of another type", call(1, Some(adder()), vec![by_reference()], Some(temp())));
    broken("result of another type", |program| {
        program.routines[3].locals.push(local("wide", Type::DINT, Const::Zero));
        let target = Place::local(LocalId(1), Type::DINT);
        program.routines[3].body.push(call_double(int(1), count(), Some(target)));
    });
    good(call_double(int(1), count(), None));
}

#[test]
fn blocks() {
    let call = |block, instruction, inputs| stmt(StatementKind::CallBlock { block, instruction, inputs });
    let on = || Expr::bool(true, AT);
    bad("not a standard block", call(count(), 0, Vec::new()));
    bad("no such instruction", call(counter(), 1, vec![on(), on(), int(1)]));
    bad("CTU: inputs in", call(counter(), 0, vec![on(), on()]));
    bad("CTU: inputs in", call(counter(), 0, vec![on(), on(), lint(1)]));
    bad("no such prescan", stmt(StatementKind::PrescanBlock { block: counter(), instruction: 0 }));
    bad("not a standard block", stmt(StatementKind::PrescanBlock { block: count(), instruction: 0 }));
    let prescan = prescan_adder;
    bad("not called on", prescan(RoutineId(0), adder()));
    bad("not called on", prescan(RoutineId(2), count()));
    bad("before its caller", prescan(RoutineId(3), adder()));
    good(prescan(RoutineId(2), adder()));
}
