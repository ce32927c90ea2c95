pub struct Program {
    pub a: bool,
    pub b: bool,
}

impl Program {
    pub const NEW: Self = Self { a: false, b: false };

    pub fn scan(&mut self, _: i64) {
        self.b = self.a;
    }
}
