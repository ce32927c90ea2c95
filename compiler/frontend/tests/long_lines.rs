//! Declarations on a line that is longer than a place has columns: none takes the other's value.
#![allow(clippy::unwrap_used)]

use staunch_frontend::{Code, Diagnostic, Options, Severity, Source, Sources, check};

/// The errors of two instances with arguments, after so many spaces on their line.
fn reported(spaces: usize, declarations: &str) -> Vec<Diagnostic> {
    let block = "FUNCTION_BLOCK F\nVAR_OUTPUT n : INT; END_VAR\nMETHOD FB_init : BOOL\nVAR_INPUT bInitRetains, \
                 bInCopyCode : BOOL; first : INT; END_VAR\nn := first;\nEND_METHOD\nEND_FUNCTION_BLOCK\n";
    let program = format!("PROGRAM Main VAR{}{declarations} END_VAR\nf1(); f2();\nEND_PROGRAM\n", " ".repeat(spaces));
    let mut sources = Sources::default();
    sources.add(Source::new("long.st", format!("{{dialect 'codesys'}}\n{block}{program}")));
    check(&sources, &Options::default()).into_iter().filter(|it| it.severity == Severity::Error).collect()
}

#[test]
fn two_declarations_beyond_the_last_column_are_refused() {
    let declarations = "f1 : F(1); f2 : F(2);";
    assert!(reported(10, declarations).is_empty(), "{:?}", reported(10, declarations));
    // One of them has the last column to itself.
    assert!(reported(65_518 - 11, declarations).is_empty());
    let found = reported(65_535, declarations);
    let [one] = found.as_slice() else { panic!("one error expected: {found:?}") };
    assert_eq!(one.code, Code::E0902);
    assert!(one.message.to_string().contains("65534"), "{}", one.message);
    assert!(reported(65_535, "f1 : F(1);\nf2 : F(2);").is_empty(), "each on its own line");
}
