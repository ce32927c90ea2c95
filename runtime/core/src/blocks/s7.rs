//! The counters of Siemens' S7: SFB 0, 1 and 2 of S7-300 and S7-400 (System Software for S7-300/400, Volume 2/2,
//! A5E00739858-01, 25.4 to 25.6), and `CTU`, `CTD` and `CTUD` of S7-1200 and S7-1500 (TIA Portal's help of SCL, "Counter
//! operations"). They count as [`iec`]'s do, in all integers. The documents disagree on whether LD is a level or an edge.

use super::iec::{self, Count};
use crate::block::pins;
use crate::{Context, Time};

/// `CTU`: counts up on each rising edge of `cu`, even past `pv`.
pub type Ctu<T> = iec::Ctu<T>;
/// `CTD`: `ld` is a level.
pub type Ctd<T> = Down<T, false>;
/// `CTUD`: `ld` is a level.
pub type Ctud<T> = Both<T, false>;
/// `CTD` with the option `s7-ld = "edge"`.
pub type CtdLdEdge<T> = Down<T, true>;
/// `CTUD` with the option `s7-ld = "edge"`.
pub type CtudLdEdge<T> = Both<T, true>;

/// Counts down on each rising edge of `cd`, even below 0; `q` while `cv <= 0`. While `ld` is TRUE, nothing counts; `pv` is
/// loaded in each such call, or, if `EDGE`, in the first of them.
///
/// ```
/// let mut parts = staunch_runtime::s7::CtdLdEdge::<i16>::new();
/// parts.call(false, true, 5);
/// parts.call(true, true, 9);
/// assert_eq!(parts.cv, 5);
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Down<T, const EDGE: bool> {
    pub cd: bool,
    pub ld: bool,
    pub pv: T,
    pub q: bool,
    pub cv: T,
    /// Memory: `cd` in the last call.
    pub cd_before: bool,
    /// Memory: `ld` in the last call.
    pub ld_before: bool,
}

impl<T: Count, const EDGE: bool> Down<T, EDGE> {
    /// One call: sets the inputs and counts.
    #[inline]
    pub fn call(&mut self, cd: bool, ld: bool, pv: T) {
        (self.cd, self.ld, self.pv) = (cd, ld, pv);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        let down = self.cd & !self.cd_before & !self.ld;
        let loads = self.ld & !(EDGE & self.ld_before);
        (self.cd_before, self.ld_before) = (self.cd, self.ld);
        let counted = self.cv.saturating_sub(T::from(down));
        self.cv = if loads { self.pv } else { counted };
        self.q = self.cv <= T::ZERO;
    }
}

pins!([T: Count, const EDGE: bool] Down<T, EDGE> {
    Input { cd: BOOL = "CD" as Down, ld: BOOL = "LD" as Load, pv: T = "PV" as Preset }
    Output { q: BOOL = "Q" as Done, cv: T = "CV" as Count }
    Memory { cd_before: BOOL = "cd_before", ld_before: BOOL = "ld_before" }
});

/// Counts up on each rising edge of `cu` and down on each of `cd`; both in one call leave `cv` unchanged. `qu` while `cv >= pv`,
/// `qd` while `cv <= 0`. Reset wins over load, load over counting; `ld` works as in [`Down`]. While `r` is TRUE, `ld` has no
/// effect, and an edge of it is used up.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Both<T, const EDGE: bool> {
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
    /// Memory: `ld` in the last call.
    pub ld_before: bool,
}

impl<T: Count, const EDGE: bool> Both<T, EDGE> {
    /// One call: sets the inputs and counts.
    #[inline]
    pub fn call(&mut self, cu: bool, cd: bool, r: bool, ld: bool, pv: T) {
        (self.cu, self.cd, self.r, self.ld, self.pv) = (cu, cd, r, ld, pv);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        let up = self.cu & !self.cu_before & !self.ld;
        let down = self.cd & !self.cd_before & !self.ld;
        let loads = self.ld & !(EDGE & self.ld_before);
        (self.cu_before, self.cd_before, self.ld_before) = (self.cu, self.cd, self.ld);
        let raised = self.cv.saturating_add(T::from(up & !down));
        let counted = raised.saturating_sub(T::from(down & !up));
        let loaded = if loads { self.pv } else { counted };
        self.cv = if self.r { T::ZERO } else { loaded };
        self.qu = self.cv >= self.pv;
        self.qd = self.cv <= T::ZERO;
    }
}

pins!([T: Count, const EDGE: bool] Both<T, EDGE> {
    Input {
        cu: BOOL = "CU" as Up, cd: BOOL = "CD" as Down, r: BOOL = "R" as Reset, ld: BOOL = "LD" as Load,
        pv: T = "PV" as Preset,
    }
    Output { qu: BOOL = "QU" as Done, qd: BOOL = "QD" as Empty, cv: T = "CV" as Count }
    Memory { cu_before: BOOL = "cu_before", cd_before: BOOL = "cd_before", ld_before: BOOL = "ld_before" }
});

/// `TONR` of S7-1200 and S7-1500: adds up in `et` how long `in_` was TRUE, until that reaches the preset: then `q` is TRUE, and
/// both stay, even when `in_` falls, until `r`, a level that clears them whatever `in_` is. The preset is the `pt` of the call
/// in which `in_` rose last; a negative preset acts as 0. The call in which `in_` falls adds the time up to it. (S7-1200 System
/// Manual, 11/2011, tables 7-18 and 7-19; TIA Portal's help, "TONR: Time accumulator")
///
/// ```
/// use staunch_runtime::{Context, s7::Tonr};
/// let mut worn = Tonr::default();
/// worn.call(true, false, 50, &Context::at(0));
/// worn.call(false, false, 50, &Context::at(30));
/// worn.call(true, false, 50, &Context::at(1000));
/// worn.call(true, false, 50, &Context::at(1020));
/// assert_eq!((worn.q, worn.et), (true, 50));
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tonr {
    pub in_: bool,
    pub r: bool,
    pub pt: Time,
    pub q: bool,
    pub et: Time,
    /// Memory: `in_` in the last call.
    pub in_before: bool,
    /// Memory: `pt` when `in_` rose last.
    pub preset: Time,
    /// Memory: the time of the last call.
    pub last: Time,
}

impl Tonr {
    /// One call: sets the inputs and measures.
    #[inline]
    pub fn call(&mut self, in_: bool, r: bool, pt: Time, cx: &Context) {
        (self.in_, self.r, self.pt) = (in_, r, pt);
        self.step(cx);
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, cx: &Context) {
        let runs = self.in_before & !self.q;
        let passed = cx.now().wrapping_sub(self.last);
        let rises = self.in_ & !self.in_before;
        (self.in_before, self.last) = (self.in_, cx.now());
        self.preset = if rises { self.pt.max(0) } else { self.preset };
        let added = self.et.saturating_add(passed).min(self.preset.max(self.et));
        let et = if runs { added } else { self.et };
        let over = (runs | rises) & (et >= self.preset);
        self.et = if self.r { 0 } else { et };
        self.q = !self.r & (self.q | over);
    }
}

pins!([] Tonr {
    Input { in_: BOOL = "IN", r: BOOL = "R", pt: TIME = "PT" }
    Output { q: BOOL = "Q", et: TIME = "ET" }
    Memory { in_before: BOOL = "in_before", preset: TIME = "preset", last: TIME = "last" }
});
