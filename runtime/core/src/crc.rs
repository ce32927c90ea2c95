//! The checksum of retained variables, both in a host's file and in a firmware's memory.

/// CRC-32 (IEEE 802.3, as in Ethernet and ZIP) of bytes that arrive in pieces.
#[derive(Clone, Copy, Debug)]
pub struct Crc32(u32);

impl Crc32 {
    pub const fn new() -> Self {
        Self(u32::MAX)
    }

    /// Continues with these bytes.
    #[must_use]
    pub const fn with(self, bytes: &[u8]) -> Self {
        let (mut crc, mut at) = (self.0, 0);
        while at < bytes.len() {
            crc ^= bytes[at] as u32;
            crc = TABLE[(crc & 15) as usize] ^ (crc >> 4);
            crc = TABLE[(crc & 15) as usize] ^ (crc >> 4);
            at += 1;
        }
        Self(crc)
    }

    pub const fn value(self) -> u32 {
        !self.0
    }
}

impl Default for Crc32 {
    fn default() -> Self {
        Self::new()
    }
}

/// CRC-32 (IEEE 802.3) of bytes.
pub const fn crc32(bytes: &[u8]) -> u32 {
    Crc32::new().with(bytes).value()
}

/// For four bits at a time: a table for eight would take a kilobyte of a small machine's flash.
const TABLE: [u32; 16] = table();

const fn table() -> [u32; 16] {
    let mut table = [0; 16];
    let mut at = 0;
    while at < table.len() {
        let mut crc = at as u32;
        let mut bit = 0;
        while bit < 4 {
            crc = (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg());
            bit += 1;
        }
        table[at] = crc;
        at += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_usual_one() {
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
        assert_eq!(crc32(b""), 0);
        assert_eq!(Crc32::new().with(b"1234").with(b"").with(b"56789").value(), 0xCBF4_3926);
    }
}
