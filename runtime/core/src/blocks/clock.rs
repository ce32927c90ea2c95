//! The scan's time: blocks that read it, advance it in a unit test, and decide what is due.

use crate::block::pins;
use crate::{Context, Location, Time};

/// Lets the time `in_` pass within a scan: `ADVANCE_TIME` in a TEST calls it. A negative time counts
/// as 0.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AdvanceTime {
    pub in_: Time,
}

impl AdvanceTime {
    /// One call: sets the input and lets the time pass.
    #[inline]
    pub fn call(&mut self, in_: Time, cx: &Context) {
        self.in_ = in_;
        self.step(cx);
    }

    /// One call with the input as it is.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        cx.advance(self.in_);
    }
}

pins!([] AdvanceTime {
    Input { in_: TIME = "IN" }
});

/// `now` is the scan's time, the same in every call of a scan: what `TIME()` and `LTIME()` read.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clock {
    pub now: Time,
}

impl Clock {
    /// One call: reads the scan's time.
    #[inline]
    pub fn call(&mut self, cx: &Context) {
        self.step(cx);
    }

    /// Like [`call`](Self::call), since it has no inputs.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        self.now = cx.now();
    }
}

pins!([] Clock {
    Input {}
    Output { now: TIME = "NOW" }
    Memory {}
});

/// Records a division by zero after which the program continues, with its place in the source.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MinorFault {
    pub file: u16,
    pub column: u16,
    pub line: u32,
}

impl MinorFault {
    /// One call: sets the place and records the fault.
    #[inline]
    pub fn call(&mut self, file: u16, column: u16, line: u32, cx: &Context) {
        (self.file, self.column, self.line) = (file, column, line);
        self.step(cx);
    }

    /// One call with the place as it is.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        cx.report_minor_fault(Location { file: self.file, column: self.column, line: self.line });
    }
}

pins!([] MinorFault {
    Input { file: UINT = "FILE", column: UINT = "COLUMN", line: UDINT = "LINE" }
});

/// Information about the scan: `first` is TRUE in the first scan after a start, and `cycle` is the time between two
/// scans, or 0 if the host does not set it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScanInfo {
    pub first: bool,
    pub cycle: Time,
}

impl ScanInfo {
    /// One call: reads both.
    #[inline]
    pub fn call(&mut self, cx: &Context) {
        self.step(cx);
    }

    /// Like [`call`](Self::call), since it has no inputs.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        (self.first, self.cycle) = (cx.first_scan, cx.cycle);
    }
}

pins!([] ScanInfo {
    Input {}
    Output { first: BOOL = "FIRST", cycle: TIME = "CYCLE" }
    Memory {}
});

/// When a TASK with SINGLE and INTERVAL is due (IEC 61131-3, 6.8.2): `q` is TRUE in each call in which `single` rises,
/// and, while `single` is FALSE, in the first call at or after each multiple of `interval`. Multiples that pass while it is
/// TRUE are skipped.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TaskTurn {
    pub single: bool,
    /// Nanoseconds, above 0.
    pub interval: Time,
    pub q: bool,
    /// Memory: `single` in the last call.
    pub single_before: bool,
    /// Memory: the next multiple of `interval`.
    pub next: Time,
}

impl TaskTurn {
    /// One call: sets the inputs and checks the time.
    #[inline]
    pub fn call(&mut self, single: bool, interval: Time, cx: &Context) {
        (self.single, self.interval) = (single, interval);
        self.step(cx);
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        let (now, interval) = (cx.now(), self.interval.max(1));
        let rises = self.single & !self.single_before;
        self.single_before = self.single;
        // Time starts anew after a power cycle, which may keep the memory.
        let is_due = now >= self.next || self.next.wrapping_sub(now) > interval;
        if is_due {
            self.next = now.div_euclid(interval).saturating_add(1).saturating_mul(interval);
        }
        self.q = rises | (is_due & !self.single);
    }
}

pins!([] TaskTurn {
    Input { single: BOOL = "SINGLE", interval: TIME = "INTERVAL" }
    Output { q: BOOL = "Q" }
    Memory { single_before: BOOL = "single_before", next: LINT = "next" }
});
