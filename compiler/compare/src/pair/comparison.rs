//! What of two states is compared, and whether it is the same.

use super::scan::Matched;
use super::side::Side;
use crate::program::held;
use staunch_ir::Type;

/// Bytes whose equality is that of values; and scalars that the two sides hold in different types.
#[derive(Debug, Default)]
pub struct Comparison {
    pub runs: Vec<Run>,
    pub singles: Vec<Matched>,
}

/// Scalars that lie one after the other on both sides.
#[derive(Debug)]
pub struct Run {
    offsets: [usize; 2],
    length: usize,
    pub scalars: Vec<Matched>,
    /// Other bytes are other values.
    is_exact: bool,
}

/// A run is no longer, so that what differs is found near it.
const MAX_RUN: usize = 512;

impl Comparison {
    /// Bytes with the same layout on both sides are compared at once.
    pub fn of(sides: &[Side; 2], matched: &[Matched]) -> Self {
        let mut found = Self::default();
        for [a, b] in matched.iter().copied() {
            let (x, y) = (&sides[0].scalars.all[a], &sides[1].scalars.all[b]);
            let (offsets, size) = ([x.offset, y.offset], x.size);
            let reprs = [sides[0].program.repr(x.ty), sides[1].program.repr(y.ty)];
            let is_reference = matches!(x.ty, Type::Reference(_)) || x.is_shared || y.is_shared;
            if reprs[0] != reprs[1] || size != y.size || is_reference {
                found.singles.push([a, b]);
                continue;
            }
            // Bytes after the end of a string are not part of its value.
            let is_exact = reprs[0].is_some();
            match found.runs.last_mut() {
                Some(Run { offsets: start, length, scalars, is_exact: exact })
                    if [start[0] + *length, start[1] + *length] == offsets && *length < MAX_RUN =>
                {
                    *length += size;
                    scalars.push([a, b]);
                    *exact &= is_exact;
                }
                _ => found.runs.push(Run { offsets, length: size, scalars: vec![[a, b]], is_exact }),
            }
        }
        found
    }

    pub fn is_same(&self, sides: &[Side; 2], states: [&[u8]; 2]) -> bool {
        let same =
            |it: &Run| it.is_same(states) || !it.is_exact && it.scalars.iter().all(|it| equal(sides, *it, states));
        self.runs.iter().all(same) && self.singles.iter().all(|it| equal(sides, *it, states))
    }
}

impl Run {
    pub fn is_same(&self, states: [&[u8]; 2]) -> bool {
        let of = |side: usize| &states[side][self.offsets[side]..self.offsets[side] + self.length];
        of(0) == of(1)
    }
}

/// Whether two scalars of one meaning have one value.
pub fn equal(sides: &[Side; 2], [a, b]: Matched, states: [&[u8]; 2]) -> bool {
    let programs = [&sides[0].program, &sides[1].program];
    let all = [&sides[0].scalars, &sides[1].scalars];
    held::equal(programs, all, [&all[0].all[a], &all[1].all[b]], states)
}
