//! Each standard function takes each type of its class, with the same result on all executors and, where it knows the
//! function, on the witness; each other type is refused.

use staunch_frontend::{Dialect, Options, Severity, Source, Sources, compile, parse};
use staunch_runtime::{Context, Family};
use staunch_tests::execute::Executor;
use staunch_tests::leaf::Leaves;
use staunch_tests::rows::{self, Row};
use staunch_witness::Machine;
use std::collections::HashMap;

fn sources(text: String) -> Sources {
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", text));
    sources
}

/// Lines with an error, and what it says.
fn errors(text: &str) -> HashMap<usize, String> {
    let compilation = compile(&sources(text.to_owned()), &Options::default());
    let errors = compilation.diagnostics.into_iter().filter(|it| it.severity == Severity::Error);
    errors.map(|it| (text[..it.span.start as usize].matches('\n').count(), it.message.to_string())).collect()
}

#[test]
fn a_row_takes_the_types_of_its_class_and_no_others() {
    let mut wrong = Vec::new();
    for row in rows::rows(Dialect::Iec) {
        let mut look = |calls: &[Vec<rows::Taken>], expected: bool| {
            let text = row.program("Main", calls);
            let errors = errors(&text);
            let first = text.lines().position(|it| it == "END_VAR").unwrap() + 1;
            for (number, types) in calls.iter().enumerate() {
                let error = errors.get(&(first + number));
                if error.is_none() != expected {
                    let types: Vec<_> = types.iter().map(|it| it.name()).collect();
                    wrong.push(format!("{}({}): {error:?}", row.signature.name, types.join(", ")));
                }
            }
        };
        look(&row.accepted(), true);
        look(&row.refused(), false);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_executors_agree_on_every_row() {
    let sources = sources(rows::program());
    let program = compile(&sources, &Options::default()).program.expect("the rows compile");
    let leaves = Leaves::new(&program);
    let results = Executor::ALL.map(|executor| {
        let mut machine = executor.machine(&program, "rows").unwrap();
        let ends: Vec<_> = (0..program.instances.len()).map(|it| machine.scan(it, &Context::at(0))).collect();
        (ends, leaves.of(machine.state()))
    });
    for (ends, _) in &results {
        let fault = ends.iter().find(|it| it.is_err());
        assert!(fault.is_none(), "{fault:?}\n{}", rows::program());
    }
    let [interpreter, rust, native] = &results;
    for (name, other) in [("Rust", rust), ("native code", native)] {
        let different = interpreter.1.iter().zip(&other.1).find(|(a, b)| a != b);
        assert!(different.is_none(), "{name}: {different:?}");
    }
}

#[test]
fn the_witness_agrees_on_the_calls_that_it_knows() {
    let (mut calls, mut known) = (0, 0);
    for row in rows::rows(Dialect::Iec) {
        for call in row.accepted() {
            calls += 1;
            known += usize::from(witnessed(row, call));
        }
    }
    assert!(known * 3 > calls, "{known} of {calls}");
}

/// Whether the witness knows the function at these types.
fn witnessed(row: Row, call: Vec<rows::Taken>) -> bool {
    let text = row.program("Main", &[call]);
    let sources = sources(text.clone());
    let files = [parse(0, &text, &mut Vec::new())];
    let Ok(mut witness) = Machine::new(&sources, &files, Family::Iec, &["Main"]) else { return false };
    if witness.scan("Main", &Context::at(0)).is_err() {
        return false;
    }
    let theirs: HashMap<_, _> = witness.variables().into_iter().collect();
    let program = compile(&sources, &Options::default()).program.expect("the call compiles");
    let mut machine = Executor::Interpreter.machine(&program, "").unwrap();
    machine.scan(0, &Context::at(0)).unwrap();
    for (path, value) in Leaves::new(&program).of(machine.state()) {
        if let Some(their) = theirs.get(&path) {
            assert_eq!(&value, their, "{path}\n{text}");
        }
    }
    true
}
