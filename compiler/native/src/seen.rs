//! What is known where the code continues, by what it has done on every way there: which checks of an index it has made, and,
//! without a branch, what numbers integer variables are.

use cranelift_codegen::ir as clif;
use staunch_ir::interval::Range;
use staunch_ir::{ArrayId, Place};

/// An index, and an array within whose bounds it is.
pub(crate) type Within = (clif::Value, ArrayId);

/// More are forgotten, so that the search stays cheap.
const MOST: usize = 16;

/// What is known in one block. Blocks are those that are current.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seen {
    block: Option<clif::Block>,
    checked: Vec<Within>,
    ranges: Vec<(Place, Range)>,
}

impl Seen {
    pub(crate) fn has(&self, block: Option<clif::Block>, it: Within) -> bool {
        self.block == block && self.checked.contains(&it)
    }

    pub(crate) fn note(&mut self, block: Option<clif::Block>, it: Within) {
        self.enter(block);
        if self.checked.len() >= MOST {
            self.checked.clear();
        }
        self.checked.push(it);
    }

    /// What variables are, the last said last.
    pub(crate) fn ranges(&self, block: Option<clif::Block>) -> &[(Place, Range)] {
        if self.block == block { &self.ranges } else { &[] }
    }

    pub(crate) fn note_range(&mut self, block: Option<clif::Block>, place: &Place, range: Range) {
        self.enter(block);
        if self.ranges.len() >= MOST {
            self.ranges.clear();
        }
        self.ranges.push((place.clone(), range));
    }

    fn enter(&mut self, block: Option<clif::Block>) {
        if self.block != block {
            *self = Self { block, ..Self::default() };
        }
    }

    /// What is known at the end of `block`, where ways part.
    pub(crate) fn at(&self, block: Option<clif::Block>) -> Self {
        if self.block == block { self.clone() } else { Self::default() }
    }

    /// The same, where one of the ways begins.
    pub(crate) fn in_way(&self, way: clif::Block) -> Self {
        Self { block: Some(way), ..self.clone() }
    }

    /// The same, where the ways meet: variables may have been written, but the index that was checked is a value.
    pub(crate) fn after_ways(&self, next: clif::Block) -> Self {
        Self { block: Some(next), checked: self.checked.clone(), ranges: Vec::new() }
    }

    /// The one way to `next` is out of `block`, where it has done what it does.
    pub(crate) fn goes_on(&mut self, block: Option<clif::Block>, next: clif::Block) {
        if self.block == block {
            self.block = Some(next);
        }
    }

    /// Forgets variables, but those that `stays` says.
    pub(crate) fn keep_ranges(&mut self, stays: impl Fn(&Place) -> bool) {
        self.ranges.retain(|it| stays(&it.0));
    }

    /// Any variable may have been written.
    pub(crate) fn forget_variables(&mut self) {
        self.ranges.clear();
    }
}
