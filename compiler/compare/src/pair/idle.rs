//! What of both states decides nothing of what is compared: states that differ in that alone go the same way.

use crate::program::dependency::Declared;
use crate::program::scalar::{Role, Scalars};
use std::collections::HashSet;
use std::ops::Range;

#[derive(Debug, Default)]
pub struct Idle {
    /// Of each side's state.
    pub bytes: [Vec<Range<usize>>; 2],
    /// The declarations that nothing compared depends on.
    pub fields: [HashSet<Declared>; 2],
}

impl Idle {
    pub fn is_empty(&self) -> bool {
        self.bytes.iter().all(Vec::is_empty)
    }
}

/// Where variables and blocks are, but for inputs.
pub fn bytes_of(scalars: &Scalars, fields: &HashSet<Declared>) -> Vec<Range<usize>> {
    let is_in = |it: Option<Declared>| it.is_some_and(|it| fields.contains(&it));
    let variables = scalars.all.iter().filter(|it| it.role != Role::Input && is_in(it.field));
    let blocks = scalars.blocks.iter().filter(|it| is_in(it.field));
    let variables = variables.map(|it| it.offset..it.offset + it.size);
    variables.chain(blocks.map(|it| it.offset..it.offset + it.block.info().size)).collect()
}
