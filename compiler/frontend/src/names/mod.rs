//! What names mean: a tree of namespaces, and the one rule by which a path is looked up in it.
//!
//! The root holds what files declare. In it are the lists of global variables (`GVL.x`), `Globals` (all
//! global variables), each enumeration (`Color.Red`), and the families of blocks (`CODESYS.CTU`).
//!
//! **The rule.** A bare name is looked up from the inside out: among the variables of the POU (its scope),
//! then in each namespace around it; in each first what it holds itself, then what it uses: the root uses
//! the lists. Last comes the library: the family that the file's dialect uses, the blocks that all systems
//! share, the standard functions. The first level that has the name, in the sense that its place asks for,
//! decides; where the namespaces that one level uses have several, all are named and none is chosen. Of a
//! path, all but the last name lead to a namespace, and the last is looked up in that alone.

pub(crate) mod functions;

use crate::ast;
use crate::dialect::{self, Dialect};
use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{BlockId, Type, Value};
use staunch_runtime::Family;
use std::sync::LazyLock;

/// What is declared, by its slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Entry {
    Type(usize),
    Pou(usize),
    Global(usize),
}

/// What a name's place asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sense {
    Type,
    /// A variable, or else what may be misused as one.
    Value,
    Callee,
}

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Declared(Entry),
    /// A value of the type in this slot, if that is an enumeration and has it.
    Enumerator(usize),
    Block(BlockId),
    /// A structure's instruction, and its position.
    Instruction(BlockId, usize),
    /// A standard function.
    Function,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Found {
    Nothing,
    One(Meaning),
    /// In full, what the name may mean.
    Several(Vec<String>),
}

/// A declared namespace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct SpaceId(usize);

impl SpaceId {
    pub const ROOT: Self = Self(0);
}

/// Where a name is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    /// The innermost namespace around it.
    pub space: SpaceId,
    pub dialect: Dialect,
}

/// What one name means in one namespace: a global variable may have the name of a type.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Entries {
    pub value: Option<Entry>,
    pub ty: Option<Entry>,
}

impl Entries {
    fn of(self, sense: Sense) -> Option<Entry> {
        match sense {
            Sense::Type => self.ty,
            Sense::Value | Sense::Callee => self.value.or(self.ty),
        }
    }
}

#[derive(Debug, Default)]
struct Namespace<'s> {
    name: &'s str,
    parent: Option<SpaceId>,
    own: FxHashMap<Key<'s>, Entries>,
    /// What the namespaces that it uses hold.
    used: FxHashMap<Key<'s>, Vec<(SpaceId, Entry)>>,
}

/// The names of a program.
#[derive(Debug)]
pub(crate) struct Names<'s> {
    spaces: Vec<Namespace<'s>>,
    lists: FxHashMap<Key<'s>, SpaceId>,
    /// The declarations in which a bare enumerator is named, with their type's slot.
    pub enumerators: FxHashMap<Key<'s>, Vec<usize>>,
    /// Names in type declarations that did not parse: they may be enumerators.
    pub unread: FxHashSet<Key<'s>>,
    /// For each anonymous or named enumeration, in order of declaration, the enumerators.
    pub anonymous_enumerators: FxHashMap<Key<'s>, (Type, Value)>,
}

impl Default for Names<'_> {
    fn default() -> Self {
        Self {
            spaces: vec![Namespace::default()],
            lists: FxHashMap::default(),
            enumerators: FxHashMap::default(),
            unread: FxHashSet::default(),
            anonymous_enumerators: FxHashMap::default(),
        }
    }
}

impl<'s> Names<'s> {
    /// What a path means where it is, after the scope of the POU.
    pub fn lookup(&self, site: Site, path: &[ast::Name<'_>], sense: Sense) -> Found {
        match path {
            [] => Found::Nothing,
            [name] => self.bare(site, name.text, sense),
            [space, name] => self.qualified(space.text, name.text, sense),
            // No namespace is in one of those that there are.
            [_, _, ..] => Found::Nothing,
        }
    }

    fn bare(&self, site: Site, name: &str, sense: Sense) -> Found {
        let mut around = Some(site.space);
        while let Some(id) = around {
            let space = &self.spaces[id.0];
            if let Some(entry) = space.own.get(&Key(name)).and_then(|it| it.of(sense)) {
                return Found::One(Meaning::Declared(entry));
            }
            match space.used.get(&Key(name)).map(Vec::as_slice).filter(|_| sense != Sense::Type) {
                None | Some([]) => {}
                Some([(_, entry)]) => return Found::One(Meaning::Declared(*entry)),
                Some(several) => {
                    return Found::Several(several.iter().map(|(id, _)| self.in_full(*id, name)).collect());
                }
            }
            around = space.parent;
        }
        self.library(site.dialect, name, sense).map_or(Found::Nothing, Found::One)
    }

    fn library(&self, dialect: Dialect, name: &str, sense: Sense) -> Option<Meaning> {
        match sense {
            Sense::Type => dialect::bare_block(dialect, name).map(Meaning::Block),
            Sense::Value => None,
            Sense::Callee => instruction_in(dialect.family(), name)
                .map(|(block, instruction)| Meaning::Instruction(block, instruction))
                .or_else(|| functions::exists_in(name, dialect).then_some(Meaning::Function)),
        }
    }

    fn qualified(&self, space: &str, name: &str, sense: Sense) -> Found {
        let found = match self.spaces[0].own.get(&Key(space)).and_then(|it| it.ty) {
            Some(Entry::Type(slot)) => Some(Meaning::Enumerator(slot)),
            Some(Entry::Pou(_) | Entry::Global(_)) => None,
            None => match self.lists.get(&Key(space)) {
                Some(list) => {
                    self.spaces[list.0].own.get(&Key(name)).and_then(|it| it.of(sense)).map(Meaning::Declared)
                }
                None if space.eq_ignore_ascii_case("Globals") => return self.global(name),
                None => Family::named(space).and_then(|it| in_family(it, name, sense)),
            },
        };
        found.map_or(Found::Nothing, Found::One)
    }

    /// `Globals.x`
    fn global(&self, name: &str) -> Found {
        let site = Site { space: SpaceId::ROOT, dialect: Dialect::Iec };
        match self.bare(site, name, Sense::Value) {
            Found::One(Meaning::Declared(entry @ Entry::Global(_))) => Found::One(Meaning::Declared(entry)),
            Found::Several(names) => Found::Several(names),
            Found::One(_) | Found::Nothing => Found::Nothing,
        }
    }

    fn in_full(&self, space: SpaceId, name: &str) -> String {
        format!("{}.{name}", self.spaces[space.0].name)
    }

    /// The list of global variables with a name, made where there is none.
    pub fn list(&mut self, name: &'s str) -> SpaceId {
        let next = SpaceId(self.spaces.len());
        let list = *self.lists.entry(Key(name)).or_insert(next);
        if list == next {
            self.spaces.push(Namespace { name, parent: Some(SpaceId::ROOT), ..Namespace::default() });
        }
        list
    }

    pub fn list_named(&self, name: &str) -> Option<SpaceId> {
        self.lists.get(&Key(name)).copied()
    }

    pub fn names_in(&self, space: SpaceId) -> impl Iterator<Item = &'s str> {
        self.spaces[space.0].own.keys().map(|it| it.0)
    }

    /// The name of a list of global variables, unless this is the root.
    pub fn list_name(&self, space: SpaceId) -> Option<&'s str> {
        (space != SpaceId::ROOT).then(|| self.spaces[space.0].name)
    }

    /// What the root holds of a name, by itself.
    pub fn root(&self, name: &str) -> Option<Entries> {
        self.own(SpaceId::ROOT, name)
    }

    pub fn own(&self, space: SpaceId, name: &str) -> Option<Entries> {
        self.spaces[space.0].own.get(&Key(name)).copied()
    }

    /// The global variables of that name in lists.
    pub fn in_lists<'n>(&'n self, name: &'n str) -> &'n [(SpaceId, Entry)] {
        self.spaces[0].used.get(&Key(name)).map_or(&[], Vec::as_slice)
    }

    pub fn insert(&mut self, space: SpaceId, name: &'s str, entry: Entry) {
        let entries = self.spaces[space.0].own.entry(Key(name)).or_default();
        match entry {
            Entry::Global(_) => entries.value = Some(entry),
            Entry::Type(_) | Entry::Pou(_) => entries.ty = Some(entry),
        }
        if space != SpaceId::ROOT {
            self.spaces[0].used.entry(Key(name)).or_default().push((space, entry));
        }
    }

    /// The names of all types and POUs.
    pub fn type_names(&self) -> impl Iterator<Item = &'s str> {
        self.spaces[0].own.iter().filter(|(_, it)| it.ty.is_some()).map(|(key, _)| key.0)
    }

    /// All names that files declare, but enumerators.
    pub fn all(&self) -> impl Iterator<Item = &'s str> {
        self.spaces.iter().flat_map(|it| it.own.keys()).map(|it| it.0)
    }
}

/// What a family's name before `name` makes of it.
fn in_family(family: Family, name: &str, sense: Sense) -> Option<Meaning> {
    match sense {
        // What all systems share needs no family of its own.
        Sense::Type => dialect::block_in(family, name).or_else(|| dialect::shared_block(name)).map(Meaning::Block),
        Sense::Value => None,
        Sense::Callee => instruction_in(family, name).map(|(block, at)| Meaning::Instruction(block, at)),
    }
}

/// The instructions of all blocks by their names.
static INSTRUCTIONS: LazyLock<FxHashMap<Key<'static>, Vec<(BlockId, usize)>>> = LazyLock::new(|| {
    let mut by_name: FxHashMap<_, Vec<_>> = FxHashMap::default();
    for (block, info) in staunch_runtime::BLOCKS.iter().enumerate() {
        for (at, it) in info.instructions.iter().enumerate().filter(|it| !it.1.name.is_empty()) {
            by_name.entry(Key(it.name)).or_default().push((BlockId::next(block), at));
        }
    }
    by_name
});

/// The first structure of a family with the instruction `name`, and the instruction's position.
pub(crate) fn instruction_in(family: Family, name: &str) -> Option<(BlockId, usize)> {
    let instructions = INSTRUCTIONS.get(&Key(name))?;
    instructions.iter().copied().find(|(block, _)| block.info().family == family)
}
