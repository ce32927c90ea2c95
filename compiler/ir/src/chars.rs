//! The characters of strings while a program is compiled, folded and interpreted.

use crate::Value;
use staunch_runtime::text::{Destination, Unit, characters};
use staunch_runtime::{Repr, StringType};
use std::fmt;

/// The value of a string.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Chars {
    /// A STRING's bytes.
    Narrow(Vec<u8>),
    /// A WSTRING's UTF-16 code units.
    Wide(Vec<u16>),
}

/// Units that have a kind of string.
pub trait CharsOf: Unit {
    const WIDE: bool;
    /// `None` where the text is of the other units.
    fn units(chars: &Chars) -> Option<&[Self]>;
    fn chars(units: Vec<Self>) -> Chars;
}

impl CharsOf for u8 {
    const WIDE: bool = false;

    fn units(chars: &Chars) -> Option<&[Self]> {
        match chars {
            Chars::Narrow(it) => Some(it),
            Chars::Wide(_) => None,
        }
    }

    fn chars(units: Vec<Self>) -> Chars {
        Chars::Narrow(units)
    }
}

impl CharsOf for u16 {
    const WIDE: bool = true;

    fn units(chars: &Chars) -> Option<&[Self]> {
        match chars {
            Chars::Wide(it) => Some(it),
            Chars::Narrow(_) => None,
        }
    }

    fn chars(units: Vec<Self>) -> Chars {
        Chars::Wide(units)
    }
}

impl Chars {
    /// No text, of a string of this type.
    pub const fn empty(ty: StringType) -> Self {
        if ty.wide { Self::Wide(Vec::new()) } else { Self::Narrow(Vec::new()) }
    }

    /// What `write` puts into a string of `U` and this capacity.
    pub fn build<U: CharsOf, E>(
        capacity: u16,
        write: impl FnOnce(&mut Destination<'_, U>) -> Result<(), E>,
    ) -> Result<Self, E> {
        let (mut length, mut units) = (0, vec![U::ZERO; usize::from(capacity)]);
        write(&mut Destination::new(&mut length, &mut units))?;
        units.truncate(usize::from(length));
        Ok(U::chars(units))
    }

    pub const fn is_wide(&self) -> bool {
        matches!(self, Self::Wide(_))
    }

    /// How many units there are.
    pub const fn len(&self) -> usize {
        match self {
            Self::Narrow(it) => it.len(),
            Self::Wide(it) => it.len(),
        }
    }

    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether a string of the type holds them all.
    pub fn fits(&self, ty: StringType) -> bool {
        self.is_wide() == ty.wide && self.len() <= usize::from(ty.capacity)
    }

    /// The text with so many other characters before it.
    #[must_use]
    pub fn after(&self, count: usize) -> Self {
        match self {
            Self::Narrow(it) => Self::Narrow([vec![b'x'; count], it.clone()].concat()),
            Self::Wide(it) => Self::Wide([vec![u16::from(b'x'); count], it.clone()].concat()),
        }
    }

    /// The same text in a string of other units, where it is ASCII.
    pub fn of_width(&self, wide: bool) -> Option<Self> {
        let units = (0..self.len()).filter_map(|it| self.unit(it));
        let ascii: Option<Vec<u8>> = units.map(|it| u8::try_from(it).ok().filter(u8::is_ascii)).collect();
        let ascii = ascii?;
        Some(if wide { Self::Wide(ascii.into_iter().map(u16::from).collect()) } else { Self::Narrow(ascii) })
    }

    /// Its units as they are in memory.
    pub fn units_as_bytes(&self) -> Vec<u8> {
        match self {
            Self::Narrow(it) => it.clone(),
            Self::Wide(it) => it.iter().flat_map(|it| it.to_ne_bytes()).collect(),
        }
    }

    /// One of its units by its position.
    pub fn unit(&self, at: usize) -> Option<u16> {
        match self {
            Self::Narrow(it) => it.get(at).copied().map(u16::from),
            Self::Wide(it) => it.get(at).copied(),
        }
    }

    /// Leaves what a string of this capacity keeps.
    pub fn cut(&mut self, capacity: u16) {
        match self {
            Self::Narrow(it) => it.truncate(usize::from(capacity)),
            Self::Wide(it) => it.truncate(usize::from(capacity)),
        }
    }

    /// As text: what belongs to no character is U+FFFD in a WSTRING, and read as Latin-1 in a STRING.
    pub fn text(&self) -> String {
        match self {
            Self::Narrow(it) => characters(it).collect(),
            Self::Wide(it) => String::from_utf16_lossy(it),
        }
    }

    /// Reads the string of this type at the start of `bytes`: a length, and units in the machine's byte order.
    pub fn read(ty: StringType, bytes: &[u8]) -> Self {
        let Value::U16(length) = Value::read(Repr::U16, bytes) else { unreachable!("read as U16") };
        // A host may have written any length.
        let length = usize::from(length.min(ty.capacity));
        let units = &bytes[2..];
        if ty.wide {
            let unit = |at: usize| u16::from_ne_bytes([units[2 * at], units[2 * at + 1]]);
            Self::Wide((0..length).map(unit).collect())
        } else {
            Self::Narrow(units[..length].to_vec())
        }
    }

    /// Writes the string to all of `bytes`, with zeros after it.
    ///
    /// # Panics
    /// If it does not fit.
    pub fn write(&self, bytes: &mut [u8]) {
        let length = u16::try_from(self.len()).expect("verified IR: a string fits its capacity");
        bytes.fill(0);
        Value::U16(length).write(bytes);
        match self {
            Self::Narrow(it) => bytes[2..2 + it.len()].copy_from_slice(it),
            Self::Wide(it) => {
                for (to, unit) in bytes[2..].chunks_exact_mut(2).zip(it) {
                    to.copy_from_slice(&unit.to_ne_bytes());
                }
            }
        }
    }
}

/// As a literal: `'abc'`, `"abc"`.
impl fmt::Display for Chars {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Narrow(it) => u8::debug(it, f),
            Self::Wide(it) => u16::debug(it, f),
        }
    }
}
