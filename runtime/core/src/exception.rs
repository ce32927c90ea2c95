//! Statements whose faults a program handles: what generated Rust has of CODESYS' `__TRY`.

use crate::Fault;

/// How such statements ended, where they did not fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Control continues after them.
    Here,
    /// By an EXIT of a loop around them.
    Exit,
    /// By a CONTINUE of a loop around them.
    Continue,
    /// By a RETURN.
    Return,
}

/// Runs the statements. A fault ends them, and is handed to who handles it.
#[inline]
pub fn attempt<T>(statements: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    statements()
}
