//! Which types a folder sees: in Automation Studio those of a `.typ` are there for its folder and the folders in it. One type that
//! several declare is read once; where they declare different types by one name, each is in a namespace of its folder's.

use super::folder_of;
use crate::ast::{File, Item, Name, Path, TypeDecl};
use crate::lex::{Kind, Scanner};
use crate::source::{Comments, Span};
use crate::spelling::Key;
use crate::{Source, Sources};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::hash_map::Entry;

/// Leaves one of several equal types, and puts those that differ into namespaces that their folders use. So are the CONSTANTs of
/// a program that the types of its folder name, in the `shared` files.
pub(super) fn expand<'s>(files: &mut [File<'s>], sources: &'s Sources, shared: &[usize]) {
    let own: Vec<usize> = (0..files.len()).filter(|at| !sources.files()[*at].is_bundled()).collect();
    let folder = |at: usize| folder_of(&sources.files()[at].path);
    let apart = different(files, &own, sources);
    let holds = |at: usize, name: &Key<'s>| apart.get(name).is_some_and(|it| it.contains(&at));
    let has_space = |at: &usize| shared.contains(at) || apart.keys().any(|it| holds(*at, it));
    let with_space: Vec<usize> = own.iter().copied().filter(has_space).collect();
    drop_copies(files, own.iter().copied().filter(|it| !with_space.contains(it)), sources);
    let root = common(own.iter().map(|at| folder(*at)));
    for at in &own {
        let mut near: Vec<usize> = with_space.iter().copied().filter(|it| is_in(folder(*at), folder(*it))).collect();
        near.sort_by_key(|it| core::cmp::Reverse(folder(*it).len()));
        let mut seen: Vec<Key<'s>> = Vec::new();
        for it in near {
            let names: Vec<Key<'s>> = types(&files[it]).map(|it| Key(it.name.text)).collect();
            let is_hidden = names.iter().any(|it| seen.contains(it)) && folder(it) != folder(*at);
            seen.extend(names);
            if let Some(region) = files[*at].regions.first_mut().filter(|_| !is_hidden) {
                region.uses.push(space(folder(it), root, region.span));
            }
        }
    }
    for at in with_space {
        if let Some(region) = files[at].regions.first_mut() {
            region.path = space(folder(at), root, region.span);
        }
    }
}

/// The types that folders declare differently, each with the files that do; what is made of such a type differs as well.
fn different<'s>(files: &[File<'s>], own: &[usize], sources: &'s Sources) -> FxHashMap<Key<'s>, Vec<usize>> {
    let folder = |at: usize| folder_of(&sources.files()[at].path);
    let mut declared: FxHashMap<Key<'s>, Vec<(usize, Vec<&'s str>)>> = FxHashMap::default();
    for at in own {
        for ty in types(&files[*at]) {
            declared.entry(Key(ty.name.text)).or_default().push((*at, words(ty, sources)));
        }
    }
    declared.retain(|_, all| all.iter().any(|it| folder(it.0) != folder(all[0].0)));
    let mut found: FxHashSet<Key<'s>> = FxHashSet::default();
    loop {
        let differs = |all: &[(usize, Vec<&'s str>)]| {
            all.iter().any(|it| it.1 != all[0].1 || it.1.iter().any(|word| found.contains(&Key(word))))
        };
        let more: Vec<_> =
            declared.iter().filter(|it| !found.contains(it.0) && differs(it.1)).map(|it| *it.0).collect();
        if more.is_empty() {
            break;
        }
        found.extend(more);
    }
    declared.retain(|name, _| found.contains(name));
    declared.into_iter().map(|(name, all)| (name, all.into_iter().map(|it| it.0).collect())).collect()
}

fn types<'a, 's>(file: &'a File<'s>) -> impl Iterator<Item = &'a TypeDecl<'s>> {
    file.items.iter().flat_map(|it| match it {
        Item::Types(types) => types.as_slice(),
        Item::Pou(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => &[],
    })
}

/// What all these namespaces are in: programs have the names of folders.
const SPACES: &str = "__types";

/// The namespace of a folder's types: its path below the folder that has all, as far as that can be names.
fn space<'s>(folder: &'s str, root: usize, span: Span) -> Path<'s> {
    let below = folder.get(root..).unwrap_or_default().split(['/', '\\']);
    let is_name = |it: &&str| {
        it.starts_with(|it: char| it.is_ascii_alphabetic())
            && it.bytes().all(|it| it.is_ascii_alphanumeric() || it == b'_')
    };
    let path = core::iter::once(SPACES).chain(below.filter(is_name));
    path.map(|text| Name { text, span: Span { end: span.start, ..span } }).collect()
}

/// Whether a folder is another, or in it.
fn is_in(folder: &str, other: &str) -> bool {
    folder.strip_prefix(other).is_some_and(|it| it.is_empty() || other.is_empty() || it.starts_with(['/', '\\']))
}

/// The length of the path that all folders begin with.
fn common<'s>(mut folders: impl Iterator<Item = &'s str>) -> usize {
    let Some(first) = folders.next() else { return 0 };
    folders.fold(first.len(), |length, it| {
        let same = first.bytes().zip(it.bytes()).take(length).take_while(|it| it.0 == it.1).count();
        let ends_at = |it: &str| it.len() == same || it.get(same..).is_some_and(|it| it.starts_with(['/', '\\']));
        if ends_at(first) && ends_at(it) {
            return same;
        }
        first.bytes().take(same).rposition(|it| matches!(it, b'/' | b'\\')).unwrap_or(0)
    })
}

/// A type that several folders declare, for their own programs, is one type where they declare the same.
fn drop_copies<'s>(files: &mut [File<'s>], of: impl Iterator<Item = usize>, sources: &'s Sources) {
    let mut seen: FxHashMap<Key<'s>, Vec<&'s str>> = FxHashMap::default();
    for at in of {
        for item in &mut files[at].items {
            let Item::Types(types) = item else { continue };
            types.retain(|ty| {
                let own = words(ty, sources);
                match seen.entry(Key(ty.name.text)) {
                    Entry::Occupied(first) => *first.get() != own,
                    Entry::Vacant(first) => {
                        first.insert(own);
                        true
                    }
                }
            });
        }
    }
}

/// The names in the types of a folder.
pub(super) fn words_of_types<'s>(folder: &str, sources: &'s Sources) -> FxHashSet<Key<'s>> {
    let is_list = |it: &&Source| folder_of(&it.path) == folder && super::has_extension(&it.path, "typ");
    sources.files().iter().filter(is_list).flat_map(|it| words_in(&it.text)).map(Key).collect()
}

/// What a declaration says, without comments.
fn words<'s>(ty: &TypeDecl<'_>, sources: &'s Sources) -> Vec<&'s str> {
    words_in(sources.text(ty.name.span.to(ty.ty.span)))
}

fn words_in(text: &str) -> Vec<&str> {
    let mut scanner = Scanner::new(text);
    scanner.end_comments(Comments::Plain);
    let mut words = Vec::new();
    while let Some(kind) = scanner.next() {
        if kind != Kind::Comment && kind != Kind::Pragma {
            words.push(text.get(scanner.span()).unwrap_or_default());
        }
    }
    words
}
