//! The grammar of JSON (RFC 8259), character by character.

use super::escape::escaped;
use super::value::{Kind, Member, Value};
use core::ops::Range;
use rustc_hash::FxHashSet;

/// Where and why reading ends before the file does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Broken {
    pub place: Range<usize>,
    pub why: String,
}

pub struct Scanner<'t> {
    file: &'t str,
    at: usize,
}

impl<'t> Scanner<'t> {
    pub const fn new(file: &'t str) -> Self {
        Self::within(file, 0)
    }

    /// From a place in the file on.
    pub const fn within(file: &'t str, at: usize) -> Self {
        Self { file, at }
    }

    /// The next value, and in it values of as many levels more.
    pub fn value(&mut self, levels: usize) -> Result<Value, Broken> {
        self.skip_space();
        let start = self.at;
        if levels == 0 {
            return Err(self.broken("values are nested too deeply"));
        }
        let kind = match self.peek() {
            Some(b'{') => Kind::Object(self.object(levels)?),
            Some(b'[') => Kind::List(self.list(levels)?),
            Some(b'"') => self.text()?,
            Some(b'-' | b'0'..=b'9') => self.number()?,
            Some(_) => self.word()?,
            None => return Err(self.broken("the file ends where a value is expected")),
        };
        Ok(Value { place: start..self.at, kind })
    }

    /// What is after the value of the file.
    pub fn end(&mut self) -> Result<(), Broken> {
        self.skip_space();
        if self.at < self.file.len() { Err(self.broken("text after the end of the value")) } else { Ok(()) }
    }

    fn object(&mut self, levels: usize) -> Result<Vec<Member>, Broken> {
        let (mut members, mut names) = (Vec::new(), FxHashSet::default());
        let opened = self.open();
        while !self.closes(b'}', !members.is_empty(), &opened)? {
            self.skip_space();
            if self.peek() != Some(b'"') {
                return Err(self.broken("the name of a member, in quotes, is expected"));
            }
            let name = self.value(levels)?;
            if !names.insert(&self.file[name.place.clone()]) {
                let why = format!("{} is in this object twice", &self.file[name.place.clone()]);
                return Err(Broken { place: name.place, why });
            }
            self.skip_space();
            self.expect(b':', "`:` is expected after the name of a member")?;
            members.push(Member { name, value: self.value(levels - 1)? });
        }
        Ok(members)
    }

    fn list(&mut self, levels: usize) -> Result<Vec<Value>, Broken> {
        let mut values = Vec::new();
        let opened = self.open();
        while !self.closes(b']', !values.is_empty(), &opened)? {
            values.push(self.value(levels - 1)?);
        }
        Ok(values)
    }

    /// Takes a bracket.
    const fn open(&mut self) -> Range<usize> {
        self.at += 1;
        self.at - 1..self.at
    }

    /// Takes the closing bracket, or the comma before one more item.
    fn closes(&mut self, close: u8, has_items: bool, opened: &Range<usize>) -> Result<bool, Broken> {
        self.skip_space();
        match self.peek() {
            None => Err(Broken { place: opened.clone(), why: "this is not closed".to_owned() }),
            Some(byte) if byte == close => {
                self.at += 1;
                Ok(true)
            }
            Some(_) if has_items => {
                let why = format!("`,` or `{}` is expected", char::from(close));
                self.expect(b',', &why).map(|()| false)
            }
            Some(_) => Ok(false),
        }
    }

    fn text(&mut self) -> Result<Kind, Broken> {
        let start = self.at;
        self.at += 1;
        loop {
            match self.peek() {
                None => return Err(Broken { place: start..start + 1, why: "this text is not closed".to_owned() }),
                Some(b'"') => break,
                Some(b'\\') => match escaped(&self.file[self.at..]) {
                    Some((_, length)) => self.at += length,
                    None => return Err(self.broken("no character is written like this")),
                },
                Some(0..=0x1f) => return Err(self.broken("a control character in a string")),
                Some(_) => self.at += 1,
            }
        }
        self.at += 1;
        Ok(Kind::Text)
    }

    /// `-1.5e3`
    fn number(&mut self) -> Result<Kind, Broken> {
        let start = self.at;
        self.at += usize::from(self.peek() == Some(b'-'));
        let zero = self.peek() == Some(b'0');
        let whole = self.digits();
        let mut is_right = whole > 0 && !(zero && whole > 1);
        if self.peek() == Some(b'.') {
            self.at += 1;
            is_right &= self.digits() > 0;
        }
        if let Some(b'e' | b'E') = self.peek() {
            self.at += 1;
            self.at += usize::from(matches!(self.peek(), Some(b'+' | b'-')));
            is_right &= self.digits() > 0;
        }
        match is_right {
            true => Ok(Kind::Number),
            false => Err(Broken { place: start..self.at, why: "this is not a number".to_owned() }),
        }
    }

    fn digits(&mut self) -> usize {
        let start = self.at;
        while let Some(b'0'..=b'9') = self.peek() {
            self.at += 1;
        }
        self.at - start
    }

    fn word(&mut self) -> Result<Kind, Broken> {
        let rest = &self.file[self.at..];
        let words = [("null", Kind::Null), ("true", Kind::Truth), ("false", Kind::Truth)];
        let found = words.into_iter().find(|(word, _)| rest.starts_with(word));
        let (word, kind) = found.ok_or_else(|| self.broken("a value is expected"))?;
        self.at += word.len();
        Ok(kind)
    }

    fn expect(&mut self, byte: u8, why: &str) -> Result<(), Broken> {
        if self.peek() != Some(byte) {
            return Err(self.broken(why));
        }
        self.at += 1;
        Ok(())
    }

    fn peek(&self) -> Option<u8> {
        self.file.as_bytes().get(self.at).copied()
    }

    fn skip_space(&mut self) {
        while let Some(b' ' | b'\t' | b'\r' | b'\n') = self.peek() {
            self.at += 1;
        }
    }

    /// Of the character here; at the end of the file, of the one before it.
    fn broken(&self, why: &str) -> Broken {
        let here = self.file[self.at..].chars().next();
        let place = match here {
            Some(it) => self.at..self.at + it.len_utf8(),
            None => self.file.trim_end().char_indices().next_back().map_or(0..0, |(at, it)| at..at + it.len_utf8()),
        };
        Broken { place, why: why.to_owned() }
    }
}
