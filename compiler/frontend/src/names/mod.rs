//! What names mean: a tree of namespaces, and the one rule by which a path is looked up in it.
//!
//! The root holds what files declare outside of a NAMESPACE. In it are the namespaces, the lists of global
//! variables (`GVL.x`), `Globals` (all global variables), each enumeration (`Color.Red`), the families of
//! blocks (`CODESYS.CTU`), and in `codesys` the library (`Standard.TON`).
//!
//! **The rule.** A bare name is looked up from the inside out: among the variables of the POU (its scope),
//! then in each namespace around it; in each first what it holds itself, then what the USING directives
//! there name: the root uses the lists. In `codesys` each library that a project names is a namespace of its own, as in CODESYS and
//! TwinCAT: in it is what its files declare; after the root come all libraries. Last comes the library: the family that
//! the file's dialect uses, the blocks that all systems share, the standard functions. The first level that has the name, in the sense
//! that its place asks for, decides; where the namespaces that one level uses have several, all are named
//! and none is chosen. The first name of a path is looked up in the same order, as a namespace or an
//! enumeration; the others lead on from there, and nowhere else.

pub(crate) mod functions;
mod region;

use crate::ast;
use crate::dialect::{self, Dialect, library};
use crate::prelude;
use crate::source::{Sources, Span};
use crate::spelling::Key;
use region::{Region, Regions};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{BlockId, Type, Value};
use staunch_runtime::Family;
use std::sync::LazyLock;

pub(crate) use region::{RegionId, SpaceId};

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
    /// A callee that is not a variable.
    Function,
}

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Declared(Entry),
    /// A value of the type in this slot, if that is an enumeration and has it.
    Enumerator(usize),
    Block(BlockId),
    /// An instruction of Logix, on structures or on bits.
    Instruction,
    /// A standard function.
    Function,
}

/// What a name could mean at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Visible {
    Declared(Entry),
    Space(SpaceId),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Found {
    Nothing,
    One(Meaning),
    /// In full, what the name may mean.
    Several(Vec<String>),
}

/// Where a name is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    pub span: Span,
    pub dialect: Dialect,
    /// In a unit of the library that the compiler brings along: a standard name means the standard's.
    pub is_bundled: bool,
}

/// What one name means in one namespace: a global variable may have the name of a type.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Entries {
    pub value: Option<Entry>,
    pub ty: Option<Entry>,
    /// Its type, or POU, is not seen from outside of the namespace.
    pub internal: bool,
}

impl Entries {
    fn of(self, sense: Sense) -> Option<Entry> {
        match sense {
            Sense::Type | Sense::Function => self.ty,
            Sense::Value | Sense::Callee => self.value.or(self.ty),
        }
    }
}

#[derive(Debug, Default)]
struct Namespace<'s> {
    /// `A.B`, or a list's name.
    name: String,
    parent: Option<SpaceId>,
    /// Whether every part of it is INTERNAL; of one that only paths name there is none.
    internal: Option<bool>,
    /// A list of global variables.
    is_list: bool,
    /// A list whose variables are named after it alone.
    is_qualified: bool,
    /// What a library of the project holds.
    is_library: bool,
    own: FxHashMap<Key<'s>, Entries>,
    inner: FxHashMap<Key<'s>, SpaceId>,
}

/// The names of a program.
#[derive(Debug)]
pub(crate) struct Names<'s> {
    spaces: Vec<Namespace<'s>>,
    regions: Regions,
    lists: FxHashMap<Key<'s>, SpaceId>,
    /// What lists would be called in a dialect where they have names.
    pub nameless_lists: FxHashSet<Key<'s>>,
    /// The global variables in lists.
    listed: FxHashMap<Key<'s>, Vec<(SpaceId, Entry)>>,
    /// The names of libraries, with the namespaces of what they hold: in dialects whose libraries have none, the root.
    libraries: Vec<(String, SpaceId)>,
    /// For each file, the namespace of what it declares outside of a NAMESPACE.
    files: Vec<SpaceId>,
    /// PROGRAMs of libraries, which give way to other declarations of their names.
    pub giving_way: FxHashSet<Entry>,
    /// How many global variables have a name.
    globals: FxHashMap<Key<'s>, usize>,
    /// The declarations in which a bare enumerator is named, with their type's slot.
    pub enumerators: FxHashMap<Key<'s>, Vec<usize>>,
    /// The same for those that are named after their type's name alone: `{attribute 'qualified_only'}`.
    pub qualified_enumerators: FxHashMap<Key<'s>, Vec<usize>>,
    /// Names in type declarations that did not parse: they may be enumerators.
    pub unread: FxHashSet<Key<'s>>,
    /// For each anonymous or named enumeration, in order of declaration, the enumerators.
    pub anonymous_enumerators: FxHashMap<Key<'s>, (Type, Value)>,
}

impl Default for Names<'_> {
    fn default() -> Self {
        Self {
            spaces: vec![Namespace::default()],
            regions: Regions::default(),
            lists: FxHashMap::default(),
            nameless_lists: FxHashSet::default(),
            listed: FxHashMap::default(),
            libraries: Vec::new(),
            files: Vec::new(),
            giving_way: FxHashSet::default(),
            globals: FxHashMap::default(),
            enumerators: FxHashMap::default(),
            qualified_enumerators: FxHashMap::default(),
            unread: FxHashSet::default(),
            anonymous_enumerators: FxHashMap::default(),
        }
    }
}

/// What the first name of a path leads to.
#[derive(Clone, Copy)]
enum Prefix {
    Space(SpaceId),
    Enumeration(usize),
    /// `Globals`
    Globals,
    Family(Family),
    /// What comes with CODESYS, by the name of its library.
    Library,
}

impl<'s> Names<'s> {
    /// What a path means where it is, after the scope of the POU.
    pub fn lookup(&self, site: Site, path: &[ast::Name<'_>], sense: Sense) -> Found {
        match path {
            [] => Found::Nothing,
            [name] => self.bare(site, name.text, sense),
            [first, between @ .., last] => self.qualified(site, first.text, between, last.text, sense),
        }
    }

    /// All that a bare name could mean where it is, from the inside out: what [`lookup`](Self::lookup) goes through.
    pub fn each_visible(&self, site: Site, sense: Sense, see: &mut dyn FnMut(&str, Visible)) {
        let mut regions = self.regions.around(site.span).peekable();
        while let Some(region) = regions.next() {
            let outer = regions.peek().map(|it| it.space);
            for space in self.spaces_to(region.space, outer).chain(region.uses.iter().copied()) {
                self.each_in(site, space, sense, see);
            }
        }
        let root = [SpaceId::ROOT].into_iter().chain(self.spaces_of_libraries());
        for space in root {
            self.each_in(site, space, sense, see);
            if names_variables(sense) {
                let of_it = self.listed.iter().flat_map(|(key, all)| all.iter().map(move |it| (key.0, *it)));
                let of_it = of_it.filter(|(_, it)| self.around_list(it.0) == space);
                of_it.for_each(|(name, it)| see(name, Visible::Declared(it.1)));
            }
        }
        self.lists.iter().for_each(|(key, space)| see(key.0, Visible::Space(*space)));
    }

    /// What a namespace holds, as far as a place sees it.
    pub fn each_in(&self, site: Site, space: SpaceId, sense: Sense, see: &mut dyn FnMut(&str, Visible)) {
        for (key, entries) in &self.spaces[space.0].own {
            // A type's name is what an enumerator or an instance of it begins with.
            let senses = [sense, Sense::Type].into_iter().filter_map(|it| entries.of(it));
            senses.filter(|it| self.sees(site, space, *entries, *it)).for_each(|it| see(key.0, Visible::Declared(it)));
        }
        self.spaces[space.0].inner.iter().for_each(|(key, inner)| see(key.0, Visible::Space(*inner)));
    }

    fn bare(&self, site: Site, name: &str, sense: Sense) -> Found {
        let key = Key(name);
        let mut regions = self.regions.around(site.span).peekable();
        let own = |space: SpaceId| self.spaces[space.0].own.get(&key).and_then(|it| it.of(sense));
        while let Some(region) = regions.next() {
            let mut spaces = self.spaces_to(region.space, regions.peek().map(|it| it.space));
            let of_standard = || self.library(site.dialect, name, sense);
            if site.is_bundled
                && region.space == SpaceId::ROOT
                && let Some(meaning) = of_standard()
            {
                return Found::One(meaning);
            }
            if let Some(entry) = spaces.next().and_then(own) {
                return Found::One(Meaning::Declared(self.variable_called_as(entry, region, name, sense)));
            }
            // A USING in `NAMESPACE A.B` is in B.
            if let Some(found) = self.used(site, region, name, sense) {
                return found;
            }
            if let Some(entry) = spaces.find_map(own) {
                return Found::One(Meaning::Declared(entry));
            }
        }
        let of_all = || self.in_libraries(site, name, sense);
        let found = self.in_lists_of(SpaceId::ROOT, name, sense).or_else(of_all);
        found.or_else(|| self.library(site.dialect, name, sense).map(Found::One)).unwrap_or(Found::Nothing)
    }

    /// The variable of a list that is called as the POU or type that a place finds, where it asks for a variable: `Move : Move;`.
    fn variable_called_as(&self, found: Entry, region: &Region, name: &str, sense: Sense) -> Entry {
        let is_type = self.spaces[region.space.0].own.get(&Key(name)).is_some_and(|it| it.ty == Some(found));
        match is_type && names_variables(sense) && region.outer.is_none() {
            true => match self.listed_in(region.space, name).as_slice() {
                [(_, variable)] => *variable,
                _ => found,
            },
            false => found,
        }
    }

    /// What the variables of lists mean by their bare names, of those in the root or in a library.
    fn in_lists_of(&self, around: SpaceId, name: &str, sense: Sense) -> Option<Found> {
        let own = if sense == Sense::Type { Vec::new() } else { self.listed_in(around, name) };
        self.one_of(name, &own)
    }

    /// What the libraries of the project hold. A PROGRAM that one brings along gives way.
    fn in_libraries(&self, site: Site, name: &str, sense: Sense) -> Option<Found> {
        let mut found = Vec::new();
        for space in self.spaces_of_libraries() {
            match self.held(site, space, name, sense) {
                Some(entry) => found.push((space, entry)),
                None if sense == Sense::Type => {}
                None => found.extend(self.listed_in(space, name)),
            }
        }
        if found.len() > 1 && found.iter().any(|it| !self.giving_way.contains(&it.1)) {
            found.retain(|it| !self.giving_way.contains(&it.1));
        }
        self.one_of(name, &found)
    }

    /// What one level has: one thing, or several that are named in full.
    fn one_of(&self, name: &str, found: &[(SpaceId, Entry)]) -> Option<Found> {
        match found {
            [] => None,
            [(_, entry)] => Some(Found::One(Meaning::Declared(*entry))),
            several => Some(Found::Several(several.iter().map(|(space, _)| self.in_full(*space, name)).collect())),
        }
    }

    fn spaces_of_libraries(&self) -> impl Iterator<Item = SpaceId> {
        // All but the root are made one after the other, before any other namespace.
        let most = self.libraries.iter().map(|it| it.1.0).max().unwrap_or_default();
        (1..=most).map(SpaceId)
    }

    /// Whether a namespace is that of a library of the project.
    pub fn is_of_library(&self, space: SpaceId) -> bool {
        self.spaces[space.0].is_library
    }

    /// From a namespace outward, as far as `outer`, which is not among them.
    fn spaces_to(&self, space: SpaceId, outer: Option<SpaceId>) -> impl Iterator<Item = SpaceId> {
        std::iter::successors(Some(space), |it| self.spaces[it.0].parent).take_while(move |it| Some(*it) != outer)
    }

    /// What the namespaces hold that a region uses.
    fn used(&self, site: Site, region: &Region, name: &str, sense: Sense) -> Option<Found> {
        let held = region.uses.iter().filter_map(|space| Some((*space, self.held(site, *space, name, sense)?)));
        // The root uses the lists, and a library its own.
        let uses_lists = region.outer.is_none() && names_variables(sense);
        let lists = if uses_lists { self.listed_in(region.space, name) } else { Vec::new() };
        let found: Vec<_> = held.chain(lists).collect();
        self.one_of(name, &found)
    }

    /// Whether a place sees what a namespace holds.
    fn sees(&self, site: Site, space: SpaceId, entries: Entries, entry: Entry) -> bool {
        !(entries.internal && entries.ty == Some(entry)) || self.is_inside(site.span, space)
    }

    /// Whether a place is in a namespace.
    pub fn is_inside(&self, place: Span, space: SpaceId) -> bool {
        // Outside of every NAMESPACE a program and its libraries are one.
        if self.is_of_library(space) {
            return true;
        }
        let mut around = self.regions.around(place);
        around.any(|it| self.spaces_to(it.space, None).any(|it| it == space))
    }

    fn library(&self, dialect: Dialect, name: &str, sense: Sense) -> Option<Meaning> {
        match sense {
            Sense::Type => dialect::bare_block(dialect, name).map(Meaning::Block),
            Sense::Value => None,
            Sense::Callee | Sense::Function => is_instruction(dialect.family(), name)
                .then_some(Meaning::Instruction)
                .or_else(|| functions::exists_in(name, dialect).then_some(Meaning::Function)),
        }
    }

    /// What a library has. Bundled Structured Text is declared like a user's sources.
    fn of_library(&self, dialect: Dialect, of: &str, name: &str, sense: Sense) -> Option<Meaning> {
        if prelude::unit(name, dialect).is_some_and(|it| library::is_one_of(it.libraries, of)) {
            // A unit whose name the program has itself has another one.
            let own = |name: &str| self.spaces[SpaceId::ROOT.0].own.get(&Key(name)).and_then(|it| it.of(sense));
            let listed = |name: &str| self.in_lists(SpaceId::ROOT, name).first().copied();
            let found = |name: &str| own(name).or_else(|| listed(name).filter(|_| sense == Sense::Value));
            return found(&prelude::renamed(name)).or_else(|| found(name)).map(Meaning::Declared);
        }
        self.library(dialect, name, sense).filter(|_| library::is_one_of(library::of_built_in(name), of))
    }

    /// Whether a name before a point is that of one of CODESYS's or TwinCAT's libraries, and of nothing else.
    pub fn is_library(&self, site: Site, name: &str) -> bool {
        matches!(self.prefix(site, name), Some(Prefix::Library))
    }

    fn qualified(&self, site: Site, first: &str, between: &[ast::Name<'_>], last: &str, sense: Sense) -> Found {
        let prefix = self.prefix(site, first);
        if let Some(Prefix::Space(space)) = prefix
            && self.is_of_library(space)
        {
            let found = self.in_space(site, space, between, last, sense);
            // The bundled part of a library is available in addition to its sources.
            let bundled = || self.of_library(site.dialect, first, last, sense).filter(|_| between.is_empty());
            let is_one = found != Found::Nothing;
            return if is_one { found } else { bundled().map_or(Found::Nothing, Found::One) };
        }
        if prefix.is_none()
            && let several @ [_, _, ..] = self.prefixes_in_libraries(first).as_slice()
        {
            let path: Vec<_> = between.iter().map(|it| it.text).chain([last]).collect();
            let full = |space| format!("{}.{}", self.in_full(space, first), path.join("."));
            return Found::Several(several.iter().map(|it| full(it.0)).collect());
        }
        let found = match prefix {
            None | Some(Prefix::Library)
                if let [inner, rest @ ..] = between
                    && library::leads_to(site.dialect, first, inner.text)
                    && self.is_library(site, inner.text) =>
            {
                return self.qualified(site, inner.text, rest, last, sense);
            }
            Some(Prefix::Space(space)) => return self.in_space(site, space, between, last, sense),
            Some(Prefix::Library) if is_list_of_a_library(between) => {
                self.of_library(site.dialect, first, last, sense).filter(|_| sense == Sense::Value)
            }
            Some(Prefix::Library) if let [ty] = between => self.enumerator_of_library(site.dialect, first, ty.text),
            _ if !between.is_empty() => None,
            Some(Prefix::Enumeration(slot)) => Some(Meaning::Enumerator(slot)),
            Some(Prefix::Globals) => return self.global(site, last, sense),
            Some(Prefix::Family(it)) => in_family(it, last, sense),
            Some(Prefix::Library) => self.of_library(site.dialect, first, last, sense),
            None => None,
        };
        found.map_or(Found::Nothing, Found::One)
    }

    /// `Tc2_MC2.MC_Direction.MC_Positive_Direction`
    fn enumerator_of_library(&self, dialect: Dialect, of: &str, ty: &str) -> Option<Meaning> {
        match self.of_library(dialect, of, ty, Sense::Type)? {
            Meaning::Declared(Entry::Type(slot)) => Some(Meaning::Enumerator(slot)),
            _ => None,
        }
    }

    fn prefix(&self, site: Site, name: &str) -> Option<Prefix> {
        let key = Key(name);
        let mut regions = self.regions.around(site.span).peekable();
        while let Some(region) = regions.next() {
            let outer = regions.peek().map(|it| it.space);
            for space in self.spaces_to(region.space, outer) {
                let space = &self.spaces[space.0];
                if let Some(inner) = space.inner.get(&key) {
                    return Some(Prefix::Space(*inner));
                }
                if let Some(Entry::Type(slot)) = space.own.get(&key).and_then(|it| it.ty) {
                    return Some(Prefix::Enumeration(slot));
                }
            }
            if let Some(Found::One(Meaning::Declared(Entry::Type(slot)))) = self.used(site, region, name, Sense::Type) {
                return Some(Prefix::Enumeration(slot));
            }
            // After `USING AxUnit;` it is `Assert.Equal`.
            if let Some(inner) = self.inner_of_used(site, region, name) {
                return Some(Prefix::Space(inner));
            }
        }
        if let Some(list) = self.lists.get(&key) {
            return Some(Prefix::Space(*list));
        }
        // A POU has no members to be named by it.
        if self.root(name).is_some_and(|it| it.ty.is_some()) {
            return None;
        }
        if let Some((_, space)) = self.libraries.iter().find(|it| it.0.eq_ignore_ascii_case(name)) {
            return Some(Prefix::Space(*space));
        }
        if let [(_, found)] = self.prefixes_in_libraries(name).as_slice() {
            return Some(*found);
        }
        if name.eq_ignore_ascii_case("Globals") {
            return Some(Prefix::Globals);
        }
        let library = library::is_library(site.dialect, name).then_some(Prefix::Library);
        Family::named(name).map(Prefix::Family).or(library)
    }

    /// The lists and enumerations of a name that libraries hold.
    fn prefixes_in_libraries(&self, name: &str) -> Vec<(SpaceId, Prefix)> {
        let key = Key(name);
        let in_space = |at: SpaceId| {
            let space = &self.spaces[at.0];
            let list = space.inner.get(&key).copied().map(Prefix::Space);
            let found = list.or_else(|| match space.own.get(&key)?.ty? {
                Entry::Type(slot) => Some(Prefix::Enumeration(slot)),
                Entry::Pou(_) | Entry::Global(_) => None,
            });
            Some((at, found?))
        };
        self.spaces_of_libraries().filter_map(in_space).collect()
    }

    /// The namespace of a name in one that a region uses, if it is in one of them alone.
    fn inner_of_used(&self, site: Site, region: &Region, name: &str) -> Option<SpaceId> {
        let mut found = region.uses.iter().filter_map(|space| self.seen(site, *space, name));
        let first = found.next()?;
        found.all(|it| it == first).then_some(first)
    }

    /// What a namespace holds at the end of a path.
    fn in_space(&self, site: Site, mut space: SpaceId, path: &[ast::Name<'_>], last: &str, sense: Sense) -> Found {
        for (at, name) in path.iter().enumerate() {
            if let Some(inner) = self.seen(site, space, name.text) {
                space = inner;
                continue;
            }
            // `Plant.Colour.Red`: the last namespace may be an enumeration.
            let ty = self.held(site, space, name.text, Sense::Type).filter(|_| at + 1 == path.len());
            return match ty {
                Some(Entry::Type(slot)) => Found::One(Meaning::Enumerator(slot)),
                Some(Entry::Pou(_) | Entry::Global(_)) | None => Found::Nothing,
            };
        }
        let held = self.held(site, space, last, sense).map(Meaning::Declared);
        // `Plant.Red`: the enumeration needs no name after that of its namespace.
        let held = held.or_else(|| self.enumerator_in(site, space, last).filter(|_| sense == Sense::Value));
        // `System.Math.Sqrt` is the standard function.
        let is_standard = sense == Sense::Callee && prelude::is_standard_space(&self.spaces[space.0].name);
        let standard = || self.library(site.dialect, last, sense).filter(|_| is_standard);
        held.or_else(standard).map_or(Found::Nothing, Found::One)
    }

    /// The only enumeration in a namespace that has a value with this name, so that the name needs no prefix.
    fn enumerator_in(&self, site: Site, space: SpaceId, name: &str) -> Option<Meaning> {
        let slots = self.enumerators.get(&Key(name))?;
        let own = self.spaces[space.0].own.values();
        let seen = own.filter_map(|it| it.ty.filter(|entry| self.sees(site, space, *it, *entry)));
        let mut found = seen.filter_map(|it| match it {
            Entry::Type(slot) if slots.contains(&slot) => Some(Meaning::Enumerator(slot)),
            Entry::Type(_) | Entry::Pou(_) | Entry::Global(_) => None,
        });
        found.next().filter(|_| found.next().is_none())
    }

    /// What a namespace holds by itself, as far as a place sees it.
    fn held(&self, site: Site, space: SpaceId, name: &str, sense: Sense) -> Option<Entry> {
        let entries = *self.spaces[space.0].own.get(&Key(name))?;
        entries.of(sense).filter(|it| self.sees(site, space, entries, *it))
    }

    /// The namespace of a name in another one, unless it is INTERNAL there and the place is outside.
    fn seen(&self, site: Site, space: SpaceId, name: &str) -> Option<SpaceId> {
        // After the name of a library there are its lists, too.
        let lists = || self.lists.get(&Key(name)).filter(|_| space == SpaceId::ROOT);
        let inner = *self.spaces[space.0].inner.get(&Key(name)).or_else(lists)?;
        (!self.is_internal(inner) || self.is_inside(site.span, space)).then_some(inner)
    }

    fn is_internal(&self, space: SpaceId) -> bool {
        self.spaces[space.0].internal == Some(true)
    }

    /// `Globals.x`; in `siemens`, whose quotes around a name say that it is not a local one, `Globals.f(…)` too.
    fn global(&self, site: Site, name: &str, sense: Sense) -> Found {
        let is_called = sense == Sense::Callee && site.dialect == Dialect::Siemens;
        match self.bare(site, name, Sense::Value) {
            Found::One(Meaning::Declared(Entry::Pou(slot))) if is_called => {
                Found::One(Meaning::Declared(Entry::Pou(slot)))
            }
            Found::One(Meaning::Declared(entry @ Entry::Global(_))) => Found::One(Meaning::Declared(entry)),
            Found::Several(names) => Found::Several(names),
            Found::One(_) | Found::Nothing => Found::Nothing,
        }
    }

    /// The name of what a namespace holds, with all namespaces around it.
    pub fn in_full(&self, space: SpaceId, name: &str) -> String {
        let around = &self.spaces[space.0];
        match (around.name.as_str(), around.parent) {
            ("", _) => name.to_owned(),
            // What a library has alone needs no name before it.
            _ if around.is_library && !self.is_elsewhere(space, name) => name.to_owned(),
            (list, Some(library)) if self.is_of_library(library) => format!("{}.{name}", self.in_full(library, list)),
            (around, _) => format!("{around}.{name}"),
        }
    }

    /// Whether the root, or another library, has the name as well.
    fn is_elsewhere(&self, space: SpaceId, name: &str) -> bool {
        let key = Key(name);
        let mut others = self.spaces_of_libraries().chain([SpaceId::ROOT]).filter(|it| *it != space);
        let has = |it: &Namespace<'s>| it.own.contains_key(&key) || it.inner.contains_key(&key);
        others.any(|it| has(&self.spaces[it.0])) || self.lists.contains_key(&key)
    }

    /// The namespace that a path of names leads to, whether or not the place sees it: what is before the last point.
    pub fn space_at(&self, site: Site, path: &[ast::Name<'_>]) -> Option<SpaceId> {
        let (first, rest) = path.split_first()?;
        let Some(Prefix::Space(mut space)) = self.prefix(site, first.text) else { return None };
        for name in rest {
            space = *self.spaces[space.0].inner.get(&Key(name.text))?;
        }
        Some(space)
    }

    /// A namespace's full name.
    pub fn name_of(&self, space: SpaceId) -> &str {
        &self.spaces[space.0].name
    }

    /// Where a place declares what it names.
    pub fn space_of(&self, place: Span) -> SpaceId {
        self.regions.around(place).next().map_or(SpaceId::ROOT, |it| it.space)
    }

    /// Adds the regions of the next file, and those of its lists of global variables. Those of the file are
    /// given back in its order.
    pub fn add_file(&mut self, file: &ast::File<'s>, lists: &[(Span, SpaceId)]) -> Vec<RegionId> {
        let own = self.space_of_file(self.regions.count_files());
        let mut around: Vec<(u32, SpaceId)> = Vec::new();
        let mut stretches = Vec::new();
        for (at, region) in file.regions.iter().enumerate() {
            around.retain(|it| region.span.start < it.0);
            let outer = around.last().map_or(own, |it| it.1);
            // A NAMESPACE is in no library: others add to it.
            let is_outermost = outer == own && !region.path.is_empty();
            let outer = if is_outermost { SpaceId::ROOT } else { outer };
            let space = region.path.iter().fold(outer, |space, name| self.inner(space, name.text));
            // The region of a file, or of a POU with USING, is of the namespace around it.
            if !region.path.is_empty() {
                let internal = &mut self.spaces[space.0].internal;
                *internal = Some(region.internal && internal.unwrap_or(true));
            }
            around.push((region.span.end, space));
            stretches.push((region.span, space, Some(at)));
        }
        stretches.extend(lists.iter().map(|(span, space)| (*span, *space, None)));
        stretches.sort_by_key(|it| (it.0.start, std::cmp::Reverse(it.0.end)));
        let ids = self.regions.add_file(stretches.iter().map(|it| (it.0, it.1)));
        let mut own: Vec<_> = stretches.iter().zip(ids).filter_map(|(it, id)| Some((it.2?, id))).collect();
        own.sort_by_key(|it| it.0);
        own.into_iter().map(|it| it.1).collect()
    }

    /// All of a file is read as if it were at a place of another one.
    pub fn read_as_at(&mut self, file: u16, place: Span) {
        self.regions.read_as_at(file, place);
    }

    /// What a USING directive in a region names; false if the namespace does not exist or is not visible.
    pub fn use_space(&mut self, region: RegionId, site: Site, path: &[ast::Name<'_>]) -> bool {
        let space = self.space_at(site, path).filter(|it| self.hidden(site, *it).is_none());
        space.into_iter().for_each(|it| self.regions.use_in(region, it));
        space.is_some()
    }

    /// The INTERNAL namespace that hides another one from a place: it, or the outermost one around it.
    pub fn hidden(&self, site: Site, space: SpaceId) -> Option<&str> {
        let hides = |it: &SpaceId| {
            let around = self.spaces[it.0].parent.filter(|_| self.is_internal(*it));
            around.is_some_and(|around| around != SpaceId::ROOT && !self.is_inside(site.span, around))
        };
        let around = std::iter::successors(Some(space), |it| self.spaces[it.0].parent);
        around.filter(hides).last().map(|it| self.spaces[it.0].name.as_str())
    }

    /// The namespace in another one, made where there is none.
    fn inner(&mut self, space: SpaceId, name: &'s str) -> SpaceId {
        let next = SpaceId(self.spaces.len());
        let inner = *self.spaces[space.0].inner.entry(Key(name)).or_insert(next);
        if inner == next {
            let full = self.in_full(space, name);
            let parent = Some(space);
            self.spaces.push(Namespace { name: full, parent, ..Namespace::default() });
        }
        inner
    }

    /// The list of global variables with a name that a file has, made where there is none.
    pub fn list(&mut self, name: &'s str, file: u16) -> SpaceId {
        let next = SpaceId(self.spaces.len());
        let around = self.space_of_file(usize::from(file));
        let lists = match around {
            SpaceId::ROOT => &mut self.lists,
            library => &mut self.spaces[library.0].inner,
        };
        let list = *lists.entry(Key(name)).or_insert(next);
        if list == next {
            let parent = Some(around);
            self.spaces.push(Namespace { name: name.to_owned(), parent, is_list: true, ..Namespace::default() });
        }
        list
    }

    fn space_of_file(&self, file: usize) -> SpaceId {
        self.files.get(file).copied().unwrap_or(SpaceId::ROOT)
    }

    /// Makes the namespaces of libraries, before any other; `has_own` says which files are in one. A library has the name
    /// that the project calls it by, too.
    pub fn add_libraries(&mut self, sources: &Sources, has_own: impl Fn(usize) -> bool) {
        for (file, source) in sources.files().iter().enumerate() {
            let space = source.library().map_or(SpaceId::ROOT, |it| self.library_named(it, has_own(file)));
            self.files.push(space);
        }
        for it in sources.references() {
            let known = self.libraries.iter().find(|known| known.0.eq_ignore_ascii_case(&it.library));
            let named = known.map(|known| (it.namespace.clone(), known.1));
            self.libraries.extend(named);
        }
    }

    fn library_named(&mut self, name: &str, has_own: bool) -> SpaceId {
        if let Some((_, space)) = self.libraries.iter().find(|it| it.0.eq_ignore_ascii_case(name)) {
            return *space;
        }
        let mut space = SpaceId::ROOT;
        if has_own {
            space = SpaceId(self.spaces.len());
            let (name, parent) = (name.to_owned(), Some(SpaceId::ROOT));
            self.spaces.push(Namespace { name, parent, is_library: true, ..Namespace::default() });
        }
        self.libraries.push((name.to_owned(), space));
        space
    }

    /// The names of the project's libraries.
    pub fn libraries(&self) -> impl Iterator<Item = &str> {
        self.libraries.iter().map(|it| it.0.as_str())
    }

    /// The namespace of the file that a place is in.
    pub fn home(&self, place: Span) -> SpaceId {
        self.space_of_file(usize::from(place.file))
    }

    pub fn names_in(&self, space: SpaceId) -> impl Iterator<Item = &'s str> {
        let space = &self.spaces[space.0];
        space.own.keys().chain(space.inner.keys()).map(|it| it.0)
    }

    /// Whether a namespace is a list of global variables.
    pub fn is_list(&self, space: SpaceId) -> bool {
        self.spaces[space.0].is_list
    }

    /// What the root holds of a name, by itself.
    pub fn root(&self, name: &str) -> Option<Entries> {
        self.own(SpaceId::ROOT, name)
    }

    pub fn own(&self, space: SpaceId, name: &str) -> Option<Entries> {
        self.spaces[space.0].own.get(&Key(name)).copied()
    }

    /// The namespace with this name in another one.
    pub fn inner_named(&self, space: SpaceId, name: &str) -> bool {
        self.spaces[space.0].inner.contains_key(&Key(name))
    }

    /// Makes each name of a list one that is used after the list's alone.
    pub fn qualify(&mut self, list: SpaceId) {
        self.spaces[list.0].is_qualified = true;
    }

    pub fn is_qualified(&self, space: SpaceId) -> bool {
        self.spaces[space.0].is_qualified
    }

    /// The list after whose name alone a name is used.
    pub fn qualified_list_with(&self, name: &str) -> Option<&str> {
        let holds = |it: &&Namespace<'_>| it.is_qualified && it.own.contains_key(&Key(name));
        self.spaces.iter().find(holds).map(|it| it.name.as_str())
    }

    /// The global variables with this name in the lists of the root, or of a library, whose names need no prefix.
    pub fn in_lists(&self, around: SpaceId, name: &str) -> Vec<Entry> {
        self.listed_in(around, name).into_iter().map(|it| it.1).collect()
    }

    fn listed_in(&self, around: SpaceId, name: &str) -> Vec<(SpaceId, Entry)> {
        let listed = self.listed.get(&Key(name)).into_iter().flatten();
        listed.copied().filter(|it| self.around_list(it.0) == around).collect()
    }

    /// What a list is in: the root, or a library.
    pub fn around_list(&self, list: SpaceId) -> SpaceId {
        self.spaces[list.0].parent.unwrap_or(SpaceId::ROOT)
    }

    /// How many global variables have that name, in all namespaces.
    pub fn globals_named(&self, name: &str) -> usize {
        self.globals.get(&Key(name)).copied().unwrap_or_default()
    }

    pub fn insert(&mut self, space: SpaceId, name: &'s str, entry: Entry, internal: bool) {
        let is_list = self.is_list(space);
        let entries = self.spaces[space.0].own.entry(Key(name)).or_default();
        match entry {
            Entry::Global(_) => {
                entries.value = Some(entry);
                *self.globals.entry(Key(name)).or_default() += 1;
            }
            Entry::Type(_) | Entry::Pou(_) => {
                entries.ty = Some(entry);
                entries.internal = internal;
            }
        }
        if is_list && !self.is_qualified(space) {
            self.listed.entry(Key(name)).or_default().push((space, entry));
        }
    }

    /// The names of all types and POUs.
    pub fn type_names(&self) -> impl Iterator<Item = &'s str> {
        self.spaces.iter().flat_map(|it| &it.own).filter(|(_, it)| it.ty.is_some()).map(|(key, _)| key.0)
    }

    /// The namespaces in full.
    pub fn namespaces(&self) -> impl Iterator<Item = &str> {
        self.spaces.iter().filter(|it| !it.name.is_empty() && !it.is_list && !it.is_library).map(|it| it.name.as_str())
    }

    /// All names that files declare, but enumerators.
    pub fn all(&self) -> impl Iterator<Item = &'s str> {
        self.spaces.iter().flat_map(|it| it.own.keys()).map(|it| it.0)
    }

    /// The full names of the namespaces that hold a type or a POU with this name, and whether it is INTERNAL.
    pub fn holders(&self, name: &str) -> Vec<(String, bool)> {
        let held = |it: &Namespace<'_>| {
            let entries = it.own.get(&Key(name)).filter(|it| it.ty.is_some())?;
            Some((it.name.clone(), entries.internal || it.internal == Some(true)))
        };
        self.spaces.iter().skip(1).filter_map(held).collect()
    }
}

fn names_variables(sense: Sense) -> bool {
    match sense {
        Sense::Value | Sense::Callee => true,
        Sense::Type | Sense::Function => false,
    }
}

/// `Tc2_System.Global_Variables.PI`
fn is_list_of_a_library(between: &[ast::Name<'_>]) -> bool {
    matches!(between, [it] if it.text.eq_ignore_ascii_case(prelude::LIST))
}

/// What a family's name before `name` makes of it.
fn in_family(family: Family, name: &str, sense: Sense) -> Option<Meaning> {
    match sense {
        // What all systems share needs no family of its own.
        Sense::Type => dialect::block_in(family, name).or_else(|| dialect::shared_block(name)).map(Meaning::Block),
        Sense::Value => None,
        Sense::Callee | Sense::Function => is_instruction(family, name).then_some(Meaning::Instruction),
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

/// The structures of a family that have the instruction `name`, each with its position there.
pub(crate) fn instructions_in(family: Family, name: &str) -> &[(BlockId, usize)] {
    let known = INSTRUCTIONS.get(&Key(name)).map_or(&[][..], Vec::as_slice);
    if known.iter().all(|(block, _)| block.info().family == family) { known } else { &[] }
}

/// Whether `name` is an instruction in `family`.
pub(crate) fn is_instruction(family: Family, name: &str) -> bool {
    !instructions_in(family, name).is_empty() || family == Family::Logix && bit_instruction(name).is_some()
}

/// An instruction of Logix on single bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BitInstruction {
    /// `ONS`
    OneShot,
    /// `OSR`
    OneShotRising,
    /// `OSF`
    OneShotFalling,
    /// `OTL`
    Latch,
    /// `OTU`
    Unlatch,
}

impl BitInstruction {
    const ALL: [(&str, Self); 5] = [
        ("ONS", Self::OneShot),
        ("OSR", Self::OneShotRising),
        ("OSF", Self::OneShotFalling),
        ("OTL", Self::Latch),
        ("OTU", Self::Unlatch),
    ];

    /// The bits that it works on, before its rung.
    pub fn operands(self) -> &'static [&'static str] {
        match self {
            Self::OneShot => &["StorageBit"],
            Self::OneShotRising | Self::OneShotFalling => &["StorageBit", "OutputBit"],
            Self::Latch | Self::Unlatch => &["DataBit"],
        }
    }

    /// What the prescan gives each of them.
    pub fn prescan(self) -> &'static [Option<bool>] {
        match self {
            Self::OneShot => &[Some(true)],
            Self::OneShotRising => &[Some(true), Some(false)],
            Self::OneShotFalling => &[Some(false), Some(false)],
            Self::Latch | Self::Unlatch => &[None],
        }
    }
}

pub(crate) fn bit_instruction(name: &str) -> Option<BitInstruction> {
    BitInstruction::ALL.into_iter().find(|(it, _)| it.eq_ignore_ascii_case(name)).map(|(_, it)| it)
}
