use crate::blocks::{Ctu, Edge, Timer};

pub struct Program {
    pub go: bool,
    x: bool,
    r: Edge,
    c: Ctu,
    t: Timer,
    pub n: i32,
}

impl Program {
    pub const NEW: Self = Self { go: false, x: false, r: Edge::NEW, c: Ctu::NEW, t: Timer::NEW, n: 0 };

    pub fn scan(&mut self, now: i64) {
        self.x = !self.x;
        self.r.rising(self.x);
        let full = self.c.q;
        self.c.call(self.r.q, full, 100);
        self.t.on(self.go & (self.c.cv > 50), 20_000_000, now);
        self.n = self.n.wrapping_add(i32::from(self.t.q));
    }
}
