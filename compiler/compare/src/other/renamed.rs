//! What the text says of its system: whose pins it names by names that the move changes, and its dialect.

use staunch_frontend::{Fix, Sources, Span};

/// For each name, the variable whose pin it is, without subscripts; `None` where the text does not show it.
pub fn owners(sources: &Sources, names: impl Iterator<Item = Span>) -> Vec<Option<String>> {
    names.map(|it| owner(sources.get(it.file).text.get(..usize::try_from(it.start).ok()?)?)).collect()
}

/// The text with the system's names of pins; the fixes are those of this file.
pub fn with_own_names<'f>(text: &str, fixes: impl Iterator<Item = &'f Fix>) -> String {
    let at = |it: u32| usize::try_from(it).unwrap_or(usize::MAX);
    let mut fixes: Vec<_> = fixes.collect();
    fixes.sort_by_key(|it| it.span.start);
    fixes.dedup_by_key(|it| it.span);
    let (mut found, mut rest) = (String::new(), 0);
    for fix in fixes {
        found += text.get(rest..at(fix.span.start)).unwrap_or_default();
        found += &fix.replacement;
        rest = at(fix.span.end);
    }
    found + text.get(rest..).unwrap_or_default()
}

/// The text without its `{dialect '…'}`, if it has any: whoever joins several names the dialect once.
pub fn without_dialect(text: &str) -> Option<String> {
    let (mut found, mut is_named) = (String::new(), false);
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        found += before;
        let pragma = after.split_once('}').filter(|(it, _)| is_dialect(it));
        rest = match pragma {
            Some((_, after)) => {
                is_named = true;
                after.strip_prefix('\r').unwrap_or(after).strip_prefix('\n').unwrap_or(after)
            }
            None => {
                found.push('{');
                after
            }
        };
    }
    is_named.then(|| found + rest)
}

fn is_dialect(pragma: &str) -> bool {
    let Some((word, rest)) = pragma.trim().split_at_checked("dialect".len()) else { return false };
    let name = rest.trim_start().trim_start_matches(":=").trim();
    word.eq_ignore_ascii_case("dialect") && name.len() > 1 && name.starts_with('\'') && name.ends_with('\'')
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
    use super::{owner, without_dialect};

    #[test]
    fn a_dialect_is_taken_out() {
        let text = without_dialect("{Dialect 'iec'}\n{allow W0507}\nx := 1; { y");
        assert_eq!(text.as_deref(), Some("{allow W0507}\nx := 1; { y"));
        assert_eq!(without_dialect("{dialect := 'iec'} x").as_deref(), Some(" x"));
        assert_eq!(without_dialect("{dialects 'iec'} x"), None);
    }

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
