//! CODESYS Standard and Standard64. Its counters are the unsigned ones of [`iec`]
//! with the pins RESET and LOAD for R and LD: an unsigned `CV <= 0` is its `CV = 0`, and an
//! unsigned minimum is its floor of 0.

use super::iec::{self, Count};
use crate::Context;
use crate::block::pins;

/// `CTU`, counting in a WORD.
pub type Ctu = iec::Ctu<u16>;
/// `CTD`, counting in a WORD.
pub type Ctd = iec::Ctd<u16>;
/// `CTUD`, counting in a WORD.
pub type Ctud = iec::Ctud<u16>;
/// `LCTU`, counting in an LWORD.
pub type Lctu = iec::Ctu<u64>;
/// `LCTD`, counting in an LWORD.
pub type Lctd = iec::Ctd<u64>;
/// `LCTUD`, counting in an LWORD.
pub type Lctud = iec::Ctud<u64>;

/// `SR` with the pins SET1 and RESET.
pub type Sr = iec::Sr;
/// `RS` with the pins SET and RESET1.
pub type Rs = iec::Rs;

/// `CTU` as the sentence "counts up to PV" has it, for the option `ctu-stop-at-pv`: as
/// [`iec::Ctu`], but an edge counts only while `cv < pv`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CtuStopAtPv<T> {
    pub cu: bool,
    pub reset: bool,
    pub pv: T,
    pub q: bool,
    pub cv: T,
    /// Memory: `cu` in the last call.
    pub cu_before: bool,
}

impl<T: Count> CtuStopAtPv<T> {
    /// One call: sets the inputs and counts.
    #[inline]
    pub fn call(&mut self, cu: bool, reset: bool, pv: T) {
        (self.cu, self.reset, self.pv) = (cu, reset, pv);
        self.step(&Context::at(0));
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        let edge = self.cu & !self.cu_before;
        self.cu_before = self.cu;
        let counted = self.cv.saturating_add(T::from(edge & (self.cv < self.pv)));
        self.cv = if self.reset { T::ZERO } else { counted };
        self.q = self.cv >= self.pv;
    }
}

pins!([T: Count] CtuStopAtPv<T> {
    Input { cu: BOOL = "CU" as Up, reset: BOOL = "RESET" as Reset, pv: T = "PV" as Preset }
    Output { q: BOOL = "Q" as Done, cv: T = "CV" as Count }
    Memory { cu_before: BOOL = "cu_before" }
});
