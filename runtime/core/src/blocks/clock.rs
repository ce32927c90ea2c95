//! The scan's time: what reads it, and what lets it pass in a unit test.

use crate::block::pins;
use crate::{Context, Time};

/// Lets the time `in_` pass, in the midst of a scan: what `ADVANCE_TIME` in a TEST calls. A negative time is
/// none.
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

/// `now` is the scan's time, which every call in a scan sees alike: what `TIME()` and `LTIME()` read.
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

    /// As [`call`](Self::call): there are no inputs.
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
