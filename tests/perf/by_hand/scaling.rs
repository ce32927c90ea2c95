fn scale(raw: i16, low: i16, high: i16, from: f32, to: f32) -> f32 {
    if raw <= low {
        from
    } else if raw >= high {
        to
    } else {
        from + (to - from) * f32::from(raw - low) / f32::from(high - low)
    }
}

pub struct Program {
    pub raw0: i16,
    raw: [i16; 16],
    level: [f32; 16],
    pub total: f32,
    pub highs: i32,
}

impl Program {
    pub const NEW: Self = Self { raw0: 0, raw: [0; 16], level: [0.0; 16], total: 0.0, highs: 0 };

    pub fn scan(&mut self, _: i64) {
        for i in 0..16 {
            self.raw[i] = self.raw0.wrapping_add(i as i16 * 100);
        }
        self.total = 0.0;
        for i in 0..16 {
            self.level[i] = scale(self.raw[i], 4000, 20000, 0.0, 150.0);
            self.total += self.level[i];
            if self.level[i] > 140.0 {
                self.highs += 1;
            }
        }
    }
}
