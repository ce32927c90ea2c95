//! Characters of texts that JSON writes with a `\`.

/// The character that `\n`, `\u00e4` or `\ud83d\ude00` at the start of a text is, and its length.
pub fn escaped(text: &str) -> Option<(char, usize)> {
    let symbol = match text.as_bytes().get(1)? {
        b'"' => '"',
        b'\\' => '\\',
        b'/' => '/',
        b'b' => '\u{8}',
        b'f' => '\u{c}',
        b'n' => '\n',
        b'r' => '\r',
        b't' => '\t',
        b'u' => return unicode(text),
        _ => return None,
    };
    Some((symbol, 2))
}

/// Half of a pair alone is not a character: it is replaced, as other readers do.
fn unicode(text: &str) -> Option<(char, usize)> {
    let first = unit(text)?;
    let second = if matches!(first, 0xd800..=0xdbff) { text.get(6..).and_then(unit) } else { None };
    let pair = second.and_then(|it| char::decode_utf16([first, it]).next()?.ok());
    match pair {
        Some(symbol) => Some((symbol, 12)),
        None => Some((char::from_u32(u32::from(first)).unwrap_or(char::REPLACEMENT_CHARACTER), 6)),
    }
}

/// `\u00e4`
fn unit(text: &str) -> Option<u16> {
    let digits = text.strip_prefix("\\u")?.get(..4)?;
    let is_hex = digits.bytes().all(|it| it.is_ascii_hexdigit());
    u16::from_str_radix(digits, 16).ok().filter(|_| is_hex)
}
