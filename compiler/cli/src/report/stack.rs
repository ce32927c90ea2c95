//! How deep the stack gets: the frames along the deepest path of calls.

use super::task::{Instance, Task};
use staunch_native::{Callee, Measures, stack_outside};
use std::collections::{BTreeSet, HashMap};

/// The stack of a scan, in bytes, from the call of `staunch_scan` on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Need {
    /// At least so much; exactly the bound where nothing is unknown.
    pub bytes: u64,
    /// The functions of the deepest path, from the outermost, with their own part.
    pub path: Vec<(String, u64)>,
    /// Functions outside of which nothing is known.
    pub unknown: BTreeSet<String>,
}

impl Need {
    /// The functions of which nothing is known, as a list.
    pub fn unknown_names(&self) -> String {
        self.unknown.iter().map(String::as_str).collect::<Vec<_>>().join(", ")
    }
}

/// Its instances run one after the other, and each gives the stack back.
pub fn of_task(task: &Task, measures: &Measures) -> Need {
    let needs: Vec<_> = task.instances.iter().map(|it| of_instance(it, measures)).collect();
    let unknown = needs.iter().flat_map(|it| it.unknown.iter().cloned()).collect();
    let deepest = needs.into_iter().max_by_key(|it| it.bytes).unwrap_or_default();
    Need { unknown, ..deepest }
}

fn of_instance(instance: &Instance, measures: &Measures) -> Need {
    let mut stacks = Stacks { measures, instance, done: HashMap::new(), unknown: BTreeSet::new() };
    let bytes = stacks.function(measures.scan);
    let path = stacks.path();
    Need { bytes, path, unknown: stacks.unknown }
}

struct Stacks<'m> {
    measures: &'m Measures,
    instance: &'m Instance,
    /// For each function that is done: the bytes, and the call that is the deepest.
    done: HashMap<usize, (u64, Option<Callee>)>,
    unknown: BTreeSet<String>,
}

impl Stacks<'_> {
    /// Routines do not call themselves, not even by others: so this ends.
    fn function(&mut self, at: usize) -> u64 {
        if let Some((known, _)) = self.done.get(&at) {
            return *known;
        }
        let (measures, instance) = (self.measures, self.instance);
        let mut deepest = (0, None);
        for callee in measures.functions[at].calls.iter().filter(|it| instance.makes(measures, at, it)) {
            let bytes = match callee {
                Callee::Function(it) => self.function(*it),
                Callee::Outside(symbol) => self.outside(symbol),
            };
            if bytes > deepest.0 {
                deepest = (bytes, Some(callee.clone()));
            }
        }
        let bytes = measures.functions[at].frame + deepest.0;
        self.done.insert(at, (bytes, deepest.1));
        bytes
    }

    fn outside(&mut self, symbol: &str) -> u64 {
        let known = stack_outside(symbol);
        if known.is_none() {
            self.unknown.insert(symbol.to_owned());
        }
        known.unwrap_or(0)
    }

    fn path(&self) -> Vec<(String, u64)> {
        let mut path = Vec::new();
        let mut next = Some(Callee::Function(self.measures.scan));
        while let Some(callee) = next {
            next = match &callee {
                Callee::Function(at) => {
                    let function = &self.measures.functions[*at];
                    path.push((function.name.clone(), function.frame));
                    self.done.get(at).and_then(|it| it.1.clone())
                }
                Callee::Outside(symbol) => {
                    path.push((symbol.clone(), stack_outside(symbol).unwrap_or(0)));
                    None
                }
            };
        }
        path
    }
}
