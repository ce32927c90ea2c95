//! The units of strings, and their meaning as text.
//!
//! A STRING is UTF-8, as sources are; a byte that is not part of a UTF-8 character is the character with its number,
//! as in ISO 8859-1, which `'$E9'` uses. A WSTRING is UTF-16.

use core::fmt::{self, Write};

/// A byte of a STRING, or a UTF-16 code unit of a WSTRING.
pub trait Unit: Copy + Ord + fmt::Debug + 'static {
    const ZERO: Self;
    /// The size in bytes.
    const SIZE: usize;
    /// One of its bytes, as in memory.
    fn byte(self, at: usize) -> u8;
    #[must_use]
    fn with_byte(self, at: usize, byte: u8) -> Self;
    /// The units as a literal.
    fn debug(units: &[Self], f: &mut fmt::Formatter<'_>) -> fmt::Result;
    /// The units as text; invalid ones are shown as U+FFFD.
    fn display(units: &[Self], f: &mut fmt::Formatter<'_>) -> fmt::Result;
}

impl Unit for u8 {
    const ZERO: Self = 0;
    const SIZE: usize = 1;

    fn byte(self, _: usize) -> u8 {
        self
    }

    fn with_byte(self, _: usize, byte: u8) -> Self {
        byte
    }

    fn debug(units: &[Self], f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "'{}'", units.escape_ascii())
    }

    fn display(units: &[Self], f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for chunk in units.utf8_chunks() {
            f.write_str(chunk.valid())?;
            if !chunk.invalid().is_empty() {
                f.write_char(char::REPLACEMENT_CHARACTER)?;
            }
        }
        Ok(())
    }
}

impl Unit for u16 {
    const ZERO: Self = 0;
    const SIZE: usize = 2;

    fn byte(self, at: usize) -> u8 {
        let [first, second] = self.to_ne_bytes();
        if at == 0 { first } else { second }
    }

    fn with_byte(self, at: usize, byte: u8) -> Self {
        let [first, second] = self.to_ne_bytes();
        Self::from_ne_bytes(if at == 0 { [byte, second] } else { [first, byte] })
    }

    fn debug(units: &[Self], f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_char('"')?;
        for unit in char::decode_utf16(units.iter().copied()) {
            match unit {
                Ok(it) => write!(f, "{}", it.escape_debug())?,
                Err(it) => write!(f, "\\u{{{:x}}}", it.unpaired_surrogate())?,
            }
        }
        f.write_char('"')
    }

    fn display(units: &[Self], f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for unit in char::decode_utf16(units.iter().copied()) {
            f.write_char(unit.unwrap_or(char::REPLACEMENT_CHARACTER))?;
        }
        Ok(())
    }
}

/// The characters of a STRING.
///
/// ```
/// use staunch_runtime::text::characters;
/// assert!(characters(b"\xC3\xA9\xE9").eq("éé".chars()));
/// ```
pub fn characters(bytes: &[u8]) -> impl Iterator<Item = char> {
    bytes.utf8_chunks().flat_map(|it| it.valid().chars().chain(it.invalid().iter().map(|byte| char::from(*byte))))
}

/// The UTF-16 code units of a text, as a constant: `&utf16!("Grüße")`.
#[macro_export]
macro_rules! utf16 {
    ($text:literal) => {
        const { $crate::text::utf16_units::<{ $crate::text::utf16_length($text) }>($text) }
    };
}

/// The number of code units in the result of [`utf16!`](crate::utf16).
#[doc(hidden)]
pub const fn utf16_length(text: &str) -> usize {
    let (bytes, mut at, mut length) = (text.as_bytes(), 0, 0);
    while at < bytes.len() {
        // A character starts with any byte but a continuation; one of four bytes is a pair of surrogates.
        length += (bytes[at] & 0xC0 != 0x80) as usize + (bytes[at] >= 0xF0) as usize;
        at += 1;
    }
    length
}

/// The code units of a text; `N` is the result of [`utf16_length`].
#[doc(hidden)]
pub const fn utf16_units<const N: usize>(text: &str) -> [u16; N] {
    let (bytes, mut at, mut count, mut units) = (text.as_bytes(), 0, 0, [0; N]);
    while at < bytes.len() {
        let first = bytes[at] as u32;
        let (length, mut number) = match first {
            0..0x80 => (1, first),
            0x80..0xE0 => (2, first & 0x1F),
            0xE0..0xF0 => (3, first & 0x0F),
            _ => (4, first & 0x07),
        };
        let end = at + length;
        at += 1;
        while at < end {
            number = number << 6 | (bytes[at] & 0x3F) as u32;
            at += 1;
        }
        if number >= 0x1_0000 {
            units[count] = (0xD800 + ((number - 0x1_0000) >> 10)) as u16;
            units[count + 1] = (0xDC00 + (number & 0x3FF)) as u16;
            count += 2;
        } else {
            units[count] = number as u16;
            count += 1;
        }
    }
    units
}

#[cfg(test)]
mod tests {
    #[test]
    fn constants_are_utf16() {
        const TEXT: &[u16] = &crate::utf16!("aé€😀\0");
        assert!("aé€😀\0".encode_utf16().eq(TEXT.iter().copied()));
        assert_eq!(crate::utf16!(""), []);
    }
}
