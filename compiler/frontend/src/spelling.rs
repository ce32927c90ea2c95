//! Names compare without regard to ASCII case, and near misses are suggested.

use std::hash::{Hash, Hasher};

/// A name as a table key.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key<'s>(pub &'s str);

impl PartialEq for Key<'_> {
    fn eq(&self, other: &Self) -> bool {
        // Mostly a name is spelled as it was declared.
        self.0 == other.0 || self.0.eq_ignore_ascii_case(other.0)
    }
}

impl Eq for Key<'_> {}

impl Hash for Key<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        // Without the bit that tells the cases of a letter apart. That makes some other characters
        // one, which costs a comparison and no more.
        let fold = |bytes: [u8; 8]| u64::from_le_bytes(bytes) & 0xdfdf_dfdf_dfdf_dfdf;
        let (words, rest) = self.0.as_bytes().as_chunks::<8>();
        words.iter().for_each(|word| state.write_u64(fold(*word)));
        let mut last = [0; 8];
        last[..rest.len()].copy_from_slice(rest);
        state.write_u64(fold(last));
    }
}

/// The candidate that `name` was probably meant to be.
pub(crate) fn nearest<'c>(name: &str, candidates: impl Iterator<Item = &'c str>) -> Option<&'c str> {
    let limit = match name.chars().count() {
        // Of two letters, one edit makes another name.
        0..=2 => 0,
        3..=4 => 1,
        5..=7 => 2,
        _ => 3,
    };
    let name = name.to_ascii_lowercase();
    candidates
        .map(|candidate| (distance(&name, &candidate.to_ascii_lowercase()), candidate))
        .filter(|(distance, candidate)| *distance <= limit && *distance < candidate.chars().count())
        .min()
        .map(|(_, candidate)| candidate)
}

/// Edits (insert, delete, replace, swap neighbours) from `a` to `b`.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    if a.len().abs_diff(b.len()) > 3 {
        return usize::MAX;
    }
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replace = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replace.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            row.push(best);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}
