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

/// A test of the program's number, two moves and an end.
#[test]
fn code_that_calls_nothing_has_no_frame() {
    takes_at_most(7, "PROGRAM Main VAR a, b : INT; END_VAR a := b; END_PROGRAM");
}

/// Two instructions an element.
#[test]
fn narrow_sums_leave_their_operands() {
    takes_at_most(
        45,
        "PROGRAM Main VAR s : USINT; d : ARRAY[0..15] OF USINT; i : INT; END_VAR
        FOR i := 0 TO 15 DO d[i] := s + INT_TO_USINT(i); END_FOR END_PROGRAM",
    );
}

/// Three instructions a turn: a copy, a shift, and a sum by its result.
#[test]
fn operands_that_are_not_needed_come_first() {
    takes_at_most(
        40,
        "PROGRAM Main VAR x : DWORD; i : INT; END_VAR FOR i := 0 TO 9 DO x := x XOR SHR(x, 1); END_FOR END_PROGRAM",
    );
}

#[test]
fn a_byte_of_data_takes_six_instructions_of_a_checksum() {
    takes_at_most(
        64 * 7 + 30,
        "PROGRAM Main VAR data : ARRAY[0..63] OF BYTE; crc : WORD; i, k : INT; END_VAR
        FOR i := 0 TO 63 DO
            crc := crc XOR BYTE_TO_WORD(data[i]);
            FOR k := 1 TO 8 DO IF crc.0 THEN crc := SHR(crc, 1) XOR 16#A001; ELSE crc := SHR(crc, 1); END_IF END_FOR
        END_FOR END_PROGRAM",
    );
}

/// Each bit of the word is stored once, and nothing is loaded again.
#[test]
fn what_is_stored_over_is_not_stored() {
    takes_at_most(22, "PROGRAM Main VAR w : WORD; a, b : BOOL; END_VAR w.0 := a; w.1 := b; w.2 := a; END_PROGRAM");
}

/// Of at most 256 turns, less than four instructions each.
#[test]
fn turns_whose_number_is_not_constant_are_in_groups() {
    takes_at_most(
        256 * 3,
        "PROGRAM Main VAR a : ARRAY[0..255] OF DINT; n, i : USINT; s : DINT; END_VAR
        s := 0; FOR i := 1 TO n DO s := s + a[i]; END_FOR END_PROGRAM",
    );
}

/// Two turns in each vector, four instructions a vector of the inner loop.
#[test]
fn turns_over_reals_are_in_lanes() {
    takes_at_most(
        8 * 4 * (8 * 4 + 8) + 60,
        "PROGRAM Main VAR a, b, c : ARRAY[0..7, 0..7] OF LREAL; s : LREAL; i, j, k : INT; END_VAR
        FOR i := 0 TO 7 DO FOR j := 0 TO 7 DO
            s := 0.0; FOR k := 0 TO 7 DO s := s + a[i, k] * b[k, j]; END_FOR c[i, j] := s;
        END_FOR END_FOR END_PROGRAM",
    );
    takes_at_most(
        62,
        "PROGRAM Main VAR a, b, c : ARRAY[0..15] OF LREAL; i : INT; END_VAR
        FOR i := 0 TO 15 DO c[i] := a[i] * b[i] + a[i]; END_FOR END_PROGRAM",
    );
}

/// One check of the index, which is a variable's.
#[test]
fn a_check_holds_in_all_ways_after_it() {
    takes_at_most(
        24,
        "PROGRAM Main VAR a : ARRAY[0..9] OF INT; i, x, y : INT; END_VAR
        IF a[i] = 3 THEN x := a[i]; ELSIF a[i] < 5 THEN y := a[i]; END_IF END_PROGRAM",
    );
}

#[test]
fn an_address_that_was_just_made_is_not_looked_up() {
    takes_at_most(
        8 * 4 + 30,
        "PROGRAM Main VAR a : ARRAY[0..7] OF DINT; p : REF_TO DINT; i : INT; END_VAR
        FOR i := 0 TO 7 DO p := REF(a[i]); p^ := p^ + 1; END_FOR END_PROGRAM",
    );
}
