//! A run of a program on each executor, by the product's own scan loop.

use crate::generated;
use crate::leaf::Leaves;
use crate::scan::{Fault, Table};
use staunch_host::{Compiled, Domain, Error, Machine, Map, Options, run as host_run};
use staunch_ir::Program;
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_ir::symbols::map_text;
use staunch_native::{Aim, Jit};
use staunch_runtime::Context;
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Executor {
    Interpreter,
    /// What the Rust back end printed, compiled into this crate.
    Rust,
    /// What the native back end made, in memory.
    Native,
    /// The same, made for a debugger.
    Debugged,
}

impl Executor {
    pub const ALL: [Self; 3] = [Self::Interpreter, Self::Rust, Self::Native];

    /// These, and what they do under a debugger.
    pub const EVERY: [Self; 4] = [Self::Interpreter, Self::Rust, Self::Native, Self::Debugged];

    /// The program in its initial state. `module` is its name among the generated modules.
    pub fn machine<'p>(self, program: &'p Program, module: &str) -> Result<Box<dyn Machine + 'p>, String> {
        Ok(match self {
            Self::Interpreter => {
                let domain = Domain::of(&map(program)?);
                Box::new(Interpreted { interpreter: Interpreter::new(program), domain })
            }
            Self::Rust => {
                let text = map_text(program, Leaves::new(program).layout());
                let machine = generated::machine(module, &text);
                Box::new(machine.ok_or("this program has no generated Rust: is the build up to date?")?)
            }
            Self::Native => Box::new(Native::new(program, Aim::Speed)?),
            Self::Debugged => Box::new(Native::new(program, Aim::Debugging)?),
        })
    }
}

fn map(program: &Program) -> Result<Map, String> {
    Map::parse(&map_text(program, Leaves::new(program).layout())).map_err(|it| it.to_string())
}

struct Interpreted<'p> {
    interpreter: Interpreter<'p>,
    domain: Domain,
}

/// Statements and turns of loops that a scan may take: a case that hangs fails instead.
const STEPS: u64 = 50_000_000;

impl Machine for Interpreted<'_> {
    fn state(&self) -> &[u8] {
        self.interpreter.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.domain.write(self.interpreter.state_mut(), offset, bytes);
    }

    fn init(&mut self) {
        self.interpreter.init();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), staunch_runtime::Fault> {
        self.interpreter.set_budget(Some(STEPS));
        self.interpreter.scan(instance, cx).map_err(|stop| match stop {
            Stop::Fault(fault) => fault,
            Stop::OutOfSteps => panic!("the scan does not end"),
        })
    }
}

struct Native {
    /// Before the code that it calls: it goes first.
    compiled: Compiled,
    _jit: Jit,
}

impl Native {
    fn new(program: &Program, aim: Aim) -> Result<Self, String> {
        let jit = Jit::aiming_at(program, aim).map_err(|error| error.to_string())?;
        // SAFETY: the code was made of the program that the map describes, and is kept as
        // long as the machine that calls it.
        let compiled = unsafe { Compiled::new(&map(program)?, jit.init, jit.scan) };
        Ok(Self { compiled, _jit: jit })
    }
}

impl Machine for Native {
    fn state(&self) -> &[u8] {
        self.compiled.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.compiled.write(offset, bytes);
    }

    fn init(&mut self) {
        self.compiled.init();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), staunch_runtime::Fault> {
        self.compiled.scan(instance, cx)
    }
}

/// What came out of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// The stimulus with its outputs.
    pub table: Table,
    /// All variables after each scan of an instance.
    pub states: Vec<Vec<(String, String)>>,
}

/// What a run needs in addition to its table.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// As `--cycle` takes it.
    pub cycle: Option<String>,
    pub loop_budget: Option<u64>,
    /// For each scan, whether the program gets it as the first; else the host decides.
    pub first: Option<Vec<bool>>,
}

/// Runs the table on one executor.
pub fn run(
    executor: Executor,
    program: &Program,
    module: &str,
    table: &Table,
    settings: &Settings,
) -> Result<Outcome, String> {
    let mut machine = executor.machine(program, module)?;
    let map = map(program)?;
    let folder = Folder::new()?;
    let (stimulus, trace) = (folder.0.join("stimulus.csv"), folder.0.join("trace.csv"));
    fs::write(&stimulus, table.stimulus()).map_err(|it| it.to_string())?;
    let cycle = settings.cycle.as_deref().map(staunch_host::parse_duration).transpose()?;
    let options = Options {
        scans: table.scans().last().copied(),
        cycle,
        loop_budget: settings.loop_budget,
        stimulus: Some(stimulus),
        trace: Some(trace.clone()),
        vars: Some(table.variables().join(",")),
        quiet: true,
        ..Options::default()
    };
    let mut recorder = Recorder {
        machine: machine.as_mut(),
        leaves: Leaves::new(program),
        states: Vec::new(),
        first: settings.first.as_deref(),
    };
    let fault = match host_run(&mut recorder, &map, &options) {
        Ok(_) => None,
        Err(Error::Fault { fault, path, .. }) => Some(shown(fault, &path, &map)),
        Err(error) => return Err(error.to_string()),
    };
    let states = recorder.states;
    let traced = fs::read_to_string(&trace).map_err(|it| it.to_string())?;
    Ok(Outcome { table: table.with_outputs(&traced, fault)?, states })
}

/// Runs the table on all executors, and compares every variable after every scan.
pub fn agree(program: &Program, module: &str, table: &Table, settings: &Settings) -> Result<Outcome, String> {
    agree_on(&Executor::ALL, program, module, table, settings)
}

/// The same for the interpreter and those of `executors`.
pub fn agree_on(
    executors: &[Executor],
    program: &Program,
    module: &str,
    table: &Table,
    settings: &Settings,
) -> Result<Outcome, String> {
    let reference = run(Executor::Interpreter, program, module, table, settings)?;
    for executor in executors.iter().copied().filter(|it| *it != Executor::Interpreter) {
        let outcome = run(executor, program, module, table, settings).map_err(|it| format!("{executor:?}: {it}"))?;
        if outcome != reference {
            return Err(format!("{executor:?} and the interpreter disagree\n{}", disagreement(&reference, &outcome)));
        }
    }
    Ok(reference)
}

fn disagreement(reference: &Outcome, outcome: &Outcome) -> String {
    let scans = reference.states.iter().zip(&outcome.states).enumerate();
    for (scan, (a, b)) in scans {
        if let Some(((path, a), (_, b))) = a.iter().zip(b).find(|(a, b)| a != b) {
            return format!("  scan {}: {path} is {b}, the interpreter has {a}", scan + 1);
        }
    }
    crate::difference::lines(&reference.table.to_string(), &outcome.table.to_string())
}

fn shown(fault: staunch_runtime::Fault, path: &str, map: &Map) -> Fault {
    let (line, column) = (fault.at.line, fault.at.column);
    let place = match map.files.first() {
        Some(first) if first == path => format!("{line}:{column}"),
        _ => format!("{path}:{line}:{column}"),
    };
    Fault { text: fault.kind.to_string(), place }
}

/// A machine that writes down its state after every scan.
struct Recorder<'m> {
    machine: &'m mut dyn Machine,
    leaves: Leaves<'m>,
    states: Vec<Vec<(String, String)>>,
    first: Option<&'m [bool]>,
}

impl Machine for Recorder<'_> {
    fn state(&self) -> &[u8] {
        self.machine.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.machine.write(offset, bytes);
    }

    fn init(&mut self) {
        self.machine.init();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), staunch_runtime::Fault> {
        let told = self.first.and_then(|it| it.get(self.states.len()).copied());
        let cx = told.map_or_else(|| cx.clone(), |first_scan| Context::new(cx.now(), first_scan).with_cycle(cx.cycle));
        let end = self.machine.scan(instance, &cx);
        self.states.push(self.leaves.of(self.machine.state()));
        end
    }
}

/// A folder of its own for the files of a run.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Self, String> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("staunch-tests-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).map_err(|it| it.to_string())?;
        Ok(Self(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What cannot be removed is left to the system's own cleaning.
        let _ = fs::remove_dir_all(&self.0);
    }
}
