//! How far each line is indented: by the blocks and brackets that are open where it starts.

use super::blocks::{Block, Blocks, Pair};
use super::roles::Role;
use super::style::Style;
use super::token::Token;
use crate::lex::Kind;

/// What a text is, as far as the layout asks.
#[derive(Clone, Copy)]
pub struct Layout<'t, 's> {
    pub tokens: &'t [Token<'s>],
    pub blocks: &'t Blocks,
    pub roles: &'t [Role],
    /// For each token the next one that is not a comment, itself or after it; none for comments at the end.
    pub code: &'t [usize],
    pub style: &'t Style,
}

/// A block that is open.
struct Open {
    pair: Pair,
    /// The level of the line that opened it.
    base: usize,
    /// The statements of a CASE have begun.
    has_body: bool,
    /// In a CASE: a label was, and no ELSE.
    is_labelled: bool,
}

/// Reads tokens one after the other.
pub struct Indenter<'t, 's> {
    layout: Layout<'t, 's>,
    open: Vec<Open>,
    /// For each open bracket the level of its line.
    brackets: Vec<usize>,
    /// The level of the line.
    line: usize,
    /// The level of the statement.
    statement: usize,
    /// A statement or a declaration starts here.
    pub starts: bool,
    /// The statement is the head of a block: its further lines are indented more than the block.
    is_head: bool,
    /// The lines of a head that no sign ends: `FUNCTION_BLOCK Pump`.
    is_line_head: bool,
    /// The last token that is not a comment.
    before: Option<usize>,
}

impl<'t, 's> Indenter<'t, 's> {
    pub fn new(layout: Layout<'t, 's>) -> Self {
        Self {
            layout,
            open: Vec::new(),
            brackets: Vec::new(),
            line: 0,
            statement: 0,
            starts: true,
            is_head: false,
            is_line_head: false,
            before: None,
        }
    }

    pub fn is_in_brackets(&self) -> bool {
        !self.brackets.is_empty()
    }

    /// Whether declarations are listed here.
    pub fn declares(&self) -> bool {
        self.open.last().is_some_and(|it| it.pair.block == Block::Declarations)
    }

    pub fn before(&self) -> Option<usize> {
        self.before
    }

    /// Starts a line with a token: its level.
    pub fn start_line(&mut self, at: usize) -> usize {
        self.line = self.level(at);
        let token = &self.layout.tokens[at];
        if self.is_line_head && !token.is_aside() && !self.continues_head(at) {
            self.starts = true;
            self.is_line_head = !self.is_begun(at);
        }
        self.line
    }

    fn level(&self, at: usize) -> usize {
        let token = &self.layout.tokens[at];
        let starts = self.starts || self.is_line_head && !self.continues_head(at);
        if let Some(bracket) = self.brackets.last() {
            let closes = matches!(token.kind, Kind::CloseParen | Kind::CloseBracket);
            let is_given =
                self.before.is_some_and(|it| matches!(self.layout.tokens[it].kind, Kind::Assign | Kind::Arrow));
            return bracket + usize::from(!closes) + usize::from(is_given);
        }
        if token.is_aside() {
            return match starts {
                true => self.content(self.layout.code.get(at).copied()),
                false => self.statement + 1,
            };
        }
        if let Some(pair) = self.layout.blocks.closed(at) {
            return self.open.iter().rfind(|it| it.pair.open == pair.open).map_or(0, |it| it.base);
        }
        let base = self.open.last().map_or(0, |it| it.base);
        match token.kind {
            Kind::Else | Kind::Elsif | Kind::Until | Kind::Catch | Kind::Finally if starts => base,
            _ if starts => self.content(Some(at)),
            Kind::Then | Kind::Do | Kind::Of if self.is_head => self.statement,
            Kind::OpenParen | Kind::Struct if self.is_after_colon() => self.statement,
            _ => self.statement + if self.is_head { 2 } else { 1 },
        }
    }

    fn is_after_colon(&self) -> bool {
        self.before.is_some_and(|it| self.layout.tokens[it].kind == Kind::Colon)
    }

    /// The level of what the innermost block holds, where it is followed by this token.
    fn content(&self, next: Option<usize>) -> usize {
        let Some(open) = self.open.last() else { return 0 };
        let is_label = next.is_some_and(|it| self.layout.roles[it] == Role::Label);
        let inner = match open.pair.block {
            // Routines are indented in their POU, and POUs in their namespace.
            Block::Pou => usize::from(self.layout.style.indents_pous || next.is_some_and(|it| self.opens_pou(it))),
            Block::Type => usize::from(self.layout.tokens.get(open.pair.open + 1).is_some_and(|it| it.breaks > 0)),
            Block::Case if open.is_labelled && !is_label => 2,
            Block::Case | Block::Declarations | Block::Statements => 1,
        };
        open.base + inner
    }

    fn opens_pou(&self, at: usize) -> bool {
        self.layout.blocks.opened(at).is_some_and(|it| it.block == Block::Pou)
    }

    /// Whether a line continues the head before it: `EXTENDS Base`.
    fn continues_head(&self, at: usize) -> bool {
        let token = &self.layout.tokens[at];
        let is_open = |it: usize| matches!(self.layout.tokens[it].kind, Kind::Colon | Kind::Comma);
        let words = ["EXTENDS", "IMPLEMENTS", "ON"];
        token.kind == Kind::Colon || words.iter().any(|it| token.is_word(it)) || self.before.is_some_and(is_open)
    }

    /// Whether a line is a statement, and not one more of a head.
    fn is_begun(&self, at: usize) -> bool {
        let next = self.layout.tokens.get(at + 1);
        let signs = [Kind::Assign, Kind::OpenParen, Kind::Dot, Kind::OpenBracket, Kind::Caret];
        self.layout.roles[at] == Role::Label || next.is_some_and(|it| signs.contains(&it.kind))
    }

    /// Goes past a token.
    pub fn pass(&mut self, at: usize) {
        if self.layout.tokens[at].is_aside() {
            return;
        }
        match self.layout.blocks.closed(at) {
            Some(pair) => self.close(*pair),
            None => self.pass_inner(at),
        }
        self.before = Some(at);
    }

    fn close(&mut self, pair: Pair) {
        let found = self.open.iter().rposition(|it| it.pair.open == pair.open);
        self.open.truncate(found.unwrap_or(self.open.len()));
        self.brackets.clear();
        self.end_head();
    }

    /// A token that closes no block.
    fn pass_inner(&mut self, at: usize) {
        let kind = self.layout.tokens[at].kind;
        if self.starts {
            self.statement = self.line;
            self.is_head = is_head(kind);
        }
        let was_start = std::mem::take(&mut self.starts);
        match kind {
            Kind::OpenParen | Kind::OpenBracket => self.brackets.push(self.line),
            Kind::CloseParen | Kind::CloseBracket => drop(self.brackets.pop()),
            Kind::Semicolon => self.brackets.clear(),
            Kind::Catch => self.is_line_head = true,
            _ => {}
        }
        if self.ends_head(at, was_start) {
            self.end_head();
        }
        if let Some(pair) = self.layout.blocks.opened(at) {
            self.open(*pair);
        }
        self.is_line_head |= was_start && self.layout.blocks.is_head(at);
    }

    /// Whether a statement may start after a token; notes what that says of a CASE.
    fn ends_head(&mut self, at: usize, was_start: bool) -> bool {
        let token = &self.layout.tokens[at];
        let case = self.open.last_mut().filter(|it| it.pair.block == Block::Case);
        match token.kind {
            Kind::Semicolon => true,
            Kind::Then | Kind::Do => self.is_head,
            Kind::Else | Kind::Finally if was_start => {
                case.into_iter().for_each(|it| it.is_labelled = false);
                true
            }
            Kind::Of => case.is_some_and(|it| !std::mem::replace(&mut it.has_body, true)),
            _ if self.layout.roles[at] == Role::LabelEnd => {
                case.into_iter().for_each(|it| it.is_labelled = true);
                true
            }
            _ => self.is_qualifier(at) || was_start && token.is_word("BEGIN"),
        }
    }

    fn end_head(&mut self) {
        (self.starts, self.is_head, self.is_line_head) = (true, false, false);
    }

    fn open(&mut self, pair: Pair) {
        self.open.push(Open { pair, base: self.line, has_body: false, is_labelled: false });
        let token = &self.layout.tokens[pair.open];
        match pair.block {
            Block::Pou => self.is_line_head = true,
            Block::Declarations | Block::Type => self.end_head(),
            Block::Statements if matches!(token.kind, Kind::Repeat | Kind::Try) || token.is_region() => self.end_head(),
            Block::Statements if token.kind == Kind::Name || token.kind == Kind::Configuration => {
                self.is_line_head = true;
            }
            Block::Case | Block::Statements => {}
        }
    }

    /// `VAR CONSTANT RETAIN`: what follows the word that opens declarations.
    pub fn is_qualifier(&self, at: usize) -> bool {
        let Some(open) = self.open.last().filter(|it| it.pair.block == Block::Declarations) else { return false };
        let tokens = self.layout.tokens;
        let is_word = |it: &Token<'_>| {
            let words = ["PUBLIC", "PRIVATE", "PROTECTED", "INTERNAL"];
            matches!(it.kind, Kind::Constant | Kind::Retain | Kind::NonRetain | Kind::Persistent)
                || words.iter().any(|word| it.is_word(word))
        };
        let is_name = tokens.get(at + 1).is_some_and(|it| matches!(it.kind, Kind::Colon | Kind::Comma | Kind::At));
        !is_name && tokens[open.pair.open + 1..=at].iter().all(|it| is_word(it) && it.breaks == 0)
    }
}

fn is_head(kind: Kind) -> bool {
    matches!(kind, Kind::If | Kind::Elsif | Kind::While | Kind::For | Kind::Case | Kind::Until)
}

impl Token<'_> {
    fn is_region(&self) -> bool {
        self.text.len() >= 6 && self.kind == Kind::Name && self.text.as_bytes()[..6].eq_ignore_ascii_case(b"REGION")
    }
}
