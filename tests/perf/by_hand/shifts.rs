pub struct Program {
    pub x: u32,
    gray: u32,
    pub back: u32,
    pub mixed: u32,
    pub n: u32,
}

impl Program {
    pub const NEW: Self = Self { x: 0, gray: 0, back: 0, mixed: 0, n: 0 };

    pub fn scan(&mut self, _: i64) {
        self.gray = self.x ^ self.x >> 1;
        let mut back = self.gray;
        for _ in 0..5 {
            back ^= back >> 1;
        }
        self.back = back;
        self.mixed = self.x.rotate_left(7) ^ self.gray.rotate_right(13) ^ back << 3;
        self.n = (self.mixed & 0xFFFF) / 7 + self.x % 13;
    }
}
