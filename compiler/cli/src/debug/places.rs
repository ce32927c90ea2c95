//! Where breakpoints are: which statements a line means.

use crate::args::Breakpoint;
use staunch_frontend::Sources;
use staunch_ir::{Location, Program, RoutineId, StatementKind, visit};
use std::collections::{BTreeSet, HashSet};
use std::path::Path;

/// A statement before which a run can stop.
#[derive(Clone, Copy, Debug)]
struct Stop {
    routine: RoutineId,
    at: Location,
}

/// All of a program.
#[derive(Debug)]
pub(super) struct Places<'a> {
    program: &'a Program,
    sources: &'a Sources,
    stops: Vec<Stop>,
    /// The routines that the running instances call.
    called: HashSet<RoutineId>,
}

/// What a breakpoint means.
#[derive(Debug)]
pub(super) struct Found {
    wanted: String,
    /// A statement that several routines have, as heirs do, has one place.
    pub at: HashSet<Location>,
    /// Whether some running PROGRAM calls its POU.
    pub is_reachable: bool,
    pub notes: Vec<String>,
}

impl Found {
    /// What is said after a run that was never there.
    pub fn never(&self) -> String {
        format!("the run never stopped at --break {}", self.wanted)
    }
}

impl<'a> Places<'a> {
    pub fn of(program: &'a Program, sources: &'a Sources) -> Self {
        let mut stops = Vec::new();
        for (number, routine) in program.routines.iter().enumerate() {
            visit::statements(&routine.body, &mut |it| {
                if matches!(it.kind, StatementKind::Stop(_)) {
                    stops.push(Stop { routine: RoutineId::next(number), at: it.at });
                }
            });
        }
        Self { program, sources, stops, called: called(program) }
    }

    pub fn find(&self, wanted: &[Breakpoint]) -> Result<Vec<Found>, String> {
        wanted.iter().map(|it| self.find_one(it)).collect()
    }

    fn find_one(&self, wanted: &Breakpoint) -> Result<Found, String> {
        let file = self.file(wanted)?;
        let path = &self.sources.get(file).path;
        let in_file: Vec<Stop> = self.stops.iter().copied().filter(|it| it.at.file == file).collect();
        let line = self.line(&in_file, wanted.line).ok_or_else(|| refused(path, &in_file, wanted))?;
        let on_line: Vec<Stop> = in_file.into_iter().filter(|it| it.at.line == line).collect();
        let mut notes = Vec::new();
        if line != wanted.line {
            notes.push(format!("{path}:{} has no statement; the breakpoint is at line {line}", wanted.line));
        }
        let is_reachable = on_line.iter().any(|it| self.called.contains(&it.routine));
        if let (false, Some(stop)) = (is_reachable, on_line.first()) {
            let title = self.program.title(self.program.routine(stop.routine));
            notes.push(format!("{path}:{line} is never reached: no running PROGRAM calls `{title}`"));
        }
        let shown = format!("{path}:{line}");
        Ok(Found { wanted: shown, at: first_of_each(&on_line), is_reachable, notes })
    }

    /// The file that is named, by its path or the end of it; the only one, where none is.
    fn file(&self, wanted: &Breakpoint) -> Result<u16, String> {
        let own = self.sources.files().iter().zip(0u16..).filter(|(it, _)| !it.is_of_library() && !it.is_expression());
        let named = own.filter(|(it, _)| wanted.file.as_ref().is_none_or(|end| Path::new(&it.path).ends_with(end)));
        let named: Vec<_> = named.collect();
        let list = || named.iter().map(|it| format!("`{}`", it.0.path)).collect::<Vec<_>>().join(", ");
        match (named.as_slice(), &wanted.file) {
            ([(_, number)], _) => Ok(*number),
            ([], Some(file)) => Err(format!("--break {wanted}: no source is named `{file}`")),
            ([], None) => Err(format!("--break {wanted}: all sources are libraries")),
            (_, Some(_)) => Err(format!("--break {wanted}: several sources have this name: {}", list())),
            (_, None) => Err(format!("--break {wanted}: name the file, as in `--break {}:{wanted}`", named[0].0.path)),
        }
    }

    /// The line, if it has a statement, else the next one that has, of a routine that begins before.
    fn line(&self, stops: &[Stop], wanted: u32) -> Option<u32> {
        let is_of_its_pou = |it: &&Stop| {
            let begins = self.program.routine(it.routine).location;
            it.at.line == wanted || (it.at.file == begins.file && begins.line <= wanted)
        };
        stops.iter().filter(|it| it.at.line >= wanted).filter(is_of_its_pou).map(|it| it.at.line).min()
    }
}

/// Of several statements on a line, the run stops before the first one of each routine.
fn first_of_each(stops: &[Stop]) -> HashSet<Location> {
    let routines: HashSet<_> = stops.iter().map(|it| it.routine).collect();
    let first = |routine| stops.iter().filter(|it| it.routine == routine).map(|it| it.at).min_by_key(|it| it.column);
    routines.into_iter().filter_map(first).collect()
}

fn refused(path: &str, stops: &[Stop], wanted: &Breakpoint) -> String {
    let lines: BTreeSet<u32> = stops.iter().map(|it| it.at.line).collect();
    let before = lines.range(..wanted.line).next_back();
    let after = lines.range(wanted.line..).next();
    let what = format!("--break {wanted}: no statement follows line {} in its POU", wanted.line);
    match (before, after) {
        (Some(before), Some(after)) => {
            format!("{what}; the nearest lines of {path} with statements are {before} and {after}")
        }
        (Some(line), None) | (None, Some(line)) => {
            format!("{what}; the nearest line of {path} with a statement is {line}")
        }
        (None, None) => format!("--break {wanted}: {path} has no statement to stop at"),
    }
}

/// The routines that running instances call, directly or not.
fn called(program: &Program) -> HashSet<RoutineId> {
    let roots = program.instances.iter().map(|it| program.class(it.program));
    let mut waiting: Vec<RoutineId> = roots.flat_map(|it| [Some(it.body), it.prescan, it.start]).flatten().collect();
    let mut called = HashSet::new();
    while let Some(routine) = waiting.pop() {
        if called.insert(routine) {
            visit::statements(&program.routine(routine).body, &mut |it| {
                if let StatementKind::Call { callee, .. } = &it.kind {
                    waiting.push(*callee);
                }
            });
        }
    }
    called
}
