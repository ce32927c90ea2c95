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
    let roles = vec![Role::Plain; tokens.len()];
    let mut reader = Reader {
        tokens,
        blocks,
        roles,
        inside: Vec::new(),
        before: None,
        second: None,
        starts: true,
        is_in_head: false,
    };
    (0..tokens.len()).filter(|it| !tokens[*it].is_aside()).for_each(|it| reader.read(it));
    reader.roles
}

/// Reads tokens one after the other, but for comments.
struct Reader<'t, 's> {
    tokens: &'t [Token<'s>],
    blocks: &'t Blocks,
    roles: Vec<Role>,
    /// The blocks that are open.
    inside: Vec<Pair>,
    /// The last token, and the one before it.
    before: Option<usize>,
    second: Option<usize>,
    /// A statement may start here.
    starts: bool,
    /// In the line of the first word of a POU.
    is_in_head: bool,
}

impl Reader<'_, '_> {
    fn read(&mut self, at: usize) {
        if self.blocks.closed(at).is_some() {
            self.inside.pop();
        }
        let is_pou = self.blocks.is_head(at) || self.blocks.opened(at).is_some_and(|it| it.block == Block::Pou);
        self.is_in_head = is_pou || self.is_in_head && self.tokens[at].breaks == 0;
        if self.starts {
            self.label(at);
        }
        self.roles[at] = self.role(at).unwrap_or(self.roles[at]);
        self.starts = self.roles[at] == Role::LabelEnd
            || ends_statement(self.tokens[at].kind)
            || self.blocks.closed(at).is_some();
        self.inside.extend(self.blocks.opened(at));
        (self.second, self.before) = (self.before, Some(at));
    }

    fn block(&self) -> Option<Block> {
        self.inside.last().map(|it| it.block)
    }

    fn is_in_declarations(&self) -> bool {
        matches!(self.block(), Some(Block::Declarations | Block::Type))
    }

    /// Marks the label that starts here, if one does.
    fn label(&mut self, at: usize) {
        if self.is_in_declarations() {
            return;
        }
        if let Some(end) = label(self.tokens, at, self.block() == Some(Block::Case)) {
            self.roles[at] = Role::Label;
            self.roles[end] = Role::LabelEnd;
        }
    }

    /// What a token is besides a label.
    fn role(&self, at: usize) -> Option<Role> {
        let token = &self.tokens[at];
        let is_first = || self.before.is_none_or(|it| begins_operand(&self.tokens[it]));
        match token.kind {
            Kind::Minus | Kind::Plus if is_first() => Some(Role::Unary),
            Kind::And | Kind::Or | Kind::Xor | Kind::Mod if is_first() => Some(Role::Function),
            Kind::Equal if !token.is_apart && is_bound(self.tokens, self.before, self.second) => Some(Role::Glued),
            _ if is_of_configuration(self.tokens, &self.inside, at, self.second) => Some(Role::Word),
            Kind::Name if self.is_in_head || self.is_in_declarations() => {
                let before = self.before.map(|it| self.tokens[it].kind);
                let is_word = is_type(token, before) || is_word(token, self.tokens.get(at + 1), self.is_in_head);
                is_word.then_some(Role::Word)
            }
            _ => None,
        }
    }
}

/// Whether a statement may start after a token.
fn ends_statement(kind: Kind) -> bool {
    matches!(kind, Kind::Semicolon | Kind::Then | Kind::Do | Kind::Else | Kind::Of | Kind::Repeat | Kind::Try)
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
