pub struct Program {
    pub code: i16,
    pub kind: i16,
    pub a: i32,
    pub b: i32,
    pub c: i32,
    pub other: i32,
}

impl Program {
    pub const NEW: Self = Self { code: 0, kind: 0, a: 0, b: 0, c: 0, other: 0 };

    pub fn scan(&mut self, _: i64) {
        match self.code {
            0..=9 => {
                self.kind = 1;
                self.a = self.a.wrapping_add(1);
            }
            10..=49 | 60..=69 => {
                self.kind = 2;
                self.b = self.b.wrapping_add(i32::from(self.code));
            }
            50..=59 => self.kind = 3,
            100 | 150 | 200 | 250 => {
                self.kind = 4;
                self.c = self.c.wrapping_add(1);
            }
            300..=399 => {
                self.kind = 5;
                if self.code % 2 == 0 {
                    self.c = self.c.wrapping_sub(1);
                }
            }
            _ => {
                self.kind = 0;
                self.other = self.other.wrapping_add(1);
            }
        }
    }
}
