//! JSON, each value with its place in the file. Values that are nested deeper than [`DEEPEST`] are refused, so that no
//! file takes more of the stack than others do.

mod escape;
mod scan;
mod value;

pub use scan::Broken;
pub use value::{Kind, Member, Value};

use core::ops::Range;
use scan::Scanner;

/// Editors nest a dozen levels.
const DEEPEST: usize = 128;

/// The value that a file is.
pub fn parse(file: &str) -> Result<Value, Broken> {
    let mut scanner = Scanner::new(file);
    let value = scanner.value(DEEPEST)?;
    scanner.end()?;
    Ok(value)
}

/// The value that a part of a file is.
pub fn parse_within(file: &str, part: Range<usize>) -> Result<Value, Broken> {
    let mut scanner = Scanner::within(&file[..part.end], part.start);
    let value = scanner.value(DEEPEST)?;
    scanner.end()?;
    Ok(value)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests;
