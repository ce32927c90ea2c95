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
        let comment = [("//", "\n"), ("(*", "*)"), ("/*", "*/")].into_iter().find(|it| rest.starts_with(it.0));
        let (kept, from) = match (comment, character) {
            (Some((_, end)), _) => (" ", rest[2..].find(end).map_or(rest.len(), |it| 2 + it + end.len())),
            (None, '\'' | '"') => {
                let end = rest[1..].find(character).map_or(rest.len(), |it| it + 2);
                (&rest[..end], end)
            }
            (None, _) => (&rest[..character.len_utf8()], character.len_utf8()),
        };
        out += kept;
        rest = &rest[from..];
    }
    out
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
        if !is_part && depth == 0 && quoted.is_none() {
            if ends(&text[word..position], extent) {
                return word;
            }
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
        let text = "F(x, (* first, second *)\n  y) // last\n OR s = 'a (* b *)' /* c */ AND d";
        let line = super::without_comments(text).split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(line, "F(x, y) OR s = 'a (* b *)' AND d");
    }
}
