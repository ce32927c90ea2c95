//! The counters of Autonomy Edge as its page documents them, and the blocks that all families share.
//!
//! The counters count rising edges; an input that is TRUE in the first call counts as one. The edge
//! memory follows the input in every call, so an edge during a reset or load is used up. Counting
//! stops at the limits of the type.

pub use super::bistable::*;
pub use super::clock::*;
pub use super::edge::*;
pub use super::timer::*;

use crate::block::pins;
use crate::{Context, Scalar};

/// A type that counters count in.
pub trait Count: Scalar + Ord + From<bool> {
    fn saturating_add(self, other: Self) -> Self;
    fn saturating_sub(self, other: Self) -> Self;
    /// One more, one less, or for both the same; it stops at the limits.
    #[must_use]
    fn counted(self, up: bool, down: bool) -> Self;
}

macro_rules! counts {
    ($($rust:ident $signed:ident $add:ident)*) => { $(
        impl Count for $rust {
            #[inline]
            fn saturating_add(self, other: Self) -> Self { self.saturating_add(other) }
            #[inline]
            fn saturating_sub(self, other: Self) -> Self { self.saturating_sub(other) }
            #[inline]
            fn counted(self, up: bool, down: bool) -> Self { self.$add($signed::from(up) - $signed::from(down)) }
        }
    )* };
}

counts! {
    i8 i8 saturating_add i16 i16 saturating_add i32 i32 saturating_add i64 i64 saturating_add
    u8 i8 saturating_add_signed u16 i16 saturating_add_signed u32 i32 saturating_add_signed u64 i64 saturating_add_signed
}

/// `CTU`: counts up on each rising edge of `cu`, even past `pv`; `q` while `cv >= pv`. Reset
/// wins over counting; `cv` stops at the type's maximum instead of wrapping.
///
/// ```
/// let mut parts = staunch_runtime::iec::Ctu::<i16>::new();
/// parts.call(true, false, 2);
/// parts.call(true, false, 2);
/// assert_eq!((parts.cv, parts.q), (1, false));
/// parts.call(false, false, 2);
/// parts.call(true, false, 2);
/// assert_eq!((parts.cv, parts.q), (2, true));
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
        let counted = self.cv.saturating_add(T::from(edge));
        self.cv = if self.r { T::ZERO } else { counted };
        self.q = self.cv >= self.pv;
    }
}

pins!([T: Count] Ctu<T> {
    Input { cu: BOOL = "CU" as Up, r: BOOL = "R" as Reset, pv: T = "PV" as Preset }
    Output { q: BOOL = "Q" as Done, cv: T = "CV" as Count }
    Memory { cu_before: BOOL = "cu_before" }
});

/// `CTD`: counts down on each rising edge of `cd`; `q` while `cv <= 0`. While `ld`, `cv` is `pv`:
/// load wins over counting. `cv` goes below 0 and stops at the type's minimum, which is 0 for an
/// unsigned type.
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
        let counted = self.cv.saturating_sub(T::from(edge));
        self.cv = if self.ld { self.pv } else { counted };
        self.q = self.cv <= T::ZERO;
    }
}

pins!([T: Count] Ctd<T> {
    Input { cd: BOOL = "CD" as Down, ld: BOOL = "LD" as Load, pv: T = "PV" as Preset }
    Output { q: BOOL = "Q" as Done, cv: T = "CV" as Count }
    Memory { cd_before: BOOL = "cd_before" }
});

/// `CTUD`: counts up on each rising edge of `cu` and down on each of `cd`; both in one call
/// leave `cv` unchanged, even at the limits. `qu` while `cv >= pv`, `qd` while `cv <= 0`. Reset wins
/// over load, load over counting; `cv` stops at the limits of the type.
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
        self.cv = match (self.r, self.ld) {
            (true, _) => T::ZERO,
            (false, true) => self.pv,
            // In one step, so a limit cannot make the pair lopsided.
            (false, false) => self.cv.counted(up, down),
        };
        self.qu = self.cv >= self.pv;
        self.qd = self.cv <= T::ZERO;
    }
}

pins!([T: Count] Ctud<T> {
    Input { cu: BOOL = "CU" as Up, cd: BOOL = "CD" as Down, r: BOOL = "R" as Reset, ld: BOOL = "LD" as Load, pv: T = "PV" as Preset }
    Output { qu: BOOL = "QU" as Done, qd: BOOL = "QD" as Empty, cv: T = "CV" as Count }
    Memory { cu_before: BOOL = "cu_before", cd_before: BOOL = "cd_before" }
});

// Controllers hold thousands of these.
const _: () = assert!(size_of::<Ctu<i16>>() <= 10);
