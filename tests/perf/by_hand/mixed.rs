use crate::blocks::{Ctd, Ctu, Ctud, Edge, Latch, Timer};

/// The program has a hundred of these by name; by hand they are an array.
#[derive(Clone, Copy)]
struct Group {
    up: Ctu,
    down: Ctd,
    both: Ctud,
    on: Timer,
    off: Timer,
    pulse: Timer,
    edge: Edge,
    latch: Latch,
    n: i16,
    x: f32,
}

impl Group {
    const NEW: Self = Self {
        up: Ctu::NEW,
        down: Ctd::NEW,
        both: Ctud::NEW,
        on: Timer::NEW,
        off: Timer::NEW,
        pulse: Timer::NEW,
        edge: Edge::NEW,
        latch: Latch::NEW,
        n: 0,
        x: 0.0,
    };

    #[inline(always)]
    fn call(&mut self, input: bool, up: bool, down: bool, reset: bool, preset: i16, now: i64) {
        self.up.call(input, reset, preset);
        self.down.call(input, reset, preset);
        self.both.call(up, down, reset, false, 48);
        self.on.on(self.up.q, 1_000_000, now);
        self.off.off(self.both.qu, 30_000_000, now);
        self.pulse.pulse(input, 5_000_000, now);
        self.edge.rising(self.pulse.q);
        self.latch.sr(self.edge.q, self.on.q);
        self.n = match self.latch.q | self.off.q {
            true => self.n.wrapping_add(self.up.cv).wrapping_sub(self.down.cv),
            false => self.n / 2,
        };
        if self.n > 10000 || self.n < -10000 {
            self.n = 0;
        }
        self.x = self.x * 0.9 + f32::from(self.n) * 0.1;
    }
}

const UP: [usize; 6] = [0, 1, 2, 4, 5, 7];
const DOWN: [usize; 2] = [3, 6];
const PRESET: [i16; 8] = [95, 95, 95, 47, 95, 95, 47, 95];

pub struct Program {
    pub in0: bool,
    pub in1: bool,
    pub in2: bool,
    pub in3: bool,
    pub in4: bool,
    pub in5: bool,
    pub in6: bool,
    pub in7: bool,
    pub rst: bool,
    groups: [Group; 100],
    pub n0: i16,
    pub n99: i16,
    pub x0: f32,
    pub x99: f32,
}

impl Program {
    pub const NEW: Self = Self {
        in0: false,
        in1: false,
        in2: false,
        in3: false,
        in4: false,
        in5: false,
        in6: false,
        in7: false,
        rst: false,
        groups: [Group::NEW; 100],
        n0: 0,
        n99: 0,
        x0: 0.0,
        x99: 0.0,
    };

    pub fn scan(&mut self, now: i64) {
        let inputs = [self.in0, self.in1, self.in2, self.in3, self.in4, self.in5, self.in6, self.in7];
        for (i, group) in self.groups.iter_mut().enumerate() {
            let (up, down) = (inputs[UP[i % 6]], inputs[DOWN[i & 1]]);
            group.call(inputs[i & 7], up, down, self.rst, PRESET[i & 7], now);
        }
        let (first, last) = (&self.groups[0], &self.groups[99]);
        (self.n0, self.x0, self.n99, self.x99) = (first.n, first.x, last.n, last.x);
    }
}
