#[derive(Clone, Copy)]
struct Fifo {
    put: bool,
    take: bool,
    value: i32,
    out: i32,
    full: bool,
    empty: bool,
    count: i16,
    ring: [i32; 32],
    head: u16,
    tail: u16,
}

impl Fifo {
    const NEW: Self = Self {
        put: false,
        take: false,
        value: 0,
        out: 0,
        full: false,
        empty: false,
        count: 0,
        ring: [0; 32],
        head: 0,
        tail: 0,
    };

    #[inline]
    fn call(&mut self, put: bool, take: bool, value: i32) {
        (self.put, self.take, self.value) = (put, take, value);
        if put && self.count < 32 {
            self.ring[usize::from(self.head % 32)] = value;
            self.head = (self.head + 1) % 32;
            self.count += 1;
        }
        if take && self.count > 0 {
            self.out = self.ring[usize::from(self.tail % 32)];
            self.tail = (self.tail + 1) % 32;
            self.count -= 1;
        }
        self.full = self.count == 32;
        self.empty = self.count == 0;
    }
}

pub struct Program {
    pub put: bool,
    pub take: bool,
    pub value: i32,
    pub sum: i32,
    a: Fifo,
    b: Fifo,
}

impl Program {
    pub const NEW: Self = Self { put: false, take: false, value: 0, sum: 0, a: Fifo::NEW, b: Fifo::NEW };

    pub fn scan(&mut self, _: i64) {
        self.a.call(self.put, self.take, self.value);
        self.b.call(self.take && !self.a.empty, self.put, self.a.out);
        self.sum = self.sum.wrapping_add(self.a.out).wrapping_sub(self.b.out);
    }
}
