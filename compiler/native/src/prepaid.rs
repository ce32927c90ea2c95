//! What is known of a loop whose turns are all taken before the first one.

use cranelift_frontend::Variable;
use staunch_ir::Place;

/// A loop that has taken its turns. Values are of 64 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prepaid<'p> {
    pub(crate) counter: Counter<'p>,
    /// The last value that a turn has been taken for.
    pub(crate) limit: Variable,
    pub(crate) step: i128,
    /// Whether the present turn has taken its step.
    pub(crate) is_stepped: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Counter<'p> {
    Register(Variable),
    Variable(&'p Place),
}
