use crate::blocks::{Edge, Timer};

#[derive(Clone, Copy)]
struct Limits {
    x: f32,
    low: f32,
    high: f32,
    band: f32,
    acknowledge: bool,
    too_low: bool,
    too_high: bool,
    alarm: bool,
    count: i16,
    edge: Edge,
    delay: Timer,
}

impl Limits {
    const NEW: Self = Self {
        x: 0.0,
        low: 0.0,
        high: 0.0,
        band: 0.0,
        acknowledge: false,
        too_low: false,
        too_high: false,
        alarm: false,
        count: 0,
        edge: Edge::NEW,
        delay: Timer::NEW,
    };

    fn call(&mut self, x: f32, low: f32, high: f32, band: f32, acknowledge: bool, now: i64) {
        (self.x, self.low, self.high, self.band, self.acknowledge) = (x, low, high, band, acknowledge);
        if x > high {
            self.too_high = true;
        } else if x < high - band {
            self.too_high = false;
        }
        if x < low {
            self.too_low = true;
        } else if x > low + band {
            self.too_low = false;
        }
        self.delay.on(self.too_low | self.too_high, 10_000_000, now);
        self.edge.rising(self.delay.q);
        if self.edge.q {
            self.alarm = true;
            self.count = self.count.wrapping_add(1);
        }
        if acknowledge && !self.delay.q {
            self.alarm = false;
        }
    }
}

pub struct Program {
    pub value: i16,
    points: [Limits; 16],
    pub any: bool,
}

impl Program {
    pub const NEW: Self = Self { value: 0, points: [Limits::NEW; 16], any: false };

    pub fn scan(&mut self, now: i64) {
        self.any = false;
        for (i, point) in (0_i16..).zip(&mut self.points) {
            point.call(f32::from(self.value.wrapping_add(i * 10)), 50.0, 450.0, 5.0, i == 3, now);
            self.any |= point.alarm;
        }
    }
}
