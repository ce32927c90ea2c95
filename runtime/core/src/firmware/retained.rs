//! Retained variables as bytes that a firmware can keep anywhere: in flash, FRAM or battery-backed memory.
//!
//! A record is the program's fingerprint, the stamp, the variables' values in the order of their
//! declarations, and a CRC-32 of all of these; numbers are little endian.

use crate::text::Unit;
use crate::{Text, Time, crc32};
use core::fmt;

/// The start of a record; the digit is the version of its form.
const TITLE: [u8; 4] = *b"STR1";

/// The size of a record in addition to its values, in bytes.
pub const RECORD_OVERHEAD: usize = 24;

/// What a firmware writes in addition to the values. The later of two stamps is the greater one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Stamp {
    /// Increases with each record, so that the later of two records is known.
    pub sequence: u32,
    /// The program's clock, in nanoseconds: the time that was passed to `Context::at`. Retained timers continue from it.
    pub now: Time,
}

/// Why the bytes are not a valid record of the program's retained variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotRetained {
    /// No record was written there, or one with a version that this runtime does not know.
    Missing,
    /// Its checksum does not match: writing it was interrupted, or a bit has flipped.
    Damaged,
    /// It belongs to a program with different retained variables.
    OtherProgram,
}

impl fmt::Display for NotRetained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Missing => "the program has no retained variables",
            Self::Damaged => "the retained variables are damaged: their checksum does not match",
            Self::OtherProgram => "the retained variables are those of another program",
        })
    }
}

impl core::error::Error for NotRetained {}

/// Copies values to a record, or from one.
#[derive(Debug)]
pub struct Carrier<'a> {
    record: Record<'a>,
    at: usize,
}

#[derive(Debug)]
enum Record<'a> {
    Saved(&'a mut [u8]),
    Loaded(&'a [u8]),
}

impl Carrier<'_> {
    /// Copies a value for which all bytes are valid.
    #[inline]
    pub fn value(&mut self, value: &mut impl Carried) {
        value.carry(self);
    }

    /// Copies a number of a subrange: a number out of range becomes the nearer bound.
    #[inline]
    pub fn within<T: Carried + Copy + PartialOrd>(&mut self, value: &mut T, low: T, high: T) {
        value.carry(self);
        if *value < low {
            *value = low;
        } else if *value > high {
            *value = high;
        }
    }

    /// Copies these bytes to the record, or replaces them with those of the record.
    #[inline]
    fn bytes(&mut self, bytes: &mut [u8]) {
        let end = self.at + bytes.len();
        match &mut self.record {
            Record::Saved(record) => {
                for (to, from) in record.iter_mut().skip(self.at).zip(bytes.iter()) {
                    *to = *from;
                }
            }
            Record::Loaded(record) => {
                for (to, from) in bytes.iter_mut().zip(record.iter().skip(self.at)) {
                    *to = *from;
                }
            }
        }
        self.at = end;
    }
}

/// A type whose values a record can hold. A loaded value is always valid for its type, whatever bytes the record has.
pub trait Carried {
    /// Copies the value to the record, or from it.
    fn carry(&mut self, carrier: &mut Carrier<'_>);
}

macro_rules! numbers {
    ($($ty:ty)*) => {
        $(
            impl Carried for $ty {
                #[inline]
                fn carry(&mut self, carrier: &mut Carrier<'_>) {
                    let mut bytes = self.to_le_bytes();
                    carrier.bytes(&mut bytes);
                    *self = Self::from_le_bytes(bytes);
                }
            }
        )*
    };
}

numbers!(i8 i16 i32 i64 u8 u16 u32 u64 f32 f64);

/// Every byte except 0 is TRUE.
impl Carried for bool {
    #[inline]
    fn carry(&mut self, carrier: &mut Carrier<'_>) {
        let mut byte = u8::from(*self);
        byte.carry(carrier);
        *self = byte != 0;
    }
}

/// A length beyond the capacity is reduced to the capacity.
impl<const N: usize, U: Unit + Carried> Carried for Text<N, U> {
    fn carry(&mut self, carrier: &mut Carrier<'_>) {
        let mut length = self.as_units().len() as u16;
        let mut units = [U::ZERO; N];
        for (to, from) in units.iter_mut().zip(self.as_units()) {
            *to = *from;
        }
        length.carry(carrier);
        units.carry(carrier);
        *self = Self::new(units.get(..usize::from(length)).unwrap_or(&units));
    }
}

impl<T: Carried, const N: usize> Carried for [T; N] {
    fn carry(&mut self, carrier: &mut Carrier<'_>) {
        for element in self {
            element.carry(carrier);
        }
    }
}

/// Writes a record that fills `bytes`.
pub fn save(bytes: &mut [u8], program: u32, stamp: Stamp, carry: impl FnOnce(&mut Carrier<'_>)) {
    let Some((record, checksum)) = bytes.split_last_chunk_mut() else { return };
    let mut carrier = Carrier { record: Record::Saved(record), at: 0 };
    let (mut title, mut program, mut stamp) = (TITLE, program, stamp);
    carrier.bytes(&mut title);
    program.carry(&mut carrier);
    stamp.sequence.carry(&mut carrier);
    stamp.now.carry(&mut carrier);
    carry(&mut carrier);
    *checksum = crc32(record).to_le_bytes();
}

/// The stamp of the record at the start of `bytes`, which has `size` bytes and belongs to the program.
///
/// # Errors
/// The reason, if the bytes do not begin with such a record.
pub fn stamp(bytes: &[u8], size: usize, program: u32) -> Result<Stamp, NotRetained> {
    let record = bytes.get(..size).filter(|it| it.starts_with(&TITLE)).ok_or(NotRetained::Missing)?;
    let (record, checksum) = record.split_last_chunk().ok_or(NotRetained::Missing)?;
    let mut carrier = Carrier { record: Record::Loaded(record), at: TITLE.len() };
    let (mut theirs, mut stamp) = (0, Stamp::default());
    carrier.value(&mut theirs);
    // Of another program also the size is another, so that the checksum says nothing.
    if program != theirs {
        return Err(NotRetained::OtherProgram);
    }
    if crc32(record) != u32::from_le_bytes(*checksum) {
        return Err(NotRetained::Damaged);
    }
    carrier.value(&mut stamp.sequence);
    carrier.value(&mut stamp.now);
    Ok(stamp)
}

/// Reads a record, after it has been checked completely.
pub fn load(
    bytes: &[u8],
    size: usize,
    program: u32,
    carry: impl FnOnce(&mut Carrier<'_>),
) -> Result<Stamp, NotRetained> {
    let stamp = stamp(bytes, size, program)?;
    carry(&mut Carrier { record: Record::Loaded(bytes), at: RECORD_OVERHEAD - size_of::<u32>() });
    Ok(stamp)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROGRAM: u32 = 0x1234_5678;

    #[derive(Clone, Copy, Debug, PartialEq)]
    struct State {
        on: bool,
        level: i16,
        name: Text<4>,
        row: [f32; 2],
    }

    const SIZE: usize = RECORD_OVERHEAD + 1 + 2 + 6 + 8;
    const STATE: State = State { on: true, level: 7, name: Text::new(b"abc"), row: [1.5, -0.0] };
    const EMPTY: State = State { on: false, level: 0, name: Text::new(b""), row: [0.0; 2] };
    const STAMP: Stamp = Stamp { sequence: 3, now: 1_000_000 };

    fn carry(carrier: &mut Carrier<'_>, state: &mut State) {
        carrier.value(&mut state.on);
        carrier.within(&mut state.level, 0, 10);
        carrier.value(&mut state.name);
        carrier.value(&mut state.row);
    }

    fn saved() -> [u8; SIZE] {
        let (mut bytes, mut state) = ([0xFF; SIZE], STATE);
        save(&mut bytes, PROGRAM, STAMP, |it| carry(it, &mut state));
        assert_eq!(state, STATE);
        bytes
    }

    fn loaded(bytes: &[u8]) -> (Result<Stamp, NotRetained>, State) {
        let mut state = EMPTY;
        (load(bytes, SIZE, PROGRAM, |it| carry(it, &mut state)), state)
    }

    #[test]
    fn values_come_back() {
        assert_eq!(loaded(&saved()), (Ok(STAMP), STATE));
        // A page of flash is longer than the record.
        let mut page = [0xFF; SIZE + 20];
        page[..SIZE].copy_from_slice(&saved());
        assert_eq!(loaded(&page), (Ok(STAMP), STATE));
        assert_eq!(saved()[TITLE.len() + 16..][..5], [1, 7, 0, 3, 0]);
    }

    #[test]
    fn every_flipped_byte_and_every_prefix_is_refused_and_changes_nothing() {
        for at in 0..SIZE {
            let mut bytes = saved();
            bytes[at] ^= 0x10;
            let expected = match at {
                0..4 => NotRetained::Missing,
                4..8 => NotRetained::OtherProgram,
                _ => NotRetained::Damaged,
            };
            assert_eq!(loaded(&bytes), (Err(expected), EMPTY), "{at}");
            assert_eq!(loaded(&saved()[..at]), (Err(NotRetained::Missing), EMPTY), "{at}");
        }
        assert_eq!(loaded(&[0xFF; 4096]), (Err(NotRetained::Missing), EMPTY));
    }

    #[test]
    fn any_bytes_become_values() {
        let mut bytes = saved();
        bytes[RECORD_OVERHEAD - 4..SIZE - 4].fill(0xFF);
        let checksum = crc32(&bytes[..SIZE - 4]).to_le_bytes();
        bytes[SIZE - 4..].copy_from_slice(&checksum);
        let (stamp, state) = loaded(&bytes);
        assert_eq!(stamp, Ok(STAMP));
        assert_eq!((state.on, state.level, state.name), (true, 0, Text::new(&[0xFF; 4])));
        assert!(state.row[0].is_nan());
    }
}
