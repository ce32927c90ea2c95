//! One test on one executor: a scan for SETUP and the test itself, and one for TEARDOWN; of a suite as many as it takes.

use super::apart;
use super::coverage::Counts;
use super::fixture::{self, Step};
use super::outcome::{Case, Outcome, failed};
use super::suite::{self, Pace, Ran};
use crate::args::{self, Backend, Opt};
use crate::rustc::{self, Kind};
use crate::session::Session;
use staunch_frontend::Test;
use staunch_host::{Machine, Map, minor_faults_json, minor_faults_note, value_at};
use staunch_ir::Program;
use staunch_machine::{Interpreted, Native};
use staunch_runtime::{Context, Fault, MinorFaults};
use std::path::PathBuf;
use std::sync::Mutex;

/// What all threads share.
pub struct Suite<'p> {
    program: &'p Program,
    pub backend: Backend,
    /// Of the back end `rust`: an executable, which runs one test each time.
    executable: Option<PathBuf>,
    pub turns: u64,
    /// What scans of a TcUnit suite there are.
    pub pace: Pace,
    /// What the tests execute, where it is counted.
    pub counts: Option<&'p Mutex<Counts>>,
    /// The divisions by zero after which programs continued.
    minor: Mutex<Minor>,
}

/// Minor faults of all tests, and the report on them: as text, and as JSON.
#[derive(Default)]
struct Minor {
    faults: MinorFaults,
    told: Option<(String, String)>,
}

/// What one thread runs its tests on.
pub struct Executor<'p> {
    runs: Runs<'p>,
    turns: u64,
    pace: Pace,
    counts: Option<&'p Mutex<Counts>>,
    minor: &'p Mutex<Minor>,
}

enum Runs<'p> {
    Here(Box<dyn Machine + 'p>, Box<Map>),
    Apart(&'p PathBuf),
}

impl<'p> Suite<'p> {
    pub fn new(
        session: &Session,
        args: &args::Test,
        program: &'p Program,
        counts: Option<&'p Mutex<Counts>>,
    ) -> Result<Self, String> {
        let executable = match args.backend {
            Backend::Rust if !program.instances.is_empty() => {
                Some(rustc::compile(program, Kind::Executable, None, Opt::Speed)?)
            }
            Backend::Rust | Backend::Native | Backend::Interpret => None,
        };
        // A suite does in one scan what a program does in many; interpreted, so many turns would take minutes.
        let patience = if args.backend == Backend::Interpret { 1 } else { 100 };
        let turns = args.loop_budget.or(session.project.loop_budget).unwrap_or(Context::TURNS * patience);
        Ok(Self {
            program,
            backend: args.backend,
            executable,
            turns,
            pace: Pace::of(session, args)?,
            counts,
            minor: Mutex::default(),
        })
    }

    /// For a program that runs once, and is not worth to be compiled.
    pub fn interpreted(program: &'p Program, turns: u64, pace: Pace) -> Self {
        Self {
            program,
            backend: Backend::Interpret,
            executable: None,
            turns,
            pace,
            counts: None,
            minor: Mutex::default(),
        }
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
        Ok(Executor { runs, turns: self.turns, pace: self.pace, counts: self.counts, minor: &self.minor })
    }

    /// The report on the minor faults of tests that ran here: as text, and as JSON.
    pub fn minor_faults(&self) -> Option<(String, String)> {
        self.minor.lock().ok()?.told.clone()
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
    /// The results of a test, or of those tests of a suite that are wanted.
    pub fn run(&mut self, instance: usize, test: &Test, wants: &dyn Fn(&str) -> bool) -> Result<Vec<Case>, String> {
        if let Some(it) = &test.fixture {
            return fixture::cases(test, it, wants, &mut |steps| {
                let outcomes = self.fixture(instance, test, steps)?;
                // After a fault the others run on a fresh state.
                self.count()?;
                Ok(outcomes)
            });
        }
        let Some(suite) = &test.suite else {
            let outcome = self.outcome(instance, test)?;
            self.count()?;
            return Ok(vec![Case { title: test.title.clone(), span: test.span, outcome }]);
        };
        let mut is_first = true;
        suite::cases(test, suite, self.pace, wants, &mut |wanted, see| {
            let run = self.suite(instance, test, wanted, see);
            // Another run of the same is no more.
            if std::mem::take(&mut is_first) {
                self.count()?;
            }
            run
        })
    }

    fn count(&self) -> Result<(), String> {
        if let (Runs::Here(machine, _), Some(counts)) = (&self.runs, self.counts) {
            counts.lock().map_err(|_| "a thread ended early")?.add(machine.state());
        }
        Ok(())
    }

    fn outcome(&mut self, instance: usize, test: &Test) -> Result<Outcome, String> {
        let minor = self.minor;
        match &mut self.runs {
            Runs::Here(machine, map) => {
                machine.init();
                for first_scan in [true, false] {
                    let cx = Context::new(0, first_scan).with_turns(self.turns).with_cycle(self.pace.cycle);
                    let ran = machine.scan(instance, &cx);
                    note(minor, &cx, map);
                    if let Err(fault) = ran {
                        return Ok(Outcome::Faulted(place_of(fault, map)));
                    }
                    let values = |name: &str| value_at(map, &[instance], machine.state(), name);
                    let outcome = failed(test, &values)?;
                    if outcome != Outcome::Passed {
                        return Ok(outcome);
                    }
                }
                Ok(Outcome::Passed)
            }
            Runs::Apart(executable) => apart::test(executable, test, self.turns, self.pace.cycle),
        }
    }

    /// Runs these tests of a fixture on one instance of it, up to a fault.
    fn fixture(&mut self, instance: usize, test: &Test, steps: &[Step]) -> Result<Vec<Outcome>, String> {
        let (turns, cycle, minor) = (self.turns, self.pace.cycle, self.minor);
        match &mut self.runs {
            Runs::Here(machine, map) => {
                machine.init();
                let (mut now, mut outcomes) = (0_i64, Vec::new());
                for step in steps {
                    for (name, value) in step.values(test) {
                        let place = staunch_host::place_of(map, &[instance], &name)?;
                        machine.write(place.offset, &value.bytes());
                    }
                    let cx = Context::new(now, now == 0).with_turns(turns).with_cycle(cycle);
                    let ran = machine.scan(instance, &cx);
                    note(minor, &cx, map);
                    if let Err(fault) = ran {
                        outcomes.push(Outcome::Faulted(place_of(fault, map)));
                        break;
                    }
                    let values = |name: &str| value_at(map, &[instance], machine.state(), name);
                    outcomes.push(failed(test, &values)?);
                    now = now.saturating_add(cycle);
                }
                Ok(outcomes)
            }
            Runs::Apart(executable) => apart::fixture(executable, test, turns, self.pace, steps),
        }
    }

    /// Runs a suite, such that what fails first in the test of a number is kept; 0 for any.
    fn suite(&mut self, instance: usize, test: &Test, wanted: usize, see: &mut suite::See<'_>) -> Result<(), String> {
        let (turns, minor, Pace { scans, cycle }) = (self.turns, self.minor, self.pace);
        match &mut self.runs {
            Runs::Here(machine, map) => {
                machine.init();
                let (over, asked) = (format!("{}.__over", test.instance), suite::variable(test, "__wanted"));
                let asked = staunch_host::place_of(map, &[instance], &asked)?;
                let number = i32::try_from(wanted).map_err(|error| error.to_string())?;
                machine.write(asked.offset, &number.to_le_bytes());
                let (mut now, mut fault) = (0_i64, None);
                for scan in 0..scans {
                    let cx = Context::new(now, scan == 0).with_turns(turns).with_cycle(cycle);
                    fault = machine.scan(instance, &cx).err().map(|it| place_of(it, map));
                    note(minor, &cx, map);
                    if fault.is_some() || value_at(map, &[instance], machine.state(), &over)? == "TRUE" {
                        break;
                    }
                    now = now.saturating_add(cycle);
                }
                let values = |name: &str| value_at(map, &[instance], machine.state(), name);
                see(&Ran { values: &values, fault })
            }
            Runs::Apart(executable) => apart::suite(executable, test, turns, self.pace, wanted, see),
        }
    }
}

/// Adds what a scan has reported to that of all tests.
fn note(minor: &Mutex<Minor>, cx: &Context, map: &Map) {
    let reported = cx.minor_faults();
    if let (1.., Ok(mut minor)) = (reported.count, minor.lock()) {
        minor.faults = minor.faults.and(reported);
        minor.told = minor_faults_note(minor.faults, map).zip(minor_faults_json(minor.faults, map));
    }
}

fn place_of(fault: Fault, map: &Map) -> String {
    let files: Vec<_> = map.files.iter().map(String::as_str).collect();
    fault.of(&files).to_string()
}
