//! Runs a compiled program: scans on a virtual or the real clock, stimulus, trace, retained
//! variables. What `staunch run` does, and what a built executable does on its own.
//!
//! It depends only on the runtime: the command contains its source, so that executables can be built
//! without access to a package registry.
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![allow(unexpected_cfgs, reason = "cargo-fuzz sets `fuzzing`")]

mod error;
mod pin;
mod remote;

mod map;
mod path;

mod domain;

mod csv;
mod json;
mod literal;
mod shown;
mod spoken;
mod value;

mod column;
mod expected;
mod force;
mod messages;
mod minor;
mod replace;
mod retain;
mod schedule;
mod start;
mod stimulus;
mod trace;

mod attachments;

mod bench;
mod drive;
mod realtime;
mod run;

mod args;
mod compiled;
mod executable;
mod signal;
mod terminal;

#[cfg(test)]
mod allocations;
#[cfg(test)]
mod fixture;
#[cfg(fuzzing)]
pub mod fuzzing;

pub use args::{Wish, parse_duration, parse_moment, parse_options, parse_priority, parse_within};
pub use attachments::{
    AtEnd, Connection, Io, Mistake, SerialUnit, check_pins, check_remotes, check_safe, is_address_and_port,
    openplc_layout,
};
pub use bench::{BenchOptions, Timing, bench};
pub use compiled::{Code, Compiled, Init, Scan, Snapshot};
pub use csv::cells as csv_cells;
pub use domain::Domain;
pub use drive::{Bookmark, Drive};
pub use error::Error;
pub use executable::{main, main_with};
pub use expected::{Expectations, ExpectedCell, ExpectedRow, When};
pub use json::quote as json_text;
pub use literal::parse as bytes_of;
pub use map::{Instance, Map, Section, Structure, StructureKind, Type, Variable};
pub use minor::{minor_faults_json, minor_faults_note};
pub use path::{Place, instance_at, part as part_of, resolve as place_of, same as same_name};
pub use pin::{Bias, Pin, PinLine};
pub use realtime::{Figures, Histogram, Kept, Overrun, Pacing};
pub use remote::{Line, OnLoss, Parity, Remote, Server, WordOrder};
pub use replace::{Replacement, Role, followed, keep_apart, open_to_read};
pub use run::{Moment, Options, Summary, run};
pub use schedule::DEFAULT_CYCLE;
pub use shown::shown;
pub use start::{Event, retained};
pub use value::{format_character, format_time, format_time_as, value_at};

pub use staunch_runtime::Elementary;

use staunch_runtime::{Context, Fault, Time};

/// A program that can be scanned: its state as bytes, laid out as its map says.
pub trait Machine {
    fn state(&self) -> &[u8];
    /// Writes bytes into the state, through its [`Domain`]: whatever they are, each variable then
    /// has a valid value of its type.
    ///
    /// # Panics
    /// If the state ends before the bytes do.
    fn write(&mut self, offset: usize, bytes: &[u8]);
    /// Writes the initial values over all of the state.
    fn init(&mut self);
    /// An event has started the program again: variables that it does not keep have their initial values.
    fn starts_again(&mut self, _: Event) {}
    /// The scan with this number is next, at a time of the run. Called only if [`Options::debugged`] is set.
    fn scan_begins(&mut self, _number: u64, _time: Time) {}
    /// Whether the run ends with this scan. Called only if [`Options::debugged`] is set.
    fn ends(&mut self) -> bool {
        false
    }
    /// One scan of an instance. After a fault the state stays as it was at that point.
    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault>;
}
