//! Names found by a table that is made when the compiler is compiled.

/// For each first and last letter of a name, the lengths of such names, each a bit: most words of a program are passed
/// over by these.
pub(super) type Lengths = [u64; 1024];

/// Numbers of names, from 1, by the name's hash; 0 is a free place.
pub(super) type Numbers = [u16; PLACES];
pub(super) const PLACES: usize = 8192;

/// A longer name is not one.
pub(super) const LONGEST: usize = 63;

/// Adds the name that is in `text` from `start` to `end`. Names with a point are found by their numbers alone.
pub(super) const fn with_name(lengths: &mut Lengths, text: &[u8], start: usize, end: usize) {
    let mut at = start;
    while at < end {
        if text[at] == b'.' {
            return;
        }
        at += 1;
    }
    assert!(end - start <= LONGEST, "a name is too long");
    lengths[place(text[start], text[end - 1])] |= 1 << (end - start);
}

/// Adds a name's number.
pub(super) const fn with_number(numbers: &mut Numbers, text: &[u8], start: usize, end: usize, number: u16) {
    let mut place = hash(text, start, end);
    while numbers[place] != 0 {
        place = (place + 1) % PLACES;
    }
    numbers[place] = number;
}

/// The places of numbers where that of a name may be.
pub(super) fn places(name: &str) -> impl Iterator<Item = usize> {
    let first = hash(name.as_bytes(), 0, name.len());
    (0..PLACES).map(move |it| (first + it) % PLACES)
}

/// Whether a name may be known that begins and ends with these letters.
pub(super) fn may_be(lengths: &Lengths, first: u8, last: u8, length: usize) -> bool {
    length <= LONGEST && lengths[place(first, last)] & (1 << length) != 0
}

const fn place(first: u8, last: u8) -> usize {
    (first & 31) as usize * 32 + (last & 31) as usize
}

/// FNV-1a, of capitals.
const fn hash(text: &[u8], start: usize, end: usize) -> usize {
    let (mut hash, mut at) = (0x811c_9dc5_u32, start);
    while at < end {
        hash = (hash ^ text[at].to_ascii_uppercase() as u32).wrapping_mul(0x0100_0193);
        at += 1;
    }
    (hash ^ (hash >> 15)) as usize % PLACES
}
