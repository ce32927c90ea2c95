//! What an operation's code is made of.

use cranelift_codegen::ir as clif;
use staunch_ir::{Lane, Location, Value};

/// The operands of an operation, evaluated.
#[derive(Debug)]
pub(crate) struct Operands {
    /// The lane that the operation's row calls `T`.
    pub(crate) lane: Lane,
    pub(crate) values: Vec<clif::Value>,
    /// Where an operand is constant, what it is.
    pub(crate) constants: Vec<Option<Value>>,
    pub(crate) at: Location,
}
