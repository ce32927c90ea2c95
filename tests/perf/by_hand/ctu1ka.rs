use crate::blocks::Ctu;

pub struct Program {
    pub in0: bool,
    pub in1: bool,
    pub in3: bool,
    pub rst: bool,
    pub want: bool,
    c: [Ctu; 1000],
    pub sum: i32,
}

impl Program {
    pub const NEW: Self =
        Self { in0: false, in1: false, in3: false, rst: false, want: false, c: [Ctu::NEW; 1000], sum: 0 };

    pub fn scan(&mut self, _: i64) {
        let inputs = [self.in0, self.in1, self.in0, self.in3, self.in0, self.in1, self.in3, self.in0];
        for (i, counter) in self.c.iter_mut().enumerate() {
            counter.call(inputs[i & 7], self.rst, 30000);
        }
        if self.want {
            self.sum = (0..).zip(&self.c).map(|(i, it)| i32::from(it.cv) * (i % 7 + 1)).sum();
        }
    }
}
