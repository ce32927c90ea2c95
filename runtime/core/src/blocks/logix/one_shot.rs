//! `FBD_ONESHOT` with `OSRI` and `OSFI`, by Rockwell 1756-RM003, *Bit Instructions*.

use crate::Context;
use crate::block::pins;

/// `FBD_ONESHOT`, the tag of the instructions `OSRI` and `OSFI`. A program sets its inputs as members.
///
/// The vendor's tag starts with `enable_in` TRUE; [`new`](Self::new) is all zero, so set it after
/// you create an instance.
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
    /// `OSRI`: `output_bit` is TRUE in an execution in which `input_bit` is TRUE but was FALSE in the previous one.
    /// In the first scan, the previous input counts as TRUE.
    #[inline]
    pub fn osri(&mut self, cx: &Context) {
        self.enable_out = self.enable_in;
        if self.enable_in {
            self.output_bit = self.input_bit & !(self.input_before | cx.first_scan);
            self.input_before = self.input_bit;
        }
    }

    /// `OSFI`: `output_bit` is TRUE in an execution in which `input_bit` is FALSE but was TRUE in the previous one.
    /// In the first scan, the previous input counts as FALSE.
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
