//! OpenPLC v3, OpenPLC Editor and Beremiz, whose library is MATIEC's. Its counters are those of
//! [`iec`](super::iec) except for one rule: an edge counts up only while `cv < pv`, and down only
//! while `cv > 0`, by the count before the call. A count that is already beyond stays. Its
//! timers first check the time in the call after they start. Its `F_TRIG` before 2024-12 is that of the
//! standard's second edition, which sees an edge in a first call with FALSE.

use super::iec::Count;
use crate::block::pins;
use crate::{Context, Time};

/// `CTU`: counts up on each rising edge of `cu` while `cv < pv`; `q` while `cv >= pv`. Reset wins
/// over counting.
///
/// ```
/// let mut parts = staunch_runtime::openplc::Ctu::<i16>::new();
/// for cu in [true, false, true] {
///     parts.call(cu, false, 1);
/// }
/// assert_eq!((parts.cv, parts.q), (1, true));
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ctu<T> {
    pub cu: bool,
    pub r: bool,
    pub pv: T,
    pub q: bool,
    pub cv: T,
    /// Memory: `cu` in the last call.
    pub cu_before: bool,
}

impl<T: Count> Ctu<T> {
    /// One call: sets the inputs and counts.
    #[inline]
    pub fn call(&mut self, cu: bool, r: bool, pv: T) {
        (self.cu, self.r, self.pv) = (cu, r, pv);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        let edge = self.cu & !self.cu_before;
        self.cu_before = self.cu;
        let counted = self.cv.saturating_add(T::from(edge & (self.cv < self.pv)));
        self.cv = if self.r { T::ZERO } else { counted };
        self.q = self.cv >= self.pv;
    }
}

pins!([T: Count] Ctu<T> {
    Input { cu: BOOL = "CU" as Up, r: BOOL = "R" as Reset, pv: T = "PV" as Preset }
    Output { q: BOOL = "Q" as Done, cv: T = "CV" as Count }
    Memory { cu_before: BOOL = "cu_before" }
});

/// `CTD`: counts down on each rising edge of `cd` while `cv > 0`; `q` while `cv <= 0`. While
/// `ld`, `cv` is `pv`: load wins over counting.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ctd<T> {
    pub cd: bool,
    pub ld: bool,
    pub pv: T,
    pub q: bool,
    pub cv: T,
    /// Memory: `cd` in the last call.
    pub cd_before: bool,
}

impl<T: Count> Ctd<T> {
    /// One call: sets the inputs and counts.
    #[inline]
    pub fn call(&mut self, cd: bool, ld: bool, pv: T) {
        (self.cd, self.ld, self.pv) = (cd, ld, pv);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        let edge = self.cd & !self.cd_before;
        self.cd_before = self.cd;
        let counted = self.cv.saturating_sub(T::from(edge & (self.cv > T::ZERO)));
        self.cv = if self.ld { self.pv } else { counted };
        self.q = self.cv <= T::ZERO;
    }
}

pins!([T: Count] Ctd<T> {
    Input { cd: BOOL = "CD" as Down, ld: BOOL = "LD" as Load, pv: T = "PV" as Preset }
    Output { q: BOOL = "Q" as Done, cv: T = "CV" as Count }
    Memory { cd_before: BOOL = "cd_before" }
});

/// `CTUD`: counts up on each rising edge of `cu` while `cv < pv`, down on each of `cd` while
/// `cv > 0`; both in one call leave `cv` unchanged. `qu` while `cv >= pv`, `qd` while `cv <= 0`. Reset
/// wins over load, load over counting.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ctud<T> {
    pub cu: bool,
    pub cd: bool,
    pub r: bool,
    pub ld: bool,
    pub pv: T,
    pub qu: bool,
    pub qd: bool,
    pub cv: T,
    /// Memory: `cu` in the last call.
    pub cu_before: bool,
    /// Memory: `cd` in the last call.
    pub cd_before: bool,
}

impl<T: Count> Ctud<T> {
    /// One call: sets the inputs and counts.
    #[inline]
    pub fn call(&mut self, cu: bool, cd: bool, r: bool, ld: bool, pv: T) {
        (self.cu, self.cd, self.r, self.ld, self.pv) = (cu, cd, r, ld, pv);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        let up = self.cu & !self.cu_before;
        let down = self.cd & !self.cd_before;
        (self.cu_before, self.cd_before) = (self.cu, self.cd);
        // At most one of the two counts, so each is judged on the count before the call.
        let raised = self.cv.saturating_add(T::from(up & !down & (self.cv < self.pv)));
        let counted = raised.saturating_sub(T::from(down & !up & (self.cv > T::ZERO)));
        let loaded = if self.ld { self.pv } else { counted };
        self.cv = if self.r { T::ZERO } else { loaded };
        self.qu = self.cv >= self.pv;
        self.qd = self.cv <= T::ZERO;
    }
}

pins!([T: Count] Ctud<T> {
    Input {
        cu: BOOL = "CU" as Up, cd: BOOL = "CD" as Down, r: BOOL = "R" as Reset, ld: BOOL = "LD" as Load,
        pv: T = "PV" as Preset,
    }
    Output { qu: BOOL = "QU" as Done, qd: BOOL = "QD" as Empty, cv: T = "CV" as Count }
    Memory { cu_before: BOOL = "cu_before", cd_before: BOOL = "cd_before" }
});

macro_rules! timers {
    ($($(#[$doc:meta])* $timer:ident $step:ident;)*) => { $(
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $timer {
            pub in_: bool,
            pub pt: Time,
            pub q: bool,
            pub et: Time,
            /// Memory: `in_` in the last call.
            pub in_before: bool,
            /// Memory: it runs.
            pub runs: bool,
            /// Memory: it has run.
            pub over: bool,
            /// Memory: when it started.
            pub start: Time,
        }

        impl $timer {
            /// One call: sets the inputs and measures.
            #[inline]
            pub fn call(&mut self, in_: bool, pt: Time, cx: &Context) {
                (self.in_, self.pt) = (in_, pt);
                self.step(cx);
            }

            /// One call with the inputs as they are.
            #[inline]
            pub fn step(&mut self, cx: &Context) {
                let is_idle = !self.runs & !self.over;
                self.$step(is_idle, cx.now());
                self.in_before = self.in_;
            }

            /// One call while it runs: whether it has run for `pt`. A negative `pt` counts as passed.
            #[inline]
            fn measure(&mut self, now: Time) {
                self.over = self.start.saturating_add(self.pt) <= now;
                self.runs = !self.over;
                self.et = if self.over { self.pt } else { now.wrapping_sub(self.start) };
            }
        }

        pins!([] $timer {
            Input { in_: BOOL = "IN", pt: TIME = "PT" }
            Output { q: BOOL = "Q", et: TIME = "ET" }
            Memory { in_before: BOOL = "in_before", runs: BOOL = "runs", over: BOOL = "over", start: TIME = "start" }
        });
    )* };
}

timers! {
    /// `TON`: `q` once `in_` has been TRUE for `pt`, in a call after the one with the rise: with a `pt` of 0, in the second.
    Ton on;
    /// `TOF`: `q` while `in_`, and for `pt` after it falls, always including the call with the fall.
    Tof off;
    /// `TP`: a rising edge gives a pulse of `pt`, which always includes the call with the edge.
    Tp pulse;
}

impl Ton {
    #[inline]
    fn on(&mut self, is_idle: bool, now: Time) {
        if is_idle & !self.in_before & self.in_ {
            (self.runs, self.q, self.start) = (true, false, now);
        } else if !self.in_ {
            (self.runs, self.over, self.q, self.et) = (false, false, false, 0);
        } else if self.runs {
            self.measure(now);
            self.q = self.over;
        }
    }
}

impl Tof {
    #[inline]
    fn off(&mut self, is_idle: bool, now: Time) {
        if is_idle & self.in_before & !self.in_ {
            (self.runs, self.start) = (true, now);
        } else if self.in_ {
            (self.runs, self.over, self.et) = (false, false, 0);
        } else if self.runs {
            self.measure(now);
        }
        self.q = self.in_ | self.runs;
    }
}

impl Tp {
    #[inline]
    fn pulse(&mut self, is_idle: bool, now: Time) {
        if is_idle & !self.in_before & self.in_ {
            (self.runs, self.q, self.start) = (true, true, now);
        } else if self.runs {
            self.measure(now);
            self.q = self.runs;
        }
        if self.over & !self.in_ {
            (self.over, self.et) = (false, 0);
        }
    }
}

/// `F_TRIG` before 2024-12: `q` in the call in which `clk` becomes FALSE, and in a first call in which it is FALSE: its
/// memory is `NOT clk`, which starts as FALSE (IEC 61131-3, second edition, 2.5.2.3.2).
///
/// ```
/// let mut falling = staunch_runtime::openplc::FTrig::default();
/// falling.call(false);
/// assert!(falling.q);
/// falling.call(false);
/// assert!(!falling.q);
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FTrig {
    pub clk: bool,
    pub q: bool,
    /// Memory: whether `clk` was FALSE in the last call.
    pub low_before: bool,
}

impl FTrig {
    /// One call: sets the input and looks for an edge.
    #[inline]
    pub fn call(&mut self, clk: bool) {
        self.clk = clk;
        self.step(&Context::default());
    }

    /// One call with the input as it is.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        self.q = !self.clk & !self.low_before;
        self.low_before = !self.clk;
    }
}

pins!([] FTrig {
    Input { clk: BOOL = "CLK" }
    Output { q: BOOL = "Q" }
    Memory { low_before: BOOL = "low_before" }
});
