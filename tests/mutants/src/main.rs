//! `mutants TREE LIST SKIP FILE…`: puts every mutant of the files of a copy of the sources into them, each with a
//! switch, so that one build holds all. The program that is made asks `STAUNCH_MUTANT` for the one that is on.
//! `LIST` gets a line for each: its number, its place and what it changes. The numbers in the file `SKIP` get no
//! switch: what they would make does not compile. Code that is only for tests gets none either.

mod insert;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// What the runtime gets at its end. Every crate with mutants, and every test, has the runtime.
const SWITCH: &str = concat!(
    "\n#[doc(hidden)]\n#[allow(missing_docs, unused, clippy::all)]\npub mod mutant {\n",
    include_str!("switch.rs"),
    "}\n"
);
/// What other crates with mutants get.
const FROM_RUNTIME: &str = "\n#[doc(hidden)]\npub use staunch_runtime::mutant;\n";
const RUNTIME: &str = "runtime/core/src/lib.rs";

fn main() -> io::Result<()> {
    let mut arguments = env::args().skip(1);
    let mut next =
        || arguments.next().map(PathBuf::from).ok_or_else(|| io::Error::other("mutants TREE LIST SKIP FILE…"));
    let (tree, list, skip) = (next()?, next()?, next()?);
    let skip: HashSet<u32> = fs::read_to_string(skip)?.lines().filter_map(|it| it.parse().ok()).collect();
    let mut first = 0;
    let mut lines = String::new();
    let mut crates = HashSet::new();
    for path in arguments {
        let file = tree.join(&path);
        if is_for_tests(&file)? {
            continue;
        }
        let text = fs::read_to_string(&file)?;
        let mut syntax = syn::parse_file(&text).map_err(|it| io::Error::other(format!("{path}: {it}")))?;
        for mutant in insert::insert(&mut syntax, first, &skip) {
            lines += &format!("{first} {path}:{}:{} {}\n", mutant.line, mutant.column, mutant.change);
            first += 1;
        }
        fs::write(&file, prettyplease::unparse(&syntax))?;
        crates.insert(root(&file)?);
    }
    let runtime = tree.join(RUNTIME);
    append(&runtime, SWITCH)?;
    for root in crates.iter().filter(|it| **it != runtime) {
        append(root, FROM_RUNTIME)?;
    }
    fs::write(list, lines)
}

fn append(path: &Path, more: &str) -> io::Result<()> {
    fs::write(path, fs::read_to_string(path)? + more)
}

/// Whether the module that a file is says `#[cfg(test)]` where it is declared. A name says nothing: the compiler has
/// modules `tests` that are about those of its users.
fn is_for_tests(file: &Path) -> io::Result<bool> {
    let (Some(folder), Some(name)) = (file.parent(), file.file_stem()) else { return Ok(false) };
    let parents =
        ["mod.rs", "lib.rs", "main.rs"].map(|it| folder.join(it)).into_iter().chain([folder.with_extension("rs")]);
    for parent in parents.filter(|it| it.exists() && it != file) {
        let syntax = syn::parse_file(&fs::read_to_string(&parent)?).map_err(io::Error::other)?;
        let is_declared = |it: &syn::Item| matches!(it, syn::Item::Mod(it) if it.content.is_none() && *name == *it.ident.to_string() && insert::is_test(&it.attrs));
        if syntax.items.iter().any(is_declared) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The file of the crate that a module is in.
fn root(file: &Path) -> io::Result<PathBuf> {
    let mut folders = file.ancestors().skip(1).map(|it| it.join("lib.rs"));
    folders.find(|it| it.exists()).ok_or_else(|| io::Error::other(format!("{} is in no library", file.display())))
}
