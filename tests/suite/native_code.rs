//! What passes of the native back end are for: no more instructions than they leave, in the longest way through a scan on
//! x86-64. A pass that does nothing any more leaves many more.

use staunch_frontend::{Options, Source, Sources};
use staunch_native::{Longest, Target, measures};

fn longest(text: &str) -> Longest {
    let mut sources = Sources::default();
    sources.add(Source::new("main.st", text.to_owned()));
    let compiled = staunch_frontend::compile(&sources, &Options::default());
    let program = compiled.program.unwrap_or_else(|| panic!("{:?}", compiled.diagnostics.first()));
    let target = Target::parse("x86_64-unknown-linux-gnu").unwrap();
    measures(&program, &target).unwrap().longest_scan(&|_, _| true)
}

fn takes_at_most(most: u64, text: &str) {
    let longest = longest(text);
    assert!(longest.unknown.is_empty(), "{longest:?}");
    assert!(longest.instructions <= most, "{} instructions for\n{text}", longest.instructions);
}

/// Three instructions a turn: a load, a product with an operand in memory, and a sum; and no value is kept in the frame.
#[test]
fn operands_are_in_memory() {
    takes_at_most(
        80,
        "PROGRAM Main VAR a, b : ARRAY[0..15] OF LREAL; i : INT; s : LREAL; END_VAR
        s := 0.0; FOR i := 0 TO 15 DO s := s + a[i] * b[i]; END_FOR END_PROGRAM",
    );
}

/// A result that is used twice is computed once, of an operand in memory, and a constant is an operand too.
#[test]
fn shared_results_have_operands_in_memory() {
    takes_at_most(20, "PROGRAM Main VAR a, b, c, x, y : LREAL; END_VAR x := 0.3 * a + b * c; y := x * x; END_PROGRAM");
}

#[test]
fn loops_that_fill_and_copy_are_one_operation() {
    takes_at_most(
        1024 + 256 + 300,
        "PROGRAM Main VAR a, b : ARRAY[0..255] OF DINT; c : ARRAY[0..255] OF BOOL; i : INT; END_VAR
        FOR i := 0 TO 254 DO a[i] := b[i + 1]; END_FOR FOR i := 255 TO 0 BY -1 DO c[i] := TRUE; END_FOR END_PROGRAM",
    );
    takes_at_most(
        20,
        "PROGRAM Main VAR a : ARRAY[0..7] OF BYTE; i : INT; END_VAR FOR i := 0 TO 7 DO a[i] := 16#55; END_FOR END_PROGRAM",
    );
}

/// Eight turns are one look-up.
#[test]
fn a_byte_of_a_checksum_is_looked_up() {
    takes_at_most(
        30,
        "PROGRAM Main VAR crc : WORD; k : INT; END_VAR
        FOR k := 1 TO 8 DO IF crc.15 THEN crc := SHL(crc, 1) XOR 16#1021; ELSE crc := SHL(crc, 1); END_IF END_FOR END_PROGRAM",
    );
}
