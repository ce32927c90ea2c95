//! The text of a condition, from where it begins.

use crate::session::Session;
use staunch_frontend::Span;
use staunch_ir::Location;

/// What ends a decision, and what ends a condition in it, outside of parentheses.
const ENDS: [&str; 4] = ["THEN", "DO", "OF", "END_REPEAT"];
const OPERATORS: [&str; 5] = ["AND", "OR", "XOR", "AND_THEN", "OR_ELSE"];

/// How far a text goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    Decision,
    Condition,
}

/// What is written, on one line and without comments.
pub fn written(session: &Session, span: Span) -> String {
    let text = without_comments(session.sources.text(span));
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn without_comments(text: &str) -> String {
    let (mut rest, mut out) = (text, String::new());
    while let Some(character) = rest.chars().next() {
        let (kept, from) = match (comment(rest), character) {
            (Some(end), _) => (" ", end),
            (None, '\'' | '"') => {
                let end = end_of_text(rest, character);
                (&rest[..end], end)
            }
            (None, _) => (&rest[..character.len_utf8()], character.len_utf8()),
        };
        out += kept;
        rest = &rest[from..];
    }
    out
}

/// Where the comment ends that the text begins with.
fn comment(text: &str) -> Option<usize> {
    let after = |end: &str| text.find(end).map_or(text.len(), |it| it + end.len());
    match text.get(..2)? {
        "//" => Some(after("\n")),
        "/*" => Some(after("*/")),
        "(*" => {
            let mut depth = 0_usize;
            let mut at = 0;
            while let Some(two) = text.as_bytes().get(at..at + 2) {
                let step = match two {
                    b"(*" => 1,
                    b"*)" => -1,
                    _ => 0,
                };
                depth = depth.saturating_add_signed(step);
                at += if step == 0 { 1 } else { 2 };
                if depth == 0 {
                    return Some(at);
                }
            }
            Some(text.len())
        }
        _ => None,
    }
}

/// Where the text in quotes ends that begins here; `$'` does not end it.
fn end_of_text(text: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (at, character) in text.char_indices().skip(1) {
        if character == quote && !is_escaped {
            return at + 1;
        }
        is_escaped = character == '$' && !is_escaped;
    }
    text.len()
}

/// The condition, or the whole decision, as far as it is on its line.
pub fn condition(session: &Session, at: Location, extent: Extent) -> String {
    let file = session.sources.file(at.file);
    let line = file.text.get(file.line_range(at.line)).unwrap_or_default();
    let from: String = line.chars().skip(usize::from(at.column.saturating_sub(1))).collect();
    from[..end(&from, extent)].trim_end().to_owned()
}

fn end(text: &str, extent: Extent) -> usize {
    let (mut depth, mut quoted, mut word) = (0, None, 0);
    for (position, character) in text.char_indices() {
        let is_part = character.is_alphanumeric() || character == '_';
        if !is_part && depth == 0 && quoted.is_none() && ends(&text[word..position], extent) {
            return word;
        }
        match character {
            _ if quoted == Some(character) => quoted = None,
            _ if quoted.is_some() => {}
            '\'' | '"' => quoted = Some(character),
            '(' | '[' => depth += 1,
            ')' | ']' if depth == 0 => return position,
            ')' | ']' => depth -= 1,
            ';' | ':' => return position,
            ',' if depth == 0 => return position,
            '&' if depth == 0 && extent == Extent::Condition => return position,
            _ => {}
        }
        if !is_part {
            word = position + character.len_utf8();
        }
    }
    if depth == 0 && ends(&text[word..], extent) { word } else { text.len() }
}

fn ends(word: &str, extent: Extent) -> bool {
    let is_operator = match extent {
        Extent::Decision => false,
        Extent::Condition => is_one(word, &OPERATORS),
    };
    is_one(word, &ENDS) || is_operator
}

fn is_one(word: &str, all: &[&str]) -> bool {
    all.iter().any(|it| word.eq_ignore_ascii_case(it))
}

#[cfg(test)]
mod tests {
    use super::{Extent, end};

    #[test]
    fn conditions_end_where_their_operators_do() {
        let cut = |text: &'static str, extent| text[..end(text, extent)].trim_end();
        assert_eq!(cut("a.Q AND b THEN", Extent::Condition), "a.Q");
        assert_eq!(cut("a.Q AND b THEN", Extent::Decision), "a.Q AND b");
        assert_eq!(cut("x[i, 2] > F(a AND b, ';') OR c THEN", Extent::Condition), "x[i, 2] > F(a AND b, ';')");
        assert_eq!(cut("b) AND c THEN", Extent::Condition), "b");
        assert_eq!(cut("done END_REPEAT", Extent::Decision), "done");
        assert_eq!(cut("ANDROID THEN", Extent::Condition), "ANDROID");
        assert_eq!(cut("a & b;", Extent::Condition), "a");
        assert_eq!(cut("a, IN := b", Extent::Condition), "a");
        assert_eq!(cut("a OR", Extent::Condition), "a");
        assert_eq!(cut("text = \"it's\" AND b", Extent::Condition), "text = \"it's\"");
    }

    #[test]
    fn what_is_written_is_one_line_without_comments() {
        let text = "F(x, (* first (* nested *), second *)\n  y) // last\n OR s = 'a$' (* b *)' /* c */ AND d (*";
        let line = super::without_comments(text).split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(line, "F(x, y) OR s = 'a$' (* b *)' AND d");
    }
}
