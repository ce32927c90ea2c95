//! What a diagnostic is about, as data: by it, what follows from one mistake is found among the others. A constructor of
//! [`Diagnostic`](super::Diagnostic) makes it together with the code and the sentence.

use staunch_ir::Elementary;

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Nothing has the name.
    Missing { kind: Missing, name: String },
    /// Another system has it under the name, and it cannot be compiled yet.
    Unavailable { name: String },
    /// The library of another dialect has it.
    Elsewhere { name: String },
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
    /// A namespace that a USING names: what is unknown in the file may be in it.
    Used,
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
    pub(super) fn sentence(self, name: &str) -> String {
        match self {
            Self::Variable | Self::Owner => format!("`{name}` is not declared"),
            Self::Type => format!("there is no type `{name}`"),
            Self::Enumeration => format!("there is no enumeration `{name}`"),
            Self::FunctionBlock => format!("there is no FUNCTION_BLOCK `{name}`"),
            Self::Interface => format!("there is no INTERFACE `{name}`"),
            Self::Namespace | Self::Used => format!("there is no namespace `{name}`"),
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

impl Holder {
    pub(super) fn lacks(self, full: &str, name: &str) -> String {
        match self {
            Self::Library => format!("the library `{full}` has no `{name}`"),
            Self::Namespace => format!("the namespace `{full}` has no `{name}`"),
            Self::GlobalList => format!("the list `{full}` has no variable `{name}`"),
        }
    }
}
