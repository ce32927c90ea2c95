//! Rockwell Logix 5000: structures that instructions work on. All-zero is their start state;
//! their tags are retentive, and a prescan before the first scan keeps an input that is already
//! TRUE from counting.

mod fbd_timer;
mod one_shot;
mod timer;

pub use fbd_timer::FbdTimer;
pub use one_shot::FbdOneshot;
pub use timer::Timer;

use crate::block::pins;

/// `COUNTER`, the tag that `CTU`, `CTD` and `RES` share. `acc` wraps at its limits: past the
/// upper one `ov` is set, past the lower one `un`, and wrapping back clears the flag again.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counter {
    /// The rung of the last `CTU`: its edge memory.
    pub cu: bool,
    /// The rung of the last `CTD`: its edge memory.
    pub cd: bool,
    pub dn: bool,
    pub ov: bool,
    pub un: bool,
    pub pre: i32,
    pub acc: i32,
}

impl Counter {
    /// `CTU`: counts up when the rung goes TRUE, even past `pre`, and updates `dn` in every call
    /// in which the rung is TRUE. Returns the rung.
    #[inline]
    pub fn ctu(&mut self, rung: bool) -> bool {
        let edge = rung & !self.cu;
        self.cu = rung;
        self.tally().up(edge);
        self.dn = if rung { self.done() } else { self.dn };
        rung
    }

    /// `CTD`: counts down when the rung goes TRUE, even below 0, and updates `dn` in every call
    /// in which the rung is TRUE: it becomes FALSE when `acc` falls below `pre`. Returns the rung.
    #[inline]
    pub fn ctd(&mut self, rung: bool) -> bool {
        let edge = rung & !self.cd;
        self.cd = rung;
        self.tally().down(edge);
        self.dn = if rung { self.done() } else { self.dn };
        rung
    }

    /// `RES`: while the rung is TRUE, clears everything but `pre`. Returns the rung.
    #[inline]
    pub fn res(&mut self, rung: bool) -> bool {
        let cleared = Self { pre: self.pre, ..Self::new() };
        *self = if rung { cleared } else { *self };
        rung
    }

    fn tally(&mut self) -> Tally<'_> {
        Tally { acc: &mut self.acc, ov: &mut self.ov, un: &mut self.un }
    }

    fn done(&self) -> bool {
        done(self.acc, self.pre, self.ov, self.un)
    }

    /// Before the first scan, for a counter that a `CTU` works on: a rung that is already TRUE
    /// does not count.
    #[inline]
    pub fn prescan_ctu(&mut self) {
        self.cu = true;
    }

    /// Before the first scan, for a counter that a `CTD` works on: a rung that is already TRUE
    /// does not count.
    #[inline]
    pub fn prescan_ctd(&mut self) {
        self.cd = true;
    }
}

pins!([] Counter {
    Member {
        cu: BOOL = "CU" as Up, cd: BOOL = "CD" as Down, dn: BOOL = "DN" as Done, ov: BOOL = "OV", un: BOOL = "UN",
        pre: DINT = "PRE" as Preset, acc: DINT = "ACC" as Count,
    }
});

/// `FBD_COUNTER`, the tag of the instruction `CTUD`. A program sets its inputs as members.
///
/// The vendor's tag starts with `enable_in` TRUE; [`new`](Self::new) is all zero, so set it after
/// you create an instance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FbdCounter {
    /// FALSE: the instruction does nothing.
    pub enable_in: bool,
    pub cu_enable: bool,
    pub cd_enable: bool,
    pub pre: i32,
    pub reset: bool,
    pub enable_out: bool,
    pub acc: i32,
    pub cu: bool,
    pub cd: bool,
    pub dn: bool,
    pub ov: bool,
    pub un: bool,
    /// Memory: `cu_enable` in the last execution; FALSE after a reset.
    pub cu_enable_before: bool,
    /// Memory: `cd_enable` in the last execution; FALSE after a reset.
    pub cd_enable_before: bool,
}

impl FbdCounter {
    /// `CTUD`: counts up on a rising `cu_enable`, then down on a rising `cd_enable`. While
    /// `reset`, the count, the flags and both edge memories are cleared, so that an enable which
    /// stays TRUE counts once when it ends.
    #[inline]
    pub fn ctud(&mut self) {
        self.enable_out = self.enable_in;
        if self.enable_in {
            if self.reset { self.clear() } else { self.count() }
        }
    }

    fn clear(&mut self) {
        self.acc = 0;
        (self.cu, self.cd, self.dn, self.ov, self.un) = (false, false, false, false, false);
        (self.cu_enable_before, self.cd_enable_before) = (false, false);
    }

    fn count(&mut self) {
        let up = self.cu_enable & !self.cu_enable_before;
        let down = self.cd_enable & !self.cd_enable_before;
        (self.cu_enable_before, self.cd_enable_before) = (self.cu_enable, self.cd_enable);
        (self.cu, self.cd) = (self.cu_enable, self.cd_enable);
        let mut tally = Tally { acc: &mut self.acc, ov: &mut self.ov, un: &mut self.un };
        tally.up(up);
        tally.down(down);
        self.dn = done(self.acc, self.pre, self.ov, self.un);
    }

    /// Before the first scan: an enable that is already TRUE does not count.
    #[inline]
    pub fn prescan_ctud(&mut self) {
        (self.cu_enable_before, self.cd_enable_before) = (true, true);
    }
}

pins!([] FbdCounter {
    Member {
        enable_in: BOOL = "EnableIn" true,
        cu_enable: BOOL = "CUEnable" as Up, cd_enable: BOOL = "CDEnable" as Down, pre: DINT = "PRE" as Preset, reset: BOOL = "Reset" as Reset,
        enable_out: BOOL = "EnableOut", acc: DINT = "ACC" as Count,
        cu: BOOL = "CU", cd: BOOL = "CD", dn: BOOL = "DN" as Done, ov: BOOL = "OV", un: BOOL = "UN",
    }
    Memory { cu_enable_before: BOOL = "cu_enable_before", cd_enable_before: BOOL = "cd_enable_before" }
});

/// A count with the flags that show past which limit it has wrapped.
struct Tally<'a> {
    acc: &'a mut i32,
    ov: &'a mut bool,
    un: &'a mut bool,
}

impl Tally<'_> {
    #[inline]
    fn up(&mut self, counts: bool) {
        let (acc, wraps) = self.acc.overflowing_add(i32::from(counts));
        *self.acc = acc;
        *self.ov |= wraps & !*self.un;
        *self.un &= !wraps;
    }

    #[inline]
    fn down(&mut self, counts: bool) {
        let (acc, wraps) = self.acc.overflowing_sub(i32::from(counts));
        *self.acc = acc;
        *self.un |= wraps & !*self.ov;
        *self.ov &= !wraps;
    }
}

/// `acc >= pre` as if `acc` had not wrapped.
#[inline]
fn done(acc: i32, pre: i32, ov: bool, un: bool) -> bool {
    ov | (!un & (acc >= pre))
}
