//! FUNCTIONs, and METHODs of one class, that have the same name and differ in their parameters.

use rustc_hash::FxHashMap;
use std::rc::Rc;

#[derive(Debug, Default)]
pub(crate) struct Overloads {
    /// By the slot of the first one, which the name leads to: the slots of all.
    pub sets: FxHashMap<usize, Vec<usize>>,
    /// What back ends call each.
    pub names: FxHashMap<usize, String>,
}

impl Overloads {
    /// The FUNCTIONs or METHODs that the name of the one in a slot means, where there are others.
    pub fn of(&self, slot: usize) -> Option<Rc<[usize]>> {
        self.sets.get(&slot).map(|it| Rc::from(it.as_slice()))
    }
}
