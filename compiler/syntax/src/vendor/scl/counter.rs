//! The types of the counters of S7, and the blocks that they are.

use rustc_hash::FxHashMap;

/// Data of a counter, which does not say which one it is of, and the suffix of a counter of its numbers.
const DATA: [(&str, &str); 8] = [
    ("IEC_COUNTER", ""),
    ("IEC_SCOUNTER", "_SINT"),
    ("IEC_DCOUNTER", "_DINT"),
    ("IEC_LCOUNTER", "_LINT"),
    ("IEC_UCOUNTER", "_UINT"),
    ("IEC_USCOUNTER", "_USINT"),
    ("IEC_UDCOUNTER", "_UDINT"),
    ("IEC_ULCOUNTER", "_ULINT"),
];

pub const INSTRUCTIONS: [&str; 3] = ["CTUD", "CTU", "CTD"];

/// What is known of the calls of a counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Called {
    /// None in this file.
    Nowhere,
    /// All name this instruction.
    As(&'static str),
    /// They name several.
    Otherwise,
}

/// Names of counters in lower case.
pub type Counters = FxHashMap<String, Called>;

/// Whether a type, in capitals, is one of the system's counters.
pub fn is_one(ty: &str) -> bool {
    DATA.iter().any(|it| it.0 == ty) || instruction(ty).is_some()
}

/// The counter, and what follows its name: `_INT`.
pub fn instruction(ty: &str) -> Option<(&'static str, &str)> {
    let named = |name: &'static str| Some((name, ty.strip_prefix(name)?));
    let numbers = |it: &str| it == "_INT" || DATA.iter().any(|row| row.1 == it);
    INSTRUCTIONS.into_iter().find_map(named).filter(|it| numbers(it.1))
}

/// The block that a counter is: its data where calls do not say which one. A counter of INTs has the bare name, which other
/// systems have as well.
pub fn block(ty: &str, called: Called) -> String {
    let upper = ty.to_ascii_uppercase();
    let data = DATA.iter().find(|it| it.0 == upper);
    match (instruction(&upper), data, called) {
        (Some((counter, "_INT")), ..) => counter.to_owned(),
        (None, Some((_, numbers)), Called::As(counter)) => format!("{counter}{numbers}"),
        _ => upper,
    }
}
