//! Strings in JSON, for the output of the compiler, the host and a firmware.

use core::fmt::{self, Write};

/// A string in quotes. `<` is escaped as well, so that the JSON may be part of an HTML page.
///
/// ```
/// assert_eq!(staunch_runtime::json::Quoted("a \"b\"\n").to_string(), r#""a \"b\"\n""#);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Quoted<'t>(pub &'t str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_char('"')?;
        for character in self.0.chars() {
            match character {
                '"' => f.write_str("\\\"")?,
                '\\' => f.write_str("\\\\")?,
                '\n' => f.write_str("\\n")?,
                '\r' => f.write_str("\\r")?,
                '\t' => f.write_str("\\t")?,
                it if it.is_control() || matches!(it, '<' | '\u{2028}' | '\u{2029}') => {
                    write!(f, "\\u{:04x}", u32::from(it))?;
                }
                it => f.write_char(it)?,
            }
        }
        f.write_char('"')
    }
}
