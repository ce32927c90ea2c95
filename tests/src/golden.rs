//! What the compiler makes of a case, and what is pinned next to it.

use crate::case::{Case, Pin};
use crate::difference;
use crate::execute::{Executor, Settings, agree_on};
use crate::scan::Table;
use staunch_frontend::{Compilation, Format, Severity, Sources, Style, render};
use staunch_ir::Program;
use std::fs;

/// Compares a case with all that is pinned; the error says what differs.
pub fn check(case: &Case) -> Result<(), String> {
    check_on(case, &Executor::EVERY)
}

/// The same, where its `.scan` runs on these executors alone.
pub fn check_on(case: &Case, executors: &[Executor]) -> Result<(), String> {
    let actual = actual(case, executors)?;
    let mut differences = String::new();
    for (pin, text) in actual {
        let changed = difference::lines(&case.pinned(pin), &text);
        if !changed.is_empty() {
            let extension = pin.extension();
            differences.push_str(&format!("{}.{extension} differs (- pinned, + now):\n{changed}", case.name));
        }
    }
    if differences.is_empty() { Ok(()) } else { Err(differences) }
}

/// Rewrites the files next to a case and returns what changed; where anything is wrong, nothing.
pub fn bless(case: &Case) -> Result<String, String> {
    let mut changes = String::new();
    for (pin, text) in actual(case, &Executor::ALL)? {
        let changed = difference::lines(&case.pinned(pin), &text);
        if !changed.is_empty() {
            let path = case.golden(pin);
            fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
            changes.push_str(&format!("{}.{}\n{changed}", case.name, pin.extension()));
        }
    }
    Ok(changes)
}

fn actual(case: &Case, executors: &[Executor]) -> Result<Vec<(Pin, String)>, String> {
    let (sources, compilation) = case.compile();
    let diagnostics = diagnostics(&sources, &compilation);
    if compilation.has_errors() != compilation.program.is_none() {
        return Err(format!("errors and program contradict each other:\n{diagnostics}"));
    }
    if let Some(program) = &compilation.program {
        staunch_ir::verify::verify(program).map_err(|it| format!("the program does not verify: {it:?}"))?;
    }
    let errors_are_pinned = case.pins.contains(&Pin::Diagnostics);
    if compilation.has_errors() && !errors_are_pinned {
        return Err(format!("it is rejected, and no .err says so:\n{diagnostics}"));
    }
    let text = |pin| {
        let program = || compilation.program.as_ref().ok_or_else(|| format!("it is rejected:\n{diagnostics}"));
        Ok((
            pin,
            match pin {
                Pin::Diagnostics if diagnostics.is_empty() => {
                    return Err("there is an .err, but nothing to say".to_owned());
                }
                Pin::Diagnostics => diagnostics.clone(),
                Pin::Ir => staunch_ir::print(program()?) + &tests(&compilation),
                Pin::Rust => {
                    let options = staunch_rust::Options { state: staunch_rust::State::Lean, ..Default::default() };
                    staunch_rust::emit(program()?, &options)
                }
                Pin::Clif => clif(program()?)?,
                Pin::Scan => scan(case, program()?, executors)?,
            },
        ))
    };
    case.pins.iter().map(|pin| text(*pin)).collect()
}

/// What is known of the unit tests in a program, and of what they cover.
fn tests(compilation: &Compilation) -> String {
    let tests = compilation.tests.iter().map(|it| format!("\n{it:#?}\n"));
    let coverage = compilation.coverage.iter().map(|it| format!("\n{it:?}"));
    tests.chain(coverage).collect()
}

/// All diagnostics as people see them, without colour.
pub fn diagnostics(sources: &Sources, compilation: &Compilation) -> String {
    let render = |it| render(it, sources, Format::Human, Style::default());
    let (errors, warnings): (Vec<_>, Vec<_>) =
        compilation.diagnostics.iter().partition(|it| it.severity == Severity::Error);
    errors.into_iter().chain(warnings).map(render).collect()
}

/// For one target, so that the text is the same on every machine.
fn clif(program: &Program) -> Result<String, String> {
    let target = staunch_native::Target::parse("x86_64-unknown-linux-gnu").map_err(|it| it.to_string())?;
    staunch_native::clif(program, &target).map_err(|it| it.to_string())
}

fn scan(case: &Case, program: &Program, executors: &[Executor]) -> Result<String, String> {
    let pinned = case.pinned(Pin::Scan);
    let table = Table::parse(&pinned).map_err(|it| format!("{}.scan: {it}", case.name))?;
    let case_settings = case.settings();
    let settings = Settings { cycle: case_settings.cycle, loop_budget: case_settings.loop_budget, first: None };
    let outcome = agree_on(executors, program, &case.module(), &table, &settings)?.table;
    // How cells are spaced is not what is pinned.
    Ok(if outcome == table { pinned } else { outcome.to_string() })
}
