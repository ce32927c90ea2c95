//! What productions are made of: the tokens, the state next to them, and the parser over them.

use chumsky::{
    DefaultExpected,
    error::{Error, LabelError},
    extra,
    input::{Checkpoint, Cursor, InputRef},
    inspector::Inspector,
    prelude::{SimpleSpan, custom},
    util::MaybeRef,
};

use crate::{
    ast::{BinaryOp, Binding, Expr, Item, MAX_CHAIN, MAX_DEPTH, Name, Pou, Region, VarDecl},
    diagnostic::{Code, Diagnostic},
    lex::{Kind, MAX_REPORTS, Tokens, index},
    source::Span,
    spelling::Key,
};
use rustc_hash::FxHashSet;

use super::doc;

pub type Extra<'t, 's> = extra::Full<Problem, State<'t, 's>, ()>;
/// What a production reads from: `'t` are the tokens, `'s` is the text.
pub type In<'t, 'p, 's> = InputRef<'t, 'p, &'t [Kind], Extra<'t, 's>>;
/// A place to come back to.
pub type Start<'t, 'p> = Checkpoint<'t, 'p, &'t [Kind], ()>;
pub type Parsed<T> = Result<T, Problem>;

/// Why a production gave up. Small and without text: most are never shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Number of the token that does not fit.
    pub at: usize,
    pub expected: Expected,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    Token(Kind),
    /// `,` or the bracket that closes the one at this token number.
    More(Kind, usize),
    /// The bracket that closes the one at this token number.
    Closing(Kind, usize),
    Name,
    Expression,
    Variable,
    Type,
    Label,
    /// `:=` or a call's `(`.
    Action,
    Block,
    /// Something else, which other rules say better.
    Other,
    /// The user has been told already.
    Reported,
}

impl Problem {
    pub const REPORTED: Self = Self { at: 0, expected: Expected::Reported };
}

impl<'t> Error<'t, &'t [Kind]> for Problem {
    /// Of the problems of two rules that start at one token: what was reported, else the farther one.
    fn merge(self, other: Self) -> Self {
        let says_more = self.at > other.at || self.at == other.at && other.expected == Expected::Other;
        let first = self == Self::REPORTED || (other != Self::REPORTED && says_more);
        if first { self } else { other }
    }
}

impl<'t> LabelError<'t, &'t [Kind], DefaultExpected<'t, Kind>> for Problem {
    fn expected_found<E: IntoIterator<Item = DefaultExpected<'t, Kind>>>(
        expected: E,
        _: Option<MaybeRef<'t, Kind>>,
        span: SimpleSpan,
    ) -> Self {
        let kind = expected.into_iter().find_map(|it| match it {
            DefaultExpected::Token(kind) => Some(*kind),
            _ => None,
        });
        Self { at: span.start, expected: kind.map_or(Expected::Name, Expected::Token) }
    }
}

/// The left side of an operator.
#[derive(Debug)]
pub struct Waiting<'s> {
    pub left: Expr<'s>,
    pub height: usize,
    pub op: BinaryOp,
    pub power: u8,
    pub sign: Span,
}

/// The state next to the tokens. Productions do not go back over what they reported, so
/// nothing in it is undone.
#[derive(Debug)]
pub struct State<'t, 's> {
    pub file: u16,
    pub text: &'s str,
    pub tokens: &'t Tokens<'s>,
    /// The text is one expression, and not a file.
    pub is_expression: bool,
    pub diagnostics: Vec<Diagnostic>,
    /// Blocks around the current place: what ends them, and what opened them.
    pub open: Vec<(Kind, Span)>,
    /// How deep the current production is nested.
    pub depth: usize,
    /// Height of the tree of the expression that was read last.
    pub height: usize,
    /// After a limit there are no more tokens.
    pub stopped: bool,
    /// Operands whose operator waits for its right side, of all expressions being read.
    pub waiting: Vec<Waiting<'s>>,
    /// A misspelt keyword that was taken, and is read as this one.
    pub instead: Option<Kind>,
    /// For each Pascal BEGIN: how many blocks were open there, and whether it opened a body.
    pub begins: Vec<(usize, bool)>,
    /// What opened the blocks whose body is in `{ … }`: they need no END_.
    pub braced: Vec<Span>,
    /// Pairs of braces that are not pragmas and have been reported.
    pub braces: Vec<Span>,
    /// Declarations among the statements of the current POU, reported.
    pub strays: Vec<VarDecl<'s>>,
    /// Number of the token after the last of them.
    pub told_at: Option<usize>,
    /// What opened the first block of the POU whose end is in another column.
    pub misaligned: Option<Span>,
    /// An ELSE without its IF has been reported: so is the END_IF after it.
    pub orphaned: bool,
    /// Units inside a POU, reported.
    pub nested: Vec<Item<'s>>,
    /// Of VAR_CONFIG outside of a CONFIGURATION.
    pub bindings: Vec<Binding<'s>>,
    /// What is reported of a unit that the end of the file ends, if it is alone there.
    pub unclosed: Vec<Diagnostic>,
    /// `a ACCESS ADR(b)` is a statement.
    pub has_access: bool,
    /// ACTIONs that no unit is before, and what is reported of each.
    pub apart: Vec<(Pou<'s>, Diagnostic)>,
    /// What is reported of `a += b`, if the dialect does not have it.
    pub combined: Vec<Diagnostic>,
    /// The address in `x : BOOL AT %QX0.0`, and what is reported if the dialect does not have it.
    pub late_addresses: Vec<(Name<'s>, Diagnostic)>,
    /// The targets of `a [:=] b`, which Logix has.
    pub nonretentive: Vec<Span>,
    pub regions: Vec<Region<'s>>,
    /// Of these, the ones around the current place.
    pub around: Vec<usize>,
    /// The user knows that the file ends too early.
    pub ended: bool,
    /// Where the file's JMPs go, from the first label on.
    pub jumped_to: Option<FxHashSet<Key<'s>>>,
}

impl<'t, 's> State<'t, 's> {
    /// Before the first token of a file, which is that region.
    pub fn new(file: u16, text: &'s str, tokens: &'t Tokens<'s>, whole: Region<'s>) -> Self {
        Self {
            file,
            text,
            tokens,
            is_expression: false,
            diagnostics: Vec::new(),
            open: Vec::new(),
            depth: 0,
            height: 0,
            stopped: false,
            waiting: Vec::new(),
            instead: None,
            begins: Vec::new(),
            braced: Vec::new(),
            braces: Vec::new(),
            strays: Vec::new(),
            told_at: None,
            misaligned: None,
            orphaned: false,
            nested: Vec::new(),
            bindings: Vec::new(),
            unclosed: Vec::new(),
            has_access: false,
            apart: Vec::new(),
            combined: Vec::new(),
            late_addresses: Vec::new(),
            nonretentive: Vec::new(),
            regions: vec![whole],
            around: vec![0],
            ended: false,
            jumped_to: None,
        }
    }
}

impl<'t, 's> Inspector<'t, &'t [Kind]> for State<'t, 's> {
    type Checkpoint = ();
    fn on_token(&mut self, _: &Kind) {}
    fn on_save<'p>(&self, _: &Cursor<'t, 'p, &'t [Kind]>) {}
    fn on_rewind<'p>(&mut self, _: &Checkpoint<'t, 'p, &'t [Kind], ()>) {}
}

impl<'s> State<'_, 's> {
    /// The first token.
    pub fn first(&self) -> Span {
        self.place(0)
    }

    pub fn place(&self, at: usize) -> Span {
        let (start, end) = self.tokens.places[at.min(self.tokens.places.len() - 1)];
        Span { file: self.file, start, end }
    }

    pub fn slice(&self, span: Span) -> &'s str {
        self.text.get(index(span.start)..index(span.end)).unwrap_or_default()
    }

    /// From the first to the last of some tokens.
    pub fn span(&self, tokens: SimpleSpan) -> Span {
        self.place(tokens.start).to(self.place(tokens.end.max(tokens.start + 1) - 1))
    }

    /// Whether a line break is between two offsets.
    pub fn breaks(&self, from: u32, to: u32) -> bool {
        self.text.get(index(from)..index(to)).is_some_and(|it| it.contains('\n'))
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        if self.stopped {
            return;
        }
        let found = self.diagnostics.len() + self.tokens.diagnostics.len();
        if found < MAX_REPORTS {
            self.diagnostics.push(diagnostic);
            return;
        }
        self.stopped = true;
        let text = format!("more than {MAX_REPORTS} errors: the rest of the file was not read");
        self.diagnostics.push(Diagnostic::new(Code::E0030, diagnostic.span, text));
    }

    /// A limit was reached: one error, and nothing after it is read.
    pub fn stop(&mut self, span: Span, message: String) -> Problem {
        self.report(Diagnostic::new(Code::E0091, span, message));
        self.stopped = true;
        Problem::REPORTED
    }
}

/// The parser of a production over the tokens.
pub trait TokenReader<'t, 's> {
    fn number(&self) -> usize;
    fn kind(&mut self) -> Kind;
    /// The kind of the token `ahead` places after the current one.
    fn kind_ahead(&mut self, ahead: usize) -> Kind;
    fn here(&mut self) -> Span;
    /// The token before the current one.
    fn last(&mut self) -> Span;
    fn text(&mut self, span: Span) -> &'s str;
    /// Whether the current token is this name, in any case. For words with a meaning in some
    /// places only.
    fn is_word(&mut self, word: &str) -> bool;
    fn on_new_line(&mut self) -> bool;
    /// Takes the current token, whatever it is.
    fn take(&mut self) -> Span;
    fn eat(&mut self, kind: Kind) -> Option<Span>;
    fn expect(&mut self, kind: Kind) -> Parsed<Span>;
    fn problem(&mut self, expected: Expected) -> Problem;
    fn name(&mut self) -> Parsed<Name<'s>>;
    fn report(&mut self, diagnostic: Diagnostic);
    /// Deeper by a number of levels, unless that is too deep. Who recovers from a problem restores
    /// the depth.
    fn enter(&mut self, levels: usize) -> Parsed<()>;
    fn leave(&mut self, levels: usize);
    /// The tree that is being made is one higher than its parts.
    fn grow(&mut self, parts: usize) -> Parsed<()>;
    /// The comment that documents what starts at token number `first` and ends here.
    fn doc(&mut self, first: usize) -> Option<String>;
    /// Lets go of problems that lie after the current token: it was gone back to.
    fn forget(&mut self);
}

impl<'t, 's> TokenReader<'t, 's> for In<'t, '_, 's> {
    fn number(&self) -> usize {
        *self.cursor().inner()
    }

    fn kind(&mut self) -> Kind {
        self.kind_ahead(0)
    }

    fn kind_ahead(&mut self, ahead: usize) -> Kind {
        let at = self.number() + ahead;
        let state = self.state();
        if state.stopped {
            return Kind::End;
        }
        if let (0, Some(kind)) = (ahead, state.instead) {
            return kind;
        }
        state.tokens.kinds.get(at).copied().unwrap_or(Kind::End)
    }

    fn here(&mut self) -> Span {
        let at = self.number();
        self.state().place(at)
    }

    fn last(&mut self) -> Span {
        let at = self.number();
        self.state().place(at.saturating_sub(1))
    }

    fn text(&mut self, span: Span) -> &'s str {
        self.state().slice(span)
    }

    fn is_word(&mut self, word: &str) -> bool {
        self.kind() == Kind::Name && {
            let span = self.here();
            self.text(span).eq_ignore_ascii_case(word)
        }
    }

    fn on_new_line(&mut self) -> bool {
        let (last, here) = (self.last(), self.here());
        self.state().breaks(last.end, here.start)
    }

    fn take(&mut self) -> Span {
        if self.state().instead.take().is_some() {
            return self.last();
        }
        let span = self.here();
        if self.kind() != Kind::End {
            self.skip();
        }
        span
    }

    fn eat(&mut self, kind: Kind) -> Option<Span> {
        (self.kind() == kind).then(|| self.take())
    }

    fn expect(&mut self, kind: Kind) -> Parsed<Span> {
        self.eat(kind).ok_or_else(|| self.problem(Expected::Token(kind)))
    }

    fn problem(&mut self, expected: Expected) -> Problem {
        Problem { at: self.number(), expected }
    }

    fn name(&mut self) -> Parsed<Name<'s>> {
        if let Some(span) = self.eat(Kind::Name) {
            return Ok(Name { text: self.text(span), span });
        }
        Err(self.problem(Expected::Name))
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.state().report(diagnostic);
    }

    fn enter(&mut self, levels: usize) -> Parsed<()> {
        self.state().depth += levels;
        if self.state().depth <= MAX_DEPTH {
            return Ok(());
        }
        let span = self.here();
        Err(self.state().stop(span, too_deep(MAX_DEPTH / levels)))
    }

    fn leave(&mut self, levels: usize) {
        self.state().depth -= levels;
    }

    fn grow(&mut self, parts: usize) -> Parsed<()> {
        self.state().height = parts + 1;
        if parts < MAX_CHAIN {
            return Ok(());
        }
        let span = self.last();
        Err(self.state().stop(span, too_long()))
    }

    fn doc(&mut self, first: usize) -> Option<String> {
        let tokens = SimpleSpan::from(first..self.number());
        doc::comment(self.state(), tokens)
    }

    fn forget(&mut self) {
        let fails = custom(|_: &mut In<'t, '_, 's>| Err::<(), _>(Problem::REPORTED));
        let _ = self.parse(fails);
    }
}

fn too_deep(limit: usize) -> String {
    format!("this is nested more than {limit} levels deep")
}

pub fn too_long() -> String {
    format!("this chain is longer than {MAX_CHAIN}")
}
