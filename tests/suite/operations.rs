//! Every operation at every repr, and every conversion, over all edge values: the Rust that is
//! printed for it does what the runtime's own function does.

use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::{Conversion, FaultKind, FieldId, Op, Repr, Type, Value, apply};
use staunch_runtime::{Context, Fault, ops};
use staunch_tests::execute::Executor;
use staunch_tests::leaf::scalar;
use staunch_tests::operation::{AT, Task, edges, program};

#[test]
fn printed_rust_computes_as_the_runtime_does() {
    compare(Executor::Rust);
}

#[test]
fn the_interpreter_computes_as_the_runtime_does() {
    compare(Executor::Interpreter);
}

fn compare(executor: Executor) {
    let tasks = Task::all();
    let program = program(&tasks);
    staunch_ir::verify::verify(&program).unwrap();
    let layout = Layout::new(&program);
    let mut machine = executor.machine(&program, "operations").unwrap();
    let (mut failures, mut compared) = (Vec::new(), 0_u64);
    for (number, task) in tasks.iter().enumerate() {
        let base = usize_of(layout.machine.instances[number]);
        let ty = Type::Struct(program.routines[number].state.unwrap());
        let at = |field: usize| base + usize_of(layout.offset(ty, FieldId::next(field)));
        for operands in combinations(&task.operands()) {
            for (field, value) in operands.iter().enumerate() {
                let mut bytes = [0; 8];
                value.write(&mut bytes);
                machine.write(at(field), &bytes[..value.repr().size() as usize]);
            }
            let end = machine.scan(number, &Context::at(0));
            let result = Value::read(task.result(), &machine.state()[at(operands.len())..]);
            let (found, expected) = (shown(end.map(|()| result)), shown(expected(*task, &operands)));
            compared += 1;
            if found != expected && failures.len() < 50 {
                failures.push(format!("{}{operands:?} is {found}, not {expected}", task.name()));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(tasks.len() > 400 && compared > 100_000, "{} tasks, {compared} comparisons", tasks.len());
}

fn expected(task: Task, operands: &[Value]) -> Result<Value, Fault> {
    let at = |kind: FaultKind| Fault { kind, at: AT };
    match task {
        Task::Apply(op, repr) => apply(op, repr, operands).unwrap().map_err(at),
        Task::NotApply(op, repr) => {
            let inner = apply(op, repr, operands).unwrap().map_err(at)?;
            apply(Op::Not, Repr::Bool, &[inner]).unwrap().map_err(at)
        }
        Task::Shift(op, repr, count) => apply(op, repr, &[operands[0], Value::I64(count)]).unwrap().map_err(at),
        Task::Convert(Conversion::Truncate, _, to) => Ok(ops::trunc_value(operands[0], to)),
        Task::Convert(Conversion::Bits, _, to) => Ok(ops::same_bits(operands[0], to)),
        Task::Convert(Conversion::Value | Conversion::Same, _, to) => Ok(ops::convert_value(operands[0], to)),
    }
}

fn shown(end: Result<Value, Fault>) -> String {
    end.map_or_else(|fault| fault.to_string(), scalar)
}

/// Every combination of edge values.
fn combinations(reprs: &[Repr]) -> Vec<Vec<Value>> {
    reprs.iter().fold(vec![Vec::new()], |rows, repr| {
        let extend =
            |row: &Vec<Value>| edges(*repr).into_iter().map(|it| [row.as_slice(), &[it]].concat()).collect::<Vec<_>>();
        rows.iter().flat_map(extend).collect()
    })
}
