//! What to run, and how.

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
    /// An instance or a PROGRAM by name; without it, all of them if the source has a CONFIGURATION.
    pub program: Option<String>,
    /// `None`: up to [`to`](Self::to), otherwise to the last row of the stimulus, or 100 scans; in real time without a
    /// stimulus, without end.
    pub scans: Option<u64>,
    /// Nanoseconds between two scans, above zero; 10 ms, or the TASKs' intervals.
    pub cycle: Option<Time>,
    /// The turns that all loops of one scan may take together; [`Context::TURNS`](staunch_runtime::Context::TURNS).
    pub loop_budget: Option<u64>,
    pub stimulus: Option<PathBuf>,
    /// Variables that are forced to a fixed value before and after each scan, as `NAME=VALUE`.
    pub forces: Vec<String>,
    /// CSV, VCD, SVG or HTML, depending on its extension; `-` is standard output.
    pub trace: Option<PathBuf>,
    /// The first and the last scan of the trace or table.
    pub from: Option<Moment>,
    pub to: Option<Moment>,
    /// Variables to trace, separated by commas.
    pub vars: Option<String>,
    /// Numeric variables that a picture shows in one lane: each entry has two or three names separated by commas.
    pub overlay: Vec<String>,
    /// A file that keeps retained variables from run to run.
    pub retain: Option<PathBuf>,
    /// In real time, the longest time until a change of retained variables is on disk, in nanoseconds; 0 is after every
    /// scan. [`RETAIN_WITHIN`](Self::RETAIN_WITHIN) if it is not set.
    pub retain_within: Option<Time>,
    /// Waits until each scan is due.
    pub realtime: bool,
    /// Settings of a run in real time.
    pub pacing: Pacing,
    /// In real time, what inputs and outputs are connected with.
    pub io: Io,
    /// The machine is called before each scan, and may end the run.
    pub debugged: bool,
    /// Prints only errors and the trace.
    pub quiet: bool,
    /// Prints the last scans as a table, if no trace is asked for.
    pub table: bool,
    /// Prints the result of the run as JSON, instead of the table.
    pub json: bool,
}

impl Options {
    /// The longest time until a change of retained variables is on disk by default: a second.
    pub const RETAIN_WITHIN: Time = 1_000_000_000;

    /// A large array has many columns, so they are made only if they are needed.
    pub(super) fn shows_values(&self) -> bool {
        self.trace.is_some() || self.vars.is_some() || self.has_table()
    }

    /// The last scans are printed as a table.
    pub(super) fn has_table(&self) -> bool {
        self.table && self.trace.is_none() && !self.quiet && !self.json
    }
}

impl Options {
    /// Checks that no file is both read and written, or written twice.
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

    /// Reports the error on standard error; with `json`, as an object on the stream of all objects.
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
