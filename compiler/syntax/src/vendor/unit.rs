//! A POU as the files of other systems hold it, in parts, and how it is written in Structured Text.

use super::assembly::{Assembly, Chunk, Says, Trouble};
use core::ops::Range;

/// What a part of a file declares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// A POU, an interface, a type or a list of global variables: its declaration says which.
    Unit,
    Method,
    Property,
    Get,
    Set,
    Action,
}

/// A body.
#[derive(Clone, Debug, Default)]
pub enum Body {
    #[default]
    None,
    Text(Vec<Chunk>),
    /// A language that is not text, and where it begins.
    Other(&'static str, Range<usize>),
}

#[derive(Clone, Debug)]
pub struct Unit<'t> {
    pub what: What,
    pub name: &'t str,
    /// Where it begins in the file.
    pub place: Range<usize>,
    /// Where it ends.
    pub end: Range<usize>,
    pub declaration: Vec<Chunk>,
    pub body: Body,
    /// Where a second one begins.
    pub second_body: Option<Range<usize>>,
    pub parts: Vec<Unit<'t>>,
}

impl<'t> Unit<'t> {
    pub fn new(what: What, name: &'t str, place: Range<usize>) -> Self {
        let end = place.end..place.end;
        Self { what, name, place, end, declaration: Vec::new(), body: Body::None, second_body: None, parts: Vec::new() }
    }

    /// Takes a body, if it is the first.
    pub fn take_body(&mut self, body: Body, place: Range<usize>) {
        match (&self.body, &body) {
            (Body::None, _) => self.body = body,
            (_, Body::None) => {}
            (Body::Text(_) | Body::Other(..), Body::Text(_) | Body::Other(..)) => {
                self.second_body.get_or_insert(place);
            }
        }
    }

    /// Writes it with its parts before its body, and its end, which declarations of other systems lack.
    pub fn write(&self, file: &str, out: &mut Assembly) {
        match self.what {
            What::Get => out.write("\nGET\n", &self.place),
            What::Set => out.write("\nSET\n", &self.place),
            What::Action => out.write(&format!("\nACTION {}\n", self.name), &self.place),
            What::Unit | What::Method | What::Property => {}
        }
        out.copy(file, &self.declaration);
        out.write("\n", &self.end);
        self.close_comments(file, &self.declaration, "declaration", out);
        for part in &self.parts {
            part.write(file, out);
        }
        match &self.body {
            Body::None => {}
            Body::Text(chunks) => {
                out.copy(file, chunks);
                self.close_comments(file, chunks, "body", out);
            }
            Body::Other(language, place) => {
                let message = format!("the body of `{}` is {language}, not Structured Text", self.name);
                out.problem(Trouble::OtherLanguage, message, place);
            }
        }
        if let Some(place) = &self.second_body {
            let message =
                format!("`{}` has several bodies (worksheets), whose order the file does not give", self.name);
            out.problem(Trouble::SecondBody, message, place);
        }
        let end = match self.what {
            What::Get => "END_GET",
            What::Set => "END_SET",
            What::Action => "END_ACTION",
            What::Method => "END_METHOD",
            What::Property => "END_PROPERTY",
            What::Unit => end(file, &self.declaration),
        };
        match self.own_end(file, end) {
            Some(place) => out.problem(Trouble::SecondEnd, format!("`{end}` is not a part of this text"), &place),
            None => out.write(&format!("\n{end}\n"), &self.end),
        }
    }

    /// Where the body itself has the word that ends it, as its last.
    fn own_end(&self, file: &str, end: &str) -> Option<Range<usize>> {
        let Body::Text(chunks) = &self.body else { return None };
        let [.., Chunk { place, says: Says::Itself }] = chunks.as_slice() else { return None };
        let text = file[place.clone()].trim_end_matches(|it: char| it.is_whitespace() || it == ';');
        let start = text.len().checked_sub(end.len()).filter(|_| !end.is_empty())?;
        let word = text.get(start..).filter(|it| it.eq_ignore_ascii_case(end))?;
        let line = text[..start].rsplit('\n').next()?;
        let begins = !line.ends_with(|it: char| it.is_ascii_alphanumeric() || it == '_');
        let start = place.start + start;
        (begins && !line.contains("//")).then(|| start..start + word.len())
    }
}

impl Unit<'_> {
    /// Reports a comment that is still open where its part of the file ends, and closes it there.
    fn close_comments(&self, file: &str, chunks: &[Chunk], what: &str, out: &mut Assembly) {
        let text: String = chunks.iter().map(|it| it.said(file)).collect();
        let Some((mut at, close)) = open_comment(&text) else { return };
        let mut place = self.place.clone();
        for chunk in chunks {
            let length = chunk.said(file).len();
            if at < length {
                let start = chunk.place.start + if chunk.says == Says::Itself { at } else { 0 };
                place = start..chunk.place.end.min(start + 2);
                break;
            }
            at -= length;
        }
        out.write(&close, &place);
        out.problem(Trouble::Open, format!("a comment in the {what} of `{}` is not closed", self.name), &place);
    }
}

/// Where a comment begins that is not closed, and what closes all that are open there: they may be inside of one another.
fn open_comment(text: &str) -> Option<(usize, String)> {
    let bytes = text.as_bytes();
    let mut opened = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let rest = &bytes[at..];
        at += match rest {
            [b'(', b'*', ..] => {
                opened.push(at);
                2
            }
            [b'*', b')', ..] if !opened.is_empty() => {
                opened.pop();
                2
            }
            _ if !opened.is_empty() => 1,
            [b'/', b'/', ..] => rest.iter().position(|it| *it == b'\n').unwrap_or(rest.len()),
            [b'/', b'*', ..] => match text[at..].find("*/") {
                Some(length) => length + 2,
                None => return Some((at, "*/".to_owned())),
            },
            [quote @ (b'\'' | b'"'), inner @ ..] => 1 + length_of_text(inner, *quote),
            _ => 1,
        };
    }
    Some((*opened.first()?, "*)".repeat(opened.len())))
}

/// The bytes up to the end of a text, or of its line, which it does not go beyond.
pub fn length_of_text(inner: &[u8], quote: u8) -> usize {
    let mut at = 0;
    while let Some(byte) = inner.get(at) {
        match byte {
            b'$' => at += 2,
            b'\n' => return at,
            byte if *byte == quote => return at + 1,
            _ => at += 1,
        }
    }
    inner.len()
}

/// The word that ends what a declaration begins; none where it holds its end itself.
fn end(file: &str, declaration: &[Chunk]) -> &'static str {
    const ENDS: [(&str, &str); 4] = [
        ("FUNCTION_BLOCK", "END_FUNCTION_BLOCK"),
        ("FUNCTION", "END_FUNCTION"),
        ("PROGRAM", "END_PROGRAM"),
        ("INTERFACE", "END_INTERFACE"),
    ];
    let text: String = declaration.iter().map(|it| it.said(file)).collect();
    let word = first_word(&text);
    ENDS.iter().find(|it| word.eq_ignore_ascii_case(it.0)).map_or("", |it| it.1)
}

/// The first word after comments and pragmas.
fn first_word(text: &str) -> &str {
    let mut rest = text.trim_start();
    loop {
        let after = if rest.starts_with("//") {
            rest.split_once('\n').map_or("", |it| it.1)
        } else if let Some(inner) = rest.strip_prefix("(*") {
            after_comment(inner)
        } else if let Some(inner) = rest.strip_prefix("/*") {
            inner.split_once("*/").map_or("", |it| it.1)
        } else if rest.starts_with('{') {
            rest.split_once('}').map_or("", |it| it.1)
        } else {
            let end = rest.find(|it: char| !it.is_ascii_alphanumeric() && it != '_').unwrap_or(rest.len());
            return &rest[..end];
        };
        rest = after.trim_start();
    }
}

/// What follows a comment, which may hold others.
pub fn after_comment(text: &str) -> &str {
    let bytes = text.as_bytes();
    let (mut open, mut at) = (1_usize, 0);
    while let Some(pair) = bytes.get(at..at + 2) {
        match pair {
            b"(*" => open += 1,
            b"*)" => open -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if open == 0 {
            return &text[at..];
        }
    }
    ""
}
