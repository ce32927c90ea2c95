//! OpenPLC Editor from v4.2 and Runtime from v4.1, whose library is that of STruC++, written in Structured Text
//! (`libs/sources/iec-standard-fb`, read and run at 0.6.1). `CTU` is [`openplc`]'s. A `CTD`, and the
//! `cd` of a `CTUD`, count on the falling edge; a `CTUD` counts up and then down, each tested against the
//! count at that moment. Timers are state machines, which check the time from the call after the edge on.

use super::iec::Count;
use super::openplc;
use crate::block::pins;
use crate::{Context, Time};

/// `CTU`: counts up on each rising edge of `cu` while `cv < pv`.
pub type Ctu<T> = openplc::Ctu<T>;

/// `CTD` with the option `openplc4-cd-edge = "rising"`.
pub type CtdRising<T> = openplc::Ctd<T>;

/// `CTD`: counts down on each falling edge of `cd` while `cv > 0`; a `cd` that is FALSE in the first call
/// is not an edge. `q` while `cv <= 0`. While `ld`, `cv` is `pv`: load wins over counting.
///
/// ```
/// let mut parts = staunch_runtime::openplc4::Ctd::<i16>::default();
/// parts.call(false, true, 2);
/// parts.call(true, false, 2);
/// assert_eq!(parts.cv, 2);
/// parts.call(false, false, 2);
/// assert_eq!(parts.cv, 1);
/// ```
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
        let edge = !self.cd & self.cd_before;
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

/// `CTUD`: counts down on the falling edge.
pub type Ctud<T> = Both<T, false>;
/// `CTUD` with the option `openplc4-cd-edge = "rising"`.
pub type CtudRising<T> = Both<T, true>;

/// Counts up on each rising edge of `cu` while `cv < pv`, then down on each edge of `cd`, rising if `RISES`,
/// while `cv > 0`; so if both count at `pv`, only down counts. `qu` while `cv >= pv`, `qd` while `cv <= 0`. Reset
/// wins over load, load over counting.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Both<T, const RISES: bool> {
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

impl<T: Count, const RISES: bool> Both<T, RISES> {
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
        let down = (self.cd ^ self.cd_before) & (self.cd == RISES);
        (self.cu_before, self.cd_before) = (self.cu, self.cd);
        let raised = self.cv.saturating_add(T::from(up & (self.cv < self.pv)));
        let counted = raised.saturating_sub(T::from(down & (raised > T::ZERO)));
        let loaded = if self.ld { self.pv } else { counted };
        self.cv = if self.r { T::ZERO } else { loaded };
        self.qu = self.cv >= self.pv;
        self.qd = self.cv <= T::ZERO;
    }
}

pins!([T: Count, const RISES: bool] Both<T, RISES> {
    Input {
        cu: BOOL = "CU" as Up, cd: BOOL = "CD" as Down, r: BOOL = "R" as Reset, ld: BOOL = "LD" as Load,
        pv: T = "PV" as Preset,
    }
    Output { qu: BOOL = "QU" as Done, qd: BOOL = "QD" as Empty, cv: T = "CV" as Count }
    Memory { cu_before: BOOL = "cu_before", cd_before: BOOL = "cd_before" }
});

/// `TON`: the call in which `in_` rises starts it; `q` becomes TRUE in a later call, once `pt` has passed, even
/// if `pt` is 0. `et` is `pt` from then on.
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

    /// One call with the inputs as they are. The timer runs while `in_` was TRUE and `q` is still FALSE.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        let runs = self.in_ & self.in_before & !self.q;
        self.start = if self.in_ & !self.in_before { cx.now() } else { self.start };
        self.in_before = self.in_;
        if runs {
            (self.q, self.et) = measured(self.start, self.pt, cx);
        }
        self.q &= self.in_;
        self.et = if self.in_ { self.et } else { 0 };
    }
}

pins!([] Ton {
    Input { in_: BOOL = "IN", pt: TIME = "PT" }
    Output { q: BOOL = "Q", et: TIME = "ET" }
    Memory { in_before: BOOL = "in_before", start: TIME = "start" }
});

/// `TOF`: `q` while `in_`, and from the call in which it falls until a later one, once `pt` has passed,
/// even if `pt` is 0.
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

    /// One call with the inputs as they are. The timer runs while `in_` was FALSE and `q` is still TRUE.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        let runs = !self.in_ & !self.in_before & self.q;
        self.start = if !self.in_ & self.in_before { cx.now() } else { self.start };
        self.in_before = self.in_;
        if runs {
            let (over, elapsed) = measured(self.start, self.pt, cx);
            (self.q, self.et) = (!over, elapsed);
        }
        self.q |= self.in_;
        self.et = if self.in_ { 0 } else { self.et };
    }
}

pins!([] Tof {
    Input { in_: BOOL = "IN", pt: TIME = "PT" }
    Output { q: BOOL = "Q", et: TIME = "ET" }
    Memory { in_before: BOOL = "in_before", start: TIME = "start" }
});

/// `TP`: a rising `in_` gives a pulse of `q` that lasts to a later call, once `pt` has passed, even if
/// `pt` is 0; changes of `in_` during the pulse are ignored. After it `et` stays until `in_` is FALSE.
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
        let begins = self.in_ & !self.in_before & !self.q;
        self.in_before = self.in_;
        self.start = if begins { cx.now() } else { self.start };
        if self.q {
            let (over, elapsed) = measured(self.start, self.pt, cx);
            (self.q, self.et) = (!over, elapsed);
        }
        self.q |= begins;
        self.et = if self.in_ | self.q { self.et } else { 0 };
    }
}

pins!([] Tp {
    Input { in_: BOOL = "IN", pt: TIME = "PT" }
    Output { q: BOOL = "Q", et: TIME = "ET" }
    Memory { in_before: BOOL = "in_before", start: TIME = "start" }
});

/// Whether `delay` has passed since `start`, and how much of it. A negative delay is over at once, and is
/// itself the part that has passed.
#[inline]
fn measured(start: Time, delay: Time, cx: &Context) -> (bool, Time) {
    let over = start.wrapping_add(delay) <= cx.now();
    (over, if over { delay } else { cx.now().wrapping_sub(start) })
}
