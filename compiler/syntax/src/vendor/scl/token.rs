//! The tokens of SCL, without comments and spaces.

use core::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Word,
    /// `"Motor 1"`
    Quoted,
    /// `#speed`, `#"speed 1"`
    Local,
    /// `{ … }`
    Pragma,
    /// `%I0.0`
    Address,
    /// What has a `#` in it, `T#1s`.
    Literal,
    /// A sign, a number or a text.
    Other,
}

#[derive(Clone, Debug)]
pub struct Token {
    pub kind: Kind,
    pub place: Range<usize>,
}

pub struct Tokens<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Tokens<'t> {
    pub fn new(text: &'t str) -> Self {
        Self { text, at: 0 }
    }
}

impl Iterator for Tokens<'_> {
    type Item = Token;

    fn next(&mut self) -> Option<Token> {
        loop {
            let rest = self.text.get(self.at..).filter(|it| !it.is_empty())?;
            let (kind, length) = first(rest);
            let start = self.at;
            self.at += length.max(1);
            if let Some(kind) = kind {
                return Some(Token { kind, place: start..self.at });
            }
        }
    }
}

/// What a text begins with, and its length; no kind is a space or a comment.
fn first(rest: &str) -> (Option<Kind>, usize) {
    let until = |close: &str| rest[1..].find(close).map_or(rest.len(), |it| 1 + it + close.len());
    match rest.chars().next().unwrap_or_default() {
        it if it.is_whitespace() || it == '\u{feff}' => (None, it.len_utf8()),
        '/' if rest.starts_with("//") => (None, rest.find('\n').unwrap_or(rest.len())),
        '/' if rest.starts_with("/*") => (None, until("*/")),
        '(' if rest.starts_with("(*") => (None, until("*)")),
        '(' if rest.starts_with("(/*") => (None, until("*/)")),
        '{' => (Some(Kind::Pragma), until("}")),
        '"' => (Some(Kind::Quoted), until("\"")),
        '\'' => (Some(Kind::Other), text(rest)),
        '#' if rest[1..].starts_with('"') => {
            (Some(Kind::Local), 1 + rest[2..].find('"').map_or(rest.len() - 1, |it| it + 2))
        }
        '#' => (Some(Kind::Local), 1 + word(&rest[1..])),
        '%' => {
            (Some(Kind::Address), 1 + rest[1..].find(|it: char| !is_of_word(it) && it != '.').unwrap_or(rest.len() - 1))
        }
        it if is_of_word(it) => {
            let length = word(rest);
            if rest[length..].starts_with('#') {
                (Some(Kind::Literal), literal(rest))
            } else if it.is_ascii_digit() {
                (Some(Kind::Other), literal(rest))
            } else {
                (Some(Kind::Word), length)
            }
        }
        it => (Some(Kind::Other), it.len_utf8()),
    }
}

fn is_of_word(it: char) -> bool {
    it.is_alphanumeric() || it == '_'
}

fn word(rest: &str) -> usize {
    rest.find(|it| !is_of_word(it)).unwrap_or(rest.len())
}

/// `T#1.5s`, `W#16#FF`; a `.` is of it before a digit, the `..` of a range is not.
fn literal(rest: &str) -> usize {
    let is_point =
        |at: usize| rest[at..].starts_with('.') && rest[at + 1..].starts_with(|it: char| it.is_ascii_digit());
    let is_of_literal = |at: usize, it: char| is_of_word(it) || it == '#' || is_point(at);
    rest.char_indices().find(|(at, it)| !is_of_literal(*at, *it)).map_or(rest.len(), |(at, _)| at)
}

fn text(rest: &str) -> usize {
    let mut is_escaped = false;
    for (at, it) in rest.char_indices().skip(1) {
        match it {
            _ if is_escaped => is_escaped = false,
            '$' => is_escaped = true,
            '\'' => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// A name without its signs. German letters are written as two, so that `Größe` and `Grüße` stay two names; what else
/// names cannot have becomes `_`.
pub fn name(token: &str) -> String {
    let inner = token.trim_start_matches('#').trim_matches('"');
    let mut plain = String::with_capacity(inner.len());
    for it in inner.chars() {
        match (it.is_ascii_alphanumeric(), plain_letters(it)) {
            (true, _) => plain.push(it),
            (false, letters) => plain.push_str(letters.unwrap_or("_")),
        }
    }
    if plain.starts_with(|it: char| it.is_ascii_digit()) { format!("_{plain}") } else { plain }
}

fn plain_letters(it: char) -> Option<&'static str> {
    Some(match it {
        'ä' => "ae",
        'ö' => "oe",
        'ü' => "ue",
        'Ä' => "Ae",
        'Ö' => "Oe",
        'Ü' => "Ue",
        'ß' | 'ẞ' => "ss",
        _ => return None,
    })
}
