//! Who is asked at a stop: shows it, and does what the commands say.

use super::call_path::call_path;
use super::commands::{Command, Commands, HELP};
use super::stop::Report;
use super::variables::{Shown, by_path, evaluated, map_text, of_program, variables};
use crate::args::Run;
use crate::output;
use crate::session::{Asked, Session};
use staunch_frontend::Style;
use staunch_host::{Map, Options, json_text};
use staunch_ir::interpret::debug::{Ask, Cause, Go, Stopped};
use staunch_ir::{Expr, Location, Program, StatementKind, visit};
use staunch_machine::Debugs;
use staunch_runtime::Time;
use std::collections::HashSet;

/// The name of what is printed, in diagnostics.
const PRINTED: &str = "p";

/// Where a run has stopped.
#[derive(Clone, Debug, Default)]
pub(super) struct StoppedAt {
    pub places: HashSet<Location>,
    /// The run ends because of a stop.
    pub is_over: bool,
}

#[derive(Debug)]
pub(super) struct Console<'a> {
    session: &'a Session,
    args: &'a Run,
    map: &'a Map,
    options: &'a Options,
    commands: Commands,
    scan: u64,
    time: Time,
    stops: u64,
    stopped_at: StoppedAt,
}

impl<'a> Console<'a> {
    pub fn new(session: &'a Session, args: &'a Run, map: &'a Map, commands: Commands, options: &'a Options) -> Self {
        let (scan, time, stops, stopped_at) = (0, 0, 0, StoppedAt::default());
        Self { session, args, map, options, commands, scan, time, stops, stopped_at }
    }

    pub fn stopped_at(&self) -> StoppedAt {
        self.stopped_at.clone()
    }

    fn show(&self, stopped: &Stopped<'_, Self>) {
        let report = Report {
            number: self.stops,
            scan: self.scan,
            time: self.time,
            at: stopped.at,
            faulted: match stopped.cause {
                Cause::Faulted(fault) => Some(fault),
                Cause::Breakpoint | Cause::Step => None,
            },
            path: call_path(stopped, self.map, &self.session.sources),
            variables: variables(stopped, self.map),
            sources: &self.session.sources,
        };
        match self.options.json {
            true => self.object(&report.json()),
            false => output::tell(report.text(Style { color: self.session.color() })),
        }
    }

    /// Without a terminal or a file of commands: the run continues until enough stops are printed.
    fn printed(&mut self, left: Option<u64>) -> Go {
        let Some(left) = left.map(|it| it - 1) else { return Go::On };
        self.commands = Commands::Printed { left: Some(left) };
        if left > 0 {
            return Go::On;
        }
        let count = if self.stops == 1 { "1 stop".to_owned() } else { format!("{} stops", self.stops) };
        self.note(&format!("the run ends with scan {}, after {count} (--stops 0 prints all stops)", self.scan));
        self.end()
    }

    fn end(&mut self) -> Go {
        self.stopped_at.is_over = true;
        Go::Unwatched
    }

    fn note(&self, text: &str) {
        match self.options.json {
            true => self.object(&format!("{{\"reason\":\"note\",\"message\":{}}}", json_text(text))),
            false => output::tell(format_args!("note: {text}")),
        }
    }

    fn object(&self, object: &str) {
        // A reader that has gone away wants no more.
        let _ = self.options.print_json(object);
    }

    /// A variable in scope, an expression in scope, or any variable of the program by its path.
    fn print(&self, stopped: &Stopped<'_, Self>, text: &str) {
        let found = by_path(stopped, self.map, text).map_or_else(|| self.evaluate(stopped, text), Ok);
        let found = found.or_else(|error| of_program(stopped, self.map, text).ok_or(error));
        match (found, self.options.json) {
            (Ok(it), true) => self.object(&format!("{{\"reason\":\"value\",{}}}", it.json())),
            (Ok(Shown { name, ty, value }), false) => output::tell(format_args!("{name} : {ty} = {value}")),
            (Err(error), true) if error.starts_with('{') => self.object(error.trim_end()),
            (Err(error), true) => self.object(&format!("{{\"reason\":\"error\",\"message\":{}}}", json_text(&error))),
            (Err(error), false) => output::tell(error.trim_end()),
        }
    }

    /// The value of an expression as the compiler means it at the statement that comes.
    fn evaluate(&self, stopped: &Stopped<'_, Self>, text: &str) -> Result<Shown, String> {
        let asked = Asked { at: stopped.at, name: PRINTED, text, is_condition: false };
        let (program, errors) = self.session.with_stops(&[asked])?;
        let Some(program) = program else { return Err(errors.concat()) };
        let program = self.session.choose(&program, self.args.program.as_deref())?;
        let not_here = || format!("`{text}` cannot be evaluated here");
        let value = self.same_place(stopped, &program).ok_or_else(not_here)?;
        let bytes = stopped.evaluate(value).map_err(|it| format!("`{text}` cannot be evaluated: {}", it.kind))?;
        let bytes = bytes.ok_or_else(not_here)?;
        Ok(evaluated(self.map, text, value.ty, program.type_name(value.ty), &bytes))
    }

    /// What is asked in another program at the place where this one has stopped, if all variables are where they are here.
    fn same_place<'q>(&self, stopped: &Stopped<'_, Self>, other: &'q Program) -> Option<&'q Expr> {
        let id = stopped.running().last()?.routine();
        let (here, there) = (stopped.program().routine(id), other.routines.get(id.index())?);
        let is_alike = here.name == there.name && variables_of(stopped.program()) == variables_of(other);
        let mut found = None;
        visit::statements(&there.body, &mut |it| {
            if let StatementKind::Stop(stop) = &it.kind
                && let Some(asked) = &stop.asked
            {
                found = Some(&asked.value);
            }
        });
        found.filter(|_| is_alike)
    }
}

/// Where all variables are, whatever the sources are called.
fn variables_of(program: &Program) -> String {
    map_text(program).lines().filter(|it| !it.starts_with("file\t")).collect::<Vec<_>>().join("\n")
}

impl Ask for Console<'_> {
    fn stopped(&mut self, stopped: &Stopped<'_, Self>) -> Go {
        self.stops += 1;
        self.stopped_at.places.insert(stopped.at);
        self.show(stopped);
        if let Commands::Printed { left } = self.commands {
            return self.printed(left);
        }
        loop {
            match self.commands.next() {
                Command::Continue => return Go::On,
                Command::Step => return Go::Step,
                Command::Next => return Go::Next,
                Command::Out => return Go::Out,
                Command::Quit => return self.end(),
                Command::Print(text) => self.print(stopped, &text),
                Command::Help => output::tell(HELP),
                Command::Unknown(line) => output::tell(format_args!("`{line}` is not a command\n{HELP}")),
            }
        }
    }
}

impl Debugs for Console<'_> {
    fn scan_begins(&mut self, number: u64, time: Time) {
        (self.scan, self.time) = (number, time);
    }

    fn ends(&self) -> bool {
        self.stopped_at.is_over
    }
}
