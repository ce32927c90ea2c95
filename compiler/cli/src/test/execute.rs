//! One test on one executor: a scan for SETUP and the test itself, and one for TEARDOWN.

use super::Outcome;
use super::coverage::Counts;
use crate::args::{self, Backend};
use crate::machine::{Interpreted, Native};
use crate::rustc::{self, Kind};
use crate::session::Session;
use staunch_frontend::Test;
use staunch_host::{Machine, Map, csv_cells, value_at};
use staunch_ir::Program;
use staunch_runtime::{Context, Fault};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

/// What all threads share.
pub struct Suite<'p> {
    program: &'p Program,
    pub backend: Backend,
    /// Of the back end `rust`: an executable, which runs one test each time.
    executable: Option<PathBuf>,
    pub turns: u64,
    /// What the tests execute, where it is counted.
    pub counts: Option<&'p Mutex<Counts>>,
}

/// What one thread runs its tests on.
pub struct Executor<'p> {
    runs: Runs<'p>,
    turns: u64,
    counts: Option<&'p Mutex<Counts>>,
}

enum Runs<'p> {
    Here(Box<dyn Machine + 'p>, Box<Map>),
    Apart(&'p PathBuf),
}

/// The variables of a test after its scans, by their names.
type Values<'v> = dyn Fn(&str) -> Result<String, String> + 'v;

impl<'p> Suite<'p> {
    pub fn new(
        session: &Session,
        args: &args::Test,
        program: &'p Program,
        counts: Option<&'p Mutex<Counts>>,
    ) -> Result<Self, String> {
        let executable = match args.backend {
            Backend::Rust if !program.instances.is_empty() => Some(rustc::compile(program, Kind::Executable, None)?),
            Backend::Rust | Backend::Native | Backend::Interpret => None,
        };
        let turns = args.loop_budget.or(session.project.loop_budget).unwrap_or(Context::TURNS);
        Ok(Self { program, backend: args.backend, executable, turns, counts })
    }

    /// For a program that runs once, and is not worth to be compiled.
    pub fn interpreted(program: &'p Program, turns: u64) -> Self {
        Self { program, backend: Backend::Interpret, executable: None, turns, counts: None }
    }

    /// An executor for the tests of the instances that are `wanted`.
    pub fn executor(&self, wanted: impl Fn(usize) -> bool) -> Result<Executor<'_>, String> {
        let runs = match (&self.executable, self.backend) {
            (Some(executable), _) => Runs::Apart(executable),
            (None, Backend::Interpret) => {
                let (machine, map) = Interpreted::new(self.program)?;
                Runs::Here(Box::new(machine), Box::new(map))
            }
            (None, Backend::Native | Backend::Rust) => {
                let (machine, map) = Native::new(&only(self.program, wanted))?;
                Runs::Here(Box::new(machine), Box::new(map))
            }
        };
        Ok(Executor { runs, turns: self.turns, counts: self.counts })
    }
}

/// The program with the statements of these tests alone: what no other thread's tests run is compiled
/// once, by that thread.
fn only(program: &Program, wanted: impl Fn(usize) -> bool) -> Program {
    let mut program = program.clone();
    for instance in (0..program.instances.len()).filter(|it| !wanted(*it)) {
        let body = program.class(program.instances[instance].program).body;
        program.routines[body.index()].body.clear();
    }
    program
}

impl Executor<'_> {
    pub fn run(&mut self, instance: usize, test: &Test) -> Result<Outcome, String> {
        let outcome = self.outcome(instance, test)?;
        if let (Runs::Here(machine, _), Some(counts)) = (&self.runs, self.counts) {
            counts.lock().map_err(|_| "a thread ended early")?.add(machine.state());
        }
        Ok(outcome)
    }

    fn outcome(&mut self, instance: usize, test: &Test) -> Result<Outcome, String> {
        match &mut self.runs {
            Runs::Here(machine, map) => {
                machine.init();
                for first_scan in [true, false] {
                    let cx = Context::new(0, first_scan).with_turns(self.turns);
                    if let Err(fault) = machine.scan(instance, &cx) {
                        return Ok(Outcome::Faulted(place_of(fault, map)));
                    }
                    let values =
                        |name: &str| value_at(map, &[instance], machine.state(), &format!("{}.{name}", test.instance));
                    let outcome = outcome(test, &values)?;
                    if outcome != Outcome::Passed {
                        return Ok(outcome);
                    }
                }
                Ok(Outcome::Passed)
            }
            Runs::Apart(executable) => apart(executable, test, self.turns),
        }
    }
}

fn place_of(fault: Fault, map: &Map) -> String {
    let files: Vec<_> = map.files.iter().map(String::as_str).collect();
    fault.of(&files).to_string()
}

fn outcome(test: &Test, values: &Values<'_>) -> Result<Outcome, String> {
    let failed = values("__failed")?;
    let Some(number) = failed.parse::<usize>().ok().filter(|it| *it > 0) else { return Ok(Outcome::Passed) };
    let assertion = number - 1;
    let made = test.assertions.get(assertion).ok_or_else(|| format!("assertion {number} is not known"))?;
    let shown = |name: &Option<String>| name.as_deref().map(values).transpose();
    let (actual, expected, message) = (shown(&made.actual)?, shown(&made.expected)?, shown(&made.message)?);
    Ok(Outcome::Failed { assertion, actual, expected, message })
}

fn apart(executable: &Path, test: &Test, turns: u64) -> Result<Outcome, String> {
    let assertions = test.assertions.iter();
    let kept = assertions.flat_map(|it| [&it.actual, &it.expected, &it.message]).flatten();
    let names: Vec<_> = ["__failed".to_owned()].into_iter().chain(kept.cloned()).collect();
    let mut command = Command::new(executable);
    command.args(["--program", &test.instance, "--scans", "2", "--trace", "-", "--vars", &names.join(",")]);
    command.args(["--loop-budget", &turns.to_string()]);
    let ran = command.output().map_err(|error| format!("cannot run {}: {error}", executable.display()))?;
    let text = String::from_utf8_lossy(&ran.stdout);
    let rows = csv_cells(&text).unwrap_or_default();
    let Some((heading, rows)) = rows.split_first() else {
        return Err(String::from_utf8_lossy(&ran.stderr).into_owned());
    };
    for row in rows {
        let values = |name: &str| {
            let at = heading.iter().position(|it| it == name);
            at.and_then(|at| row.get(at)).cloned().ok_or_else(|| format!("the trace has no `{name}`"))
        };
        let outcome = outcome(test, &values)?;
        if outcome != Outcome::Passed {
            return Ok(outcome);
        }
    }
    match ran.status.code() {
        Some(0) => Ok(Outcome::Passed),
        _ => Ok(Outcome::Faulted(fault_in(&String::from_utf8_lossy(&ran.stderr)))),
    }
}

/// The place and the kind of a fault, without the scan and the program that an executable adds.
fn fault_in(text: &str) -> String {
    let text = text.trim();
    let text = text.strip_prefix("error: ").unwrap_or(text).replacen(": fault: ", ": ", 1);
    text.rsplit_once(" (scan ").map_or(text.clone(), |it| it.0.to_owned())
}
