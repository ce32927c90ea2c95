//! Labels around a statement.

use crate::ast::Name;
use staunch_ir::Place;

/// A list of statements with labels, which becomes a loop over its segments.
#[derive(Clone, Debug)]
pub(crate) struct Jumps<'s> {
    pub labels: Vec<Name<'s>>,
    /// The number of the label where the list continues; 0 from its start, and while a segment runs.
    pub next: Place,
    /// How many loops of the source are around the list.
    pub loops: usize,
    /// Whether there is a jump, so that there has to be a loop.
    pub is_used: bool,
    /// Whether a jump to the list leaves loops in it.
    pub passes_loops: bool,
    /// By what else the list is left: EXIT or CONTINUE of the loop around it.
    pub left_by: Vec<u8>,
}
