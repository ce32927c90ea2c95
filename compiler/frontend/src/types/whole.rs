//! What holds of the whole program and matters in each of its bodies, but is known only when all are checked. Then the
//! program is checked again with it: mostly that is not needed.

use super::declarations::Declarations;
use super::in_outs::InOut;
use crate::Span;
use rustc_hash::FxHashSet;
use staunch_ir::Reach;

#[derive(Clone, Debug, Default)]
pub(crate) struct Whole {
    /// The VAR_IN_OUTs that are given instances of what extends their classes.
    pub in_outs: FxHashSet<InOut>,
    pub reach: Reach,
    /// The classes to whose instances something refers, where that decides what calls what.
    pub referred: Option<FxHashSet<usize>>,
    /// The names of PROGRAMs that run by themselves, and that bodies name: they have one instance, among the globals.
    pub shared: FxHashSet<Span>,
}

impl Whole {
    /// Takes over what a check of the program has found; whether that is more than it was checked with.
    pub fn grow(&mut self, found: Self) -> bool {
        let before = (self.in_outs.len(), self.shared.len(), self.reach);
        self.in_outs.extend(found.in_outs);
        self.shared.extend(found.shared);
        self.reach.references |= found.reach.references;
        self.reach.copies |= found.reach.copies;
        let referred = found.referred.unwrap_or_default();
        let is_known = |all: &FxHashSet<usize>| referred.is_subset(all);
        let is_more = !self.referred.as_ref().is_none_or(is_known);
        if let Some(all) = &mut self.referred {
            all.extend(referred);
        }
        is_more || before != (self.in_outs.len(), self.shared.len(), self.reach)
    }
}

impl Declarations<'_> {
    /// What the bodies that were checked say of the whole program.
    pub fn whole(&self) -> Whole {
        let reach = Reach { references: !self.program.references.is_empty(), copies: self.table.copies.get() };
        let (in_outs, referred) = (self.polymorphic(), Some(self.table.interfaces.referred.clone()));
        Whole { in_outs, reach, referred, shared: FxHashSet::default() }
    }
}
