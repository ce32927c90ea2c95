#[derive(Clone, Copy)]
struct Biquad {
    x: f64,
    b: [f64; 3],
    a: [f64; 2],
    y: f64,
    x1: f64,
    x2: f64,
    y1: f64,
    y2: f64,
}

impl Biquad {
    const NEW: Self = Self { x: 0.0, b: [0.0; 3], a: [0.0; 2], y: 0.0, x1: 0.0, x2: 0.0, y1: 0.0, y2: 0.0 };

    #[inline]
    fn call(&mut self, x: f64, b: [f64; 3], a: [f64; 2]) -> f64 {
        (self.x, self.b, self.a) = (x, b, a);
        self.y = b[0] * x + b[1] * self.x1 + b[2] * self.x2 - a[0] * self.y1 - a[1] * self.y2;
        (self.x2, self.x1, self.y2, self.y1) = (self.x1, x, self.y1, self.y);
        self.y
    }
}

pub struct Program {
    pub x: i16,
    sections: [Biquad; 4],
    pub out: f64,
}

impl Program {
    pub const NEW: Self = Self { x: 0, sections: [Biquad::NEW; 4], out: 0.0 };

    pub fn scan(&mut self, _: i64) {
        let [a, b, c, d] = &mut self.sections;
        let first = a.call(f64::from(self.x), [0.2, 0.4, 0.2], [-0.37, 0.19]);
        let second = b.call(first, [0.2, 0.4, 0.2], [-0.37, 0.19]);
        let third = c.call(second, [0.3, 0.3, 0.1], [-0.3, 0.1]);
        self.out = d.call(third, [0.3, 0.3, 0.1], [-0.3, 0.1]);
    }
}
