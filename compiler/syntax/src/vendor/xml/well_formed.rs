//! What XML asks of a tag, and of references to characters and entities, beyond that its end is found.

use core::ops::Range;
use rustc_hash::FxHashSet;

/// Where and why it is not well-formed.
pub type Wrong = (Range<usize>, String);

const LESS: &str = "a `<` in a text is written `&lt;`";
const AND: &str = "a `&` in a text is written `&amp;`";

/// A tag that opens an element: its name, and attributes that differ, each with a value in quotes.
pub fn tag(file: &str, place: &Range<usize>) -> Result<(), Wrong> {
    let start = place.start + 1;
    let end = place.end - if file[place.clone()].ends_with("/>") { 2 } else { 1 };
    let name = name(&file[start..end]);
    if name == 0 {
        return wrong(place.start..start, LESS);
    }
    let (mut at, mut names) = (start + name, FxHashSet::default());
    loop {
        let space = space(&file[at..end]);
        if at + space == end {
            return Ok(());
        }
        if space == 0 && self::name(&file[at..end]) > 0 {
            return wrong(at..at + self::name(&file[at..end]), "a space is missing before this attribute");
        }
        at = attribute(file, at + space..end, &mut names)?;
    }
}

/// `Name="Motor"`, with which a text begins; where it ends.
fn attribute<'t>(file: &'t str, place: Range<usize>, names: &mut FxHashSet<&'t str>) -> Result<usize, Wrong> {
    let Range { start, end } = place;
    let length = name(&file[start..end]);
    let name = &file[start..start + length];
    if length == 0 {
        let first = file[start..end].chars().next().map_or(0, char::len_utf8);
        return wrong(start..start + first, format!("an attribute is `Name=\"value\"`; {LESS}"));
    }
    if !names.insert(name) {
        return wrong(start..start + length, format!("the attribute `{name}` is given twice"));
    }
    let sign = start + length + space(&file[start + length..end]);
    if !file[sign..end].starts_with('=') {
        let message = format!("the attribute `{name}` has no value; {LESS}");
        return wrong(start..start + length, message);
    }
    let open = sign + 1 + space(&file[sign + 1..end]);
    let quote = file[open..end].chars().next().filter(|it| matches!(it, '"' | '\''));
    let Some((value, quote)) = quote.and_then(|quote| Some((file[open + 1..end].find(quote)?, quote))) else {
        return wrong(start..sign + 1, format!("the value of the attribute `{name}` is not in quotes"));
    };
    let value = open + 1..open + 1 + value;
    values(file, &value)?;
    Ok(value.end + quote.len_utf8())
}

/// The value of an attribute.
fn values(file: &str, place: &Range<usize>) -> Result<(), Wrong> {
    let mut rest = place.clone();
    while let Some(at) = file[rest.clone()].find(['<', '&']) {
        let at = rest.start + at;
        if file[at..].starts_with('<') {
            return wrong(at..at + 1, LESS);
        }
        let Some(length) = file[at..rest.end].find(';') else { return wrong(at..at + 1, AND) };
        let end = at + length + 1;
        if character(&file[at + 1..end - 1]).is_none() {
            return Err(unknown(file, at..end));
        }
        rest.start = end;
    }
    Ok(())
}

/// The character that `&name;` is.
pub fn character(name: &str) -> Option<char> {
    match name {
        "lt" => Some('<'),
        "gt" => Some('>'),
        "amp" => Some('&'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        _ => number(name.strip_prefix('#')?),
    }
}

/// `#65` and `#x41`. What XML's characters do not have, `&#0;`, is none.
fn number(digits: &str) -> Option<char> {
    let code = match digits.strip_prefix('x') {
        Some(digits) => u32::from_str_radix(digits.strip_prefix('+').map_or(digits, |_| ""), 16),
        None => digits.strip_prefix('+').map_or(digits, |_| "").parse(),
    };
    char::from_u32(code.ok()?).filter(|it| *it >= ' ' || matches!(it, '\t' | '\n' | '\r'))
}

/// What `&name;` is if it is not a character.
pub fn unknown(file: &str, place: Range<usize>) -> Wrong {
    let inner = &file[place.start + 1..place.end - 1];
    if !inner.starts_with('#') && (name(inner) == 0 || name(inner) < inner.len()) {
        return (place.start..place.start + 1, AND.to_owned());
    }
    let written = &file[place.clone()];
    let what = if inner.starts_with('#') { "not a character" } else { "an entity that XML itself does not have" };
    let why = format!("`{written}` is {what}; {AND}");
    (place, why)
}

/// What a text is, between tags, that is not well-formed.
pub fn text(file: &str, place: &Range<usize>) -> Result<(), Wrong> {
    match file[place.clone()].find("]]>") {
        Some(at) => wrong(place.start + at..place.start + at + 3, "a `]]>` in a text is written `]]&gt;`"),
        None => Ok(()),
    }
}

/// Where and why reading ends before a text, by `why` where what it begins with says no more.
pub fn end(file: &str, at: usize, why: &str) -> Wrong {
    let rest = &file[at..];
    let line = at..at + rest.find(['\n', '\r']).unwrap_or(rest.len());
    match rest.split_at_checked(1) {
        Some(("&", _)) => (at..at + 1, AND.to_owned()),
        Some(("<", after)) if name(after) > 0 => (line, format!("{why}; {LESS}")),
        Some(("<", after)) if !after.starts_with(['/', '!', '?']) => (at..at + 1, LESS.to_owned()),
        _ => (line, why.to_owned()),
    }
}

fn wrong<T>(place: Range<usize>, why: impl Into<String>) -> Result<T, Wrong> {
    Err((place, why.into()))
}

fn space(text: &str) -> usize {
    text.find(|it| !matches!(it, ' ' | '\t' | '\r' | '\n')).unwrap_or(text.len())
}

/// The length of a name that a text begins with.
fn name(text: &str) -> usize {
    let is_first = |it: char| it.is_alphabetic() || matches!(it, '_' | ':');
    let is_next = |it: char| it.is_alphanumeric() || matches!(it, '_' | ':' | '-' | '.' | '\u{b7}');
    if text.starts_with(is_first) { text.find(|it| !is_next(it)).unwrap_or(text.len()) } else { 0 }
}
