//! A table is a test too: a CSV file next to a source, with inputs to the left of a `|` and expected values to the right.

use super::coverage::Counts;
use super::execute::Suite;
use super::outcome::Outcome;
use crate::args::Backend;
use crate::run;
use crate::scratch;
use crate::session::Session;
use staunch_host::{Expectations, Machine, Map, Moment, Options, When, csv_cells};
use staunch_ir::layout::Layout;
use staunch_ir::{ClassKind, Program};
use staunch_machine::{Interpreted, Native};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::{fs, io};

/// A table, and the source next to it.
#[derive(Clone, Debug)]
pub struct Table {
    pub path: PathBuf,
    pub title: String,
    file: u16,
}

/// The tables next to the sources: `pump.csv` is one of `pump.st` if its header has a `|`.
pub fn tables(session: &Session) -> Result<Vec<Table>, String> {
    let mut tables = Vec::new();
    for (source, file) in session.sources.files().iter().zip(0..) {
        let path = Path::new(&source.path).with_extension("csv");
        match fs::read(&path) {
            Ok(bytes) if Expectations::are_in(&bytes) => {
                let title = path.file_stem().map(|it| it.to_string_lossy().into_owned()).unwrap_or_default();
                tables.push(Table { path, title, file });
            }
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(format!("{}: {error}", path.display())),
        }
    }
    Ok(tables)
}

/// The program with the instances that a table is about: those of the PROGRAMs in its source, or, where that
/// has none, those of the only PROGRAM or of the CONFIGURATION.
fn subject(session: &Session, program: &Program, table: &Table) -> Result<Program, String> {
    let is_own = |it: &staunch_ir::Instance| program.class(it.program).location.file == table.file;
    if !program.instances.iter().any(is_own) {
        let is_known = session.project.program.is_some() || program.instances.len() < 2 || program.is_configured;
        if !is_known {
            let names: Vec<_> = program.instances.iter().map(|it| format!("`{}`", it.name)).collect();
            let which = "no CONFIGURATION says which PROGRAMs run, and the source next to the table has none";
            return Err(format!("{which}: there are {}", names.join(", ")));
        }
        return session.choose(program, None);
    }
    let mut program = program.clone();
    let classes: Vec<_> = program.classes.iter().map(|it| it.location.file).collect();
    program.instances.retain(|it| classes[it.program.index()] == table.file);
    // Of several that no CONFIGURATION runs, `run` asks which one is meant.
    if !program.is_configured {
        program.instances.iter_mut().for_each(|it| it.priority = 0);
    }
    Ok(program)
}

/// What is said besides where a table does not fit: a CONFIGURATION that leaves out the PROGRAMs of its source.
fn idle(session: &Session, program: &Program, table: &Table) -> String {
    let is_own = |it: &&staunch_ir::Class| it.kind == ClassKind::Program && it.location.file == table.file;
    let own: Vec<_> = program.classes.iter().filter(is_own).map(|it| format!("`{}`", it.name)).collect();
    if own.is_empty() || program.instances.iter().any(|it| program.class(it.program).location.file == table.file) {
        return String::new();
    }
    let source = &session.sources.get(table.file).path;
    format!("\nno CONFIGURATION runs a PROGRAM of {source}: {}", own.join(", "))
}

/// Runs a table; what is wrong with the file itself fails the test, too.
pub fn run(
    session: &Session,
    suite: &Suite<'_>,
    program: &Program,
    table: &Table,
    counts: Option<&Mutex<Counts>>,
) -> Outcome {
    ran(session, suite, program, table, counts)
        .unwrap_or_else(|error| Outcome::Differs(error.lines().map(str::to_owned).collect()))
}

fn ran(
    session: &Session,
    suite: &Suite<'_>,
    program: &Program,
    table: &Table,
    counts: Option<&Mutex<Counts>>,
) -> Result<Outcome, String> {
    let idle = idle(session, program, table);
    let program = subject(session, program, table)?;
    let bytes = fs::read(&table.path).map_err(|error| format!("{}: {error}", table.path.display()))?;
    let map = staunch_machine::map(&program)?;
    let running: Vec<usize> = (0..map.instances.len()).collect();
    let expected = Expectations::parse(&table.path, &bytes, &map, &running);
    let expected = expected.map_err(|error| format!("{error}{idle}"))?;
    let folder = scratch::folder()?;
    let trace = folder.path().join("trace.csv");
    let options = Options {
        cycle: run::cycle(session, None)?,
        loop_budget: Some(suite.turns),
        stimulus: Some(table.path.clone()),
        trace: Some(trace.clone()),
        vars: Some(expected.variables.join(",")),
        quiet: true,
        ..Options::default()
    };
    // The instances that do not run take no part in the state's layout.
    let layout = Layout::new(&program);
    let count = |state: &[u8]| {
        if let Some(Ok(mut counts)) = counts.map(Mutex::lock) {
            counts.add_at(layout.machine.globals, state);
        }
    };
    let fault = match suite.backend {
        Backend::Native => {
            let (mut machine, map) = Native::new(&program)?;
            here(&mut machine, &map, &options, &count)?
        }
        Backend::Interpret => {
            let (mut machine, map) = Interpreted::new(&program)?;
            here(&mut machine, &map, &options, &count)?
        }
        Backend::Rust => apart(&program, &options)?,
    };
    let text = fs::read_to_string(&trace).map_err(|error| format!("{}: {error}", trace.display()))?;
    let rows = csv_cells(&text).unwrap_or_default();
    Ok(compared(table, &expected, rows.get(1..).unwrap_or_default(), fault))
}

/// The fault that ended the run.
fn here(
    machine: &mut dyn Machine,
    map: &Map,
    options: &Options,
    count: &dyn Fn(&[u8]),
) -> Result<Option<String>, String> {
    let ran = staunch_host::run(machine, map, options);
    count(machine.state());
    match ran {
        Ok(_) => Ok(None),
        Err(error) if error.exit_code() == crate::FAULTED => Ok(Some(error.to_string())),
        Err(error) => Err(error.to_string()),
    }
}

fn apart(program: &Program, options: &Options) -> Result<Option<String>, String> {
    let executable = crate::rustc::compile(program, crate::rustc::Kind::Executable, None, crate::args::Opt::Speed)?;
    let mut command = Command::new(&executable);
    let paths = [("--stimulus", &options.stimulus), ("--trace", &options.trace)];
    paths.iter().for_each(|(flag, path)| _ = command.arg(flag).args(path.iter()));
    command.arg("--quiet").arg("--vars").args(options.vars.iter());
    command.arg("--loop-budget").args(options.loop_budget.map(|it| it.to_string()));
    command.args(options.cycle.map(|it| format!("--cycle={it}ns")));
    let ran = command.output().map_err(|error| format!("cannot run {}: {error}", executable.display()))?;
    let said = String::from_utf8_lossy(&ran.stderr);
    let said = said.trim().strip_prefix("error: ").unwrap_or(&said).to_owned();
    match ran.status.code() {
        Some(0) => Ok(None),
        Some(code) if code == i32::from(crate::FAULTED) => Ok(Some(said)),
        _ => Err(said),
    }
}

/// The first row in which something differs, each difference with its cell.
fn compared(table: &Table, expected: &Expectations, trace: &[Vec<String>], fault: Option<String>) -> Outcome {
    for row in &expected.rows {
        let scan = |it: &Vec<String>| it.first().and_then(|it| it.parse::<u64>().ok());
        let time = |it: &Vec<String>| match staunch_host::parse_moment(&format!("{}ms", it.get(1)?)) {
            Ok(Moment::Time(time)) => Some(time),
            Ok(Moment::Scan(_)) | Err(_) => None,
        };
        let found = trace.iter().find(|it| match row.when {
            When::Scan(number) => scan(it) == Some(number),
            When::Time(at) => time(it).is_some_and(|it| it >= at),
        });
        // The run has ended before.
        let Some(found) = found else { break };
        let mut problem = Vec::new();
        for (column, cell) in &row.cells {
            let shown = found.get(column + 2).map_or("", String::as_str);
            if !cell.is(shown) {
                let place = format!("{}:{}:{}", table.path.display(), cell.line, cell.column);
                let (name, number) = (&expected.variables[*column], scan(found).unwrap_or(0));
                problem.push(format!("{place}: {name} after scan {number}"));
                problem.push(format!("expected to be {}, found {shown}", cell.text));
            }
        }
        if !problem.is_empty() {
            return Outcome::Differs(problem);
        }
    }
    fault.map_or(Outcome::Passed, Outcome::Faulted)
}

impl Table {
    /// As the report names it.
    pub fn file(&self) -> String {
        self.path.display().to_string().replace(std::path::MAIN_SEPARATOR, "/")
    }
}
