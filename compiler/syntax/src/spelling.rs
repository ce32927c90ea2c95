//! Names compare without regard to ASCII case, and near misses are suggested.

use std::hash::{Hash, Hasher};

/// A name as a table key.
#[derive(Clone, Copy, Debug)]
pub struct Key<'s>(pub &'s str);

impl PartialEq for Key<'_> {
    fn eq(&self, other: &Self) -> bool {
        // Mostly a name is spelled as it was declared.
        self.0 == other.0 || self.0.eq_ignore_ascii_case(other.0)
    }
}

impl Eq for Key<'_> {}

impl Hash for Key<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        // Without the bit in which upper and lower case differ. That makes some other characters
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
pub fn nearest<'c>(name: &str, candidates: impl Iterator<Item = &'c str>) -> Option<&'c str> {
    let limit = match name.chars().count() {
        // Of two letters, one edit makes another name.
        0..=2 => 0,
        3..=4 => 1,
        5..=7 => 2,
        _ => 3,
    };
    let name = name.to_ascii_lowercase();
    let letters = letters_of(&name);
    let distance = |candidate: &str| {
        let lower = candidate.to_ascii_lowercase();
        // An edit adds a letter, takes one away, or does both.
        let apart = (letters ^ letters_of(&lower)).count_ones();
        let is_far = usize::try_from(apart).is_ok_and(|it| it > 2 * limit);
        if is_far { usize::MAX } else { strsim::osa_distance(&name, &lower) }
    };
    candidates
        .map(|candidate| (distance(candidate), candidate))
        .filter(|(distance, candidate)| *distance <= limit && *distance < candidate.chars().count())
        // The first letter is rarely the wrong one.
        .min_by_key(|(distance, candidate)| (*distance, !begin_alike(&name, candidate), *candidate))
        .map(|(_, candidate)| candidate)
}

/// Whether a word is some of the letters of another one, in their order and from the first on: `PRG` of `PROGRAM`.
pub fn abbreviates(word: &str, whole: &str) -> bool {
    let mut letters = whole.chars();
    word.chars().next() == whole.chars().next() && word.chars().all(|it| letters.any(|of| of == it))
}

fn begin_alike(a: &str, b: &str) -> bool {
    let first = |it: &str| it.chars().next().map(|it| it.to_ascii_lowercase());
    first(a) == first(b)
}

/// The letters that a name has, as a set of 64: it usually shows that two names are very different.
fn letters_of(name: &str) -> u64 {
    name.chars().fold(0, |set, letter| set | 1 << (u32::from(letter) % 64))
}

/// Whether what follows a `#` is a word of C's preprocessor.
pub fn is_preprocessor(rest: &str) -> bool {
    let word = rest.split(|it: char| !it.is_ascii_alphabetic()).next().unwrap_or_default();
    let follows = rest[word.len()..].starts_with([' ', '\t', '\r', '\n']);
    follows && ["include", "define", "undef", "ifdef", "ifndef", "endif", "pragma"].contains(&word)
}
