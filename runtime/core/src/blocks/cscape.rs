//! Horner Cscape, IEC editor with Enhanced IEC. Its counters have no edge memory: they count in
//! every call whose input is TRUE. They stop at their goal, and `q` is TRUE only while `cv` equals it,
//! so `q` becomes FALSE if `pv` is changed to a value below `cv`.

use crate::Context;
use crate::block::pins;

/// `CTU`: while `cu` is TRUE, each call counts up until `cv` reaches `pv`; `q` while `cv = pv`. Reset
/// wins over counting.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ctu {
    pub cu: bool,
    pub reset: bool,
    pub pv: i16,
    pub q: bool,
    pub cv: i16,
}

impl Ctu {
    /// One call: sets the inputs and counts.
    #[inline]
    pub fn call(&mut self, cu: bool, reset: bool, pv: i16) {
        (self.cu, self.reset, self.pv) = (cu, reset, pv);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        let counted = self.cv.saturating_add(i16::from(self.cu & (self.cv < self.pv)));
        self.cv = if self.reset { 0 } else { counted };
        self.q = self.cv == self.pv;
    }
}

pins!([] Ctu {
    Input { cu: BOOL = "CU" as Up, reset: BOOL = "RESET" as Reset, pv: INT = "PV" as Preset }
    Output { q: BOOL = "Q" as Done, cv: INT = "CV" as Count }
});

/// `CTD`: while `cd` is TRUE, each call counts down until `cv` reaches 0; `q` while `cv = 0`. While
/// `load` is TRUE, `cv` is `pv`: load wins over counting. A negative `cv` stays.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ctd {
    pub cd: bool,
    pub load: bool,
    pub pv: i16,
    pub q: bool,
    pub cv: i16,
}

impl Ctd {
    /// One call: sets the inputs and counts.
    #[inline]
    pub fn call(&mut self, cd: bool, load: bool, pv: i16) {
        (self.cd, self.load, self.pv) = (cd, load, pv);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        let counted = self.cv.saturating_sub(i16::from(self.cd & (self.cv > 0)));
        self.cv = if self.load { self.pv } else { counted };
        self.q = self.cv == 0;
    }
}

pins!([] Ctd {
    Input { cd: BOOL = "CD" as Down, load: BOOL = "LOAD" as Load, pv: INT = "PV" as Preset }
    Output { q: BOOL = "Q" as Done, cv: INT = "CV" as Count }
});

/// `R_CTU`: a [`Ctu`]. Its fourth pin RCV is a variable of the caller, which the compiler sets to
/// `cv` after each call, and `cv` to it at a restart if it is retained.
pub type RCtu = Ctu;
/// `R_CTD`: a [`Ctd`], with the pin RCV of [`RCtu`].
pub type RCtd = Ctd;
