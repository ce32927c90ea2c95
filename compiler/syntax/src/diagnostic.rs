//! What a user reads: one mistake, where it is, and what to do about it.

mod codes;
mod levels;
mod render;
mod sentence;
mod subject;
pub mod wording;

pub use codes::Code;
pub use levels::lint;
pub use levels::{Level, Levels};
pub use render::{Format, Style, excerpt, render};
pub use sentence::Sentence;
pub use subject::{Holder, Missing, Subject};

use crate::source::Span;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    Error,
    Warning,
}

/// A note at another place that explains the diagnostic.
#[derive(Clone, Debug)]
pub struct Label {
    pub span: Span,
    pub text: String,
}

/// A replacement that can be pasted, or applied by an editor.
#[derive(Clone, Debug)]
pub struct Fix {
    pub span: Span,
    pub replacement: String,
}

#[derive(Clone, Debug)]
pub struct Diagnostic {
    pub code: Code,
    pub severity: Severity,
    /// One sentence in Structured Text words: what is wrong.
    pub message: Sentence,
    /// The same as data, where something follows from it.
    pub subject: Option<Subject>,
    pub span: Span,
    /// What is under the caret: expected and found.
    pub label: Option<String>,
    pub others: Vec<Label>,
    pub notes: Vec<String>,
    /// What to do, imperative, can be followed literally.
    pub help: Option<String>,
    pub fix: Option<Fix>,
    /// It is a mistake in what only this dialect has, or takes at its word: another one would accept the text, and mean
    /// something else.
    pub in_this_dialect: bool,
}

impl Diagnostic {
    /// Severity is the code's default.
    pub fn new(code: Code, span: Span, message: impl Into<Sentence>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message: message.into(),
            subject: None,
            span,
            label: None,
            others: Vec::new(),
            notes: Vec::new(),
            help: None,
            fix: None,
            in_this_dialect: false,
        }
    }

    #[must_use]
    pub fn about(mut self, subject: Subject) -> Self {
        self.subject = Some(subject);
        self
    }

    /// Whether another one is the same sentence, perhaps at another place.
    pub fn repeats(&self, other: &Self) -> bool {
        self.code == other.code && self.message == other.message
    }

    /// Marks what another dialect would accept without making it right.
    #[must_use]
    pub fn in_this_dialect(mut self) -> Self {
        self.in_this_dialect = true;
        self
    }

    #[must_use]
    pub fn label(mut self, text: impl Into<String>) -> Self {
        self.label = Some(text.into());
        self
    }

    #[must_use]
    pub fn other(mut self, span: Span, text: impl Into<String>) -> Self {
        self.others.push(Label { span, text: text.into() });
        self
    }

    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    #[must_use]
    pub fn fix(mut self, span: Span, replacement: impl Into<String>) -> Self {
        self.fix = Some(Fix { span, replacement: replacement.into() });
        self
    }
}

/// Each with the sentence, the code and the subject of one kind of mistake.
impl Diagnostic {
    /// That nothing has a name.
    pub fn missing(kind: Missing, name: &str, span: Span) -> Self {
        Self::new(code_of(kind), span, kind.sentence(name)).about(Subject::Missing { kind, name: name.to_owned() })
    }

    /// That `holder` has nothing of a name; the code is that of what was looked for.
    pub fn missing_inside(code: Code, holder: (Holder, &str), name: &str, span: Span) -> Self {
        let (kind, full) = holder;
        Self::new(code, span, kind.lacks(full, name))
            .about(Subject::Missing { kind: Missing::Inside, name: format!("{full}.{name}") })
    }

    /// That something with this name cannot be compiled yet; `what` names it in the sentence.
    pub fn unavailable(name: &str, span: Span, what: &str) -> Self {
        Self::unsupported(span, what).about(Subject::Unavailable { name: name.to_owned() })
    }

    /// That something cannot be compiled yet.
    pub fn unsupported(span: Span, what: &str) -> Self {
        Self::new(Code::E0902, span, format!("{what} is not supported yet"))
            .label("this version of Staunch cannot compile it")
    }

    /// That a block is not closed, as far as it was read.
    pub(crate) fn unclosed(end: String, span: Span, found: &str) -> Self {
        Self::new(Code::E0014, span, format!("expected {end}, found {found}")).about(Subject::Unclosed { end })
    }

    /// The same where what follows is not written: the file says in another way where the body ends.
    pub fn end_with_the_body(&mut self) {
        if let Some(Subject::Unclosed { end }) = &self.subject
            && !self.others.is_empty()
        {
            self.message = format!("expected {end} before the body ends").into();
            let opened = self.others.remove(0);
            (self.span, self.label) = (opened.span, Some(opened.text));
        }
    }
}

const fn code_of(kind: Missing) -> Code {
    match kind {
        Missing::Variable | Missing::Owner | Missing::GlobalVariable | Missing::Program | Missing::Task => Code::E0101,
        Missing::Type
        | Missing::Enumeration
        | Missing::FunctionBlock
        | Missing::Interface
        | Missing::Namespace
        | Missing::Used
        | Missing::Library
        | Missing::InFull
        | Missing::Inside => Code::E0102,
        Missing::Callable => Code::E0307,
        Missing::Step => Code::E0515,
    }
}
