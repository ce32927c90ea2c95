//! Which word opens a block that which other one closes. A word whose block is not closed opens none, so that a text with
//! mistakes is laid out as far as it is understood.

use super::token::Token;
use crate::lex::Kind;
use rustc_hash::FxHashMap;

/// What a block is to the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// A POU or a routine of one, or what holds POUs.
    Pou,
    /// What holds declarations.
    Declarations,
    Type,
    Case,
    /// What holds statements, or parts of a configuration.
    Statements,
}

/// A block: its first and its last word.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub block: Block,
    pub open: usize,
    pub close: usize,
}

/// The blocks of a text, and for each token the one that it opens or closes.
pub struct Blocks {
    pub pairs: Vec<Pair>,
    opened: Vec<u32>,
    closed: Vec<u32>,
    /// The first words of POUs that are not closed: vendors' files leave the last word out.
    heads: Vec<usize>,
}

const NONE: u32 = u32::MAX;

impl Blocks {
    pub fn of(tokens: &[Token<'_>]) -> Self {
        let none = || vec![NONE; tokens.len()];
        let mut blocks = Self { pairs: Vec::new(), opened: none(), closed: none(), heads: Vec::new() };
        let mut open: Vec<(&'static Words, usize)> = Vec::new();
        // How many of the open ones each word closes: what closes none is not looked for.
        let mut wanted: FxHashMap<&'static str, usize> = FxHashMap::default();
        let mut starts = true;
        for (at, token) in tokens.iter().enumerate() {
            if token.is_aside() {
                continue;
            }
            starts |= token.breaks > 0;
            if let Some(words) = closes(token) {
                let is_wanted = wanted.iter().any(|it| *it.1 > 0 && it.0.eq_ignore_ascii_case(words));
                let last = || open.iter().rposition(|it| it.0.close.eq_ignore_ascii_case(words));
                if let Some(found) = is_wanted.then(last).flatten() {
                    let (words, first) = open[found];
                    blocks.leave(&open[found + 1..]);
                    for (words, _) in open.drain(found..) {
                        *wanted.entry(words.close).or_default() -= 1;
                    }
                    blocks.pairs.push(Pair { block: words.block, open: first, close: at });
                }
            } else if let Some(words) = opens(tokens, at, starts, open.last().map(|it| it.0)) {
                *wanted.entry(words.close).or_default() += 1;
                open.push((words, at));
            }
            starts = matches!(token.kind, Kind::Semicolon) || closes(token).is_some();
        }
        blocks.leave(&open);
        blocks.heads.sort_unstable();
        blocks.pairs.sort_unstable_by_key(|it| it.open);
        for (number, pair) in (0..).zip(&blocks.pairs) {
            blocks.opened[pair.open] = number;
            blocks.closed[pair.close] = number;
        }
        blocks
    }

    /// What was opened, and is not closed.
    fn leave(&mut self, open: &[(&'static Words, usize)]) {
        self.heads.extend(open.iter().filter(|it| it.0.block == Block::Pou).map(|it| it.1));
    }

    /// Whether a token begins a POU that nothing closes.
    pub fn is_head(&self, at: usize) -> bool {
        self.heads.binary_search(&at).is_ok()
    }

    /// The block that a token opens.
    pub fn opened(&self, at: usize) -> Option<&Pair> {
        self.pairs.get(usize::try_from(*self.opened.get(at)?).ok()?)
    }

    /// The block that a token closes.
    pub fn closed(&self, at: usize) -> Option<&Pair> {
        self.pairs.get(usize::try_from(*self.closed.get(at)?).ok()?)
    }
}

#[derive(Debug)]
struct Words {
    open: &'static str,
    close: &'static str,
    block: Block,
}

const fn words(open: &'static str, close: &'static str, block: Block) -> Words {
    Words { open, close, block }
}

const WORDS: &[Words] = &[
    words("IF", "END_IF", Block::Statements),
    words("FOR", "END_FOR", Block::Statements),
    words("WHILE", "END_WHILE", Block::Statements),
    words("REPEAT", "END_REPEAT", Block::Statements),
    words("CASE", "END_CASE", Block::Case),
    words("__TRY", "__ENDTRY", Block::Statements),
    words("VAR", "END_VAR", Block::Declarations),
    words("VAR_INPUT", "END_VAR", Block::Declarations),
    words("VAR_OUTPUT", "END_VAR", Block::Declarations),
    words("VAR_IN_OUT", "END_VAR", Block::Declarations),
    words("VAR_TEMP", "END_VAR", Block::Declarations),
    words("VAR_STAT", "END_VAR", Block::Declarations),
    words("VAR_GLOBAL", "END_VAR", Block::Declarations),
    words("VAR_EXTERNAL", "END_VAR", Block::Declarations),
    words("VAR_CONFIG", "END_VAR", Block::Declarations),
    words("VAR_ACCESS", "END_VAR", Block::Declarations),
    words("VAR_INST", "END_VAR", Block::Declarations),
    words("CONST", "END_CONST", Block::Declarations),
    words("STRUCT", "END_STRUCT", Block::Declarations),
    words("UNION", "END_UNION", Block::Declarations),
    words("TYPE", "END_TYPE", Block::Type),
    words("PROGRAM", "END_PROGRAM", Block::Pou),
    words("FUNCTION", "END_FUNCTION", Block::Pou),
    words("FUNCTION_BLOCK", "END_FUNCTION_BLOCK", Block::Pou),
    words("CONFIGURATION", "END_CONFIGURATION", Block::Statements),
    words("RESOURCE", "END_RESOURCE", Block::Statements),
    words("METHOD", "END_METHOD", Block::Pou),
    words("PROPERTY", "END_PROPERTY", Block::Pou),
    words("GET", "END_GET", Block::Pou),
    words("SET", "END_SET", Block::Pou),
    words("ACTION", "END_ACTION", Block::Pou),
    words("INTERFACE", "END_INTERFACE", Block::Pou),
    words("CLASS", "END_CLASS", Block::Pou),
    words("NAMESPACE", "END_NAMESPACE", Block::Pou),
    words("TEST", "END_TEST", Block::Pou),
    words("SETUP", "END_SETUP", Block::Pou),
    words("TEARDOWN", "END_TEARDOWN", Block::Pou),
    words("DATA_BLOCK", "END_DATA_BLOCK", Block::Pou),
    words("ORGANIZATION_BLOCK", "END_ORGANIZATION_BLOCK", Block::Pou),
    words("REGION", "END_REGION", Block::Statements),
    words("INITIAL_STEP", "END_STEP", Block::Statements),
    words("STEP", "END_STEP", Block::Statements),
    words("TRANSITION", "END_TRANSITION", Block::Statements),
];

/// The closing word that a token is.
fn closes<'s>(token: &Token<'s>) -> Option<&'s str> {
    if token.is_kept || token.is_member || !token.is_name_like() {
        return None;
    }
    let has_mark = token.text.get(..4).is_some_and(|it| it.eq_ignore_ascii_case("END_"));
    let word = token.text.split_ascii_whitespace().next().unwrap_or_default();
    (has_mark || token.kind == Kind::EndTry).then_some(word)
}

/// The block that a token opens, inside of another.
fn opens(tokens: &[Token<'_>], at: usize, starts: bool, inside: Option<&Words>) -> Option<&'static Words> {
    let token = &tokens[at];
    let word = match token.kind {
        Kind::Name if token.is_member => return None,
        Kind::Name if token.is_word("UNION") || starts && is_begun(tokens, at) => {
            token.text.split_ascii_whitespace().next()?
        }
        kind => kind.keyword()?,
    };
    // `PROGRAM Line WITH Fast : Main;` is no POU.
    let is_instance = token.kind == Kind::Program && inside.is_some_and(|it| it.block == Block::Statements);
    WORDS.iter().find(|it| !is_instance && it.open.eq_ignore_ascii_case(word))
}

/// Whether a name is the first word of a block, and not of a statement or a declaration.
fn is_begun(tokens: &[Token<'_>], at: usize) -> bool {
    let next = tokens[at + 1..].iter().find(|it| !it.is_aside());
    !next.is_some_and(|it| {
        matches!(
            it.kind,
            Kind::Assign
                | Kind::Colon
                | Kind::Comma
                | Kind::Semicolon
                | Kind::Dot
                | Kind::OpenParen
                | Kind::OpenBracket
                | Kind::Caret
                | Kind::Attempt
                | Kind::At
        )
    })
}
