//! Values of literals, read from the text of their tokens.

/// Why a literal has no value: a range of its text, and a sentence.
#[derive(Debug, PartialEq, Eq)]
pub struct Fault {
    pub start: usize,
    pub end: usize,
    pub message: String,
    /// The whole literal as it is meant.
    pub meant: Option<String>,
}

impl Fault {
    fn new(start: usize, end: usize, message: impl Into<String>) -> Self {
        Self { start, end, message: message.into(), meant: None }
    }
}

type IsByte = fn(&u8) -> bool;

/// `text` holds no `_` but between a byte that may stand before it and one that may follow.
fn strokes(text: &str, (before, behind): (IsByte, IsByte), message: &str) -> Result<(), Fault> {
    let bytes = text.as_bytes();
    let is = |at: Option<usize>, what: IsByte| at.and_then(|it| bytes.get(it)).is_some_and(what);
    let loose = |at: &usize| bytes[*at] == b'_' && !(is(at.checked_sub(1), before) && is(Some(at + 1), behind));
    let Some(start) = (0..bytes.len()).find(loose) else { return Ok(()) };
    let end = start + bytes[start..].iter().take_while(|it| **it == b'_').count();
    let mut meant = String::new();
    for part in text.split('_').filter(|it| !it.is_empty()) {
        if meant.as_bytes().last().is_some_and(before) && part.as_bytes().first().is_some_and(behind) {
            meant.push('_');
        }
        meant.push_str(part);
    }
    Err(Fault { meant: Some(meant), ..Fault::new(start, end, message) })
}

const BETWEEN_DIGITS: &str = "`_` stands between two digits";

/// `1_000`, `16#FF`: the magnitude.
pub fn integer(text: &str) -> Result<u64, Fault> {
    let (radix, digits, at) = match text.split_once('#') {
        None => (10, text, 0),
        Some(("2", digits)) => (2, digits, 2),
        Some(("8", digits)) => (8, digits, 2),
        Some(("16", digits)) => (16, digits, 3),
        Some((base, _)) => {
            let message = format!("a number's base is 2, 8 or 16, not {base}");
            return Err(Fault::new(0, base.len(), message));
        }
    };
    if digits.bytes().all(|it| it == b'_') {
        return Err(Fault::new(0, text.len(), "the number has no digits"));
    }
    let digit: IsByte = if radix == 16 { u8::is_ascii_hexdigit } else { u8::is_ascii_digit };
    strokes(text, (digit, digit), BETWEEN_DIGITS)?;
    let mut value = 0_u64;
    for (place, digit) in digits.char_indices().filter(|(_, it)| *it != '_') {
        let Some(digit) = digit.to_digit(radix) else {
            let message = format!("`{digit}` is no digit of base {radix}");
            return Err(Fault::new(at + place, at + place + 1, message));
        };
        value = value
            .checked_mul(u64::from(radix))
            .and_then(|it| it.checked_add(u64::from(digit)))
            .ok_or_else(|| Fault::new(0, text.len(), "the number does not fit 64 bits"))?;
    }
    Ok(value)
}

/// The digits of a real, without `_`.
pub fn real(text: &str) -> Result<String, Fault> {
    strokes(text, (u8::is_ascii_digit, u8::is_ascii_digit), BETWEEN_DIGITS)?;
    Ok(text.chars().filter(|it| *it != '_').collect())
}

/// Units from the longest to the shortest, in nanoseconds.
const UNITS: [(&str, i128); 7] = [
    ("d", 86_400_000_000_000),
    ("h", 3_600_000_000_000),
    ("m", 60_000_000_000),
    ("s", 1_000_000_000),
    ("ms", 1_000_000),
    ("us", 1_000),
    ("ns", 1),
];

/// `T#-1h30m`, `LTIME#1.5s`: signed nanoseconds, and whether it is an LTIME.
pub fn duration(text: &str) -> Result<(i64, bool), Fault> {
    let (prefix, value) = text.split_once('#').unwrap_or(("", text));
    let long = prefix.starts_with(['l', 'L']);
    let negative = value.starts_with('-');
    let mut at = text.len() - value.trim_start_matches(['-', '+']).len();
    let mut total = 0_i128;
    // Index of the unit that the next part may have at most.
    let mut next_unit = 0;
    // Where a part with a fraction stands, and its unit.
    let mut fraction = None;
    while at < text.len() {
        let (unit, nanoseconds, end) = part(text, at)?;
        if unit < next_unit {
            let message = format!("`{}` stands behind a shorter or the same unit", UNITS[unit].0);
            return Err(Fault::new(at, end, message));
        }
        next_unit = unit + 1;
        total = total.saturating_add(nanoseconds);
        fraction = fraction.or_else(|| text[at..end].contains('.').then_some((at, end, UNITS[unit].0)));
        at = end;
    }
    if let Some((start, end, unit)) = fraction.filter(|it| it.1 < text.len()) {
        let message = format!("only the last unit of a duration has a fraction, and `{unit}` is not the last");
        let sign = if negative { "-" } else { "" };
        let meant = format!("{prefix}#{sign}{}", spelled(total));
        return Err(Fault { meant: Some(meant), ..Fault::new(start, end, message) });
    }
    let places: (IsByte, IsByte) = (u8::is_ascii_alphanumeric, u8::is_ascii_digit);
    strokes(text, places, "`_` stands between two digits, or between two units")?;
    let total = if negative { -total } else { total };
    let nanoseconds = i64::try_from(total)
        .map_err(|_| Fault::new(0, text.len(), "the duration does not fit 64 bits of nanoseconds (about 292 years)"))?;
    Ok((nanoseconds, long))
}

/// Nanoseconds in units.
fn spelled(mut nanoseconds: i128) -> String {
    let mut out = String::new();
    for (unit, scale) in UNITS {
        let count = nanoseconds / scale;
        nanoseconds -= count * scale;
        if count > 0 || (out.is_empty() && scale == 1) {
            out += &format!("{count}{unit}");
        }
    }
    out
}

/// One number with its unit: index of the unit, nanoseconds, where it ends.
fn part(text: &str, start: usize) -> Result<(usize, i128, usize), Fault> {
    let rest = &text[start..];
    let number = rest.find(|it: char| it.is_ascii_alphabetic()).unwrap_or(rest.len());
    let after = &rest[number..];
    let letters = after.find(|it: char| !it.is_ascii_alphabetic()).unwrap_or(after.len());
    // `1h_30m`: the stroke belongs to nobody.
    let strokes = after[letters..].len() - after[letters..].trim_start_matches('_').len();
    let end = start + number + letters + strokes;
    let name = after[..letters].to_ascii_lowercase();
    let Some(unit) = UNITS.iter().position(|(it, _)| *it == name) else {
        let message = if name.is_empty() {
            "a duration needs a unit: d, h, m, s, ms, us or ns".into()
        } else {
            format!("`{name}` is no unit of time: expected d, h, m, s, ms, us or ns")
        };
        return Err(Fault::new(start, end.max(start + 1).min(text.len()), message));
    };
    let digits: String = rest[..number].chars().filter(|it| *it != '_').collect();
    let (whole, fraction) = digits.split_once('.').unwrap_or((&digits, ""));
    if whole.is_empty() || fraction.contains('.') {
        return Err(Fault::new(start, end, "expected a number before the unit"));
    }
    let nanoseconds = scaled(whole, fraction, UNITS[unit].1);
    Ok((unit, nanoseconds, end))
}

/// `whole.fraction` times `scale`, saturating, cut to whole nanoseconds.
fn scaled(whole: &str, fraction: &str, scale: i128) -> i128 {
    let whole = whole.parse::<i128>().map_or(i128::MAX, |it| it.saturating_mul(scale));
    // No unit has more than 14 decimal digits of nanoseconds.
    let fraction = &fraction[..fraction.len().min(15)];
    let tenths = 10_i128.pow(u32::try_from(fraction.len()).unwrap_or(0));
    let part = fraction.parse::<i128>().unwrap_or(0) * scale / tenths;
    whole.saturating_add(part)
}

/// `'…'` or `"…"`, escapes resolved; the second value names those that mean nothing.
pub fn string(text: &str, wide: bool) -> (Vec<u8>, Vec<Fault>) {
    let quote = &text[..1];
    let inner = &text[1..];
    let inner = inner.strip_suffix(quote).unwrap_or(inner);
    let mut bytes = Vec::with_capacity(inner.len());
    let mut faults = Vec::new();
    let mut at = 0;
    while let Some(escape) = inner[at..].find('$') {
        bytes.extend_from_slice(&inner.as_bytes()[at..at + escape]);
        at += escape;
        match resolve(&inner[at..], wide, &mut bytes) {
            Some(len) => at += len,
            None => {
                let len = 1 + inner[at + 1..].chars().next().map_or(0, char::len_utf8);
                let shown = &inner[at..at + len];
                let message = format!("`{shown}` is no escape");
                faults.push(Fault::new(1 + at, 1 + at + len, message));
                at += len;
            }
        }
    }
    bytes.extend_from_slice(&inner.as_bytes()[at..]);
    (bytes, faults)
}

/// Writes the character of the escape that `text` starts with; its length.
fn resolve(text: &str, wide: bool, bytes: &mut Vec<u8>) -> Option<usize> {
    let plain = match text.as_bytes().get(1)? {
        letter @ (b'$' | b'\'' | b'"') => *letter,
        b'N' | b'n' | b'L' | b'l' => b'\n',
        b'P' | b'p' => 0x0c,
        b'R' | b'r' => b'\r',
        b'T' | b't' => b'\t',
        _ => return hexadecimal(text, wide, bytes),
    };
    bytes.push(plain);
    Some(2)
}

/// `$0A` is a byte; in a wide string `$00E4` is a UTF-16 unit, a surrogate pair two of them.
fn hexadecimal(text: &str, wide: bool, bytes: &mut Vec<u8>) -> Option<usize> {
    if !wide {
        bytes.push(u8::from_str_radix(digits(text, 1, 2)?, 16).ok()?);
        return Some(3);
    }
    let unit = u16::from_str_radix(digits(text, 1, 4)?, 16).ok()?;
    let second = text[5..].starts_with('$').then(|| digits(text, 6, 4)).flatten();
    let second = second.and_then(|it| u16::from_str_radix(it, 16).ok());
    let mut decoded = char::decode_utf16([unit].into_iter().chain(second));
    let first = decoded.next()?;
    let len = if first.is_ok() && decoded.next().is_none() && second.is_some() { 10 } else { 5 };
    let character = first.unwrap_or(char::REPLACEMENT_CHARACTER);
    bytes.extend_from_slice(character.encode_utf8(&mut [0; 4]).as_bytes());
    Some(len)
}

fn digits(text: &str, start: usize, len: usize) -> Option<&str> {
    let digits = text.get(start..start + len)?;
    digits.bytes().all(|it| it.is_ascii_hexdigit()).then_some(digits)
}
