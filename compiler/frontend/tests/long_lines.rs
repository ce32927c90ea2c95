//! Declarations on a line that is longer than a place has columns.
#![allow(clippy::unwrap_used)]

use staunch_frontend::{Code, Diagnostic, Options, Severity, Source, Sources, check};

/// The errors of two FUNCTIONs that are implemented outside, after so many spaces on their line.
fn reported(spaces: usize, declarations: &str) -> Vec<Diagnostic> {
    let program = "PROGRAM Main VAR n : INT; END_VAR n := F1(1) + F2(2); END_PROGRAM";
    let mut sources = Sources::default();
    sources.add(Source::new("long.st", format!("{}{declarations}\n{program}\n", " ".repeat(spaces))));
    check(&sources, &Options::default()).into_iter().filter(|it| it.severity == Severity::Error).collect()
}

const FIRST: &str = "{external} FUNCTION F1 : INT VAR_INPUT n : INT; END_VAR END_FUNCTION";
const SECOND: &str = "{external} FUNCTION F2 : INT VAR_INPUT n : INT; END_VAR END_FUNCTION";

/// Back ends find these by their places. What a program declares for itself is found by its number: `tests/suite/long_lines.rs`.
#[test]
fn two_external_functions_beyond_the_last_column_are_refused() {
    let declarations = format!("{FIRST} {SECOND}");
    assert!(reported(10, &declarations).is_empty(), "{:?}", reported(10, &declarations));
    let found = reported(65_535, &declarations);
    let [one] = found.as_slice() else { panic!("one error expected: {found:?}") };
    assert_eq!(one.code, Code::E0902);
    assert!(one.message.to_string().contains("65534"), "{}", one.message);
    assert!(reported(65_535, &format!("{FIRST}\n{SECOND}")).is_empty(), "each on its own line");
}
