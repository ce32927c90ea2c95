//! What is to be run, and how.

use crate::Error;
use crate::attachments::Io;
use crate::realtime::Pacing;
use crate::replace::{Role, keep_apart};
use staunch_runtime::Time;
use std::io::{self, Write as _};
use std::path::PathBuf;

/// A point of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    Scan(u64),
    Time(Time),
}

impl Moment {
    pub(super) fn is_after(self, scan: u64, time: Time) -> bool {
        match self {
            Self::Scan(it) => it > scan,
            Self::Time(it) => it > time,
        }
    }

    pub(super) fn is_before(self, scan: u64, time: Time) -> bool {
        match self {
            Self::Scan(it) => it < scan,
            Self::Time(it) => it < time,
        }
    }
}

/// What to run and how. The default is 100 scans.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// An instance or a PROGRAM by name; all of them if the source has a CONFIGURATION.
    pub program: Option<String>,
    /// `None`: to [`to`](Self::to), else to the last row of the stimulus, or 100; in real time without a
    /// stimulus, for ever.
    pub scans: Option<u64>,
    /// Nanoseconds between two scans, above zero; 10 ms, or the TASKs' intervals.
    pub cycle: Option<Time>,
    /// Turns that the loops of one scan may take together; [`Context::TURNS`](staunch_runtime::Context::TURNS).
    pub loop_budget: Option<u64>,
    pub stimulus: Option<PathBuf>,
    /// Variables that have one value before and after each scan, as `NAME=VALUE`.
    pub forces: Vec<String>,
    /// CSV, VCD, SVG or HTML by its ending; `-` is standard output.
    pub trace: Option<PathBuf>,
    /// The first and the last scan of the trace or table.
    pub from: Option<Moment>,
    pub to: Option<Moment>,
    /// Variables to trace, separated by commas.
    pub vars: Option<String>,
    /// Numbers that a picture shows in one lane, each time two or three names separated by commas.
    pub overlay: Vec<String>,
    /// A file that keeps retained variables from run to run.
    pub retain: Option<PathBuf>,
    /// In real time, how soon a change of retained variables is on disk, in nanoseconds; 0 is after every
    /// scan. [`RETAIN_WITHIN`](Self::RETAIN_WITHIN) without.
    pub retain_within: Option<Time>,
    /// Waits for the time at which each scan is due.
    pub realtime: bool,
    /// How a run in real time keeps its time.
    pub pacing: Pacing,
    /// In real time, what inputs and outputs are connected with.
    pub io: Io,
    /// The machine learns of each scan, and may end the run.
    pub debugged: bool,
    /// Prints nothing but errors and the trace.
    pub quiet: bool,
    /// Prints the last scans as a table, if no trace is asked for.
    pub table: bool,
    /// Prints what the run came to as JSON, in place of the table.
    pub json: bool,
}

impl Options {
    /// How soon a change of retained variables is on disk where nothing else is asked for: a second.
    pub const RETAIN_WITHIN: Time = 1_000_000_000;

    /// A large array has many columns: they are not made for nothing.
    pub(super) fn shows_values(&self) -> bool {
        self.trace.is_some() || self.vars.is_some() || self.has_table()
    }

    /// The last scans are printed as a table.
    pub(super) fn has_table(&self) -> bool {
        self.table && self.trace.is_none() && !self.quiet && !self.json
    }
}

impl Options {
    /// No file is read and written, or written twice.
    pub(super) fn keep_apart(&self) -> Result<(), String> {
        // What runs is not a file to write either.
        let own = std::env::current_exe().ok();
        let own = own.iter().map(|it| ("the executable", it.as_path()));
        let inputs: Vec<Role<'_>> = self.stimulus.iter().map(|it| ("--stimulus", it.as_path())).chain(own).collect();
        let outputs = [("--retain", &self.retain), ("--trace", &self.trace)];
        let outputs: Vec<Role<'_>> =
            outputs.iter().filter_map(|(what, path)| Some((*what, path.as_deref()?))).collect();
        keep_apart(&inputs, &outputs)
    }

    /// Says on standard error what went wrong; with `json`, as an object where all objects go.
    pub fn report(&self, error: &Error) {
        match error {
            Error::ClosedPipe => {}
            error if self.json => drop(self.print_json(&error.json())),
            error => crate::error::tell(format_args!("error: {error}")),
        }
    }

    /// On standard output, unless the trace is written there.
    pub fn print_json(&self, object: &str) -> Result<(), Error> {
        let line = format!("{object}\n");
        let written = match self.trace.as_deref().is_some_and(|it| it.as_os_str() == "-") {
            true => io::stderr().write_all(line.as_bytes()),
            false => io::stdout().write_all(line.as_bytes()).and_then(|()| io::stdout().flush()),
        };
        written.map_err(|error| Error::file("standard output".as_ref(), "write", error))
    }
}
