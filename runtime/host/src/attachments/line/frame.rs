//! Frames of Modbus RTU, as "MODBUS over Serial Line Specification and Implementation Guide V1.02" has them: a unit, a request or answer, and a
//! CRC, with silence before and after.

use crate::remote::{Line, Parity};
use std::time::Duration;

/// Bytes of a frame.
pub(crate) const MOST: usize = 256;
/// A unit, a function and a CRC.
pub(crate) const LEAST: usize = 4;
/// Silence that ends a frame of which more is expected. 3.5 characters are less, but an adapter at USB hands bytes over every 16 ms, and a thread
/// may have to wait for a processor.
pub(crate) const PAUSE: Duration = Duration::from_millis(50);
/// Above 19200 bits a second, the specification has this silence between frames, and not that of 3.5 characters (2.5.1.1).
pub(crate) const LEAST_SILENCE: Duration = Duration::from_micros(1750);

/// Times of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timing {
    /// How long a byte is on the line.
    pub character: Duration,
    /// Between two frames.
    pub silence: Duration,
}

impl Timing {
    pub fn of(line: &Line) -> Self {
        let parity = u32::from(line.parity != Parity::None);
        let bits = 1 + 8 + parity + u32::from(line.stop_bits);
        let character = Duration::from_secs(1) * bits / line.baud_rate;
        let silence = match line.baud_rate {
            0..=19200 => character * 7 / 2,
            _ => LEAST_SILENCE,
        };
        Self { character, silence }
    }
}

/// Ends a frame with its CRC.
pub(crate) fn close(frame: &mut Vec<u8>) {
    let crc = crc(frame);
    frame.extend(crc.to_le_bytes());
}

/// Whether it is a frame with a right CRC.
pub(crate) fn is_whole(frame: &[u8]) -> bool {
    // The CRC of a frame and its own CRC is 0.
    (LEAST..=MOST).contains(&frame.len()) && crc(frame) == 0
}

/// Where the first frame with a right CRC ends that the bytes begin with.
pub(crate) fn first_whole(bytes: &[u8]) -> Option<usize> {
    let mut crc = START;
    let ends = bytes.iter().take(MOST).zip(1..).filter_map(|(byte, end)| {
        crc = added(crc, *byte);
        (crc == 0 && end >= LEAST).then_some(end)
    });
    ends.min()
}

const START: u16 = 0xFFFF;

/// The CRC of a frame: 2.5.1.2, with its low byte first on the line.
fn crc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(START, |crc, byte| added(crc, *byte))
}

fn added(crc: u16, byte: u8) -> u16 {
    const POLYNOMIAL: u16 = 0xA001;
    let shifted = |crc: u16| if crc & 1 == 0 { crc >> 1 } else { crc >> 1 ^ POLYNOMIAL };
    (0..8).fold(crc ^ u16::from(byte), |crc, _| shifted(crc))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first is of the specification, 6.2.2, the second of a frame that many pages have.
    #[test]
    fn the_crc_is_that_of_the_specification() {
        assert_eq!(crc(&[2, 7]), 0x1241);
        let mut frame = vec![1, 3, 0, 0, 0, 10];
        close(&mut frame);
        assert_eq!(frame[6..], [0xC5, 0xCD]);
        assert!(is_whole(&frame) && !is_whole(&frame[1..]));
        assert_eq!(first_whole(&[&frame[..], &frame].concat()), Some(8));
    }
}
