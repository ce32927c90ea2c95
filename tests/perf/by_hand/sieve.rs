pub struct Program {
    pub start: bool,
    composite: [bool; 4096],
    pub count: i32,
}

impl Program {
    pub const NEW: Self = Self { start: false, composite: [false; 4096], count: 0 };

    pub fn scan(&mut self, _: i64) {
        self.composite = [false; 4096];
        self.count = 0;
        for i in 2..4096 {
            if !self.composite[i] {
                self.count += 1;
                let mut multiple = i * i;
                while multiple < 4096 {
                    self.composite[multiple] = true;
                    multiple += i;
                }
            }
        }
    }
}
