pub struct Program {
    pub word_in: u16,
    pub word_out: u16,
    changed: u16,
    before: u16,
    lamp: [bool; 16],
    pub ones: i16,
    pub parity: bool,
    any: bool,
    pub packed: u32,
}

impl Program {
    pub const NEW: Self = Self {
        word_in: 0,
        word_out: 0,
        changed: 0,
        before: 0,
        lamp: [false; 16],
        ones: 0,
        parity: false,
        any: false,
        packed: 0,
    };

    pub fn scan(&mut self, _: i64) {
        self.changed = self.word_in ^ self.before;
        self.before = self.word_in;
        for i in 0..8 {
            self.lamp[i] = self.word_in >> i & 1 == 1;
        }
        self.ones = self.word_in.count_ones() as i16;
        self.parity = self.ones % 2 == 1;
        self.any = self.changed != 0;
        let bits = [self.lamp[7], self.lamp[6], self.lamp[5] && self.any];
        let low = bits.iter().rev().fold(0, |word, bit| word << 1 | u16::from(*bit));
        self.word_out = self.word_out & 0x7FF8 | low | u16::from(self.parity) << 15;
        self.packed = u32::from(self.word_in) << 16 | u32::from(self.word_out.rotate_left(3));
    }
}
