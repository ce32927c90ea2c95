//! `FBD_TIMER` with `TONR`, `TOFR` and `RTOR`, by Rockwell 1756-RM003, *Timer and Counter Instructions*.

use crate::block::pins;
use crate::{Context, Time};

/// `FBD_TIMER`, the tag of the instructions `TONR`, `TOFR` and `RTOR`. A program sets its inputs as
/// members; `pre` and `acc` count milliseconds.
///
/// The vendor's tag starts with `enable_in` TRUE; [`new`](Self::new) is all zero, so set it after
/// you create an instance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FbdTimer {
    /// FALSE: the instruction does nothing.
    pub enable_in: bool,
    pub timer_enable: bool,
    /// 0 or more; with a negative preset the instruction is not executed.
    pub pre: i32,
    pub reset: bool,
    pub enable_out: bool,
    pub acc: i32,
    pub en: bool,
    pub tt: bool,
    pub dn: bool,
    /// Bit 0 is `instruct_fault`, bit 1 `preset_inv`.
    pub status: i32,
    pub instruct_fault: bool,
    pub preset_inv: bool,
    /// Memory: the last call had `enable_in`.
    pub enabled_before: bool,
    /// Memory: when `acc` was last brought up to date.
    pub last: Time,
}

const MILLISECOND: Time = 1_000_000;

impl FbdTimer {
    /// `TONR`: `dn` once `timer_enable` has been TRUE for `pre`. When it falls, and while `reset`, all
    /// outputs are cleared.
    #[inline]
    pub fn tonr(&mut self, cx: &Context) {
        if self.executes(cx, |_, _| 0) {
            match self.timer_enable & !self.reset {
                true => self.time(cx, false),
                false => self.clear(0),
            }
        }
    }

    /// `RTOR`: like `TONR`, but `acc` and `dn` stay as they are when `timer_enable` falls; only `reset` clears
    /// them.
    #[inline]
    pub fn rtor(&mut self, cx: &Context) {
        if self.executes(cx, |acc, _| acc) {
            match (self.reset, self.timer_enable) {
                (true, _) => self.clear(0),
                (false, true) => self.time(cx, false),
                (false, false) => (self.en, self.tt) = (false, false),
            }
        }
    }

    /// `TOFR`: `dn` while `timer_enable`, and for `pre` after it falls. While `reset`, and in the first scan,
    /// `acc` is at `pre`, so that nothing is timed before `timer_enable` is TRUE again.
    #[inline]
    pub fn tofr(&mut self, cx: &Context) {
        if self.executes(cx, |_, pre| pre) {
            match (self.reset, self.timer_enable) {
                (true, _) => self.clear(self.pre),
                (false, true) => (self.en, self.tt, self.dn, self.acc) = (true, false, true, 0),
                (false, false) => self.time(cx, true),
            }
        }
    }

    /// Whether the instruction is executed. In the first scan, in its first run, and when `enable_in`
    /// rises, the flags are cleared first, and `initial` computes `acc` from its old value and `pre`.
    fn executes(&mut self, cx: &Context, initial: fn(i32, i32) -> i32) -> bool {
        let starts = self.enable_in & (cx.first_scan | !self.enabled_before);
        if !self.enable_in {
            (self.enable_out, self.enabled_before) = (false, false);
            return false;
        }
        let is_valid = self.pre >= 0;
        (self.enable_out, self.instruct_fault, self.preset_inv) = (is_valid, !is_valid, !is_valid);
        self.status = if is_valid { 0 } else { 3 };
        if is_valid {
            self.enabled_before = true;
            if starts {
                self.clear(initial(self.acc, self.pre));
            }
        }
        is_valid
    }

    fn clear(&mut self, acc: i32) {
        (self.en, self.tt, self.dn, self.acc) = (false, false, false, acc);
    }

    /// Adds the time since the last execution, if that was timing too; `dn` at the end of an off delay
    /// is FALSE, at that of an on delay TRUE. Time in which the instruction was not executed counts.
    fn time(&mut self, cx: &Context, off: bool) {
        let begins = self.en == off;
        self.en = !off;
        if self.dn != off {
            self.tt = false;
            return;
        }
        let now = cx.now().div_euclid(MILLISECOND);
        let passed = if begins { 0 } else { now.wrapping_sub(self.last).max(0) };
        self.last = now;
        self.acc = i32::try_from(passed).map_or(i32::MAX, |passed| self.acc.saturating_add(passed));
        let is_over = self.acc >= self.pre;
        (self.tt, self.dn) = (!is_over, is_over != off);
    }
}

pins!([] FbdTimer {
    Member {
        enable_in: BOOL = "EnableIn" true, timer_enable: BOOL = "TimerEnable", pre: DINT = "PRE", reset: BOOL = "Reset",
        enable_out: BOOL = "EnableOut", acc: DINT = "ACC", en: BOOL = "EN", tt: BOOL = "TT", dn: BOOL = "DN",
        status: DINT = "Status", instruct_fault: BOOL = "InstructFault", preset_inv: BOOL = "PresetInv",
    }
    Memory { enabled_before: BOOL = "enabled_before", last: LINT = "last" }
});
