//! `FBD_ONESHOT` with `OSRI` and `OSFI`, by Rockwell 1756-RM003, *Bit Instructions*.

use crate::Context;
use crate::block::pins;

/// `FBD_ONESHOT`, the tag of the instructions `OSRI` and `OSFI`. A program sets its inputs as members.
///
/// The vendor's tag starts with `enable_in` TRUE; [`new`](Self::new) is all zero, and whoever
/// makes an instance sets it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FbdOneshot {
    /// FALSE: the instruction does nothing.
    pub enable_in: bool,
    pub input_bit: bool,
    pub enable_out: bool,
    pub output_bit: bool,
    /// Memory: `input_bit` in the last execution.
    pub input_before: bool,
}

impl FbdOneshot {
    /// `OSRI`: `output_bit` in an execution in which `input_bit` is TRUE and was FALSE in the one before.
    /// In the first scan it counts as one that was TRUE.
    #[inline]
    pub fn osri(&mut self, cx: &Context) {
        self.enable_out = self.enable_in;
        if self.enable_in {
            self.output_bit = self.input_bit & !(self.input_before | cx.first_scan);
            self.input_before = self.input_bit;
        }
    }

    /// `OSFI`: `output_bit` in an execution in which `input_bit` is FALSE and was TRUE in the one before.
    /// In the first scan it counts as one that was FALSE.
    #[inline]
    pub fn osfi(&mut self, cx: &Context) {
        self.enable_out = self.enable_in;
        if self.enable_in {
            self.output_bit = !self.input_bit & self.input_before & !cx.first_scan;
            self.input_before = self.input_bit;
        }
    }
}

pins!([] FbdOneshot {
    Member {
        enable_in: BOOL = "EnableIn" true, input_bit: BOOL = "InputBit",
        enable_out: BOOL = "EnableOut", output_bit: BOOL = "OutputBit",
    }
    Memory { input_before: BOOL = "input_before" }
});
