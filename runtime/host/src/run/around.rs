//! What is around a scan, and in which order.

use crate::schedule::Due;
use staunch_runtime::Time;

/// What is done for each scan. In real time each step copies bytes in the scan's thread, and neither waits nor allocates: what is slow has a
/// thread of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Events and values of the stimulus.
    Stimulus,
    /// What the connections read, but for inputs of the stimulus.
    Inputs,
    /// The programs, each between two writes of what is forced: nobody sees another value of it, whoever has written one.
    Programs,
    /// What the connections show.
    Outputs,
    /// What the program has logged.
    Messages,
    /// The state after a whole scan is the one that is kept.
    Retained,
    /// The row of the scan.
    Trace,
}

/// The order, which is the same on both clocks; docs/realtime.md says it to users.
pub(super) const AROUND: [Step; 7] =
    [Step::Stimulus, Step::Inputs, Step::Programs, Step::Outputs, Step::Messages, Step::Retained, Step::Trace];

impl Step {
    /// Messages that a program has logged before its fault are shown. Outputs, retained variables and the trace show nothing of an incomplete scan.
    pub fn is_after_a_fault(self) -> bool {
        match self {
            Self::Messages => true,
            Self::Stimulus | Self::Inputs | Self::Programs | Self::Outputs | Self::Retained | Self::Trace => false,
        }
    }
}

/// A scan on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scan {
    pub number: u64,
    /// What its programs see: in real time, when it has begun.
    pub time: Time,
    /// When its programs have ended, in real time.
    pub ended: Time,
    pub programs: Programs,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Programs {
    /// All that are due at a time of the virtual clock. The stimulus may have `placed` the scan there.
    Due { placed: bool },
    /// The next one in real time.
    One(Due),
}
