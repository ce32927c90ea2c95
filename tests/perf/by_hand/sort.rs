pub struct Program {
    pub seed: i32,
    a: [i32; 256],
    pub chk: i32,
}

impl Program {
    pub const NEW: Self = Self { seed: 0, a: [0; 256], chk: 0 };

    pub fn scan(&mut self, _: i64) {
        for value in &mut self.a {
            self.seed = self.seed.wrapping_mul(1103).wrapping_add(12345) % 65536;
            *value = self.seed;
        }
        for i in 0..255 {
            // The greatest so far is carried, and written where it stays.
            let rest = &mut self.a[..256 - i];
            let mut carried = rest[0];
            for j in 1..rest.len() {
                let next = rest[j];
                rest[j - 1] = carried.min(next);
                carried = carried.max(next);
            }
            rest[rest.len() - 1] = carried;
        }
        self.chk = self.chk.wrapping_add(self.a[0]).wrapping_add(self.a[128].wrapping_mul(3)).wrapping_add(self.a[255]);
        if self.chk > 1_000_000_000 {
            self.chk -= 1_000_000_000;
        }
    }
}
