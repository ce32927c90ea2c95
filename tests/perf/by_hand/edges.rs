use crate::blocks::Edge;

pub struct Program {
    pub in_word: u16,
    pub rises: i32,
    pub falls: i32,
    rising: [Edge; 8],
    falling: [Edge; 8],
}

impl Program {
    pub const NEW: Self = Self { in_word: 0, rises: 0, falls: 0, rising: [Edge::NEW; 8], falling: [Edge::NEW; 8] };

    pub fn scan(&mut self, _: i64) {
        for i in 0..8 {
            self.rising[i].rising(self.in_word >> i & 1 == 1);
            self.rises = self.rises.wrapping_add(i32::from(self.rising[i].q));
            self.falling[i].falling(self.in_word >> (i + 8) & 1 == 1);
            self.falls = self.falls.wrapping_add(i32::from(self.falling[i].q));
        }
    }
}
