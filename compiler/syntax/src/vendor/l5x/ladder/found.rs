//! Rungs among statements of Structured Text.

use super::parse::{self, Element};
use super::rows::{ANY, row_of};

/// Calls that Structured Text has in the form that rungs have.
const CALLS: [&str; 3] = ["COP", "CPS", "SIZE"];

/// Whether a text begins as a rung may: with a branch, or an instruction.
pub fn starts_as_rung(text: &str) -> bool {
    if text.starts_with('[') {
        return true;
    }
    let length = text.find(|it: char| !it.is_ascii_alphanumeric() && it != '_').unwrap_or(text.len());
    text[length..].trim_start().starts_with('(') && row_of(&text[..length]).is_some()
}

/// Whether a statement is a rung, and whether it can be nothing else; `None` where it is none. One with a test is, whatever else
/// is wrong with it.
pub fn is_rung(statement: &str) -> Option<bool> {
    let Ok(path) = parse::rung(statement) else {
        let is_test = ["XIC", "XIO", "["].iter().any(|it| statement.starts_with(it));
        return is_test.then_some(true);
    };
    match path.as_slice() {
        [] => None,
        [Element::Instruction(it)] => {
            let name = &statement[it.name.clone()];
            let row = row_of(name).filter(|it| !CALLS.contains(&it.names[0]))?;
            let is_test = ["XIC", "XIO"].iter().any(|it| name.eq_ignore_ascii_case(it));
            let is_whole = row.operands == ANY || row.operands.len() == it.operands.len();
            (is_whole || is_test).then_some(false)
        }
        _ => Some(true),
    }
}
