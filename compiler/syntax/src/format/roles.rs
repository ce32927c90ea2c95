//! What some signs and names mean where they stand.

use super::blocks::{Block, Blocks, Pair};
use super::token::Token;
use crate::lex::Kind;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    #[default]
    Plain,
    /// A sign of one operand.
    Unary,
    /// The first token of the label of a CASE, or of a jump.
    Label,
    /// The colon after such a label.
    LabelEnd,
    /// The sign of `REF=`, `S=` and `R=`.
    Glued,
    /// An operator as the name of a function: `AND(a, b)`.
    Function,
    /// A word of the language that is not reserved: the name of a type where one is declared, `POINTER TO`, `EXTENDS`.
    Word,
}

/// The role of each token.
pub fn roles(tokens: &[Token<'_>], blocks: &Blocks) -> Vec<Role> {
    let mut roles = vec![Role::Plain; tokens.len()];
    let mut inside: Vec<Pair> = Vec::new();
    let (mut before, mut second) = (None::<usize>, None::<usize>);
    let (mut starts, mut is_in_head) = (true, false);
    for at in 0..tokens.len() {
        let token = &tokens[at];
        if token.is_aside() {
            continue;
        }
        if blocks.closed(at).is_some() {
            inside.pop();
        }
        let is_pou = blocks.is_head(at) || blocks.opened(at).is_some_and(|it| it.block == Block::Pou);
        is_in_head = is_pou || is_in_head && token.breaks == 0;
        let block = inside.last().map(|it| it.block);
        if starts
            && !matches!(block, Some(Block::Declarations | Block::Type))
            && let Some(end) = label(tokens, at, block == Some(Block::Case))
        {
            roles[at] = Role::Label;
            roles[end] = Role::LabelEnd;
        }
        match token.kind {
            Kind::Minus | Kind::Plus if before.is_none_or(|it| begins_operand(&tokens[it])) => roles[at] = Role::Unary,
            Kind::And | Kind::Or | Kind::Xor | Kind::Mod if before.is_none_or(|it| begins_operand(&tokens[it])) => {
                roles[at] = Role::Function;
            }
            Kind::Equal if !token.is_apart && is_bound(tokens, before, second) => roles[at] = Role::Glued,
            _ if is_of_configuration(tokens, &inside, at, second) => roles[at] = Role::Word,
            Kind::Name => {
                let declares = is_in_head || matches!(block, Some(Block::Declarations | Block::Type));
                let before = before.map(|it| tokens[it].kind);
                if declares && (is_type(token, before) || is_word(token, tokens.get(at + 1), is_in_head)) {
                    roles[at] = Role::Word;
                }
            }
            _ => {}
        }
        starts = roles[at] == Role::LabelEnd
            || matches!(
                token.kind,
                Kind::Semicolon | Kind::Then | Kind::Do | Kind::Else | Kind::Of | Kind::Repeat | Kind::Try
            )
            || blocks.closed(at).is_some();
        if let Some(pair) = blocks.opened(at) {
            inside.push(*pair);
        }
        (second, before) = (before, Some(at));
    }
    roles
}

/// The colon of the label that starts here.
fn label(tokens: &[Token<'_>], at: usize, in_case: bool) -> Option<usize> {
    let mut depth = 0_usize;
    for (number, token) in tokens.iter().enumerate().skip(at) {
        match token.kind {
            Kind::Comment | Kind::Pragma => continue,
            Kind::OpenParen | Kind::OpenBracket => depth += 1,
            Kind::CloseParen | Kind::CloseBracket => depth = depth.checked_sub(1)?,
            Kind::Colon if depth == 0 => return (number > at).then_some(number),
            Kind::Semicolon | Kind::Assign | Kind::Arrow | Kind::Attempt => return None,
            kind if kind.keyword().is_some() && !matches!(kind, Kind::True | Kind::False | Kind::Not) => return None,
            // A jump's label is one name.
            _ if !in_case && number > at => return None,
            _ => {}
        }
    }
    None
}

/// Whether what follows is an operand.
fn begins_operand(before: &Token<'_>) -> bool {
    match before.kind {
        Kind::CloseParen | Kind::CloseBracket | Kind::Caret | Kind::True | Kind::False => false,
        kind => kind.is_sign() || kind.keyword().is_some(),
    }
}

/// `a REF= b`, `a S= b`
fn is_bound(tokens: &[Token<'_>], before: Option<usize>, second: Option<usize>) -> bool {
    let is_word = |it: usize| ["REF", "S", "R"].iter().any(|word| tokens[it].is_word(word));
    let is_target = |it: usize| {
        matches!(
            tokens[it].kind,
            Kind::Name
                | Kind::CloseBracket
                | Kind::Caret
                | Kind::Integer
                | Kind::Part
                | Kind::Address
                | Kind::Configuration
        )
    };
    before.is_some_and(is_word) && second.is_some_and(is_target)
}

/// Whether a name is that of a type of the standard, where a type stands.
fn is_type(token: &Token<'_>, before: Option<Kind>) -> bool {
    let is_expected = matches!(before, Some(Kind::Colon | Kind::Of | Kind::To | Kind::CloseParen));
    let is_standard = || {
        staunch_runtime::Elementary::named(token.text).is_some()
            || ["STRING", "WSTRING"].iter().any(|it| token.is_word(it))
    };
    is_expected && is_standard()
}

/// `ON` after the name of a RESOURCE, `TASK` before its name, and `PROGRAM … WITH` in a CONFIGURATION.
fn is_of_configuration(tokens: &[Token<'_>], inside: &[Pair], at: usize, second: Option<usize>) -> bool {
    if !inside.iter().any(|it| tokens[it.open].kind == Kind::Configuration) {
        return false;
    }
    let token = &tokens[at];
    let is_named = tokens.get(at + 1).is_some_and(|it| it.kind == Kind::Name);
    let follows = |is: &dyn Fn(&Token<'_>) -> bool| second.is_some_and(|it| is(&tokens[it]));
    match token.kind {
        Kind::Program => is_named,
        Kind::Name if token.is_word("TASK") => is_named && token.breaks > 0,
        Kind::Name if token.is_word("ON") => follows(&|it| it.is_word("RESOURCE")),
        Kind::Name if token.is_word("WITH") => follows(&|it| it.kind == Kind::Program),
        _ => false,
    }
}

/// Words of the head of a POU, before a name.
const OF_HEADS: [&str; 9] =
    ["EXTENDS", "IMPLEMENTS", "PUBLIC", "PRIVATE", "PROTECTED", "INTERNAL", "ABSTRACT", "FINAL", "OVERRIDE"];

fn is_word(token: &Token<'_>, next: Option<&Token<'_>>, is_in_head: bool) -> bool {
    let Some(next) = next.filter(|it| it.breaks == 0) else { return false };
    let refers = || next.kind == Kind::To && ["POINTER", "REFERENCE"].iter().any(|it| token.is_word(it));
    is_in_head && next.kind == Kind::Name && OF_HEADS.iter().any(|it| token.is_word(it)) || refers()
}
