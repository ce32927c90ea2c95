//! One program on the witness, the interpreter, and as native code.

use crate::leaf::Leaves;
use staunch_frontend::{Format, Options, Severity, Source, Sources, Style, parse, render};
use staunch_host::{Compiled, Machine as _, Map};
use staunch_ir::Program;
use staunch_ir::interpret::{Interpreter, Stop as Early};
use staunch_ir::symbols::map_text;
use staunch_native::Jit;
use staunch_runtime::{Context, Family, Fault};
use staunch_witness::{Machine, Stop};
use std::collections::HashMap;
use std::fmt;

/// Scans of a program.
const SCANS: i64 = 5;
/// Nanoseconds from scan to scan.
const CYCLE: i64 = 10_000_000;
/// Turns of loops that a scan may take, and statements on the interpreter: more than the witness takes.
const TURNS: u64 = 400_000;
const STEPS: u64 = 4_000_000;

pub enum Verdict {
    Same {
        faulted: bool,
    },
    /// `check` refuses it, or the witness does not know a construct.
    Rejected(String),
    Endless,
    Differs(String),
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Same { faulted } => write!(f, "the same; faulted: {faulted}"),
            Self::Rejected(why) => write!(f, "not compared: {why}"),
            Self::Endless => f.write_str("it does not end"),
            Self::Differs(how) => f.write_str(how),
        }
    }
}

/// How a scan ended, and all variables then.
#[derive(PartialEq)]
pub struct Scan {
    pub end: Option<Fault>,
    pub variables: Vec<(String, String)>,
}

/// Compares the witness, the interpreter and, if asked to, native code.
pub fn compare(text: &str, with_native: bool) -> Verdict {
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", text.to_owned()));
    let compilation = staunch_frontend::compile(&sources, &Options::default());
    let Some(program) = compilation.program else {
        let error = compilation.diagnostics.iter().find(|it| it.severity == Severity::Error);
        let shown = error.map(|it| render(it, &sources, Format::Short, Style::default())).unwrap_or_default();
        let shown = shown.split_once("error").map_or(shown.clone(), |it| it.1.to_owned());
        return Verdict::Rejected(shown.trim().to_owned());
    };
    let [instance] = program.instances.as_slice() else {
        return Verdict::Rejected("several PROGRAMs run by themselves".to_owned());
    };
    let witnessed = match witnessed(&sources, &instance.name, text) {
        Ok(scans) => scans,
        Err(verdict) => return verdict,
    };
    let interpreted = match interpreted(&program, text) {
        Some(scans) => scans,
        None => return Verdict::Differs("only the interpreter does not end".to_owned()),
    };
    if let Some(how) = differences("interpreter", &interpreted, "witness", &witnessed) {
        return Verdict::Differs(how);
    }
    let faulted = witnessed.last().is_some_and(|it| it.end.is_some());
    if !with_native {
        return Verdict::Same { faulted };
    }
    match native(&program, text) {
        Err(error) => Verdict::Differs(error),
        Ok(native) => match differences("native code", &native, "interpreter", &interpreted) {
            Some(how) => Verdict::Differs(how),
            None => Verdict::Same { faulted },
        },
    }
}

/// The witness has no prescan of Logix: programs with its counters start without one.
fn contexts(text: &str) -> impl Iterator<Item = Context> {
    let prescan = !text.contains("LOGIX.");
    (0..SCANS).map(move |scan| Context::new(scan * CYCLE, prescan && scan == 0).with_turns(TURNS))
}

fn witnessed(sources: &Sources, instance: &str, text: &str) -> Result<Vec<Scan>, Verdict> {
    let files = [parse(0, text, &mut Vec::new())];
    let unknown = |stop| match stop {
        Stop::Endless => Verdict::Endless,
        Stop::Unknown(what) => Verdict::Rejected(format!("the witness does not know {what}")),
        Stop::Fault(_) => Verdict::Differs("the witness faults in an initial value".to_owned()),
    };
    let mut machine = Machine::new(sources, &files, Family::Iec, &[instance]).map_err(unknown)?;
    let mut scans = Vec::new();
    for context in contexts(text) {
        let end = match machine.scan(instance, &context) {
            Ok(()) => None,
            Err(Stop::Fault(fault)) => Some(fault),
            Err(stop) => return Err(unknown(stop)),
        };
        scans.push(Scan { end, variables: machine.variables() });
        if end.is_some() {
            break;
        }
    }
    Ok(scans)
}

fn interpreted(program: &Program, text: &str) -> Option<Vec<Scan>> {
    let leaves = Leaves::new(program);
    let mut machine = Interpreter::new(program);
    machine.set_budget(Some(STEPS));
    let mut scans = Vec::new();
    for context in contexts(text) {
        let end = match machine.scan(0, &context) {
            Ok(()) => None,
            Err(Early::Fault(fault)) => Some(fault),
            Err(Early::OutOfSteps) => return None,
        };
        scans.push(Scan { end, variables: leaves.of(machine.state()) });
        if end.is_some() {
            break;
        }
    }
    Some(scans)
}

fn native(program: &Program, text: &str) -> Result<Vec<Scan>, String> {
    let leaves = Leaves::new(program);
    let jit = Jit::new(program).map_err(|error| error.to_string())?;
    let map = Map::parse(&map_text(program, leaves.layout())).map_err(|error| error.to_string())?;
    // SAFETY: the code was made of the program that the map describes, and outlives the machine.
    let mut machine = unsafe { Compiled::new(&map, jit.init, jit.scan) };
    let mut scans = Vec::new();
    for context in contexts(text) {
        let end = machine.scan(0, &context).err();
        scans.push(Scan { end, variables: leaves.of(machine.state()) });
        if end.is_some() {
            break;
        }
    }
    Ok(scans)
}

/// The first scan and variable in which two runs differ.
fn differences(name: &str, scans: &[Scan], other_name: &str, others: &[Scan]) -> Option<String> {
    let mut pairs = scans.iter().zip(others).zip(1..);
    pairs.find_map(|((scan, other), number)| difference(number, name, scan, other_name, other))
}

/// The first variable in which two scans differ. The second need not have all variables: constants and temporaries of the
/// front end belong to no program.
pub fn difference(number: u32, name: &str, scan: &Scan, other_name: &str, other: &Scan) -> Option<String> {
    let values: HashMap<String, &str> =
        other.variables.iter().map(|it| (it.0.to_ascii_uppercase(), it.1.as_str())).collect();
    for (path, value) in &scan.variables {
        if let Some(theirs) = values.get(&path.to_ascii_uppercase())
            && theirs != value
            // An LTIME of CODESYS has no sign; the witness knows it by the half of its values that has one, too.
            && theirs.strip_prefix("I64(").is_none_or(|it| value.strip_prefix("U64(") != Some(it))
        {
            return Some(format!("scan {number}: {path} is {value} ({name}), {theirs} ({other_name})"));
        }
    }
    if scan.end != other.end {
        let shown = |end: Option<Fault>| end.map_or("no fault".to_owned(), |it| it.to_string());
        return Some(format!("scan {number}: {} ({name}), {} ({other_name})", shown(scan.end), shown(other.end)));
    }
    None
}
