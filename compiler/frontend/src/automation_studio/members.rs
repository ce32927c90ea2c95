//! Names that differ only in case, which Automation Studio distinguishes. B&R's libraries have such members, for internal use, and
//! types with the names of function blocks. A member that no code names, and a type, is renamed here;
//! other such names stay, and are refused.

use crate::Sources;
use crate::ast::{File, Item, Name, TypeKind, TypeSpec, VarDecl};
use crate::spelling::Key;
use rustc_hash::FxHashMap;

/// What such members are called, in their order.
const NAMES: [&str; 4] = ["__other_1", "__other_2", "__other_3", "__other_4"];

/// What such types are called.
const TYPES: [&str; 4] = ["__other_type_1", "__other_type_2", "__other_type_3", "__other_type_4"];

pub(super) fn expand<'s>(files: &mut [File<'s>], sources: &'s Sources) {
    for (file, source) in files.iter_mut().zip(sources.files()).filter(|it| super::has_extension(&it.1.path, "typ")) {
        debug_assert!(!source.is_bundled(), "the library has no such files");
        for item in &mut file.items {
            let Item::Types(types) = item else { continue };
            for ty in types {
                if let TypeKind::Struct(members) = &mut ty.ty.kind {
                    rename(members, sources);
                }
            }
        }
    }
}

/// Types with the name of a function block that is declared without a body, in other capitals: what is of such a type says so in its own.
pub(super) fn rename_types(files: &mut [File<'_>]) {
    let items = || files.iter().flat_map(|it| &it.items);
    let blocks: Vec<&str> = items()
        .filter_map(|it| match it {
            Item::Pou(pou) if pou.is_stub => Some(pou.name.text),
            Item::Pou(_) | Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
        })
        .collect();
    let types = items().flat_map(|it| match it {
        Item::Types(types) => types.as_slice(),
        Item::Pou(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => &[],
    });
    let is_other = |it: &&str| blocks.iter().any(|block| Key(block) == Key(it) && block != it);
    let renamed: Vec<(&str, &'static str)> = types.map(|it| it.name.text).filter(is_other).zip(TYPES).collect();
    if renamed.is_empty() {
        return;
    }
    let rename = |name: &mut Name<'_>| {
        if let Some((_, other)) = renamed.iter().find(|it| it.0 == name.text) {
            name.text = other;
        }
    };
    for item in files.iter_mut().flat_map(|it| &mut it.items) {
        match item {
            Item::Types(types) => types.iter_mut().for_each(|it| {
                rename(&mut it.name);
                each_type(&mut it.ty, &rename);
            }),
            Item::Pou(pou) => {
                let vars = pou.blocks.iter_mut().flat_map(|it| &mut it.vars);
                vars.for_each(|it| each_type(&mut it.ty, &rename));
            }
            Item::Globals(block) => block.vars.iter_mut().for_each(|it| each_type(&mut it.ty, &rename)),
            Item::Configuration(_) | Item::Test(_) => {}
        }
    }
}

/// Calls `rename` with each name of a type in what a variable is declared as.
fn each_type<'s>(ty: &mut TypeSpec<'s>, rename: &dyn Fn(&mut Name<'s>)) {
    match &mut ty.kind {
        TypeKind::Named(path) => {
            if let [name] = path.as_mut_slice() {
                rename(name);
            }
        }
        TypeKind::Array { element: inner, .. } | TypeKind::Reference { target: inner, .. } => each_type(inner, rename),
        TypeKind::Struct(members) | TypeKind::Union(members) => {
            members.iter_mut().for_each(|it| each_type(&mut it.ty, rename));
        }
        TypeKind::String { .. } | TypeKind::Subrange { .. } | TypeKind::Enum { .. } | TypeKind::Error => {}
    }
}

fn rename<'s>(members: &mut [VarDecl<'s>], sources: &'s Sources) {
    let mut seen: FxHashMap<Key<'s>, &'s str> = FxHashMap::default();
    let mut free = NAMES.into_iter();
    for name in members.iter_mut().flat_map(|it| &mut it.names) {
        let first = *seen.entry(Key(name.text)).or_insert(name.text);
        if first != name.text
            && !is_named(name.text, sources)
            && let Some(other) = free.next()
        {
            name.text = other;
        }
    }
}

/// Whether code names a member, with these capitals: `x.name`, `(name := 1)`.
fn is_named(name: &str, sources: &Sources) -> bool {
    let is_of_word = |it: char| it.is_alphanumeric() || it == '_';
    sources.files().iter().any(|source| {
        source.text.match_indices(name).any(|(at, _)| {
            let (before, after) = (&source.text[..at], &source.text[at + name.len()..]);
            let is_whole = !before.ends_with(is_of_word) && !after.starts_with(is_of_word);
            is_whole && (before.trim_end().ends_with('.') || after.trim_start().starts_with(":="))
        })
    })
}
