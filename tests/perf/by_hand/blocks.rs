//! The standard's blocks as one writes them for speed: every pin is a field, and is stored.
#![allow(dead_code, reason = "a program uses some of them")]

#[derive(Clone, Copy)]
pub struct Ctu {
    pub cu: bool,
    pub r: bool,
    pub pv: i16,
    pub q: bool,
    pub cv: i16,
    before: bool,
}

impl Ctu {
    pub const NEW: Self = Self { cu: false, r: false, pv: 0, q: false, cv: 0, before: false };

    #[inline(always)]
    pub fn call(&mut self, cu: bool, r: bool, pv: i16) {
        (self.cu, self.r, self.pv) = (cu, r, pv);
        let edge = cu & !self.before;
        self.before = cu;
        let cv = if r { 0 } else { self.cv.saturating_add(i16::from(edge)) };
        self.cv = cv;
        self.q = cv >= pv;
    }
}

#[derive(Clone, Copy)]
pub struct Ctd {
    pub cd: bool,
    pub ld: bool,
    pub pv: i16,
    pub q: bool,
    pub cv: i16,
    before: bool,
}

impl Ctd {
    pub const NEW: Self = Self { cd: false, ld: false, pv: 0, q: false, cv: 0, before: false };

    #[inline(always)]
    pub fn call(&mut self, cd: bool, ld: bool, pv: i16) {
        (self.cd, self.ld, self.pv) = (cd, ld, pv);
        let edge = cd & !self.before;
        self.before = cd;
        let cv = if ld { pv } else { self.cv.saturating_sub(i16::from(edge)) };
        self.cv = cv;
        self.q = cv <= 0;
    }
}

#[derive(Clone, Copy)]
pub struct Ctud {
    pub cu: bool,
    pub cd: bool,
    pub r: bool,
    pub ld: bool,
    pub pv: i16,
    pub qu: bool,
    pub qd: bool,
    pub cv: i16,
    up_before: bool,
    down_before: bool,
}

impl Ctud {
    pub const NEW: Self = Self {
        cu: false,
        cd: false,
        r: false,
        ld: false,
        pv: 0,
        qu: false,
        qd: false,
        cv: 0,
        up_before: false,
        down_before: false,
    };

    #[inline(always)]
    pub fn call(&mut self, cu: bool, cd: bool, r: bool, ld: bool, pv: i16) {
        (self.cu, self.cd, self.r, self.ld, self.pv) = (cu, cd, r, ld, pv);
        let (up, down) = (cu & !self.up_before, cd & !self.down_before);
        (self.up_before, self.down_before) = (cu, cd);
        let cv = match (r, ld) {
            (true, _) => 0,
            (false, true) => pv,
            (false, false) => self.cv.saturating_add(i16::from(up) - i16::from(down)),
        };
        self.cv = cv;
        (self.qu, self.qd) = (cv >= pv, cv <= 0);
    }
}

/// TON, TOF and TP; times are in nanoseconds.
#[derive(Clone, Copy)]
pub struct Timer {
    pub input: bool,
    pub pt: i64,
    pub q: bool,
    pub et: i64,
    start: i64,
    running: bool,
}

impl Timer {
    pub const NEW: Self = Self { input: false, pt: 0, q: false, et: 0, start: 0, running: false };

    #[inline(always)]
    pub fn on(&mut self, input: bool, pt: i64, now: i64) {
        let before = self.input;
        (self.input, self.pt) = (input, pt);
        if !input {
            (self.q, self.et) = (false, 0);
        } else if !self.q {
            if !before {
                self.start = now;
            }
            let elapsed = now - self.start;
            self.q = elapsed >= pt;
            self.et = elapsed.min(pt);
        }
    }

    #[inline(always)]
    pub fn off(&mut self, input: bool, pt: i64, now: i64) {
        let before = self.input;
        (self.input, self.pt) = (input, pt);
        if input {
            (self.q, self.et) = (true, 0);
        } else if self.q {
            if before {
                self.start = now;
            }
            let elapsed = now - self.start;
            self.q = elapsed < pt;
            self.et = elapsed.min(pt);
        }
    }

    #[inline(always)]
    pub fn pulse(&mut self, input: bool, pt: i64, now: i64) {
        let before = self.input;
        (self.input, self.pt) = (input, pt);
        if self.running {
            let elapsed = now - self.start;
            self.running = elapsed < pt;
            self.et = elapsed.min(pt);
        } else if input & !before {
            (self.running, self.start, self.et) = (true, now, 0);
        }
        self.q = self.running;
        if !self.running & !input {
            self.et = 0;
        }
    }
}

/// R_TRIG and F_TRIG.
#[derive(Clone, Copy)]
pub struct Edge {
    pub clk: bool,
    pub q: bool,
}

impl Edge {
    pub const NEW: Self = Self { clk: false, q: false };

    #[inline(always)]
    pub fn rising(&mut self, clk: bool) {
        self.q = clk & !self.clk;
        self.clk = clk;
    }

    #[inline(always)]
    pub fn falling(&mut self, clk: bool) {
        self.q = !clk & self.clk;
        self.clk = clk;
    }
}

/// SR and RS.
#[derive(Clone, Copy)]
pub struct Latch {
    pub set: bool,
    pub reset: bool,
    pub q: bool,
}

impl Latch {
    pub const NEW: Self = Self { set: false, reset: false, q: false };

    #[inline(always)]
    pub fn sr(&mut self, set: bool, reset: bool) {
        (self.set, self.reset) = (set, reset);
        self.q = set | (self.q & !reset);
    }

    #[inline(always)]
    pub fn rs(&mut self, set: bool, reset: bool) {
        (self.set, self.reset) = (set, reset);
        self.q = !reset & (set | self.q);
    }
}
