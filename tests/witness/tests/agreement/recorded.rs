//! A run of a golden case on the interpreter, by the product's own loop of scans: what the loop did, and what came out.

use crate::case::Settings;
use crate::compare::Scan;
use crate::leaf::{Leaf, Leaves, Read};
use crate::scan::Table;
use staunch_host::{Domain, Error, Machine, Map, Options, run};
use staunch_ir::Program;
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_ir::symbols::map_text;
use staunch_runtime::{Context, Fault};
use std::fs;
use std::sync::atomic::{AtomicU64, Ordering};

/// Statements that a scan may take: a case that hangs fails instead.
const STEPS: u64 = 50_000_000;

/// What a machine is asked for.
pub enum Event {
    /// A value from outside: of a stimulus, or kept over a restart.
    Put(String, Read),
    Init,
    /// A scan of an instance, and what came out of it.
    Scan(String, Context, Scan),
}

/// Runs a table, and writes down what happens.
pub fn recorded(
    program: &Program,
    table: &Table,
    settings: &Settings,
    prescan: bool,
    name: &str,
) -> Result<Vec<Event>, String> {
    let leaves = Leaves::new(program);
    let map = Map::parse(&map_text(program, leaves.layout())).map_err(|it| it.to_string())?;
    // Two tests may run one case at a time.
    static RUNS: AtomicU64 = AtomicU64::new(0);
    let number = RUNS.fetch_add(1, Ordering::Relaxed);
    let stimulus = std::env::temp_dir().join(format!("staunch-witness-{}-{number}-{name}.csv", std::process::id()));
    fs::write(&stimulus, table.stimulus()).map_err(|it| it.to_string())?;
    let options = Options {
        scans: table.scans().last().copied(),
        cycle: settings.cycle.as_deref().map(staunch_host::parse_duration).transpose()?,
        loop_budget: settings.loop_budget,
        stimulus: Some(stimulus.clone()),
        quiet: true,
        ..Options::default()
    };
    let (interpreter, domain) = (Interpreter::new(program), Domain::of(&map));
    let mut recorder = Recorder { interpreter, domain, leaves, prescan, program, events: Vec::new() };
    let end = run(&mut recorder, &map, &options);
    // What cannot be removed is left to the system's own cleaning.
    let _ = fs::remove_file(stimulus);
    match end {
        Ok(_) | Err(Error::Fault { .. }) => Ok(recorder.events),
        Err(error) => Err(error.to_string()),
    }
}

struct Recorder<'p> {
    interpreter: Interpreter<'p>,
    domain: Domain,
    leaves: Leaves<'p>,
    /// Whether the program gets which scan is the first.
    prescan: bool,
    program: &'p Program,
    events: Vec<Event>,
}

impl Machine for Recorder<'_> {
    fn state(&self) -> &[u8] {
        self.interpreter.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.domain.write(self.interpreter.state_mut(), offset, bytes);
        let end = offset + bytes.len();
        let is_written = |it: &Leaf| {
            let size = match &it.value {
                Read::Scalar(it) => usize::try_from(it.repr().size()).unwrap_or(1),
                Read::Text(_) => 1,
            };
            it.offset < end && it.offset + size > offset
        };
        let written = self.leaves.values(self.interpreter.state()).into_iter().filter(is_written);
        self.events.extend(written.map(|it| Event::Put(it.path, it.value)));
    }

    fn init(&mut self) {
        self.interpreter.init();
        self.events.push(Event::Init);
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        let told = if self.prescan { cx.clone() } else { Context::new(cx.now(), false).with_cycle(cx.cycle) };
        self.interpreter.set_budget(Some(STEPS));
        let end = self.interpreter.scan(instance, &told).map_err(|stop| match stop {
            Stop::Fault(fault) => fault,
            Stop::OutOfSteps => panic!("the scan does not end"),
        });
        let scan = Scan { end: end.err(), variables: self.leaves.of(self.interpreter.state()) };
        self.events.push(Event::Scan(self.program.instances[instance].name.clone(), told, scan));
        end
    }
}
