//! Character strings: a fixed capacity in place, no heap. Text that does not fit is cut.
//!
//! The functions count units, bytes of a STRING and UTF-16 code units of a WSTRING, positions from 1. A count or position out of range acts as the
//! nearest one that is in range, so a negative count acts as 0.

mod conversion;
mod matiec;
mod string_type;
mod strucpp;
mod unit;

pub use crate::utf16;
pub use conversion::*;
use matiec::general;
pub use matiec::*;
pub use string_type::StringType;
pub use strucpp::*;
pub use unit::{Unit, characters, utf16_length, utf16_units};

use core::fmt;

/// A STRING of at most `N` bytes, or a [`WideText`]. The units past its length are zero, so equal
/// strings are equal in memory.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Text<const N: usize, U = u8> {
    len: u16,
    units: [U; N],
}

/// A WSTRING of at most `N` UTF-16 code units.
pub type WideText<const N: usize> = Text<N, u16>;

impl<const N: usize, U: Unit> Text<N, U> {
    /// The start of `units`, as much as fits.
    pub const fn new(units: &[U]) -> Self {
        const { assert!(N <= u16::MAX as usize, "a string holds at most 65535 units") };
        let mut text = Self { len: 0, units: [U::ZERO; N] };
        let mut at = 0;
        while at < N && at < units.len() {
            text.units[at] = units[at];
            at += 1;
        }
        text.len = at as u16;
        text
    }

    /// The string that `write` writes.
    #[inline]
    pub fn build(write: impl FnOnce(&mut Destination<'_, U>)) -> Self {
        let mut text = Self::default();
        write(&mut text.destination());
        text
    }

    /// Another string, cut if it is longer than `N`.
    #[inline]
    pub fn from_text<const M: usize>(other: &Text<M, U>) -> Self {
        Self::build(|out| out.write(other.as_units()))
    }

    #[inline]
    pub fn as_units(&self) -> &[U] {
        self.units.get(..usize::from(self.len)).unwrap_or(&self.units)
    }

    /// Replaces the string with the start of `units`, as much as fits.
    #[inline]
    pub fn assign(&mut self, units: &[U]) {
        self.destination().write(units);
    }

    /// A byte of the string as it is in memory: its length, then its characters.
    pub(crate) fn raw_byte(&self, at: usize) -> u8 {
        let [low, high] = self.len.to_ne_bytes();
        match at {
            0 => low,
            1 => high,
            at => self.units.get((at - 2) / U::SIZE).map_or(0, |unit| unit.byte((at - 2) % U::SIZE)),
        }
    }

    pub(crate) fn set_raw_byte(&mut self, at: usize, byte: u8) {
        let [low, high] = self.len.to_ne_bytes();
        match at {
            0 => self.len = u16::from_ne_bytes([byte, high]),
            1 => self.len = u16::from_ne_bytes([low, byte]),
            at => {
                if let Some(unit) = self.units.get_mut((at - 2) / U::SIZE) {
                    *unit = unit.with_byte((at - 2) % U::SIZE, byte);
                }
            }
        }
    }

    /// Empties the string, and returns it as a destination for a new value.
    #[inline]
    pub fn destination(&mut self) -> Destination<'_, U> {
        Destination::new(&mut self.len, &mut self.units)
    }

    /// Returns the string as a destination for writing after its end.
    #[inline]
    pub fn end(&mut self) -> Destination<'_, U> {
        Destination::at_end(&mut self.len, &mut self.units)
    }

    /// Appends as much of `units` as still fits.
    ///
    /// ```
    /// let mut text = staunch_runtime::Text::<5>::new(b"abc");
    /// text.append(b"def");
    /// assert_eq!(text.as_bytes(), b"abcde");
    /// ```
    #[inline]
    pub fn append(&mut self, units: &[U]) {
        self.end().write(units);
    }
}

impl<const N: usize> Text<N> {
    #[inline]
    pub fn as_bytes(&self) -> &[u8] {
        self.as_units()
    }
}

impl<const N: usize, U: Unit> Default for Text<N, U> {
    #[inline]
    fn default() -> Self {
        Self::new(&[])
    }
}

impl<const N: usize, U: Unit> fmt::Debug for Text<N, U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        U::debug(self.as_units(), f)
    }
}

/// Bytes that are not UTF-8, and unpaired surrogates, are shown as U+FFFD.
impl<const N: usize, U: Unit> fmt::Display for Text<N, U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        U::display(self.as_units(), f)
    }
}

/// Where a string function writes: the length and the units of a string of any capacity. Each writes after the existing text,
/// so that several make one string.
///
/// The units past a string's length are zero. So units that no longer belong to it are set to zero when the
/// writing ends; the others are not touched.
#[derive(Debug)]
pub struct Destination<'a, U: Unit = u8> {
    len: &'a mut u16,
    units: &'a mut [U],
    /// The previous length of the string.
    before: u16,
}

impl<'a, U: Unit> Destination<'a, U> {
    /// A destination that replaces the string of this length.
    #[inline]
    pub fn new(len: &'a mut u16, units: &'a mut [U]) -> Self {
        let before = core::mem::take(len);
        Self { len, units, before }
    }

    /// A destination that appends to the existing string.
    #[inline]
    pub fn at_end(len: &'a mut u16, units: &'a mut [U]) -> Self {
        Self { len, units, before: 0 }
    }

    /// Lengthens the string by so many units, as far as there is room: those that are to be written.
    #[inline]
    pub fn lengthen(&mut self, count: usize) -> &mut [U] {
        let free = self.units.get_mut(usize::from(*self.len)..).unwrap_or_default();
        let count = free.len().min(count).min(usize::from(u16::MAX - *self.len));
        *self.len += count as u16;
        free.get_mut(..count).unwrap_or_default()
    }

    /// Appends as much of `units` as still fits.
    #[inline]
    pub fn write(&mut self, units: &[U]) {
        let free = self.units.get_mut(usize::from(*self.len)..).unwrap_or_default();
        let count = free.len().min(units.len()).min(usize::from(u16::MAX - *self.len));
        if let (Some(to), Some(from)) = (free.get_mut(..count), units.get(..count)) {
            // `copy_from_slice` has a panic, which is not always seen to be out of reach.
            to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
        }
        *self.len += count as u16;
    }
}

impl<U: Unit> Drop for Destination<'_, U> {
    #[inline]
    fn drop(&mut self) {
        if *self.len < self.before {
            let before = usize::from(self.before).min(self.units.len());
            let unused = self.units.get_mut(usize::from(*self.len)..before);
            unused.unwrap_or_default().fill(U::ZERO);
        }
    }
}

/// The order of two strings, unit by unit: -1, 0 or 1. A string comes after its own prefixes.
///
/// ```
/// use staunch_runtime::text::compare;
/// assert_eq!(compare(b"ab", b"abc"), -1);
/// assert_eq!(compare(b"b", b"abc"), 1);
/// ```
#[inline]
pub fn compare<U: Unit>(a: &[U], b: &[U]) -> i16 {
    a.cmp(b) as i16
}

/// `LEN`: the number of units; 32767 if there are more.
#[inline]
pub fn len<U: Unit>(text: &[U]) -> i16 {
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
pub fn find<U: Unit>(text: &[U], pattern: &[U]) -> i16 {
    let Some(first) = pattern.first() else { return 0 };
    let is_found = |window: &[U]| window.first() == Some(first) && window == pattern;
    text.windows(pattern.len()).position(is_found).map_or(0, |at| saturated(at + 1))
}

/// `LEFT`: the first `count` units.
#[inline]
pub fn left<U: Unit>(text: &[U], count: i64, out: &mut Destination<'_, U>) {
    out.write(split(text, count).0);
}

/// `RIGHT`: the last `count` units.
#[inline]
pub fn right<U: Unit>(text: &[U], count: i64, out: &mut Destination<'_, U>) {
    out.write(split(text, (text.len() as i64).saturating_sub(count)).1);
}

/// `MID`: `count` units, the first of them at `position`.
///
/// ```
/// use staunch_runtime::{Text, text::mid};
/// let text = Text::<5>::build(|out| mid(b"ABCDE", 2, 3, out));
/// assert_eq!(text.as_bytes(), b"CD");
/// ```
#[inline]
pub fn mid<U: Unit>(text: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    let (_, rest) = split(text, position.saturating_sub(1));
    out.write(split(rest, count).0);
}

/// `CONCAT`: `a`, then `b`.
#[inline]
pub fn concat<U: Unit>(a: &[U], b: &[U], out: &mut Destination<'_, U>) {
    out.write(a);
    out.write(b);
}

/// `INSERT`: puts `inserted` after the unit at `position`; position 0 is before the first unit.
#[inline]
pub fn insert<U: Unit>(text: &[U], inserted: &[U], position: i64, out: &mut Destination<'_, U>) {
    let (before, after) = split(text, position);
    out.write(before);
    out.write(inserted);
    out.write(after);
}

/// `DELETE`: leaves out `count` units, the first of them at `position`.
#[inline]
pub fn delete<U: Unit>(text: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    replace(text, &[], count, position, out);
}

/// `REPLACE`: puts `by` in the place of `count` units, the first of them at `position`.
///
/// ```
/// use staunch_runtime::{Text, text::replace};
/// let text = Text::<8>::build(|out| replace(b"ABCDE", b"X", 2, 3, out));
/// assert_eq!(text.as_bytes(), b"ABXE");
/// ```
#[inline]
pub fn replace<U: Unit>(text: &[U], by: &[U], count: i64, position: i64, out: &mut Destination<'_, U>) {
    let (before, rest) = split(text, position.saturating_sub(1));
    out.write(before);
    out.write(by);
    out.write(split(rest, count).1);
}

#[inline]
fn unit_at<U: Unit>(text: &[U], position: i64) -> U {
    usize::try_from(position).ok().and_then(|it| text.get(it)).copied().unwrap_or(U::ZERO)
}

/// The byte of a STRING at `position`, counted from 0; 0 after its end.
#[inline]
pub fn char_at(text: &[u8], position: i64) -> u8 {
    unit_at(text, position)
}

/// The code unit of a WSTRING at `position`, counted from 0; 0 after its end.
#[inline]
pub fn wchar_at(text: &[u16], position: i64) -> u16 {
    unit_at(text, position)
}

/// A STRING with another byte at `position`, counted from 0: a zero ends the string there, and another byte beyond its end
/// lengthens it, with zeros in between, if there is room for all of it.
///
/// ```
/// use staunch_runtime::{Text, text::with_char};
/// let changed = |position, byte| Text::<8>::build(|out| with_char(b"ABC", position, byte, out));
/// assert_eq!(changed(1, b'x').as_bytes(), b"AxC");
/// assert_eq!(changed(1, 0).as_bytes(), b"A");
/// assert_eq!(changed(4, b'x').as_bytes(), b"ABC\0x");
/// assert_eq!(changed(8, b'x').as_bytes(), b"ABC");
/// ```
#[inline]
pub fn with_char(text: &[u8], position: i64, byte: u8, out: &mut Destination<'_>) {
    with_unit(text, position, byte, out);
}

/// The same for a WSTRING and a code unit.
#[inline]
pub fn with_wchar(text: &[u16], position: i64, unit: u16, out: &mut Destination<'_, u16>) {
    with_unit(text, position, unit, out);
}

#[inline]
fn with_unit<U: Unit>(text: &[U], position: i64, unit: U, out: &mut Destination<'_, U>) {
    let (before, rest) = split(text, position);
    let fits = position < out.units.len() as i64;
    match (unit == U::ZERO, fits) {
        (true, _) => out.write(before),
        (false, false) => out.write(text),
        (false, true) => {
            out.write(before);
            (before.len() as i64..position).for_each(|_| out.write(&[U::ZERO]));
            out.write(&[unit]);
            out.write(split(rest, 1).1);
        }
    }
}

/// The first `count` units and the others.
#[inline]
fn split<U: Unit>(text: &[U], count: i64) -> (&[U], &[U]) {
    let count = count.clamp(0, text.len() as i64) as usize;
    text.split_at_checked(count).unwrap_or((text, &[]))
}

#[inline]
fn saturated(count: usize) -> i16 {
    i16::try_from(count).unwrap_or(i16::MAX)
}
