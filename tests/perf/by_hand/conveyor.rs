use crate::blocks::{Ctu, Edge, Latch, Timer};

pub struct Program {
    pub start: bool,
    pub stop: bool,
    pub jam: bool,
    pub r#box: bool,
    motor: bool,
    pub lamp: bool,
    pub horn: bool,
    pub ready: bool,
    pub boxes: i32,
    pub jams: i32,
    seen: Edge,
    stuck: Edge,
    latch: Latch,
    delay: Timer,
    off: Timer,
    after: Timer,
    batch: Ctu,
}

impl Program {
    pub const NEW: Self = Self {
        start: false,
        stop: false,
        jam: false,
        r#box: false,
        motor: false,
        lamp: false,
        horn: false,
        ready: false,
        boxes: 0,
        jams: 0,
        seen: Edge::NEW,
        stuck: Edge::NEW,
        latch: Latch::NEW,
        delay: Timer::NEW,
        off: Timer::NEW,
        after: Timer::NEW,
        batch: Ctu::NEW,
    };

    pub fn scan(&mut self, now: i64) {
        self.latch.rs(self.start & !self.jam, self.stop | self.jam);
        self.delay.on(self.latch.q, 5_000_000, now);
        self.motor = self.delay.q & !self.jam;
        self.after.off(self.motor, 15_000_000, now);
        self.seen.rising(self.r#box & self.motor);
        self.boxes = self.boxes.wrapping_add(i32::from(self.seen.q));
        self.stuck.rising(self.jam);
        self.jams = self.jams.wrapping_add(i32::from(self.stuck.q));
        let full = self.batch.q;
        self.batch.call(self.seen.q, full, 12);
        self.off.on(!self.motor, 50_000_000, now);
        self.ready = self.off.q & !self.after.q;
        self.lamp = self.motor | (self.after.q & !self.ready);
        self.horn = self.jam | self.batch.q;
    }
}
