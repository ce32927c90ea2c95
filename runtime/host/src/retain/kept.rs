//! The parts of a state that are kept, as one row of bytes. What compiled code leaves in bytes of no variable, between
//! the members of a structure or after the text of a string, is its own: there the row has zeros.

use crate::domain::Domain;
use std::ops::Range;

#[derive(Debug, Default)]
pub(super) struct Kept {
    /// Bytes of variables, in the state and in the row.
    parts: Vec<(Range<usize>, usize)>,
    size: usize,
}

impl Kept {
    pub fn new(regions: impl Iterator<Item = Range<usize>>, domain: &Domain) -> Self {
        let mut kept = Self::default();
        for region in regions {
            let start = kept.size;
            domain.values(&region, &mut |value| {
                let at = start + value.start - region.start;
                kept.add(value, at);
            });
            kept.size += region.len();
        }
        kept
    }

    fn add(&mut self, value: Range<usize>, at: usize) {
        match self.parts.last_mut() {
            Some((part, to)) if part.end == value.start && *to + part.len() == at => part.end = value.end,
            _ => self.parts.push((value, at)),
        }
    }

    /// Regions in which all bytes are of variables.
    #[cfg(test)]
    pub fn whole(regions: &[Range<usize>]) -> Self {
        let mut kept = Self::default();
        for region in regions {
            kept.add(region.clone(), kept.size);
            kept.size += region.len();
        }
        kept
    }

    pub fn of(&self, state: &[u8]) -> Vec<u8> {
        let mut row = vec![0; self.size];
        self.copy_changed(state, &mut row);
        row
    }

    /// Copies what is other in the state than in the row; FALSE if nothing is.
    pub fn copy_changed(&self, state: &[u8], row: &mut [u8]) -> bool {
        let mut changed = false;
        for (part, to) in &self.parts {
            let (from, to) = (&state[part.clone()], &mut row[*to..*to + part.len()]);
            if from != to {
                to.copy_from_slice(from);
                changed = true;
            }
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::map;

    #[test]
    fn bytes_of_no_variable_are_zero_and_no_change() {
        let (map, all) = (map(), 0..map().size);
        let domain = Domain::of(&map);
        let kept = Kept::new(std::iter::once(all.clone()), &domain);
        let mut belongs = vec![false; map.size];
        domain.values(&all, &mut |it| belongs[it].fill(true));
        assert!(belongs.iter().any(|it| *it) && belongs.iter().any(|it| !*it), "{belongs:?}");
        let mut row = kept.of(&vec![0xFF; map.size]);
        let expected: Vec<u8> = belongs.iter().map(|it| if *it { 0xFF } else { 0 }).collect();
        assert_eq!(row, expected);
        let other: Vec<u8> = belongs.iter().map(|it| if *it { 0xFF } else { 7 }).collect();
        assert!(!kept.copy_changed(&other, &mut row));
        assert_eq!(row, expected);
        assert!(kept.copy_changed(&vec![1; map.size], &mut row));
    }

    #[test]
    fn regions_follow_one_another() {
        let domain = Domain::of(&map());
        let first = (0..map().size).find(|at| domain.is_value(*at)).unwrap_or(0);
        let kept = Kept::new([first..first + 1, first..first + 1].into_iter(), &domain);
        let mut state = vec![0; map().size];
        state[first] = 5;
        assert_eq!(kept.of(&state), [5, 5]);
    }
}
