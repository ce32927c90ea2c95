//! What is no longer compared once accepted findings have been seen, and what of the states then decides nothing.

use super::scan::Matched;
use std::collections::HashSet;
use std::ops::Range;

/// Which accepted findings have been seen since the start, a bit each.
pub type Passed = Vec<u64>;

#[derive(Debug, Default)]
pub struct Passing {
    /// Whether a fault on one side is accepted.
    pub faults: [bool; 2],
    /// For each bit, what is compared and may follow from it.
    pub cones: Vec<HashSet<Matched>>,
    /// And what may follow from it, and is compared still: outputs that no line accepts.
    pub kept: Vec<HashSet<Matched>>,
    /// And the bytes of both states that do, which then decide nothing else.
    pub bytes: Vec<[Vec<Range<usize>>; 2]>,
    /// Neither program can fault, so that nothing is left where all that is compared is passed over.
    pub is_faultless: bool,
}

impl Passing {
    pub fn accepts_fault(&self, side: usize) -> bool {
        self.faults[side]
    }

    /// Whether this is compared still.
    pub fn remains(&self, matched: Matched, passed: &Passed) -> bool {
        !self.cones.iter().enumerate().any(|(bit, cone)| is_set(passed, bit) && cone.contains(&matched))
    }

    /// Whether this is an output that may follow from what was passed over, and is compared still.
    pub fn keeps(&self, matched: Matched, passed: &Passed) -> bool {
        self.kept.iter().enumerate().any(|(bit, kept)| is_set(passed, bit) && kept.contains(&matched))
    }

    /// Bytes of a side's state that decide nothing but what is passed over.
    pub fn idle_bytes(&self, side: usize, passed: &Passed) -> Vec<Range<usize>> {
        if !self.is_faultless {
            return Vec::new();
        }
        let set = self.bytes.iter().enumerate().filter(|it| is_set(passed, it.0));
        set.flat_map(|it| it.1[side].iter().cloned()).collect()
    }
}

fn is_set(passed: &Passed, bit: usize) -> bool {
    passed.get(bit / 64).is_some_and(|it| it >> (bit % 64) & 1 == 1)
}
