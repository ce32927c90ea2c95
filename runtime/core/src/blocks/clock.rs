//! The clock of a unit test.

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
