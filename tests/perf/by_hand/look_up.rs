fn interpolate(x: f32, xs: &[f32; 12], ys: &[f32; 12]) -> f32 {
    if x <= xs[0] {
        return ys[0];
    }
    for i in 1..12 {
        if x <= xs[i] {
            return ys[i - 1] + (ys[i] - ys[i - 1]) * (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
        }
    }
    ys[11]
}

pub struct Program {
    pub x: i16,
    pub y: f32,
    pub sum: f32,
    xs: [f32; 12],
    ys: [f32; 12],
}

impl Program {
    pub const NEW: Self = Self {
        x: 0,
        y: 0.0,
        sum: 0.0,
        xs: [0.0, 50.0, 120.0, 200.0, 300.0, 420.0, 500.0, 610.0, 700.0, 810.0, 900.0, 1000.0],
        ys: [4.0, 5.5, 7.0, 6.0, 9.0, 12.5, 13.0, 15.0, 14.0, 18.0, 19.0, 20.0],
    };

    pub fn scan(&mut self, _: i64) {
        self.y = interpolate(f32::from(self.x), &self.xs, &self.ys);
        self.sum = self.sum * 0.9 + self.y;
    }
}
