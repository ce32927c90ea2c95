//! Readers of bytes that come from outside, as fuzzers call them (tests/fuzz): compiled for them only.

use crate::map::Map;
use crate::stimulus::Stimulus;
use crate::{attachments, csv, retain};

/// A program with a variable of each kind.
const MAP: &str = "map\t1\nmachine\t64\t8\nenum\t0\tE\ti16\ta=0\tb=5\narray\t0\t1\t4\tINT\t2\narray\t1\t0\t1\tBOOL\t1
struct\t1\tGlobals\t64\tglobals
field\tb\tBOOL\t0\tglobal\t-\t%IX0.1\t-
field\tc\tarray:1\t1\tglobal\tretain\t%QX1.0\t-
field\td\tINT\t4\tglobal\t-\t%IW3\t-
field\te\tarray:0\t6\tglobal\tretain\t%QW5\t-
field\tf\tINT\t14\tglobal\t-\t%MW0\t-
field\tg\tDINT\t16\tglobal\tretain\t%MD1\t-
field\th\tLINT\t24\tglobal\t-\t%ML2\t-
field\ti\tenum:0\t32\tglobal\t-\t-\t-
field\tj\tSTRING[4]\t34\tglobal\tretain\t-\t-
field\tk\tREAL\t40\tglobal\t-\t-\t-
field\tl\tTIME\t48\tglobal\t-\t-\t-
field\tm\tINT\t56\tglobal\t-\t-\t0..10
globals\tstruct:1\t0
";

fn map() -> Map {
    Map::parse(MAP).expect("the map is right")
}

/// A stimulus is read, or refused with a place.
pub fn stimulus(bytes: &[u8]) {
    let text = csv::decoded(bytes);
    if let Err(error) = Stimulus::parse("stimulus.csv".as_ref(), &text, &map(), &[]) {
        assert!(!error.to_string().is_empty());
    }
}

/// What is recovered of a file of retained variables.
pub fn retained(bytes: &[u8]) {
    retain::recovered(bytes);
}

/// Each request has an answer of its function.
pub fn requests(bytes: &[u8]) {
    attachments::answered(&map(), bytes);
}
