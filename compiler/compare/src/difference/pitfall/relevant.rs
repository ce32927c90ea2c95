//! What the differences at the end depend on.

use crate::pair::{Matched, Pair, Row};
use crate::program::apart::Declared;
use crate::program::dependency::Dependencies;
use std::collections::HashSet;

/// What the differences at the end depend on.
pub struct Relevant {
    pub dependencies: Dependencies,
    differences: HashSet<Declared>,
    pub found: Vec<Matched>,
}

impl Relevant {
    pub fn of(pair: &Pair, differences: &[Matched]) -> Self {
        let declared = differences.iter().filter_map(|it| pair.declared(0, *it)).collect();
        Self {
            dependencies: Dependencies::of(&pair.sides[0].program),
            differences: declared,
            found: differences.to_vec(),
        }
    }

    /// Whether a variable decides them, without going through others. A fault may follow from anything.
    pub fn has(&self, declared: Option<Declared>, others: &HashSet<Declared>) -> bool {
        let decides = |it| !self.dependencies.follow_past(it, others).is_disjoint(&self.differences);
        self.differences.is_empty() || declared.is_none_or(decides)
    }

    /// Whether what decides them differs in a row.
    pub fn differs(&self, pair: &Pair, row: &Row) -> bool {
        let mut differing = pair.compared.iter().filter(|it| !pair.same(**it, row));
        differing.any(|it| self.has(pair.declared(0, *it), &HashSet::new()))
    }
}
