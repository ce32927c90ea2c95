//! Variables by name: the table of a program that was emitted with names.

use crate::text::Unit;
use crate::{Text, WideText};
use core::fmt;

/// A variable, or the elements of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name {
    /// The path as in Structured Text, beginning with the name of the program's instance, `Main.parts.CV`; for a global
    /// only its own name. The elements of an array share a path with its bounds, `Main.levels[1..8]`.
    pub path: &'static str,
    /// The type's name in Structured Text.
    pub ty: &'static str,
    /// The number of values with this path.
    pub elements: usize,
}

/// The value of a variable: numbers in their Rust type, times in nanoseconds, enumerations as numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'v> {
    Bool(bool),
    Signed(i64),
    Unsigned(u64),
    Real(f32),
    LongReal(f64),
    /// A STRING's characters.
    Text(&'v [u8]),
    /// A WSTRING's characters, as UTF-16.
    WideText(&'v [u16]),
}

impl fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => f.write_str(if *value { "TRUE" } else { "FALSE" }),
            Self::Signed(value) => value.fmt(f),
            Self::Unsigned(value) => value.fmt(f),
            Self::Real(value) => write!(f, "{value:?}"),
            Self::LongReal(value) => write!(f, "{value:?}"),
            Self::Text(value) => u8::debug(value, f),
            Self::WideText(value) => u16::debug(value, f),
        }
    }
}

macro_rules! values {
    ($($from:ty => $kind:ident)*) => {
        $(
            impl From<$from> for Value<'_> {
                #[inline]
                fn from(value: $from) -> Self {
                    Self::$kind(value.into())
                }
            }
        )*
    };
}

values! {
    bool => Bool
    i8 => Signed
    i16 => Signed
    i32 => Signed
    i64 => Signed
    u8 => Unsigned
    u16 => Unsigned
    u32 => Unsigned
    u64 => Unsigned
    f32 => Real
    f64 => LongReal
}

impl<'v, const N: usize> From<&'v Text<N>> for Value<'v> {
    #[inline]
    fn from(value: &'v Text<N>) -> Self {
        Self::Text(value.as_bytes())
    }
}

impl<'v, const N: usize> From<&'v WideText<N>> for Value<'v> {
    #[inline]
    fn from(value: &'v WideText<N>) -> Self {
        Self::WideText(value.as_units())
    }
}
