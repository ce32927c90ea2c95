//! Texts: STRING and WSTRING, their functions, and their characters.

use crate::expressions::in_repr;
use crate::functions::positions;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::places::Character;
use crate::storage::{Cell, Place, Value, integer_cell};
use crate::types::{Elementary, Text, Type};
use staunch_frontend::ast::{Argument, Chars, Expr};
use staunch_runtime::{FaultKind, Value as Scalar};

/// Bytes, or code units.
pub(crate) type Units = Vec<u16>;

pub(crate) fn units(chars: &Chars) -> Units {
    match chars {
        Chars::Narrow(bytes) => bytes.iter().copied().map(u16::from).collect(),
        Chars::Wide(units) => units.clone(),
    }
}

/// As a trace shows it.
pub(crate) fn shown(units: &[u16], wide: bool) -> String {
    let chars = match wide {
        true => Chars::Wide(units.to_vec()),
        false => Chars::Narrow(units.iter().filter_map(|it| u8::try_from(*it).ok()).collect()),
    };
    format!("{:?}", chars.text())
}

impl<'a> Value<'a> {
    /// A text, or the one of a character.
    pub fn as_text(&self) -> Outcome<Units> {
        match self.cells.as_slice() {
            [Cell::Text(it)] => Ok(it.clone()),
            [Cell::Scalar(Scalar::U8(it))] if self.is_character() => Ok(vec![u16::from(*it)]),
            [Cell::Scalar(Scalar::U16(it))] if self.is_character() => Ok(vec![*it]),
            _ => unknown("a value that is not a text"),
        }
    }

    pub fn is_character(&self) -> bool {
        matches!(self.ty, Type::Elementary(Elementary::Char | Elementary::Wchar))
    }

    /// Whether it is a text, or a character, which becomes one.
    pub fn is_text(&self) -> bool {
        self.is_character() || matches!(self.ty, Type::Text(_))
    }

    fn is_wide(&self) -> bool {
        match &self.ty {
            Type::Text(it) => it.wide,
            _ => self.ty.elementary() == Some(Elementary::Wchar),
        }
    }
}

/// The number of units before a position that counts so many: none below 0, all beyond the end.
fn before(text: &[u16], count: i128) -> usize {
    usize::try_from(count.max(0)).unwrap_or(usize::MAX).min(text.len())
}

/// `REPLACE`: `by` where `count` units are, the first of them at `position`.
fn replaced(text: &[u16], by: &[u16], count: i128, position: i128) -> Units {
    let (start, rest) = text.split_at(before(text, position - 1));
    [start, by, &rest[before(rest, count)..]].concat()
}

/// `FIND`: the position of the first match of a pattern.
fn found(text: &[u16], pattern: &[u16]) -> usize {
    let is_there = |at: &usize| text[*at..].starts_with(pattern);
    (0..text.len()).find(|it| !pattern.is_empty() && is_there(it)).map_or(0, |it| it + 1)
}

/// The names of a function's parameters, the standard's and those of CODESYS.
fn parameters(name: &str) -> (&'static [&'static str], &'static [&'static str]) {
    match name {
        "LEN" => (&["IN"], &["STR"]),
        "FIND" | "CONCAT" => (&["IN1", "IN2"], &["STR1", "STR2"]),
        "LEFT" | "RIGHT" => (&["IN", "L"], &["STR", "SIZE"]),
        "MID" | "DELETE" => (&["IN", "L", "P"], &["STR", "LEN", "POS"]),
        "INSERT" => (&["IN1", "IN2", "P"], &["STR1", "STR2", "POS"]),
        _ => (&["IN1", "IN2", "L", "P"], &["STR1", "STR2", "L", "P"]),
    }
}

/// A number as CODESYS spells it.
fn digits(value: &Value<'_>) -> Outcome<Units> {
    if let Type::Enum(_) = value.ty {
        return unknown("the text of an enumeration");
    }
    let is_number = value.ty.base().is_some_and(|it| it.is_integer() || it.is_bits());
    let text = match value.as_scalar()? {
        Scalar::Bool(it) => if it { "TRUE" } else { "FALSE" }.to_owned(),
        it if is_number => it.as_integer().map_or_else(String::new, |it| it.to_string()),
        _ => return unknown("how this value is spelled"),
    };
    Ok(text.bytes().map(u16::from).collect())
}

/// The characters of a text as UTF-16, or as UTF-8: a byte that belongs to none is the one of its number.
fn of_width(text: &[u16], wide: bool) -> Units {
    if !wide {
        let characters = char::decode_utf16(text.iter().copied()).map(|it| it.unwrap_or('?'));
        return characters.collect::<String>().bytes().map(u16::from).collect();
    }
    let bytes: Vec<u8> = text.iter().filter_map(|it| u8::try_from(*it).ok()).collect();
    let chunks = bytes.utf8_chunks();
    let characters = chunks.flat_map(|it| it.valid().chars().chain(it.invalid().iter().map(|it| char::from(*it))));
    characters.collect::<String>().encode_utf16().collect()
}

impl<'a> Machine<'a> {
    pub(crate) fn text_function(
        &mut self,
        frame: &Frame<'a>,
        name: &str,
        arguments: &'a [Argument<'a>],
    ) -> Outcome<Value<'a>> {
        let (names, others) = parameters(name);
        let given = positions(names, arguments).or_else(|_| positions(others, arguments))?;
        let mut values: Vec<(usize, Value<'a>)> = Vec::new();
        for (position, expr) in given {
            let counts = names.get(position).is_some_and(|it| matches!(*it, "L" | "P"));
            let value = if counts { self.count_of_text(frame, expr)? } else { self.value(frame, expr, None)? };
            values.push((position, value));
        }
        values.sort_by_key(|it| it.0);
        let text = |at: usize| values[at].1.as_text();
        let count = |at: usize| values[at].1.as_integer();
        let number = |it: usize| Ok(Value::scalar(Elementary::Int, Scalar::I16(i16::try_from(it).unwrap_or(i16::MAX))));
        let made = match name {
            "LEN" => return number(text(0)?.len()),
            "FIND" => return number(found(&text(0)?, &text(1)?)),
            "LEFT" => text(0)?[..before(&text(0)?, count(1)?)].to_vec(),
            "RIGHT" => {
                let all = text(0)?;
                let length = i128::try_from(all.len()).unwrap_or(i128::MAX);
                all[before(&all, length - count(1)?)..].to_vec()
            }
            "MID" => {
                let all = text(0)?;
                let rest = &all[before(&all, count(2)? - 1)..];
                rest[..before(rest, count(1)?)].to_vec()
            }
            "DELETE" => replaced(&text(0)?, &[], count(1)?, count(2)?),
            // After the character at the position.
            "INSERT" => replaced(&text(0)?, &text(1)?, 0, count(2)? + 1),
            "REPLACE" => replaced(&text(0)?, &text(1)?, count(2)?, count(3)?),
            _ => {
                let all: Outcome<Vec<Units>> = values.iter().map(|it| it.1.as_text()).collect();
                all?.concat()
            }
        };
        Ok(Value::text(made, values[0].1.is_wide()))
    }

    /// A count or a position. In CODESYS these functions are a library's: what is computed at 32 bits is passed at its own type.
    fn count_of_text(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<Value<'a>> {
        let value = self.value(frame, expr, Some(&Type::LINT))?;
        let passed = match value.ty.elementary().filter(|it| self.is_codesys() && self.promotes(*it)) {
            Some(own) => in_repr(value.as_scalar()?, own),
            None => value,
        };
        self.converted(passed, &Type::LINT, expr.span)
    }

    /// To and from texts and characters; `None` for another conversion.
    pub(crate) fn text_converted(&self, value: &Value<'a>, to: &str) -> Outcome<Option<Value<'a>>> {
        let is_text = matches!(value.ty, Type::Text(_));
        let character = Elementary::named(to).filter(|it| it.is_char());
        let made = match (to, character) {
            ("STRING" | "WSTRING", _) => {
                let wide = to == "WSTRING";
                let units = if value.is_text() { value.as_text()? } else { digits(value)? };
                Value::text(if value.is_wide() == wide { units } else { of_width(&units, wide) }, wide)
            }
            // The first character.
            (_, Some(ty)) if is_text => {
                let first = value.as_text()?.first().copied().unwrap_or(0);
                Value { ty: Type::Elementary(ty), cells: vec![integer_cell(ty, i128::from(first))] }
            }
            (_, Some(Elementary::Char)) if value.is_wide() && value.as_integer()? > 255 => {
                Value::scalar(Elementary::Char, Scalar::U8(b'?'))
            }
            _ if is_text => return unknown("what a text is read as"),
            _ => return Ok(None),
        };
        Ok(Some(made))
    }

    /// `s[i]`: the standard counts from 1, CODESYS from 0; there the one after the last is 0.
    pub(crate) fn character(
        &self,
        base: &Place<'a>,
        text: Text,
        number: i128,
        fault: (FaultKind, staunch_frontend::Span),
    ) -> Outcome<Place<'a>> {
        let capacity = i128::try_from(text.capacity).unwrap_or(i128::MAX);
        let (first, last) = if self.is_codesys() { (0, capacity) } else { (1, capacity) };
        if !(first..=last).contains(&number) {
            return Err(self.fault(fault.0, fault.1));
        }
        let ty = match (self.is_codesys(), text.wide) {
            (true, false) => Elementary::Byte,
            (true, true) => Elementary::Word,
            (false, false) => Elementary::Char,
            (false, true) => Elementary::Wchar,
        };
        let at = usize::try_from(number - first).unwrap_or(0);
        let character = Some(Character { at, capacity: text.capacity });
        Ok(Place { ty: Type::Elementary(ty), declared: None, character, ..base.clone() })
    }

    /// The character of a text; 0 after its end.
    pub(crate) fn read_character(&self, place: &Place<'a>, at: usize) -> Cell<'a> {
        let unit = match &self.memory[place.at] {
            Cell::Text(text) => text.get(at).copied().unwrap_or(0),
            Cell::Scalar(_) | Cell::Bytes(_) | Cell::Reference(_) => 0,
        };
        integer_cell(place.ty.elementary().unwrap_or(Elementary::Word), i128::from(unit))
    }

    /// A 0 ends the text; what is beyond its end lengthens it, with zeros in between.
    pub(crate) fn write_character(
        &mut self,
        place: &Place<'a>,
        Character { at, capacity }: Character,
        cell: &Cell<'a>,
    ) {
        let (Cell::Text(text), Cell::Scalar(value)) = (&mut self.memory[place.at], cell) else { return };
        let unit = value.as_integer().and_then(|it| u16::try_from(it).ok()).unwrap_or(0);
        if unit == 0 {
            text.truncate(at);
        } else if at < capacity {
            text.resize(text.len().max(at + 1), 0);
            text[at] = unit;
        }
    }
}
