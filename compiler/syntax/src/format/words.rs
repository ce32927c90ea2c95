//! The spelling of words and comments.

use super::indent::Layout;
use super::roles::Role;
use super::style::Letters;
use crate::lex::Kind;
use std::borrow::Cow;

/// A token as it is printed.
pub fn word<'s>(layout: Layout<'_, 's>, at: usize) -> Cow<'s, str> {
    let token = &layout.tokens[at];
    if token.is_kept {
        return Cow::Borrowed(token.text);
    }
    if token.kind == Kind::Comment || token.kind == Kind::Pragma {
        return trimmed(token.text);
    }
    if !is_keyword(layout, at) {
        return Cow::Borrowed(token.text);
    }
    let word = token.text.split_ascii_whitespace().next().unwrap_or_default();
    let rest = &token.text[word.len()..];
    match layout.style.keywords {
        Letters::Upper => Cow::Owned(word.to_ascii_uppercase() + rest),
        Letters::Lower => Cow::Owned(word.to_ascii_lowercase() + rest),
        Letters::AsWritten => Cow::Borrowed(token.text),
    }
}

/// Whether a word is one of the language's here.
fn is_keyword(layout: Layout<'_, '_>, at: usize) -> bool {
    let token = &layout.tokens[at];
    let is_of_block = layout.blocks.opened(at).is_some() || layout.blocks.closed(at).is_some();
    let opens = matches!(token.kind, Kind::Configuration | Kind::Program | Kind::Function | Kind::Type | Kind::Struct);
    match token.kind.keyword() {
        // `TO := 5` names an input; S7 has variables with such names.
        Some(_) if layout.tokens.get(at + 1).is_some_and(|it| names(it.kind)) && !is_value(token.kind) => false,
        Some(_) => !opens || is_of_block || layout.roles[at] == Role::Word,
        None => is_of_block || layout.roles[at] == Role::Word,
    }
}

/// Whether what is before it is a name.
fn names(next: Kind) -> bool {
    matches!(next, Kind::Assign | Kind::Arrow | Kind::Colon)
}

fn is_value(kind: Kind) -> bool {
    matches!(kind, Kind::True | Kind::False)
}

/// A comment without white space at the ends of its lines, and at its own end.
fn trimmed(text: &str) -> Cow<'_, str> {
    if text.lines().all(|it| it.trim_end() == it) && !text.contains('\r') && !text.ends_with('\n') {
        return Cow::Borrowed(text);
    }
    let lines: Vec<_> = text.trim_end().split('\n').map(str::trim_end).collect();
    Cow::Owned(lines.join("\n"))
}
