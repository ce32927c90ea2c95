//! What a name means where it is written: names are found from the inside out (edition 3, 6.9).
//!
//! A key is the whole name of what the files declare, with the namespaces that it is in.

use crate::machine::{Outcome, unknown};
use staunch_frontend::Span;
use staunch_frontend::ast::{File, Item, Name, Pou, PouKind, Region, TypeDecl, VarBlock};
use std::collections::{HashMap, HashSet};

/// What the files declare.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Declared<'a> {
    Type(&'a TypeDecl<'a>),
    /// With its number in the order of the files.
    Pou(usize, &'a Pou<'a>),
}

#[derive(Debug)]
pub(crate) struct Names<'a> {
    files: &'a [File<'a>],
    declared: HashMap<String, Declared<'a>>,
    /// A variable may have the name of a type or a POU.
    globals: HashSet<String>,
}

/// Where a name is looked up at once.
struct Level {
    /// The namespace around; a POU has none of its own.
    own: Option<String>,
    /// What its USING directives name.
    uses: Vec<String>,
}

impl<'a> Names<'a> {
    pub fn new(files: &'a [File<'a>]) -> Outcome<Self> {
        let mut this = Self { files, declared: HashMap::new(), globals: HashSet::new() };
        let mut pous = 0;
        for item in files.iter().flat_map(|it| &it.items) {
            match item {
                Item::Pou(pou) => {
                    this.add(&pou.name, Declared::Pou(pous, pou))?;
                    pous += 1;
                }
                Item::Types(types) => {
                    types.iter().try_for_each(|it| this.add(&it.name, Declared::Type(it)))?;
                }
                Item::Globals(block) => this.add_globals(block)?,
                Item::Configuration(it) => {
                    let mut blocks = it.globals.iter().chain(it.resources.iter().flat_map(|it| &it.globals));
                    blocks.try_for_each(|it| this.add_globals(it))?;
                }
                Item::Test(_) => return unknown("a TEST"),
            }
        }
        Ok(this)
    }

    fn add_globals(&mut self, block: &'a VarBlock<'a>) -> Outcome<()> {
        let names: Vec<_> = block.vars.iter().flat_map(|it| &it.names).map(|it| self.key(it)).collect();
        let all_new = names.into_iter().all(|it| self.globals.insert(it));
        if all_new { Ok(()) } else { unknown("two global variables with the same name") }
    }

    fn add(&mut self, name: &Name<'a>, declared: Declared<'a>) -> Outcome<()> {
        match self.declared.insert(self.key(name), declared) {
            Some(_) => unknown("two types or POUs with the same name"),
            None => Ok(()),
        }
    }

    /// The key of what is declared at this place.
    pub fn key(&self, name: &Name<'a>) -> String {
        let around = self.levels(name.span).into_iter().rev().find_map(|it| it.own);
        joined(&around.unwrap_or_default(), name.text)
    }

    /// What a path of names means where it is written, of types and POUs.
    pub fn find(&self, path: &[Name<'a>]) -> Option<(String, Declared<'a>)> {
        self.meanings(path).find_map(|key| Some((key.clone(), *self.declared.get(&key)?)))
    }

    /// The key of the global variable, or the PROGRAM, that a path names.
    pub fn variable(&self, path: &[Name<'a>]) -> Option<String> {
        let is_program =
            |key: &str| matches!(self.declared.get(key), Some(Declared::Pou(_, it)) if it.kind == PouKind::Program);
        self.meanings(path).find(|key| self.globals.contains(key) || is_program(key))
    }

    /// The keys that a path may mean, that of the innermost place first.
    fn meanings(&self, path: &[Name<'a>]) -> impl Iterator<Item = String> {
        let name = path.iter().map(|it| it.text).collect::<Vec<_>>().join(".");
        let levels = path.first().map_or_else(Vec::new, |it| self.levels(it.span));
        let places = levels.into_iter().rev().flat_map(|it| it.own.into_iter().chain(it.uses));
        places.map(move |it| joined(&it, &name))
    }

    /// The POU that a path names, and its number.
    pub fn pou(&self, path: &[Name<'a>]) -> Option<(usize, &'a Pou<'a>)> {
        match self.find(path)?.1 {
            Declared::Pou(number, pou) => Some((number, pou)),
            Declared::Type(_) => None,
        }
    }

    /// The namespaces and POUs around a place, from the outside in.
    fn levels(&self, at: Span) -> Vec<Level> {
        let Some(file) = self.files.get(usize::from(at.file)) else { return Vec::new() };
        let mut levels = Vec::new();
        let mut namespace = String::new();
        for (number, region) in file.regions.iter().enumerate() {
            if number > 0 && !(region.span.start <= at.start && at.start < region.span.end) {
                continue;
            }
            for part in &region.path {
                namespace = joined(&namespace, part.text);
                levels.push(Level { own: Some(namespace.clone()), uses: Vec::new() });
            }
            match levels.last_mut().filter(|_| !region.path.is_empty()) {
                Some(last) => last.uses = uses(region),
                // The file is outside of all namespaces.
                None => levels.push(Level { own: (number == 0).then(String::new), uses: uses(region) }),
            }
        }
        levels
    }
}

fn uses(region: &Region<'_>) -> Vec<String> {
    let path = |it: &Vec<Name<'_>>| it.iter().fold(String::new(), |path, it| joined(&path, it.text));
    region.uses.iter().map(path).collect()
}

fn joined(namespace: &str, name: &str) -> String {
    let name = name.to_ascii_uppercase();
    if namespace.is_empty() { name } else { format!("{namespace}.{name}") }
}
