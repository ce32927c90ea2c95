//! Statements whose faults a program handles: CODESYS' `__TRY` in generated Rust.

use crate::Fault;

/// How such statements ended, if they did not fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Control continues after them.
    Here,
    /// By an EXIT of an enclosing loop.
    Exit,
    /// By a CONTINUE of an enclosing loop.
    Continue,
    /// By a RETURN.
    Return,
}

/// Runs the statements. A fault ends them, and is passed to the handler.
#[inline]
pub fn attempt<T>(statements: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    statements()
}
