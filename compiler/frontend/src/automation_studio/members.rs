//! Members whose names differ only in capitals and small letters: structures of B&R's libraries have them, for what is internal to
//! them. One that no code names is called otherwise; others stay, and are refused.

use crate::Sources;
use crate::ast::{File, Item, TypeKind, VarDecl};
use crate::spelling::Key;
use rustc_hash::FxHashMap;

/// What such members are called, in their order.
const NAMES: [&str; 4] = ["__other_1", "__other_2", "__other_3", "__other_4"];

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
