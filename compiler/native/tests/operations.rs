//! Every operation at every repr, and every conversion, does what the runtime's function does,
//! over all edge values, whether its operands are variables or constants.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use staunch_ir::*;
use staunch_runtime::{Context, Fault, ops};
use support::*;

type Make = Box<dyn Fn(Vec<Expr>) -> Expr>;
type Expect = Box<dyn Fn(&[Value]) -> Result<Value, FaultKind>>;

/// One computation: a PROGRAM of its own, with a field for each operand and one for the result.
struct Case {
    name: String,
    operands: Vec<Repr>,
    result: Repr,
    /// From expressions that read the operands.
    value: Make,
    expected: Expect,
}

fn program_of(cases: &[Case]) -> Program {
    let mut structs = Vec::new();
    let mut routines = Vec::new();
    for case in cases {
        let id = StructId::next(structs.len());
        let reprs = case.operands.iter().chain([&case.result]);
        structs.push(structure(&case.name, reprs.map(|repr| zero("field", elementary(*repr))).collect()));
        let operand = |(at, repr): (usize, &Repr)| load(member(id, at, elementary(*repr)));
        let operands = case.operands.iter().enumerate().map(operand).collect();
        let target = member(id, case.operands.len(), elementary(case.result));
        routines.push(Routine {
            body: vec![assign(target, (case.value)(operands))],
            ..routine(RoutineKind::Body, &case.name, Some(id))
        });
    }
    program(Vec::new(), structs, routines)
}

/// Runs every case with all combinations of its operands' edge values.
fn check(cases: &[Case]) {
    let program = program_of(cases);
    let mut native = Native::new(&program);
    for (number, case) in cases.iter().enumerate() {
        let choices: Vec<_> = case.operands.iter().map(|repr| choices(*repr, case.operands.len())).collect();
        let mut tuple = vec![0; choices.len()];
        loop {
            let operands: Vec<_> = tuple.iter().zip(&choices).map(|(at, values)| values[*at]).collect();
            check_one(&program, &mut native, number, case, &operands);
            let Some(at) = (0..tuple.len()).find(|at| tuple[*at] + 1 < choices[*at].len()) else { break };
            tuple[at] += 1;
            tuple[..at].fill(0);
        }
    }
}

/// Fewer where there are more operands.
fn choices(repr: Repr, operands: usize) -> Vec<Value> {
    let all = edges(repr);
    let step = if operands > 2 { all.len().div_ceil(18) } else { 1 };
    all.into_iter().step_by(step).collect()
}

fn check_one(program: &Program, native: &mut Native, number: usize, case: &Case, operands: &[Value]) {
    let before = case.result.zero();
    for (at, value) in operands.iter().chain([&before]).enumerate() {
        let offset = native.offset(program, number, at);
        native.write_value(offset, *value);
    }
    let end = native.scan(number, &Context::at(0));
    let found = Value::read(case.result, &native.state()[native.offset(program, number, operands.len())..]);
    let expected = (case.expected)(operands);
    let holds = match (expected, end) {
        (Ok(expected), Ok(())) => same(expected, found),
        (Err(kind), Err(fault)) => fault == (Fault { kind, at: AT }) && same(found, before),
        _ => false,
    };
    assert!(holds, "{}{operands:?}: expected {expected:?}, found {found:?}, {end:?}", case.name);
}

fn reprs_of(op: Op, repr: Repr) -> Vec<Repr> {
    op.operands().iter().map(|fixed| fixed.unwrap_or(repr)).collect()
}

fn result_of(op: Op, repr: Repr) -> Repr {
    op.result().unwrap_or(repr)
}

fn rows() -> impl Iterator<Item = (Op, Repr)> {
    let reprs = |op: &'static Op| Repr::ALL.into_iter().filter(|repr| op.allows(*repr)).map(|repr| (*op, repr));
    Op::ALL.iter().flat_map(reprs)
}

#[test]
fn every_operation_at_every_repr() {
    let case = |(op, repr): (Op, Repr)| Case {
        name: format!("{}_{}", op.function(), repr.rust_name()),
        operands: reprs_of(op, repr),
        result: result_of(op, repr),
        value: Box::new(move |operands| operation(op, elementary(result_of(op, repr)), operands)),
        expected: Box::new(move |operands| apply_op(op, repr, operands)),
    };
    check(&rows().map(case).collect::<Vec<_>>());
}

fn apply_op(op: Op, repr: Repr, operands: &[Value]) -> Result<Value, FaultKind> {
    apply(op, repr, operands).unwrap()
}

/// Operations that are emitted otherwise for a constant last operand, or improved for one.
const CONSTANT_MATTERS: &[Op] = &[Op::Mul, Op::Div, Op::Mod, Op::Shl, Op::Shr, Op::Rol, Op::Ror, Op::Lt];

#[test]
fn operations_with_a_constant_last_operand() {
    let mut cases = Vec::new();
    for (op, repr) in rows().filter(|(op, _)| CONSTANT_MATTERS.contains(op)) {
        let reprs = reprs_of(op, repr);
        for last in edges(reprs[1]) {
            cases.push(Case {
                name: format!("{}_{}_by_{last:?}", op.function(), repr.rust_name()),
                operands: vec![reprs[0]],
                result: result_of(op, repr),
                value: Box::new(move |mut operands| {
                    operands.push(constant(last));
                    operation(op, elementary(result_of(op, repr)), operands)
                }),
                expected: Box::new(move |operands| apply_op(op, repr, &[operands[0], last])),
            });
        }
    }
    check(&cases);
}

#[test]
fn every_conversion() {
    let mut cases = Vec::new();
    for from in Repr::ALL {
        for to in Repr::ALL {
            cases.push(Case {
                name: format!("convert_{}_{}", from.rust_name(), to.rust_name()),
                operands: vec![from],
                result: to,
                value: Box::new(move |operands| converted(Conversion::Value, to, operands)),
                expected: Box::new(move |operands| Ok(ops::convert_value(operands[0], to))),
            });
            if from.is_float() && to.is_integer() {
                cases.push(Case {
                    name: format!("trunc_{}_{}", from.rust_name(), to.rust_name()),
                    operands: vec![from],
                    result: to,
                    value: Box::new(move |operands| converted(Conversion::Truncate, to, operands)),
                    expected: Box::new(move |operands| Ok(ops::trunc_value(operands[0], to))),
                });
            }
        }
    }
    check(&cases);
}

fn converted(how: Conversion, to: Repr, mut operands: Vec<Expr>) -> Expr {
    Expr::convert(how, elementary(to), operands.remove(0), AT)
}
