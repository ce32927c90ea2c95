pub struct Program {
    pub seed: u8,
    data: [u8; 64],
    pub crc: u16,
}

impl Program {
    pub const NEW: Self = Self { seed: 0, data: [0; 64], crc: 0 };

    pub fn scan(&mut self, _: i64) {
        for i in 0..64 {
            self.data[i] = self.seed.wrapping_add(i as u8);
        }
        let mut crc = 0xFFFF_u16;
        for byte in self.data {
            crc ^= u16::from(byte);
            for _ in 0..8 {
                crc = if crc & 1 == 1 { crc >> 1 ^ 0xA001 } else { crc >> 1 };
            }
        }
        self.crc = crc;
    }
}
