//! References: checked access to the variables whose addresses a program takes.
//!
//! A program has no heap and no recursion, so the objects that references can refer to are all
//! known, each with its place in the program's state. A [`Reference`] is the number of an object and an
//! address, in bytes; arithmetic changes the address, but never the object. A [`Table`] lists
//! where the objects are and which types they contain, and checks every access: all executors use it, so
//! that all fault in the same way.
//!
//! Numbers can be viewed as bytes and as other numbers, in the machine's byte order; a BOOL as a byte that is
//! 0 or not. A string is viewed as its characters with a zero after the last one, from position 0. Adjacent numbers
//! in a structure can be viewed as one number; padding bytes between members are 0, and writing to them has no effect.
//! Enumerations are viewed as their own type, and as bytes; subranges, references and standard blocks only as their own type.
//!
//! An object in a pool has a mark, which shows whether it is in use: following a reference to a deleted object is a fault.

mod copy;
mod found;
mod memory;
mod table;

pub use crate::{shared, shared_enumeration};
pub use found::{Found, behind, element, inverse, part, to, whole};
pub use memory::{Memory, Raw, Shared, find, inside, offset, this};
pub use table::{Part, Table, View, Wanted, encode};

pub use crate::Repr;
use crate::text::Unit;
use crate::{FaultKind, Scalar, StringType, Text, Value, WideText};

/// The value of a variable of a reference type: the object's number, from 1, in the low bits of the upper half, and
/// the address in the lower. 0 is null. The bits above the object's number are [`CLASS`]: the class of an
/// instance, for calls that depend on it. They are not used in an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    pub object: u32,
    pub address: u32,
}

/// The address of the state's first byte. It keeps addresses different from null, and aligned like the state.
pub const ORIGIN: u32 = 0x1000;

/// The lowest bit of the class number in a reference. The bits below it are enough for 2^20 objects.
pub const CLASS: u32 = 52;

impl Reference {
    pub const fn from_bits(bits: u64) -> Self {
        Self { object: (bits >> 32) as u32 & ((1 << (CLASS - 32)) - 1), address: bits as u32 }
    }

    pub const fn bits(self) -> u64 {
        (self.object as u64) << 32 | self.address as u64
    }
}

impl<'t> Table<'t> {
    /// The reference to the `size` bytes at `offset` in the state: into the smallest object
    /// that holds them. Null if none does, which a compiled program excludes.
    pub fn address(&self, offset: usize, size: usize) -> u64 {
        let address = ORIGIN + offset as u32;
        self.holding(offset, size).map_or(0, |object| Reference { object, address }.bits())
    }

    /// The value of type `T` at `distance` bytes from where the reference points.
    #[cold]
    pub fn load<T: Scalar>(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        view: View,
    ) -> Result<T, FaultKind> {
        let value = self.load_value(memory, bits, distance, view, T::LANE)?;
        Ok(T::from_value(value).unwrap_or(T::ZERO))
    }

    pub fn load_value(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        view: View,
        repr: Repr,
    ) -> Result<Value, FaultKind> {
        let mut bytes = [0; 8];
        let wanted = bytes.get_mut(..repr.size() as usize).unwrap_or_default();
        self.load_bytes(memory, bits, distance, view, wanted)?;
        Ok(Value::read(repr, &bytes))
    }

    /// Reads as many bytes as a value of the view has; a BOOL is 0 or 1.
    pub fn load_bytes(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        view: View,
        out: &mut [u8],
    ) -> Result<(), FaultKind> {
        self.check_is_there(memory, bits)?;
        match self.part(bits, distance, view)? {
            Part::Bytes { at, .. } => memory.read(at, out),
            Part::Truth { at } => {
                memory.read(at, out);
                out.iter_mut().for_each(|it| *it = u8::from(*it != 0));
            }
            Part::Spread { at } => {
                for (at, byte) in (at..).zip(out.chunks_mut(1)) {
                    byte.fill(0);
                    if self.is_number(at) {
                        memory.read(at, byte);
                    }
                }
            }
            Part::Characters { text, ty, index } => {
                for (at, byte) in (index..).zip(out) {
                    *byte = character_byte(memory, text, ty, at);
                }
            }
        }
        Ok(())
    }

    #[cold]
    pub fn store<T: Scalar>(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        view: View,
        value: T,
    ) -> Result<(), FaultKind> {
        self.store_value(memory, bits, distance, view, value.into_value())
    }

    pub fn store_value(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        view: View,
        value: Value,
    ) -> Result<(), FaultKind> {
        let mut bytes = [0; 8];
        value.write(&mut bytes);
        let size = value.repr().size() as usize;
        self.store_bytes(memory, bits, distance, view, bytes.get(..size).unwrap_or_default())
    }

    /// Writes the bytes of a value of the view.
    pub fn store_bytes(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        view: View,
        bytes: &[u8],
    ) -> Result<(), FaultKind> {
        let first = bytes.first().copied().unwrap_or_default();
        self.check_is_there(memory, bits)?;
        match self.part(bits, distance, view)? {
            Part::Bytes { at, .. } => memory.write(at, bytes),
            Part::Truth { at } => memory.write(at, &[u8::from(first != 0)]),
            Part::Spread { at } => {
                for (at, byte) in (at..).zip(bytes.chunks(1)).filter(|(at, _)| self.is_number(*at)) {
                    memory.write(at, byte);
                }
            }
            Part::Characters { text, ty, index } if ty.wide => {
                // The other byte of the character stays.
                let before = [0, 1].map(|at| character_byte(memory, text, ty, index / 2 * 2 + at));
                let mut unit = before;
                for (to, from) in unit.iter_mut().skip(index % 2).zip(bytes) {
                    *to = *from;
                }
                // A zero byte of a character to come does not end the string: bytes may be copied downward.
                if bytes.len() == 2 || unit != before {
                    set_character(memory, text, ty.capacity, index / 2, u16::from_ne_bytes(unit))?;
                }
            }
            Part::Characters { text, ty, index } => set_character(memory, text, ty.capacity, index, first)?,
        }
        Ok(())
    }

    /// Appends the characters from the reference's target up to the first zero to `out`, as many as fit.
    pub fn load_text<U: Unit>(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        out: &mut crate::text::Destination<'_, U>,
    ) -> Result<(), FaultKind> {
        self.check_is_there(memory, bits)?;
        match self.part(bits, distance, View::Text { wide: U::SIZE == 2 })? {
            Part::Bytes { at, rest } => put_characters(at..at + rest / U::SIZE * U::SIZE, memory, out),
            Part::Truth { .. } | Part::Spread { .. } => return Err(FaultKind::ForbiddenView),
            Part::Characters { text, ty, index } => {
                let start = text + HEADER;
                let used = usize::from(length(memory, text).min(ty.capacity)) * U::SIZE;
                put_characters(start + index..start + used, memory, out);
            }
        }
        Ok(())
    }

    /// Writes characters to the reference's target, as many as fit, and ends the string after them.
    pub fn store_text<U: Unit>(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        value: &[U],
    ) -> Result<(), FaultKind> {
        self.check_is_there(memory, bits)?;
        match self.part(bits, distance, View::Text { wide: U::SIZE == 2 })? {
            Part::Bytes { at, rest } => {
                let rest = rest / U::SIZE;
                // The last place is for the zero that ends it.
                let count = value.len().min(rest.saturating_sub(1));
                write_units(memory, at, value.get(..count).unwrap_or_default());
                if count < rest {
                    write_units(memory, at + count * U::SIZE, &[U::ZERO]);
                }
            }
            Part::Truth { .. } | Part::Spread { .. } => return Err(FaultKind::ForbiddenView),
            Part::Characters { text, ty, index } => {
                let index = (index / U::SIZE).min(usize::from(ty.capacity));
                clear_from::<U>(memory, text, index);
                let count = value.len().min(usize::from(ty.capacity) - index);
                write_units(memory, text + HEADER + index * U::SIZE, value.get(..count).unwrap_or_default());
                memory.write(text, &((index + count) as u16).to_ne_bytes());
            }
        }
        Ok(())
    }

    /// The variable of exactly this type that the reference refers to.
    #[cold]
    pub fn variable<'m, T: core::any::Any>(
        &self,
        machine: &'m impl Shared,
        bits: u64,
        distance: u64,
        wanted: Wanted,
    ) -> Result<&'m T, FaultKind> {
        let offset = self.find(machine, bits, distance, wanted)?;
        find(machine, offset).ok_or(FaultKind::ForbiddenView)
    }

    /// A copy of the target as a STRING.
    pub fn string<const N: usize>(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
    ) -> Result<Text<N>, FaultKind> {
        self.text(memory, bits, distance)
    }

    /// As a WSTRING.
    pub fn wide_string<const N: usize>(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
    ) -> Result<WideText<N>, FaultKind> {
        self.text(memory, bits, distance)
    }

    fn text<const N: usize, U: Unit>(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
    ) -> Result<Text<N, U>, FaultKind> {
        let mut text = Text::default();
        self.load_text(memory, bits, distance, &mut text.destination())?;
        Ok(text)
    }
}

/// Bytes before the first character of a string in memory: its length.
const HEADER: usize = size_of::<u16>();

fn length(memory: &(impl Memory + ?Sized), text: usize) -> u16 {
    let mut length = [0; HEADER];
    memory.read(text, &mut length);
    u16::from_ne_bytes(length)
}

/// A byte of a string's characters; 0 after the last one.
fn character_byte(memory: &(impl Memory + ?Sized), text: usize, ty: StringType, at: usize) -> u8 {
    let mut byte = [0];
    if at < usize::from(ty.capacity) * ty.unit_size() as usize {
        memory.read(text + HEADER + at, &mut byte);
    }
    byte[0]
}

/// A zero ends the string there; another character beyond its end lengthens it, with zeros in between.
fn set_character<U: Unit>(
    memory: &(impl Memory + ?Sized),
    text: usize,
    capacity: u16,
    index: usize,
    unit: U,
) -> Result<(), FaultKind> {
    if index >= usize::from(capacity) {
        // There the zero is that ends a string of full length.
        return if unit == U::ZERO { Ok(()) } else { Err(FaultKind::OutsideObject) };
    }
    if unit == U::ZERO {
        clear_from::<U>(memory, text, index);
        return Ok(());
    }
    write_units(memory, text + HEADER + index * U::SIZE, &[unit]);
    if index >= usize::from(length(memory, text)) {
        memory.write(text, &(index as u16 + 1).to_ne_bytes());
    }
    Ok(())
}

/// Ends a string; the bytes after that become zero, as in every string.
fn clear_from<U: Unit>(memory: &(impl Memory + ?Sized), text: usize, index: usize) {
    let length = usize::from(length(memory, text));
    for at in index..length {
        write_units(memory, text + HEADER + at * U::SIZE, &[U::ZERO]);
    }
    if index < length {
        memory.write(text, &(index as u16).to_ne_bytes());
    }
}

fn write_units<U: Unit>(memory: &(impl Memory + ?Sized), at: usize, units: &[U]) {
    for (unit, start) in units.iter().zip((at..).step_by(U::SIZE)) {
        for part in 0..U::SIZE {
            memory.write(start + part, &[unit.byte(part)]);
        }
    }
}

fn put_characters<U: Unit>(
    range: core::ops::Range<usize>,
    memory: &(impl Memory + ?Sized),
    out: &mut crate::text::Destination<'_, U>,
) {
    for at in range.step_by(U::SIZE) {
        let mut unit = U::ZERO;
        for part in 0..U::SIZE {
            let mut byte = [0];
            memory.read(at + part, &mut byte);
            unit = unit.with_byte(part, byte[0]);
        }
        if unit == U::ZERO {
            return;
        }
        out.write(&[unit]);
    }
}
