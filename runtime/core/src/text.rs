//! Character strings: a fixed capacity in place, no heap. Text that does not fit is cut.
//!
//! The functions count bytes, positions from 1. A count or position out of range acts as the
//! nearest one that is in range, so a negative count acts as 0.

mod conversion;

pub use conversion::*;

use core::fmt;

/// A STRING of at most `N` bytes. The bytes past its length are zero, so equal strings are equal
/// in memory.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Text<const N: usize> {
    len: u16,
    bytes: [u8; N],
}

impl<const N: usize> Text<N> {
    /// The start of `bytes`, as much as fits.
    pub const fn new(bytes: &[u8]) -> Self {
        const { assert!(N <= u16::MAX as usize, "a string holds at most 65535 bytes") };
        let mut text = Self { len: 0, bytes: [0; N] };
        let mut at = 0;
        while at < N && at < bytes.len() {
            text.bytes[at] = bytes[at];
            at += 1;
        }
        text.len = at as u16;
        text
    }

    /// What `write` puts into its destination.
    #[inline]
    pub fn build(write: impl FnOnce(&mut Destination<'_>)) -> Self {
        let mut text = Self::default();
        write(&mut text.destination());
        text
    }

    /// Another string, cut if it is longer than `N`.
    #[inline]
    pub fn from_text<const M: usize>(other: &Text<M>) -> Self {
        Self::build(|out| out.write(other.as_bytes()))
    }

    #[inline]
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..usize::from(self.len)).unwrap_or(&self.bytes)
    }

    /// Becomes the start of `bytes`, as much as fits.
    #[inline]
    pub fn assign(&mut self, bytes: &[u8]) {
        self.destination().write(bytes);
    }

    /// A byte of the string as it lies in memory: its length, then its characters.
    pub(crate) fn raw_byte(&self, at: usize) -> u8 {
        let [low, high] = self.len.to_ne_bytes();
        match at {
            0 => low,
            1 => high,
            at => self.bytes.get(at - 2).copied().unwrap_or_default(),
        }
    }

    pub(crate) fn set_raw_byte(&mut self, at: usize, byte: u8) {
        let [low, high] = self.len.to_ne_bytes();
        match at {
            0 => self.len = u16::from_ne_bytes([byte, high]),
            1 => self.len = u16::from_ne_bytes([low, byte]),
            at => {
                if let Some(place) = self.bytes.get_mut(at - 2) {
                    *place = byte;
                }
            }
        }
    }

    /// Empties the string, for writing it anew.
    #[inline]
    pub fn destination(&mut self) -> Destination<'_> {
        Destination::new(&mut self.len, &mut self.bytes)
    }
}

impl<const N: usize> Default for Text<N> {
    #[inline]
    fn default() -> Self {
        Self::new(&[])
    }
}

impl<const N: usize> fmt::Debug for Text<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "'{}'", self.as_bytes().escape_ascii())
    }
}

/// Bytes that are not UTF-8 show as U+FFFD.
impl<const N: usize> fmt::Display for Text<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for chunk in self.as_bytes().utf8_chunks() {
            f.write_str(chunk.valid())?;
            if !chunk.invalid().is_empty() {
                f.write_str("\u{FFFD}")?;
            }
        }
        Ok(())
    }
}

/// Where a string function writes: the length and the bytes of a string of any capacity.
#[derive(Debug)]
pub struct Destination<'a> {
    len: &'a mut u16,
    bytes: &'a mut [u8],
}

impl<'a> Destination<'a> {
    /// An empty string in `bytes`, which are set to zero.
    #[inline]
    pub fn new(len: &'a mut u16, bytes: &'a mut [u8]) -> Self {
        *len = 0;
        bytes.fill(0);
        Self { len, bytes }
    }

    /// Appends as much of `bytes` as still fits.
    #[inline]
    pub fn write(&mut self, bytes: &[u8]) {
        let free = self.bytes.get_mut(usize::from(*self.len)..).unwrap_or_default();
        let count = free.len().min(bytes.len()).min(usize::from(u16::MAX - *self.len));
        for (to, from) in free.iter_mut().zip(bytes).take(count) {
            *to = *from;
        }
        *self.len += count as u16;
    }
}

/// The order of two strings, byte by byte: -1, 0 or 1. A string comes after those it begins with.
///
/// ```
/// use staunch_runtime::text::compare;
/// assert_eq!(compare(b"ab", b"abc"), -1);
/// assert_eq!(compare(b"b", b"abc"), 1);
/// ```
#[inline]
pub fn compare(a: &[u8], b: &[u8]) -> i16 {
    a.cmp(b) as i16
}

/// `LEN`: the number of bytes; 32767 if there are more.
#[inline]
pub fn len(text: &[u8]) -> i16 {
    saturated(text.len())
}

/// `FIND`: the position at which `pattern` first occurs; 0 if it does not, or is empty.
///
/// ```
/// use staunch_runtime::text::find;
/// assert_eq!(find(b"ABCBC", b"BC"), 2);
/// assert_eq!(find(b"ABCBC", b"X"), 0);
/// assert_eq!(find(b"ABCBC", b""), 0);
/// ```
#[inline]
pub fn find(text: &[u8], pattern: &[u8]) -> i16 {
    // `windows` refuses a length of zero.
    let length = pattern.len().max(1);
    text.windows(length).position(|window| window == pattern).map_or(0, |at| saturated(at + 1))
}

/// `LEFT`: the first `count` bytes.
#[inline]
pub fn left(text: &[u8], count: i64, out: &mut Destination<'_>) {
    out.write(split(text, count).0);
}

/// `RIGHT`: the last `count` bytes.
#[inline]
pub fn right(text: &[u8], count: i64, out: &mut Destination<'_>) {
    out.write(split(text, (text.len() as i64).saturating_sub(count)).1);
}

/// `MID`: `count` bytes, the first of them at `position`.
///
/// ```
/// use staunch_runtime::{Text, text::mid};
/// let text = Text::<5>::build(|out| mid(b"ABCDE", 2, 3, out));
/// assert_eq!(text.as_bytes(), b"CD");
/// ```
#[inline]
pub fn mid(text: &[u8], count: i64, position: i64, out: &mut Destination<'_>) {
    let (_, rest) = split(text, position.saturating_sub(1));
    out.write(split(rest, count).0);
}

/// `CONCAT`: `a`, then `b`.
#[inline]
pub fn concat(a: &[u8], b: &[u8], out: &mut Destination<'_>) {
    out.write(a);
    out.write(b);
}

/// `INSERT`: puts `inserted` after the byte at `position`; 0 puts it in front.
#[inline]
pub fn insert(text: &[u8], inserted: &[u8], position: i64, out: &mut Destination<'_>) {
    let (before, after) = split(text, position);
    out.write(before);
    out.write(inserted);
    out.write(after);
}

/// `DELETE`: leaves out `count` bytes, the first of them at `position`.
#[inline]
pub fn delete(text: &[u8], count: i64, position: i64, out: &mut Destination<'_>) {
    replace(text, &[], count, position, out);
}

/// `REPLACE`: puts `by` in the place of `count` bytes, the first of them at `position`.
///
/// ```
/// use staunch_runtime::{Text, text::replace};
/// let text = Text::<8>::build(|out| replace(b"ABCDE", b"X", 2, 3, out));
/// assert_eq!(text.as_bytes(), b"ABXE");
/// ```
#[inline]
pub fn replace(text: &[u8], by: &[u8], count: i64, position: i64, out: &mut Destination<'_>) {
    let (before, rest) = split(text, position.saturating_sub(1));
    out.write(before);
    out.write(by);
    out.write(split(rest, count).1);
}

/// The first `count` bytes and the others.
#[inline]
fn split(text: &[u8], count: i64) -> (&[u8], &[u8]) {
    let count = count.clamp(0, text.len() as i64) as usize;
    text.split_at_checked(count).unwrap_or((text, &[]))
}

#[inline]
fn saturated(count: usize) -> i16 {
    i16::try_from(count).unwrap_or(i16::MAX)
}
