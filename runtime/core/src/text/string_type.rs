//! STRING and WSTRING, with their capacities.

use core::fmt;

/// The type of a string: the kind of its units, and its capacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StringType {
    /// Whether it is a WSTRING, which consists of UTF-16 code units; a STRING consists of bytes.
    pub wide: bool,
    /// The maximum number of units.
    pub capacity: u16,
}

impl StringType {
    /// A STRING.
    pub const fn narrow(capacity: u16) -> Self {
        Self { wide: false, capacity }
    }

    /// A WSTRING.
    pub const fn wide(capacity: u16) -> Self {
        Self { wide: true, capacity }
    }

    /// The same kind of string with another capacity.
    #[must_use]
    pub const fn of_capacity(self, capacity: u16) -> Self {
        Self { capacity, ..self }
    }

    /// A WSTRING or a STRING with the same capacity.
    #[must_use]
    pub const fn of_kind(self, wide: bool) -> Self {
        Self { wide, ..self }
    }

    /// `STRING` or `WSTRING`
    pub const fn word(self) -> &'static str {
        if self.wide { "WSTRING" } else { "STRING" }
    }

    /// The unit of its capacity, in messages.
    pub const fn units(self) -> &'static str {
        if self.wide { "UTF-16 code units" } else { "bytes" }
    }

    /// The size of a unit, in bytes.
    pub const fn unit_size(self) -> u32 {
        if self.wide { 2 } else { 1 }
    }

    /// The size of a variable, in bytes: its length, its units, and the padding for alignment.
    pub const fn size(self) -> u32 {
        2 + (self.capacity as u32 * self.unit_size()).next_multiple_of(2)
    }
}

/// `WSTRING[80]`
impl fmt::Display for StringType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}[{}]", self.word(), self.capacity)
    }
}
