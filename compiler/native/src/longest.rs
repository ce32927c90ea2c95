//! The most instructions that a scan runs: the longest way through the functions' code, with that of what they call.

use crate::count::{Call, Costs, Counted, Gap, Repeats, Why, longest};
use crate::measure::{Callee, Measures};
use crate::outside::instructions_outside;
use rustc_hash::FxHashMap;
use staunch_ir::Location;
use std::collections::BTreeSet;

/// What is known of how many instructions a call runs at most.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Longest {
    /// The number, if nothing is unknown.
    pub instructions: u64,
    /// The functions of the longest chain of calls, from the outermost, each with what a call of it runs.
    pub path: Vec<(String, u64)>,
    pub unknown: BTreeSet<Unknown>,
}

/// Why it has no number.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unknown {
    /// Nothing says how often a loop is repeated.
    Loop { at: Location, why: Why },
    /// A function that is not the program's own, by its symbol.
    Call(String),
    /// Something in the code of this function.
    Code(String, Gap),
}

impl Measures {
    /// Of `staunch_scan`, where `makes` says which calls of a caller are made.
    pub fn longest_scan(&self, makes: &dyn Fn(usize, &Callee) -> bool) -> Longest {
        let mut search = Search { measures: self, makes, done: FxHashMap::default(), unknown: BTreeSet::new() };
        let (instructions, _) = search.function(self.scan);
        Longest { instructions, path: search.path(), unknown: search.unknown }
    }
}

struct Search<'m> {
    measures: &'m Measures,
    makes: &'m dyn Fn(usize, &Callee) -> bool,
    /// For each function: its number, and the call in it that is the longest.
    done: FxHashMap<usize, (u64, Option<(Callee, u64)>)>,
    unknown: BTreeSet<Unknown>,
}

impl Search<'_> {
    /// Routines do not call themselves, not even by others: so this ends.
    fn function(&mut self, at: usize) -> (u64, Option<(Callee, u64)>) {
        if let Some(known) = self.done.get(&at) {
            return known.clone();
        }
        let function = &self.measures.functions[at];
        let found = match &function.counted {
            Ok(counted) => {
                let mut way = Way { search: self, at, counted, heads: FxHashMap::default(), deepest: None };
                let instructions = longest(&counted.nodes, &mut way);
                (instructions, way.deepest)
            }
            Err(gap) => {
                self.unknown.insert(Unknown::Code(function.name.clone(), *gap));
                (0, None)
            }
        };
        self.done.insert(at, found.clone());
        found
    }

    fn outside(&mut self, symbol: &str, size: Option<u64>) -> u64 {
        let known = instructions_outside(symbol, size);
        if known.is_none() {
            self.unknown.insert(Unknown::Call(symbol.to_owned()));
        }
        known.unwrap_or(0)
    }

    fn path(&self) -> Vec<(String, u64)> {
        let (mut path, mut next) = (Vec::new(), Some((Callee::Function(self.measures.scan), 0)));
        while let Some((callee, instructions)) = next {
            next = match callee {
                Callee::Function(at) => {
                    let (instructions, deepest) = self.done.get(&at).cloned().unwrap_or_default();
                    path.push((self.measures.functions[at].name.clone(), instructions));
                    deepest
                }
                Callee::Outside(symbol) => {
                    path.push((symbol, instructions));
                    None
                }
            };
        }
        path
    }
}

/// The way through one function.
struct Way<'w, 'm> {
    search: &'w mut Search<'m>,
    at: usize,
    counted: &'w Counted<Callee>,
    /// The start of the loop that each mark is of.
    heads: FxHashMap<u32, usize>,
    deepest: Option<(Callee, u64)>,
}

impl Way<'_, '_> {
    fn unknown_loop(&mut self) -> u64 {
        let name = self.search.measures.functions[self.at].name.clone();
        self.search.unknown.insert(Unknown::Code(name, Gap::Loop));
        0
    }

    /// Loops that share their start are repeated as often as all of them together.
    fn all(&mut self, head: usize, marks: impl Iterator<Item = (u32, Repeats)>) -> u64 {
        let mut all = 1_u64;
        for (number, repeats) in marks {
            if *self.heads.entry(number).or_insert(head) != head {
                return self.unknown_loop();
            }
            match repeats.most {
                Some(most) => all = all.saturating_mul(most.saturating_add(1)),
                None => _ = self.search.unknown.insert(Unknown::Loop { at: repeats.at, why: repeats.why }),
            }
        }
        all - 1
    }
}

impl Costs<Call<Callee>> for Way<'_, '_> {
    fn call(&mut self, call: &Call<Callee>) -> Option<u64> {
        if !(self.search.makes)(self.at, &call.callee) {
            return None;
        }
        let instructions = match &call.callee {
            Callee::Function(it) => self.search.function(*it).0,
            Callee::Outside(symbol) => self.search.outside(symbol, call.size),
        };
        if self.deepest.as_ref().is_none_or(|it| it.1 < instructions) {
            self.deepest = Some((call.callee.clone(), instructions));
        }
        Some(instructions)
    }

    fn repeats(&mut self, head: usize, from: &[usize]) -> u64 {
        if let Some(pages) = self.counted.probes(from) {
            return pages;
        }
        match self.counted.repeats(from) {
            Some(marks) => self.all(head, marks.into_iter()),
            None => self.unknown_loop(),
        }
    }

    fn tangled(&mut self) {
        self.unknown_loop();
    }
}
