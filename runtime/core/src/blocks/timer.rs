//! Timers. They have no clock: they measure from the scan time they are called with, so within
//! one scan no time passes. A negative `pt` acts as 0.
//!
//! A timer is idle, or has expired, in nearly all scans. So a step branches, and such a scan measures nothing.

use crate::block::pins;
use crate::{Context, Time};
use core::mem;

/// `TON`: `q` once `in_` has been TRUE for `pt`, until it falls. `et` is the time it has been
/// TRUE, up to `pt`. While it runs, each call's `pt` counts; once it has expired, `q` and `et`
/// stay as they are. With a `pt` of 0, `q` is TRUE in the first call with `in_`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ton {
    pub in_: bool,
    pub pt: Time,
    pub q: bool,
    pub et: Time,
    /// Memory: `in_` in the last call.
    pub in_before: bool,
    /// Memory: when `in_` rose.
    pub start: Time,
}

impl Ton {
    /// One call: sets the inputs and measures.
    #[inline]
    pub fn call(&mut self, in_: bool, pt: Time, cx: &Context) {
        (self.in_, self.pt) = (in_, pt);
        self.step(cx);
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        let before = mem::replace(&mut self.in_before, self.in_);
        if !self.in_ {
            (self.q, self.et) = (false, 0);
            return;
        }
        if !before {
            self.start = cx.now();
        }
        if !self.q {
            let run = Run::measure(self.start, cx.now(), self.pt);
            (self.q, self.et) = (run.over, run.elapsed);
        }
    }
}

pins!([] Ton {
    Input { in_: BOOL = "IN", pt: TIME = "PT" }
    Output { q: BOOL = "Q", et: TIME = "ET" }
    Memory { in_before: BOOL = "in_before", start: TIME = "start" }
});

/// `TOF`: `q` while `in_`, and for `pt` after it falls; FALSE until `in_` is first TRUE. `et` is
/// the time since it fell, up to `pt`. While it runs, each call's `pt` counts; once it has
/// expired, `et` stays until `in_` rises. With a `pt` of 0, `q` follows `in_`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tof {
    pub in_: bool,
    pub pt: Time,
    pub q: bool,
    pub et: Time,
    /// Memory: `in_` in the last call.
    pub in_before: bool,
    /// Memory: when `in_` fell.
    pub start: Time,
}

impl Tof {
    /// One call: sets the inputs and measures.
    #[inline]
    pub fn call(&mut self, in_: bool, pt: Time, cx: &Context) {
        (self.in_, self.pt) = (in_, pt);
        self.step(cx);
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        let before = mem::replace(&mut self.in_before, self.in_);
        if self.in_ {
            (self.q, self.et) = (true, 0);
            return;
        }
        if before {
            self.start = cx.now();
        }
        if self.q {
            let run = Run::measure(self.start, cx.now(), self.pt);
            (self.q, self.et) = (!run.over, run.elapsed);
        }
    }
}

pins!([] Tof {
    Input { in_: BOOL = "IN", pt: TIME = "PT" }
    Output { q: BOOL = "Q", et: TIME = "ET" }
    Memory { in_before: BOOL = "in_before", start: TIME = "start" }
});

/// `TP`: a rising `in_` gives a pulse of `q` that lasts `pt`, whatever `in_` does in the meantime;
/// another rising edge during the pulse, or in the call that ends it, is lost. `et` is the time since
/// the pulse began; after it, `et` stays until `in_` is FALSE. During the pulse each call's `pt`
/// counts; a `pt` of 0 gives no pulse.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tp {
    pub in_: bool,
    pub pt: Time,
    pub q: bool,
    pub et: Time,
    /// Memory: `in_` in the last call.
    pub in_before: bool,
    /// Memory: when the pulse began.
    pub start: Time,
}

impl Tp {
    /// One call: sets the inputs and measures.
    #[inline]
    pub fn call(&mut self, in_: bool, pt: Time, cx: &Context) {
        (self.in_, self.pt) = (in_, pt);
        self.step(cx);
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        let before = mem::replace(&mut self.in_before, self.in_);
        if !self.q {
            if !self.in_ {
                self.et = 0;
                return;
            }
            if before {
                return;
            }
            self.start = cx.now();
        }
        let run = Run::measure(self.start, cx.now(), self.pt);
        self.q = !run.over;
        self.et = if self.in_ | self.q { run.elapsed } else { 0 };
    }
}

pins!([] Tp {
    Input { in_: BOOL = "IN", pt: TIME = "PT" }
    Output { q: BOOL = "Q", et: TIME = "ET" }
    Memory { in_before: BOOL = "in_before", start: TIME = "start" }
});

/// How far a delay has run.
struct Run {
    /// At most the delay.
    elapsed: Time,
    over: bool,
}

impl Run {
    #[inline]
    fn measure(start: Time, now: Time, delay: Time) -> Self {
        let elapsed = now.wrapping_sub(start);
        let delay = delay.max(0);
        Self { elapsed: elapsed.min(delay), over: elapsed >= delay }
    }
}
