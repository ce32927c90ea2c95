//! What is compared after accepted findings have been seen.

use super::comparison::Comparison;
use super::passing::{Passed, Passing};
use super::{Faults, Matched, Pair, Remaining, ends_both};

impl Pair {
    /// Whether anything differs that does not follow from accepted findings seen since the start; and whether
    /// nothing is left to compare.
    pub fn differs_beyond(&mut self, passing: &Passing, seen: &Passed, faults: Faults) -> (bool, bool) {
        self.passed.resize(self.passed.len().max(seen.len()), 0);
        self.passed.iter_mut().zip(seen).for_each(|(all, it)| *all |= it);
        if !self.remaining.contains_key(&self.passed) {
            let remaining = self.remaining_compared(passing);
            let comparison = Comparison::of(&self.sides, &remaining);
            let idle = [0, 1].map(|side| passing.idle_bytes(side, &self.passed));
            let known = Remaining { is_empty: remaining.is_empty(), comparison, idle };
            self.remaining.insert(self.passed.clone(), known);
        }
        let Remaining { is_empty, comparison, .. } = &self.remaining[&self.passed];
        if self.faults_differ(faults) {
            let accepted = (0..2).all(|side| faults[side].is_none() || passing.accepts_fault(side));
            return (!accepted, *is_empty);
        }
        (!ends_both(faults) && !self.all_equal(comparison), *is_empty && passing.is_faultless)
    }

    /// What is still compared after the accepted findings that have been seen.
    pub fn remaining_compared(&self, passing: &Passing) -> Vec<Matched> {
        self.compared.iter().copied().filter(|it| passing.remains(*it, &self.passed)).collect()
    }

    /// Of these, the outputs that may follow from accepted findings which have been seen.
    pub fn following(&self, passing: &Passing, found: &[Matched]) -> Vec<Matched> {
        found.iter().copied().filter(|it| passing.keeps(*it, &self.passed)).collect()
    }
}
