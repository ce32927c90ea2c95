//! R_TRIG and F_TRIG (IEC 61131-3, edition 3, table 44), and their variants in other systems.

use crate::Context;
use crate::block::pins;

/// `R_TRIG`: `q` is TRUE in the call in which `clk` becomes TRUE; a `clk` that is TRUE in the first call
/// counts as an edge.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RTrig {
    pub clk: bool,
    pub q: bool,
    /// Memory: `clk` in the last call.
    pub clk_before: bool,
}

impl RTrig {
    /// One call: sets the input and looks for an edge.
    #[inline]
    pub fn call(&mut self, clk: bool) {
        self.clk = clk;
        self.step(&Context::default());
    }

    /// One call with the input as it is.
    #[inline]
    pub fn step(&mut self, _: &Context) {
        self.q = self.clk & !self.clk_before;
        self.clk_before = self.clk;
    }
}

pins!([] RTrig {
    Input { clk: BOOL = "CLK" }
    Output { q: BOOL = "Q" }
    Memory { clk_before: BOOL = "clk_before" }
});

/// `F_TRIG`: `q` is TRUE in the call in which `clk` becomes FALSE; a `clk` that is FALSE in the first
/// call does not count as an edge.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FTrig {
    pub clk: bool,
    pub q: bool,
    /// Memory: `clk` in the last call.
    pub clk_before: bool,
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
        self.q = !self.clk & self.clk_before;
        self.clk_before = self.clk;
    }
}

pins!([] FTrig {
    Input { clk: BOOL = "CLK" }
    Output { q: BOOL = "Q" }
    Memory { clk_before: BOOL = "clk_before" }
});
