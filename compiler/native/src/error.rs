//! What can go wrong: nothing in a program but its size.

use core::fmt::{self, Write as _};

/// Why no code was made. With verified IR and a supported target, only size can be the cause.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// No code is made for this target; the sentence says what to do.
    Target(String),
    /// The code generator refused a function: it is too large for it.
    Code { function: String, reason: String },
    /// What is implemented outside is not in memory; its name.
    External(String),
    /// The object or the memory for the code cannot be made.
    Output(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Target(sentence) => f.write_str(sentence),
            Self::Code { function, reason } => write!(f, "no native code for {function}: {reason}"),
            Self::External(name) => {
                write!(f, "{name} is implemented outside the program: build an object, and link the implementation")
            }
            Self::Output(reason) => write!(f, "no native code: {reason}"),
        }
    }
}

impl core::error::Error for Error {}

impl From<cranelift_module::ModuleError> for Error {
    fn from(error: cranelift_module::ModuleError) -> Self {
        Self::Output(error.to_string())
    }
}

/// The whole chain of causes: Cranelift's own message is only the last of them.
pub(crate) fn reason(error: &dyn core::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        write!(text, ": {error}").expect("writing to a String does not fail");
        cause = error.source();
    }
    text
}
