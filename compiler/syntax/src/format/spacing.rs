//! Whether a space is printed between two tokens of a line.

use super::roles::Role;
use super::token::Token;
use crate::lex::{Kind, Scanner};

/// A token, and what it means.
pub type Placed<'t, 's> = (&'t Token<'s>, Role);

pub fn is_apart((before, role): Placed<'_, '_>, (token, own): Placed<'_, '_>) -> bool {
    if before.is_kept || token.is_kept {
        return false;
    }
    // What has no meaning in this language is left as it is written: `#tag`, `!ready`.
    if is_foreign(before.kind) || is_foreign(token.kind) {
        return token.is_apart;
    }
    if before.is_aside() || token.is_aside() {
        return true;
    }
    match (before.kind, token.kind) {
        // Together these begin a comment.
        (Kind::OpenParen, Kind::Star | Kind::Power) | (Kind::Slash, Kind::Slash | Kind::Star) => true,
        // `0xFF`, `5s`: a number of another language, which has a fix as it is.
        (Kind::Integer | Kind::Real, Kind::Name) => token.is_apart,
        // `T# 2` is a prefix without its literal.
        (Kind::Prefix, _) => token.is_apart && joins(before, token),
        (
            _,
            Kind::Semicolon
            | Kind::Comma
            | Kind::CloseParen
            | Kind::CloseBracket
            | Kind::Dot
            | Kind::DotDot
            | Kind::Caret,
        ) => false,
        (Kind::OpenParen | Kind::OpenBracket | Kind::Dot | Kind::DotDot, _) => false,
        (_, Kind::Colon) => own != Role::LabelEnd,
        (_, Kind::Equal) if own == Role::Glued => false,
        _ if role == Role::Unary => false,
        (Kind::Array, Kind::OpenBracket) => false,
        (it, Kind::OpenParen) => !ends_operand(it) && it != Kind::Integer && role != Role::Function,
        (it, Kind::OpenBracket) => !ends_operand(it),
        _ => true,
    }
}

/// Whether two tokens are another one without the space between them.
fn joins(before: &Token<'_>, token: &Token<'_>) -> bool {
    let text = format!("{}{}", before.text, token.text);
    Scanner::new(&text).next() != Some(before.kind)
}

/// Signs that Structured Text does not have, and that mark a name in others.
fn is_foreign(kind: Kind) -> bool {
    matches!(kind, Kind::Unknown | Kind::Percent | Kind::Bang)
}

fn ends_operand(kind: Kind) -> bool {
    matches!(kind, Kind::Name | Kind::CloseParen | Kind::CloseBracket | Kind::Caret | Kind::WideText)
}
