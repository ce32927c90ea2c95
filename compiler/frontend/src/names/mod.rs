//! What names mean.

use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Type, Value};

/// What a name at file level means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Entry {
    Type(usize),
    Pou(usize),
    Global(usize),
}

/// The names of a program.
#[derive(Debug, Default)]
pub(crate) struct Names<'s> {
    pub names: FxHashMap<Key<'s>, Entry>,
    /// The types and FUNCTION_BLOCKs whose name is a global's too: they are meant where a type is
    /// expected, the variable elsewhere.
    pub hidden_types: FxHashMap<Key<'s>, Entry>,
    /// The declarations in which a bare enumerator is named, with their type's slot.
    pub enumerators: FxHashMap<Key<'s>, Vec<usize>>,
    /// Names in type declarations that did not parse: they may be enumerators.
    pub unread: FxHashSet<Key<'s>>,
    /// For each anonymous or named enumeration, in order of declaration, the enumerators.
    pub anonymous_enumerators: FxHashMap<Key<'s>, (Type, Value)>,
}

impl<'s> Names<'s> {
    pub fn get(&self, name: &str) -> Option<Entry> {
        self.names.get(&Key(name)).copied()
    }

    /// What a name means where a type is expected.
    pub fn type_named(&self, name: &str) -> Option<Entry> {
        let hidden = self.hidden_types.get(&Key(name));
        hidden.or_else(|| self.names.get(&Key(name))).copied().filter(|it| !matches!(it, Entry::Global(_)))
    }

    /// The names of all types and POUs.
    pub fn type_names(&self) -> impl Iterator<Item = &'s str> {
        let own = self.names.iter().filter(|(_, entry)| !matches!(entry, Entry::Global(_)));
        own.chain(&self.hidden_types).map(|(key, _)| key.0)
    }
}
