//! A value of JSON, with its place in the file.

use super::super::assembly::{Chunk, Says};
use super::escape::escaped;
use core::ops::Range;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Value {
    /// With the quotes of a text, the braces of an object.
    pub place: Range<usize>,
    pub kind: Kind,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    Null,
    Truth,
    Number,
    Text,
    List(Vec<Value>),
    Object(Vec<Member>),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// A text.
    pub name: Value,
    pub value: Value,
}

impl Value {
    /// What this is, with its article.
    pub const fn what(&self) -> &'static str {
        match self.kind {
            Kind::Null => "null",
            Kind::Truth => "a truth value",
            Kind::Number => "a number",
            Kind::Text => "a string",
            Kind::List(_) => "a list",
            Kind::Object(_) => "an object",
        }
    }

    /// As it is in the file; of a text, what is between its quotes.
    pub fn raw<'t>(&self, file: &'t str) -> &'t str {
        match self.kind {
            Kind::Text => &file[self.place.start + 1..self.place.end - 1],
            Kind::Null | Kind::Truth | Kind::Number | Kind::List(_) | Kind::Object(_) => &file[self.place.clone()],
        }
    }

    /// A text's characters.
    pub fn text(&self, file: &str) -> String {
        let mut text = String::new();
        for Chunk { place, says } in self.chunks(file) {
            match says {
                Says::Itself => text.push_str(&file[place]),
                Says::Symbol(symbol) => text.push(symbol),
                Says::Words(words) => text.push_str(&words),
                Says::Wrong(..) => {}
            }
        }
        text
    }

    /// A text in pieces of the file: `\n` and its like stand for one character each.
    pub fn chunks(&self, file: &str) -> Vec<Chunk> {
        let inner = self.raw(file);
        let start = self.place.start + 1;
        let (mut chunks, mut at) = (Vec::new(), 0);
        while at < inner.len() {
            let rest = &inner[at..];
            let length = rest.find('\\').unwrap_or(rest.len());
            if length > 0 {
                chunks.push(Chunk::verbatim(start + at..start + at + length));
                at += length;
                continue;
            }
            let (symbol, length) = escaped(rest).unwrap_or((char::REPLACEMENT_CHARACTER, 1));
            let place = start + at..start + at + length;
            chunks.push(Chunk { place, says: Says::Symbol(symbol) });
            at += length;
        }
        chunks
    }
}
