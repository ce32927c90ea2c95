//! The text of a condition, from where it begins.

use crate::session::Session;
use staunch_ir::Location;

/// What ends a decision, and what ends a condition in it, outside of parentheses.
const ENDS: [&str; 6] = ["THEN", "DO", "OF", "END_REPEAT", "AND_THEN", "OR_ELSE"];
const OPERATORS: [&str; 3] = ["AND", "OR", "XOR"];

/// The condition, or the whole decision, as far as it is on its line.
pub fn condition(session: &Session, at: Location, is_whole: bool) -> String {
    let file = session.sources.file(at.file);
    let line = file.text.get(file.line_range(at.line)).unwrap_or_default();
    let from: String = line.chars().skip(usize::from(at.column.saturating_sub(1))).collect();
    from[..end(&from, is_whole)].trim_end().to_owned()
}

fn end(text: &str, is_whole: bool) -> usize {
    let (mut depth, mut quoted, mut word) = (0, false, 0);
    for (position, character) in text.char_indices() {
        let is_part = character.is_alphanumeric() || character == '_';
        if !is_part && depth == 0 && !quoted && ends(&text[word..position], is_whole) {
            return word;
        }
        match character {
            '\'' => quoted = !quoted,
            _ if quoted => {}
            '(' | '[' => depth += 1,
            ')' | ']' if depth == 0 => return position,
            ')' | ']' => depth -= 1,
            ';' | ':' => return position,
            ',' if depth == 0 => return position,
            '&' if depth == 0 && !is_whole => return position,
            _ => {}
        }
        if !is_part {
            word = position + character.len_utf8();
        }
    }
    if depth == 0 && ends(&text[word..], is_whole) { word } else { text.len() }
}

fn ends(word: &str, is_whole: bool) -> bool {
    let is_one = |all: &[&str]| all.iter().any(|it| word.eq_ignore_ascii_case(it));
    is_one(&ENDS) || !is_whole && is_one(&OPERATORS)
}

#[cfg(test)]
mod tests {
    use super::end;

    #[test]
    fn conditions_end_where_their_operators_do() {
        let cut = |text: &'static str, is_whole| text[..end(text, is_whole)].trim_end();
        assert_eq!(cut("a.Q AND b THEN", false), "a.Q");
        assert_eq!(cut("a.Q AND b THEN", true), "a.Q AND b");
        assert_eq!(cut("x[i, 2] > F(a AND b, ';') OR c THEN", false), "x[i, 2] > F(a AND b, ';')");
        assert_eq!(cut("b) AND c THEN", false), "b");
        assert_eq!(cut("done END_REPEAT", true), "done");
        assert_eq!(cut("ANDROID THEN", false), "ANDROID");
        assert_eq!(cut("a & b;", false), "a");
        assert_eq!(cut("a, IN := b", false), "a");
        assert_eq!(cut("a OR", false), "a");
    }
}
