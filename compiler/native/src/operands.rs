//! What an operation's code is made of.

use cranelift_codegen::ir as clif;
use staunch_ir::{Location, Repr, Value};

/// The operands of an operation, evaluated.
#[derive(Debug)]
pub(crate) struct Operands {
    /// The repr that the operation's row calls `T`.
    pub(crate) repr: Repr,
    pub(crate) values: Vec<clif::Value>,
    /// Where an operand is constant, what it is.
    pub(crate) constants: Vec<Option<Value>>,
    /// None is below 0, in a division.
    pub(crate) are_positive: bool,
    pub(crate) at: Location,
}
