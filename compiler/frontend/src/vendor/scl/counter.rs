//! The counters of S7, and what a family has in their place.

use rustc_hash::FxHashMap;
use staunch_runtime::{BLOCKS, Family};

/// Data of a counter, which does not say which one it is of, and the suffix of a counter of its numbers.
const DATA: [(&str, &str); 8] = [
    ("IEC_COUNTER", ""),
    ("IEC_SCOUNTER", ""),
    ("IEC_DCOUNTER", "_DINT"),
    ("IEC_LCOUNTER", "_LINT"),
    ("IEC_UCOUNTER", ""),
    ("IEC_USCOUNTER", ""),
    ("IEC_UDCOUNTER", "_UDINT"),
    ("IEC_ULCOUNTER", "_ULINT"),
];

pub const INSTRUCTIONS: [&str; 3] = ["CTUD", "CTU", "CTD"];

/// Names of counters in lower case, and the instruction that a call of each names.
pub type Counters = FxHashMap<String, Option<&'static str>>;

/// Whether a type, in capitals, is one of the system's counters.
pub fn is_one(ty: &str) -> bool {
    DATA.iter().any(|it| it.0 == ty) || instruction(ty).is_some()
}

/// The counter, and what follows its name: `_INT`.
fn instruction(ty: &str) -> Option<(&'static str, &str)> {
    let named = |name: &'static str| Some((name, ty.strip_prefix(name)?));
    INSTRUCTIONS.into_iter().find_map(named).filter(|it| it.1.is_empty() || it.1.starts_with('_'))
}

/// What the standard's family has in place of a counter with the numbers of a type, `CTD_INT`.
fn with_numbers(name: &str, numbers: &str) -> String {
    let full = format!("{name}{numbers}");
    let has = BLOCKS.iter().any(|it| it.family == Family::Iec && it.is_named(&full));
    format!("IEC.{}", if has { full.as_str() } else { name })
}

/// What the standard's family has in place of a counter's type; `called` is the instruction that a call of it names.
pub fn of_the_standard(ty: &str, called: Option<&str>) -> String {
    let upper = ty.to_ascii_uppercase();
    match instruction(&upper) {
        Some((counter, numbers)) => with_numbers(counter, numbers),
        None => {
            let numbers = DATA.iter().find(|it| it.0 == upper).map_or("", |it| it.1);
            with_numbers(called.unwrap_or("CTUD"), numbers)
        }
    }
}
