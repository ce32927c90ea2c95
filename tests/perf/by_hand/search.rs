use core::cmp::Ordering;

pub struct Program {
    pub key: i16,
    pub pos: i16,
    keys: [i16; 128],
    pub hits: i32,
    pub probes: i32,
    started: bool,
}

impl Program {
    pub const NEW: Self = Self { key: 0, pos: 0, keys: [0; 128], hits: 0, probes: 0, started: false };

    pub fn scan(&mut self, _: i64) {
        if !self.started {
            self.started = true;
            for i in 0..128 {
                self.keys[i] = i as i16 * 3;
            }
        }
        let (mut low, mut high) = (0_i16, 127_i16);
        self.pos = -1;
        while low <= high {
            let middle = (low + high) / 2;
            self.probes += 1;
            match self.keys[middle as usize & 127].cmp(&self.key) {
                Ordering::Equal => {
                    self.pos = middle;
                    break;
                }
                Ordering::Less => low = middle + 1,
                Ordering::Greater => high = middle - 1,
            }
        }
        if self.pos >= 0 {
            self.hits += 1;
        }
    }
}
