//! Files of version 2: text with a checksum, values in hexadecimal. They are read, and no longer
//! written.

use super::content::{Content, Refusal};
use staunch_runtime::crc32;

pub(super) fn recover(file: &[u8]) -> Result<Content, Refusal> {
    let body = checked(file).ok_or(Refusal::Damaged("its checksum does not match"))?;
    let mut lines = body.lines().skip(1);
    let programs = lines.next().and_then(|it| it.strip_prefix("program\t")).unwrap_or_default();
    let mut content = Content { programs: programs.to_owned(), ..Content::default() };
    for line in lines {
        match line.strip_prefix("clock\t").map(str::parse) {
            Some(clock) => content.clock = clock.map_err(|_| Refusal::Damaged("its clock is not a number"))?,
            None => content.variables.extend(variable(line)),
        }
    }
    Ok(content)
}

fn variable(line: &str) -> Option<(String, String, Option<Vec<u8>>)> {
    let mut cells = line.split('\t');
    let (path, ty, hex) = (cells.next()?, cells.next()?, cells.next()?);
    Some((path.to_owned(), ty.to_owned(), from_hex(hex)))
}

/// The text before the checksum, if that is right.
fn checked(file: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(file).ok()?;
    let at = text.rfind("crc32\t")?;
    let (body, last) = text.split_at(at);
    let checksum = u32::from_str_radix(last.strip_prefix("crc32\t")?.strip_suffix('\n')?, 16).ok()?;
    (crc32(body.as_bytes()) == checksum).then_some(body)
}

fn from_hex(text: &str) -> Option<Vec<u8>> {
    let digits = text.as_bytes().chunks(2);
    digits.map(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()).collect()
}
