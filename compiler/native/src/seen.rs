//! Checks that have been made on the way to where the code continues: of an index that is a value of a register, one check of
//! its bounds does for what follows it without a branch.

use cranelift_codegen::ir as clif;
use staunch_ir::ArrayId;

/// An index, and an array within whose bounds it is.
pub(crate) type Within = (clif::Value, ArrayId);

/// More are forgotten, so that the search stays cheap.
const MOST: usize = 16;

/// What is known in one block. Blocks are those that are current.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    block: Option<clif::Block>,
    checked: Vec<Within>,
}

impl Seen {
    pub(crate) fn has(&self, block: Option<clif::Block>, it: Within) -> bool {
        self.block == block && self.checked.contains(&it)
    }

    pub(crate) fn note(&mut self, block: Option<clif::Block>, it: Within) {
        if self.block != block || self.checked.len() >= MOST {
            *self = Self { block, checked: Vec::new() };
        }
        self.checked.push(it);
    }

    /// The one way to `next` is out of `block`, where it has done what it does.
    pub(crate) fn goes_on(&mut self, block: Option<clif::Block>, next: clif::Block) {
        if self.block == block {
            self.block = Some(next);
        }
    }
}
