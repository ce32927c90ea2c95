#[derive(Clone, Copy)]
struct Average {
    x: f32,
    mean: f32,
    low: f32,
    high: f32,
    last: [f32; 32],
    pos: u16,
    filled: i16,
    sum: f32,
}

impl Average {
    const NEW: Self = Self { x: 0.0, mean: 0.0, low: 0.0, high: 0.0, last: [0.0; 32], pos: 0, filled: 0, sum: 0.0 };

    fn call(&mut self, x: f32) {
        self.x = x;
        let pos = usize::from(self.pos % 32);
        self.sum = self.sum - self.last[pos] + x;
        self.last[pos] = x;
        self.pos = (self.pos + 1) % 32;
        if self.filled < 32 {
            self.filled += 1;
        }
        self.mean = self.sum / f32::from(self.filled);
        let (mut low, mut high) = (self.last[0], self.last[0]);
        for value in &self.last[1..self.filled as usize] {
            low = if *value < low { *value } else { low };
            high = if *value > high { *value } else { high };
        }
        (self.low, self.high) = (low, high);
    }
}

pub struct Program {
    pub value: i16,
    a: Average,
    b: Average,
    pub out: f32,
}

impl Program {
    pub const NEW: Self = Self { value: 0, a: Average::NEW, b: Average::NEW, out: 0.0 };

    pub fn scan(&mut self, _: i64) {
        self.a.call(f32::from(self.value));
        self.b.call(self.a.mean * 0.5);
        self.out = self.b.mean + self.b.low + self.b.high;
    }
}
