//! `TIMER` with `TON`, `TOF`, `RTO` and `RES`, by Rockwell 1756-RM003, *Timer and Counter Instructions*.

use crate::block::pins;
use crate::{Context, Time};

/// `TIMER`, the tag of the instructions `TON`, `TOF`, `RTO` and `RES`. `pre` and `acc` count milliseconds, 0
/// or more: the compiler emits a check that faults before an instruction times with a negative value.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timer {
    /// The rung of the last execution.
    pub en: bool,
    /// Time is being added.
    pub tt: bool,
    pub dn: bool,
    pub pre: i32,
    pub acc: i32,
    /// Memory: when a timer whose rung lets it time was last executed, in milliseconds.
    pub last: Time,
}

const MILLISECOND: Time = 1_000_000;

impl Timer {
    /// `TON`: `dn` once the rung has been TRUE for `pre`. While it is FALSE, all but `pre` is cleared. A program
    /// that sets `dn` pauses the timer until it clears it. Returns the rung.
    #[inline]
    pub fn ton(&mut self, rung: bool, cx: &Context) -> bool {
        match rung {
            true => self.on_delay(cx),
            false => self.clear(0),
        }
        rung
    }

    /// `RTO`: like `TON`, but `acc` and `dn` stay as they are while the rung is FALSE; only `RES` clears them.
    /// Returns the rung.
    #[inline]
    pub fn rto(&mut self, rung: bool, cx: &Context) -> bool {
        match rung {
            true => self.on_delay(cx),
            false => (self.en, self.tt) = (false, false),
        }
        rung
    }

    /// `TOF`: `dn` while the rung is TRUE, and for `pre` after it falls. A program that clears `dn` pauses the
    /// timer until it sets it. Returns the rung.
    #[inline]
    pub fn tof(&mut self, rung: bool, cx: &Context) -> bool {
        match rung {
            true => (self.en, self.tt, self.dn, self.acc) = (true, false, true, 0),
            false => self.off_delay(cx),
        }
        rung
    }

    /// `RES`: while the rung is TRUE, clears everything but `pre`. Returns the rung.
    #[inline]
    pub fn res(&mut self, rung: bool) -> bool {
        if rung {
            self.clear(0);
        }
        rung
    }

    /// Before the first scan, for a timer that a `TON` works on: it starts again from 0.
    #[inline]
    pub fn prescan_ton(&mut self) {
        self.clear(0);
    }

    /// Before the first scan, for a timer that an `RTO` works on: it continues from its `acc`.
    #[inline]
    pub fn prescan_rto(&mut self) {
        self.clear(self.acc);
    }

    /// Before the first scan, for a timer that a `TOF` works on: nothing is timed before the rung is TRUE.
    #[inline]
    pub fn prescan_tof(&mut self) {
        self.clear(self.pre);
    }

    fn clear(&mut self, acc: i32) {
        (self.en, self.tt, self.dn, self.acc) = (false, false, false, acc);
    }

    fn on_delay(&mut self, cx: &Context) {
        let begins = !self.en;
        self.en = true;
        let is_over = self.time(cx, begins, !self.dn);
        self.dn |= is_over;
    }

    fn off_delay(&mut self, cx: &Context) {
        let begins = self.en;
        self.en = false;
        let is_over = self.time(cx, begins, self.dn);
        self.dn &= !is_over;
    }

    /// Adds the time since the last execution, unless it begins or is paused; returns whether `pre` is reached.
    fn time(&mut self, cx: &Context, begins: bool, runs: bool) -> bool {
        let now = cx.now().div_euclid(MILLISECOND);
        let passed = if begins { 0 } else { now.wrapping_sub(self.last).max(0) };
        self.last = now;
        if runs {
            self.acc = i32::try_from(passed).map_or(i32::MAX, |passed| self.acc.saturating_add(passed));
        }
        let is_over = runs & (self.acc >= self.pre);
        self.tt = runs & !is_over;
        is_over
    }
}

pins!([] Timer {
    Member { en: BOOL = "EN", tt: BOOL = "TT", dn: BOOL = "DN", pre: DINT = "PRE", acc: DINT = "ACC" }
    Memory { last: LINT = "last" }
});
