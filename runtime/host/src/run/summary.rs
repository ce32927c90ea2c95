//! What a run came to, for people and as JSON.

use crate::json::quote;
use crate::realtime::Figures;
use crate::spoken::{rounded, spoken};
use staunch_runtime::Time;
use std::time::Duration;

/// What a run came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    pub scans: u64,
    /// On the clock of the program, in nanoseconds, to the end of the last cycle.
    pub time: Time,
    /// How long the run took.
    pub elapsed: Duration,
    /// Of a run in real time.
    pub real: Option<Figures>,
}

impl Summary {
    /// Times in nanoseconds.
    pub(super) fn json(&self, title: &str, lost: u64) -> String {
        let Self { scans, time, elapsed, real } = self;
        let mut text = format!(
            "{{\"reason\":\"run\",\"program\":{},\"scans\":{scans},\"time_ns\":{time},\"elapsed_ns\":{}",
            quote(title),
            elapsed.as_nanos()
        );
        if let Some(figures) = real {
            let (shortest, longest) = (figures.shortest().as_nanos(), figures.longest().as_nanos());
            let overruns = figures.overruns();
            text += &format!(",\"overruns\":{overruns},\"shortest_ns\":{shortest},\"longest_ns\":{longest}");
            text += &format!(",\"programs\":{}", figures.json());
        }
        if lost > 0 {
            text += &format!(",\"rows_lost\":{lost}");
        }
        text + "}"
    }

    /// A line for people, and a table of a run in real time.
    pub(super) fn text(&self, title: &str) -> String {
        let Self { scans, time, elapsed, real } = self;
        let plural = if *scans == 1 { "" } else { "s" };
        let begin = format!("{scans} scan{plural} of {title}, ");
        let took = rounded(*elapsed);
        match real {
            None => format!("{begin}{} of virtual time, in {took}\n", spoken(*time)),
            Some(figures) => format!("{begin}{took} in real time\n{}", figures.table()),
        }
    }
}

/// What is printed of a run in real time while it lasts: for people, or as JSON.
pub(super) fn figures_text(figures: &Figures) -> String {
    figures.table()
}

pub(super) fn figures_json(figures: &Figures) -> String {
    format!("{{\"reason\":\"figures\",\"programs\":{}}}", figures.json())
}
