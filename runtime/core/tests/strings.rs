//! String functions at the edges of their positions, counts and capacities.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use staunch_runtime::Text;
use staunch_runtime::text::*;

/// What a function writes, with room for everything.
fn built(write: impl FnOnce(&mut Destination<'_>)) -> String {
    Text::<80>::build(write).to_string()
}

const EDGES: [i64; 6] = [i64::MIN, -1, 0, 2, 4, i64::MAX];

#[test]
fn counts_and_positions_are_clamped() {
    assert_eq!(EDGES.map(|n| built(|out| left(b"ABC", n, out))), ["", "", "", "AB", "ABC", "ABC"]);
    assert_eq!(EDGES.map(|n| built(|out| right(b"ABC", n, out))), ["", "", "", "BC", "ABC", "ABC"]);
    assert_eq!(EDGES.map(|n| built(|out| mid(b"ABC", n, 2, out))), ["", "", "", "BC", "BC", "BC"]);
    assert_eq!(EDGES.map(|at| built(|out| mid(b"ABC", 1, at, out))), ["A", "A", "A", "B", "", ""]);
    assert_eq!(
        EDGES.map(|at| built(|out| insert(b"ABC", b"x", at, out))),
        ["xABC", "xABC", "xABC", "ABxC", "ABCx", "ABCx"]
    );
    assert_eq!(EDGES.map(|at| built(|out| delete(b"ABC", 1, at, out))), ["BC", "BC", "BC", "AC", "ABC", "ABC"]);
    assert_eq!(
        EDGES.map(|n| built(|out| replace(b"ABC", b"x", n, 2, out))),
        ["AxBC", "AxBC", "AxBC", "Ax", "Ax", "Ax"]
    );
    assert_eq!(built(|out| concat(b"AB", b"", out)), "AB");
}

#[test]
fn text_that_does_not_fit_is_cut() {
    let text = Text::<3>::new(b"ABCDE");
    assert_eq!(text.as_bytes(), b"ABC");
    assert_eq!(Text::<2>::from_text(&text).as_bytes(), b"AB");
    assert_eq!(Text::<4>::build(|out| concat(b"ABC", b"DEF", out)).as_bytes(), b"ABCD");
    assert_eq!(Text::<0>::new(b"A").as_bytes(), b"");
}

#[test]
fn equal_strings_are_equal_in_memory() {
    let mut text = Text::<5>::new(b"ABCDE");
    text.assign(b"A");
    assert_eq!(text, Text::new(b"A"));
    assert_eq!(size_of::<Text<80>>(), 82);
    assert_eq!(size_of::<Text<3>>(), 6);
}

#[test]
fn strings_are_ordered_and_searched_by_bytes() {
    assert_eq!([compare(b"", b""), compare(b"a", b"B"), compare(b"a", b"aa")], [0, 1, -1]);
    assert_eq!([find(b"ABAB", b"B"), find(b"AB", b"ABC"), find(b"", b"")], [2, 0, 0]);
    assert_eq!([len(b""), len(b"AB"), len(&[0_u8; 65535])], [0, 2, i16::MAX]);
}

#[test]
fn what_is_not_utf_8_still_shows() {
    assert_eq!(Text::<4>::new(b"a\xFFb").to_string(), "a\u{FFFD}b");
    assert_eq!(format!("{:?}", Text::<4>::new(b"a'\n")), r"'a\'\n'");
}
