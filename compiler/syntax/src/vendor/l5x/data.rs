//! Decorated data: the values of tags, with the types that they have.

use super::super::assembly::Chunk;
use super::super::xml::{Broken, Element, Part, Reader};
use super::names::{legal, plain};
use core::ops::Range;
use staunch_runtime::literal;

/// What a tag, a member or an element has as its value.
#[derive(Clone, Debug)]
pub struct Value<'t> {
    pub ty: &'t str,
    /// The lengths of an array's dimensions.
    pub dimensions: &'t str,
    pub place: Range<usize>,
    pub what: What<'t>,
}

#[derive(Clone, Debug)]
pub enum What<'t> {
    /// A number in Structured Text, and whether it is 0.
    Number(String, bool),
    /// Not a value of its type.
    Odd,
    Text(Chunk, bool),
    List(Vec<Value<'t>>),
    Members(Vec<(Chunk, &'t str, Value<'t>)>),
}

/// The value in an element that was opened, to the element's end.
pub fn within<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Option<Value<'t>>, Broken> {
    let mut value = None;
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => value = Some(read(file, reader, &element, "")?),
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(value)
}

/// A value that was opened, to its end; `ty` is that of an array's elements.
fn read<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>, ty: &'t str) -> Result<Value<'t>, Broken> {
    let ty = element.attribute(file, "DataType").unwrap_or(ty);
    let place = element.place.clone();
    let mut value = Value { ty, dimensions: "", place: place.clone(), what: What::Number("0".to_owned(), true) };
    match element.name {
        "Array" | "ArrayMember" => {
            value.dimensions = element.attribute(file, "Dimensions").unwrap_or_default();
            if array_of(value.dimensions).is_none() {
                let why = format!("`{}` are not dimensions of an array", value.dimensions);
                return Err(Broken { place, why });
            }
            let elements = inner(file, reader, ty)?;
            let mut due = vec![0; lengths(value.dimensions).len()];
            for (_, index, element) in &elements {
                if !index.is_empty() && lengths(index) != due {
                    let why = format!("the element {index} of an array, where the element {due:?} was expected");
                    return Err(Broken { place: element.place.clone(), why });
                }
                advance(&mut due, &lengths(value.dimensions));
            }
            value.what = What::List(elements.into_iter().map(|it| it.2).collect());
        }
        "Structure" | "StructureMember" => {
            let members = inner(file, reader, "")?;
            // A string is its length and its characters, which are one text.
            let text =
                members.iter().find(|it| it.1.eq_ignore_ascii_case("DATA") && matches!(it.2.what, What::Text(..)));
            value.what = match text {
                Some((_, _, text)) => text.what.clone(),
                None => What::Members(members),
            };
        }
        _ => {
            let written = element.attribute(file, "Value");
            let (held, text) = content(file, reader, ty)?;
            value.what = match (written, held, text) {
                (Some(written), ..) => number(ty, written),
                (None, Some(held), _) => return Ok(Value { place, ..held }),
                (None, None, Some(text)) => characters(file, ty, text),
                // `<![CDATA[]]>`: the characters of a string that is empty.
                (None, None, None) if element.attribute(file, "Radix") == Some("ASCII") && bits(ty).is_none() => {
                    What::Text(Chunk::words("''", &place), true)
                }
                (None, None, None) => value.what,
            };
        }
    }
    Ok(value)
}

/// The numbers of `2,3` or `[0,1]`.
fn lengths(text: &str) -> Vec<u64> {
    text.split(|it: char| !it.is_ascii_digit()).filter_map(|it| it.parse().ok()).collect()
}

/// The index of the next element, the last dimension first.
fn advance(index: &mut [u64], lengths: &[u64]) {
    for (at, length) in index.iter_mut().zip(lengths).rev() {
        *at += 1;
        if *at < *length {
            return;
        }
        *at = 0;
    }
}

/// The members, by their names, or elements, by their indices, of an element that was opened, to its end.
type Inner<'t> = Vec<(Chunk, &'t str, Value<'t>)>;

fn inner<'t>(file: &'t str, reader: &mut Reader<'t>, ty: &'t str) -> Result<Inner<'t>, Broken> {
    let mut all = Vec::new();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => {
                let name =
                    element.attribute(file, "Name").or_else(|| element.attribute(file, "Index")).unwrap_or_default();
                let chunk = name_of(file, &element).unwrap_or_else(|| Chunk::words("", &element.place));
                all.push((chunk, name, read(file, reader, &element, ty)?));
            }
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(all)
}

/// The structure or the text in an element that was opened, to its end.
fn content<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    ty: &'t str,
) -> Result<(Option<Value<'t>>, Option<Chunk>), Broken> {
    let (mut value, mut text) = (None, None);
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => value = Some(read(file, reader, &element, ty)?),
            Part::Text(chunk) if !file[chunk.place.clone()].trim().is_empty() => text = Some(chunk),
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok((value, text))
}

/// What is in quotes: the text of a string, else one character after the other of a number.
fn characters<'t>(file: &str, ty: &str, chunk: Chunk) -> What<'t> {
    let text = file[chunk.place.clone()].trim();
    if bits(ty).is_some() { number(ty, text) } else { What::Text(chunk, text == "''") }
}

/// The text of a string: `<Data Format="String"><![CDATA['…']]></Data>`.
pub fn text<'t>(file: &'t str, reader: &mut Reader<'t>, place: &Range<usize>) -> Result<Option<Value<'t>>, Broken> {
    let (_, text) = content(file, reader, "STRING")?;
    let what = |chunk| characters(file, "STRING", chunk);
    Ok(text.map(|it| Value { ty: "STRING", dimensions: "", place: place.clone(), what: what(it) }))
}

/// Numbers of the older form, which is positions without names: one alone, or those of an array.
pub fn plain_numbers<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    ty: &'t str,
    place: &Range<usize>,
) -> Result<Option<Value<'t>>, Broken> {
    let (_, text) = content(file, reader, ty)?;
    let is_number = bits(ty).is_some() || matches!(ty, "BOOL" | "REAL" | "LREAL");
    let Some(text) = text.map(|it| file[it.place].trim()).filter(|it| is_number && !it.starts_with('\'')) else {
        return Ok(None);
    };
    let value = |what| Value { ty, dimensions: "", place: place.clone(), what };
    if !text.starts_with('[') {
        return Ok(Some(value(number(ty, text))));
    }
    // The elements of several dimensions are in one row, as an initial value has them.
    let elements = text.split(['[', ']', ',']).map(str::trim).filter(|it| !it.is_empty());
    let elements = elements.map(|it| value(number(ty, it))).collect();
    Ok(Some(value(What::List(elements))))
}

/// The bits of an integer's type, and whether it has a sign.
fn bits(ty: &str) -> Option<(u32, bool)> {
    Some(match ty {
        "SINT" => (8, true),
        "INT" => (16, true),
        "DINT" => (32, true),
        "LINT" => (64, true),
        "USINT" => (8, false),
        "UINT" => (16, false),
        "UDINT" => (32, false),
        "ULINT" => (64, false),
        _ => return None,
    })
}

/// A number as Structured Text has it.
fn number<'t>(ty: &str, written: &str) -> What<'t> {
    let written = written.trim();
    if matches!(ty, "BOOL" | "BIT") {
        return match (written, integer(written)) {
            ("true", _) | (_, Some(1)) => What::Number("TRUE".to_owned(), false),
            ("false", _) | (_, Some(0)) => What::Number("FALSE".to_owned(), true),
            _ => What::Odd,
        };
    }
    if matches!(ty, "DT" | "LDT" | "TIME" | "LTIME") {
        return moment(ty, written);
    }
    let Some((bits, is_signed)) = bits(ty) else { return real(written) };
    let Some(value) = integer(written).or_else(|| microseconds(written)) else { return What::Odd };
    // Digits of other bases are the bits.
    let limit = 1_i128 << bits;
    let value = if is_signed && value >= limit / 2 && value < limit { value - limit } else { value };
    What::Number(value.to_string(), value == 0)
}

/// `DT#1970-01-01-00:00:00.000_000Z`, `T#0us`: what is 0 of these is a time, too.
fn moment<'t>(ty: &str, written: &str) -> What<'t> {
    let Some((_, digits)) = written.split_once('#') else { return What::Odd };
    let is_zero = match date(written) {
        Some(it) => it == 0,
        None => !digits.contains(|it: char| ('1'..='9').contains(&it)),
    };
    let digits = digits.strip_suffix('Z').map_or_else(|| digits.to_owned(), |it| it.replace('_', ""));
    What::Number(format!("{ty}#{digits}"), is_zero)
}

/// A date as a number of microseconds, which a LINT shows as one.
fn microseconds(written: &str) -> Option<i128> {
    Some(date(written)? / 1000)
}

/// `DT#2024-02-29-12:30:00.000_000Z`, in nanoseconds since 1970.
fn date(written: &str) -> Option<i128> {
    let (prefix, rest) = written.strip_suffix('Z')?.split_once('#')?;
    if !matches!(prefix, "DT" | "LDT") {
        return None;
    }
    literal::date_and_time(rest).ok().map(i128::from)
}

fn real<'t>(written: &str) -> What<'t> {
    // Logix writes NaN and infinities as `1.#QNAN` and the like, which have no literal.
    let Ok(value) = written.parse::<f64>() else { return What::Odd };
    let text = if written.contains(['.', 'e', 'E', '#']) { written.to_owned() } else { format!("{written}.0") };
    // The sign of a zero is a value, too.
    What::Number(text, value == 0.0 && value.is_sign_positive())
}

fn integer(written: &str) -> Option<i128> {
    if let Some(inner) = written.strip_prefix('\'') {
        return of_characters(&without_entities(inner.strip_suffix('\'')?));
    }
    let (base, digits) = match written.split_once('#') {
        Some((base, digits)) => (base.parse().ok().filter(|it| (2..=16).contains(it))?, digits),
        None => (10, written),
    };
    i128::from_str_radix(&digits.replace('_', ""), base).ok()
}

/// What an attribute has in place of characters that are signs of XML.
fn without_entities(text: &str) -> String {
    let entities = [("&quot;", "\""), ("&apos;", "'"), ("&lt;", "<"), ("&gt;", ">"), ("&amp;", "&")];
    entities.iter().fold(text.to_owned(), |text, (entity, sign)| text.replace(entity, sign))
}

/// `$00$41`, `A$r`: the first is the highest byte.
fn of_characters(text: &str) -> Option<i128> {
    let mut value: i128 = 0;
    let mut rest = text.chars();
    while let Some(it) = rest.next() {
        let byte = if it == '$' { escaped(&mut rest)? } else { u8::try_from(it).ok()? };
        value = value.checked_mul(256)? + i128::from(byte);
    }
    Some(value)
}

fn escaped(rest: &mut core::str::Chars<'_>) -> Option<u8> {
    Some(match rest.next()? {
        'r' | 'R' => 13,
        'n' | 'N' | 'l' | 'L' => 10,
        't' | 'T' => 9,
        'p' | 'P' => 12,
        it @ ('$' | '\'') => u8::try_from(it).ok()?,
        high => u8::try_from(high.to_digit(16)? * 16 + rest.next()?.to_digit(16)?).ok()?,
    })
}

impl Value<'_> {
    pub fn is_zero(&self) -> bool {
        match &self.what {
            What::Number(_, is_zero) | What::Text(_, is_zero) => *is_zero,
            What::Odd => false,
            What::List(elements) => elements.iter().all(Self::is_zero),
            What::Members(members) => members.iter().all(|it| it.2.is_zero()),
        }
    }

    /// Writes it as an initial value; of a structure what is 0 may be left out, unless `all` is wanted, and what is
    /// `hidden`, a member of a type, always is.
    pub fn write(&self, all: bool, hidden: &dyn Fn(&str, &str) -> bool, out: &mut Vec<Chunk>) {
        let place = &self.place;
        match &self.what {
            What::Number(text, _) => out.push(Chunk::words(text.clone(), place)),
            What::Odd => {
                out.push(Chunk::odd(format!("this is not a value of the type {}", self.ty), place));
                out.push(Chunk::words(nothing(self.ty), place));
            }
            What::Text(chunk, _) => out.push(chunk.clone()),
            What::List(elements) => {
                for (at, element) in elements.iter().enumerate() {
                    out.push(Chunk::words(if at == 0 { "[" } else { ", " }, place));
                    element.write(all, hidden, out);
                }
                out.push(Chunk::words("]", place));
            }
            What::Members(members) => {
                let mut before = "(";
                for (at, (name, text, member)) in members.iter().enumerate() {
                    let is_said = all || !member.is_zero() || (at == 0 && self.is_zero());
                    if is_said && !hidden(self.ty, text) {
                        out.extend([Chunk::words(before, place), name.clone(), Chunk::words(" := ", place)]);
                        member.write(all, hidden, out);
                        before = ", ";
                    }
                }
                out.push(Chunk::words(")", place));
            }
        }
    }
}

/// What is written in place of a value that is none of its type.
fn nothing(ty: &str) -> &'static str {
    match ty {
        "DT" => "DT#1970-01-01-00:00:00",
        "LDT" => "LDT#1970-01-01-00:00:00",
        "TIME" => "T#0s",
        "LTIME" => "LTIME#0s",
        _ => "0",
    }
}

/// A type's name in Structured Text. A string of Logix has 82 characters.
pub fn ty_text(ty: &str) -> Option<String> {
    match ty {
        "BIT" => Some("BOOL".to_owned()),
        "STRING" => Some("STRING[82]".to_owned()),
        _ => ty.contains(':').then(|| plain(ty)),
    }
}

/// What an element is called, in Structured Text.
pub fn name_of<'t>(file: &'t str, element: &Element<'t>) -> Option<Chunk> {
    let place = element.attribute_place(file, "Name")?;
    let name = &file[place.clone()];
    Some(match legal(name) {
        Some(legal) => Chunk::words(legal, &place),
        None if name.contains(':') => Chunk::words(plain(name), &place),
        None => Chunk::verbatim(place),
    })
}

/// `ARRAY[0..9, 0..4] OF ` for `10 5`; nothing where all are 0, and `None` if these are not lengths.
pub fn array_of(dimensions: &str) -> Option<String> {
    let parts = dimensions.split([' ', ',']).filter(|it| !it.is_empty());
    let lengths: Vec<u32> = parts.map(|it| it.parse().ok()).collect::<Option<_>>()?;
    let used = lengths.iter().position(|it| *it == 0).unwrap_or(lengths.len());
    // Dimensions that are not there are 0, the last ones.
    if lengths[used..].iter().any(|it| *it > 0) {
        return None;
    }
    let bounds: Vec<_> = lengths[..used].iter().map(|it| format!("0..{}", it - 1)).collect();
    Some(if bounds.is_empty() { String::new() } else { format!("ARRAY[{}] OF ", bounds.join(", ")) })
}
