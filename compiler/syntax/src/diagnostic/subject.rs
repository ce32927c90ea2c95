//! What a diagnostic is about, as data: by it, what follows from one mistake is found among the others. For each kind there is one
//! constructor, which makes the code and the sentence, too.

use super::{Code, Diagnostic};
use crate::source::Span;
use staunch_ir::Elementary;

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Nothing has the name.
    Missing { kind: Missing, name: String },
    /// Another system has it under the name, and it cannot be compiled yet.
    Unavailable { name: String },
    /// A number that the type does not hold.
    Beyond(Elementary),
    /// Two types of which neither becomes the other here.
    Mismatch(Elementary, Elementary),
    /// A block without its end, as it is shown.
    Unclosed { end: String },
}

/// What was looked for by a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// A variable, or another value.
    Variable,
    /// What is before the point in `Severity.Info`: an enumeration, a list or a namespace, which no POU declares, or a variable.
    Owner,
    Type,
    Enumeration,
    FunctionBlock,
    Interface,
    Namespace,
    /// A library that is known by its name, and not bundled.
    Library,
    /// A FUNCTION, or an instance that is called.
    Callable,
    /// What has another full name.
    InFull,
    /// What a library, a namespace or a list of global variables does not have: the name begins with its own.
    Inside,
    GlobalVariable,
    Program,
    Task,
    Step,
}

impl Missing {
    const fn code(self) -> Code {
        match self {
            Self::Variable | Self::Owner | Self::GlobalVariable | Self::Program | Self::Task => Code::E0101,
            Self::Type
            | Self::Enumeration
            | Self::FunctionBlock
            | Self::Interface
            | Self::Namespace
            | Self::Library
            | Self::InFull
            | Self::Inside => Code::E0102,
            Self::Callable => Code::E0307,
            Self::Step => Code::E0515,
        }
    }

    fn sentence(self, name: &str) -> String {
        match self {
            Self::Variable | Self::Owner => format!("`{name}` is not declared"),
            Self::Type => format!("there is no type `{name}`"),
            Self::Enumeration => format!("there is no enumeration `{name}`"),
            Self::FunctionBlock => format!("there is no FUNCTION_BLOCK `{name}`"),
            Self::Interface => format!("there is no INTERFACE `{name}`"),
            Self::Namespace => format!("there is no namespace `{name}`"),
            Self::Library => format!("the library `{name}` is not available"),
            Self::Callable => format!("there is no function or instance `{name}`"),
            Self::InFull | Self::Inside => format!("there is no `{name}`"),
            Self::GlobalVariable => format!("there is no global variable `{name}`"),
            Self::Program => format!("there is no PROGRAM `{name}`"),
            Self::Task => format!("there is no TASK `{name}`"),
            Self::Step => format!("there is no step `{name}`"),
        }
    }
}

/// What may have names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holder {
    Library,
    Namespace,
    GlobalList,
}

impl Diagnostic {
    /// That nothing has a name.
    pub fn missing(kind: Missing, name: &str, span: Span) -> Self {
        Self::new(kind.code(), span, kind.sentence(name)).about(Subject::Missing { kind, name: name.to_owned() })
    }

    /// That `holder` has nothing of a name; the code is that of what was looked for.
    pub fn missing_inside(code: Code, holder: (Holder, &str), name: &str, span: Span) -> Self {
        let (kind, full) = holder;
        let message = match kind {
            Holder::Library => format!("the library `{full}` has no `{name}`"),
            Holder::Namespace => format!("the namespace `{full}` has no `{name}`"),
            Holder::GlobalList => format!("the list `{full}` has no variable `{name}`"),
        };
        Self::new(code, span, message).about(Subject::Missing { kind: Missing::Inside, name: format!("{full}.{name}") })
    }

    /// That something of this name cannot be compiled yet; `what` is how it is called in the sentence.
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
