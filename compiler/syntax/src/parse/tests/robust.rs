//! Texts that are not programs: the parser ends, and reports it.

use super::shape::parsed;
use crate::{diagnostic::Code, source::Source};

const SAMPLE: &str = "(* doc *) PROGRAM p VAR a : ARRAY[1..2] OF INT := [1, 2(3)]; s : STRING := 'x$N'; END_VAR
    IF a[1] = 1 THEN a[1] := 2; ELSIF b THEN f(x := 1, y => z); ELSE ; END_IF
    CASE x OF 1, 2..3: y := T#1s; ELSE y := -2 ** 3; END_CASE {pragma} /* c */ // d
    FOR i := 1 TO 3 BY 2 DO EXIT; END_FOR WHILE a DO ; END_WHILE REPEAT ; UNTIL b END_REPEAT
    END_PROGRAM TYPE T : (A, B := 2); S : STRUCT x : INT; END_STRUCT; END_TYPE
    FUNCTION_BLOCK ä METHOD m END_METHOD END_FUNCTION_BLOCK
    CONFIGURATION c RESOURCE r ON x TASK t (A := 1); PROGRAM p WITH t : q; END_RESOURCE END_CONFIGURATION";

#[test]
fn a_file_may_end_anywhere() {
    for end in (0..=SAMPLE.len()).filter(|it| SAMPLE.is_char_boundary(*it)) {
        parsed(&SAMPLE[..end]);
        parsed(&SAMPLE[end..]);
    }
}

/// Tokens in any order must never panic, nor loop.
#[test]
fn tokens_in_any_order() {
    let words: Vec<_> = SAMPLE.split_inclusive([' ', '(', ')', ';', ',']).collect();
    let mut seed = 1_u64;
    for _ in 0..3000 {
        let mut text = String::new();
        for _ in 0..30 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            text.push_str(words[usize::try_from(seed >> 33).unwrap_or(0) % words.len()]);
            text.push(' ');
        }
        parsed(&text);
    }
}

#[test]
fn bytes_in_any_order() {
    let mut seed = 7_u64;
    for _ in 0..500 {
        let bytes: Vec<u8> = (0..400)
            .map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                seed.to_be_bytes()[0]
            })
            .collect();
        parsed(&Source::decode("x", &bytes).text);
    }
}

#[track_caller]
fn refused_once(text: &str, code: Code) {
    let (_, diagnostics) = parsed(text);
    let codes: Vec<_> = diagnostics.iter().map(|it| it.code).collect();
    assert_eq!(codes, [code], "{}", &text[..text.len().min(60)]);
}

#[test]
fn nesting_and_chains_are_limited() {
    let deep = |before: &str, repeated: &str, after: &str| format!("{before}{}{after}", repeated.repeat(100_000));
    let texts = [
        deep("PROGRAM p x := ", "(", "1; END_PROGRAM"),
        deep("PROGRAM p x := ", "-", "1; END_PROGRAM"),
        deep("PROGRAM p x := ", "NOT ", "1; END_PROGRAM"),
        deep("PROGRAM p x := 1 ", "+ 1 ", "; END_PROGRAM"),
        deep("PROGRAM p x := 1 ", "OR (a XOR (b AND (c = (d < (e + (f * (g ** h ", "; END_PROGRAM"),
        deep("PROGRAM p x := a", "[1]", "; END_PROGRAM"),
        deep("PROGRAM p x := a", "[a", "; END_PROGRAM"),
        deep("PROGRAM p x := a", ".b", "; END_PROGRAM"),
        deep("PROGRAM p x := a", "^", "; END_PROGRAM"),
        deep("PROGRAM p x := a", "()", "; END_PROGRAM"),
        deep("PROGRAM p ", "f(", "END_PROGRAM"),
        deep("PROGRAM p ", "IF a THEN ", "END_PROGRAM"),
        deep("PROGRAM p IF a THEN ", "ELSIF a THEN ", "END_IF END_PROGRAM"),
        deep("PROGRAM p ", "IF a THEN ELSE ", "END_PROGRAM"),
        deep("PROGRAM p ", "CASE a OF 1: ", "END_PROGRAM"),
        deep("PROGRAM p ", "FOR i := 1 TO 2 DO ", "END_PROGRAM"),
        deep("PROGRAM p ", "WHILE a DO ", "END_PROGRAM"),
        deep("PROGRAM p ", "REPEAT ", "END_PROGRAM"),
        deep("VAR_GLOBAL a : ", "ARRAY[1..2] OF ", "INT; END_VAR"),
        deep("VAR_GLOBAL a : ", "STRUCT a : ", "INT; END_VAR"),
        deep("VAR_GLOBAL a : ", "REF_TO ", "INT; END_VAR").replacen("REF_TO ", "ARRAY[1..2] OF ", 300),
        deep("VAR_GLOBAL a : T := ", "[", "1; END_VAR"),
        deep("VAR_GLOBAL a : T := ", "(a := ", "1; END_VAR"),
        deep("VAR_GLOBAL a : T := [", "2(", "1; END_VAR"),
    ];
    for text in texts {
        refused_once(&text, Code::E0091);
    }
}

#[test]
fn what_is_below_the_limits_parses() {
    for text in [
        format!("PROGRAM p x := {}1{}; END_PROGRAM", "(".repeat(250), ")".repeat(250)),
        format!("PROGRAM p x := 1{}; END_PROGRAM", " + 1".repeat(900)),
        format!("PROGRAM p {}{} END_PROGRAM", "IF a THEN ".repeat(250), "END_IF ".repeat(250)),
        format!("{}{}", "(*".repeat(1_000_000), "*)".repeat(1_000_000)),
    ] {
        super::shape::correct(&text);
    }
}

#[test]
fn an_error_limit_ends_a_file_of_garbage() {
    for text in ["x := ; ", "§ ", "' \n", "END_IF ", "PROGRAM ", "1 ", "a b ", "\u{0}\u{1} ", "\" \n"] {
        let (_, diagnostics) = parsed(&text.repeat(200_000));
        assert!(diagnostics.len() <= 101, "{text}: {}", diagnostics.len());
    }
}

/// What a wrong end closes is weighed within a horizon: a long file of mistakes takes no longer.
#[test]
fn wrong_ends_in_a_long_file() {
    let line = "IF a THEN b := MAX(a b; END_WHILE;\n";
    let text = format!("PROGRAM p {}END_PROGRAM", line.repeat(20_000));
    let (_, diagnostics) = parsed(&text);
    assert!(diagnostics.iter().any(|it| it.code == Code::E0030));
}
