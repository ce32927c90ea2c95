//! Whose pins the text names by names that the move changes.

use staunch_frontend::{Sources, Span};

/// For each name, the variable whose pin it is, without subscripts; `None` where the text does not show it.
pub fn owners(sources: &Sources, names: &[Span]) -> Vec<Option<String>> {
    names.iter().map(|it| owner(sources.get(it.file).text.get(..usize::try_from(it.start).ok()?)?)).collect()
}

/// The variable before a pin's name: `c.R`, `c(CU := s, R := …)`, `cells[1](…)`.
fn owner(before: &str) -> Option<String> {
    let text = before.trim_end();
    let (call, text) = match text.strip_suffix('.') {
        Some(variable) => (false, variable),
        None => (true, text),
    };
    if text.contains("(*") || text.contains("//") || text.contains('\'') {
        return last_statement(text).and_then(|it| variable(if call { opened(it)? } else { it }));
    }
    variable(if call { opened(text)? } else { text })
}

/// A statement without remarks and texts in it is read; of others nothing is said.
fn last_statement(text: &str) -> Option<&str> {
    let text = text.rsplit(';').next().unwrap_or(text);
    (!text.contains("(*") && !text.contains("*)") && !text.contains("//") && !text.contains('\'')).then_some(text)
}

/// What is before the parenthesis that is open at the end.
fn opened(text: &str) -> Option<&str> {
    let mut depth = 0_usize;
    for (at, it) in text.char_indices().rev() {
        match it {
            ')' => depth += 1,
            '(' if depth == 0 => return text.get(..at),
            '(' => depth -= 1,
            _ => {}
        }
    }
    None
}

/// The name at the end of a text, without subscripts.
fn variable(text: &str) -> Option<String> {
    let mut text = text.trim_end();
    while text.ends_with(']') {
        text = text[..text.rfind('[')?].trim_end();
    }
    let is_name = |it: char| it.is_alphanumeric() || it == '_';
    let name = &text[text.trim_end_matches(is_name).len()..];
    (!name.is_empty()).then(|| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::owner;

    #[test]
    fn the_variable_before_a_pin_is_found() {
        let found = |text: &str| owner(text);
        assert_eq!(found("x := 1; c(CU := (a AND b), ").as_deref(), Some("c"));
        assert_eq!(found("x := main.c.").as_deref(), Some("c"));
        assert_eq!(found("cells[i + 1] (").as_deref(), Some("cells"));
        assert_eq!(found("(* the (first *) x := 1; c(CU := s, ").as_deref(), Some("c"));
        assert_eq!(found("c(CU := s, (* the reset *) "), None);
    }
}
