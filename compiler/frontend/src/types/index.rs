//! Parts of types by their names, and types that there are already: found as fast in a large program as in a small one.

use rustc_hash::FxHashMap;
use staunch_ir::{Array, ArrayId, BoundsId, EnumId, RefType, ReferenceId, StructId};

/// Up to so many names are compared one by one.
const FEW: usize = 16;

/// The first position of each name, in capitals.
type Positions = FxHashMap<String, usize>;

#[derive(Debug, Default)]
pub(crate) struct Index {
    /// Arrays that differ in their elements' initial values alone are several.
    pub arrays: FxHashMap<Array, Vec<ArrayId>>,
    pub bounds: FxHashMap<(i128, i128), BoundsId>,
    pub references: FxHashMap<RefType, ReferenceId>,
    pub fields: Names<StructId>,
    pub values: Names<EnumId>,
}

/// The names of the parts of large types.
#[derive(Debug)]
pub(crate) struct Names<Id>(FxHashMap<Id, Positions>);

impl<Id> Default for Names<Id> {
    fn default() -> Self {
        Self(FxHashMap::default())
    }
}

impl<Id: Copy + Eq + std::hash::Hash> Names<Id> {
    /// Notes the names of a type's parts.
    pub fn add<'n>(&mut self, id: Id, names: impl ExactSizeIterator<Item = &'n str>) {
        if names.len() <= FEW {
            return;
        }
        let positions = self.0.entry(id).or_default();
        for (at, name) in names.enumerate() {
            positions.entry(name.to_ascii_uppercase()).or_insert(at);
        }
    }

    /// The position of a name among a type's parts, whose names are `names`.
    pub fn find<'n>(&self, id: Id, name: &str, mut names: impl Iterator<Item = &'n str>) -> Option<usize> {
        match self.0.get(&id) {
            Some(positions) => positions.get(&name.to_ascii_uppercase()).copied(),
            None => names.position(|it| it.eq_ignore_ascii_case(name)),
        }
    }
}
