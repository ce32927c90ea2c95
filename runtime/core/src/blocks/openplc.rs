//! OpenPLC v3, OpenPLC Editor and Beremiz, whose library is MATIEC's. Its counters are those of
//! [`iec`](super::iec) but for one rule: an edge counts up only while `cv < pv`, and down only
//! while `cv > 0`, as the count was before the call. A count that is beyond already stays. Its
//! `F_TRIG` is the second edition's text, which sees an edge in a first call with FALSE.

use super::iec::Count;
use crate::Context;
use crate::block::pins;

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
/// `cv > 0`; both in one call leave `cv` alone. `qu` while `cv >= pv`, `qd` while `cv <= 0`. Reset
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

/// `F_TRIG`: `q` in the call in which `clk` becomes FALSE, and in a first call in which it is FALSE: what is
/// remembered is `NOT clk`, which starts as FALSE (IEC 61131-3, second edition, 2.5.2.3.2).
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
