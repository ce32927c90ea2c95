use crate::Time;

/// What a scan is told about the world: the runtime has no clock of its own.
///
/// Native code reads this struct by offset, so its layout is part of the ABI.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Context {
    /// Time since start at the beginning of this scan, in nanoseconds; never goes back.
    pub now: Time,
    /// TRUE in the first scan after a start, a restart, or a change from IDLE to RUN.
    pub first_scan: bool,
}

impl Context {
    /// A scan at `now` nanoseconds that is not the first.
    pub const fn at(now: Time) -> Self {
        Self { now, first_scan: false }
    }

    /// The first scan, at `now` nanoseconds.
    pub const fn first(now: Time) -> Self {
        Self { now, first_scan: true }
    }
}
