//! SR and RS (IEC 61131-3, edition 3, table 43).

use crate::Context;
use crate::block::pins;

/// `SR`: `q1` is set by `s1` and reset by `r`; `s1` wins.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sr {
    pub s1: bool,
    pub r: bool,
    pub q1: bool,
}

impl Sr {
    /// One call: sets the inputs and the output.
    #[inline]
    pub fn call(&mut self, s1: bool, r: bool) {
        (self.s1, self.r) = (s1, r);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        self.q1 = self.s1 | (!self.r & self.q1);
    }
}

pins!([] Sr {
    Input { s1: BOOL = "S1" as Set, r: BOOL = "R" as Reset }
    Output { q1: BOOL = "Q1" as Done }
});

/// `RS`: `q1` is set by `s` and reset by `r1`; `r1` wins.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rs {
    pub s: bool,
    pub r1: bool,
    pub q1: bool,
}

impl Rs {
    /// One call: sets the inputs and the output.
    #[inline]
    pub fn call(&mut self, s: bool, r1: bool) {
        (self.s, self.r1) = (s, r1);
        self.step(&Context::default());
    }

    /// One call with the inputs as they are.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        self.q1 = !self.r1 & (self.s | self.q1);
    }
}

pins!([] Rs {
    Input { s: BOOL = "S" as Set, r1: BOOL = "R1" as Reset }
    Output { q1: BOOL = "Q1" as Done }
});
