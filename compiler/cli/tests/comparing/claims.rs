//! `staunch compare` claims no more than it has shown. What each program must come to follows from the systems' rules,
//! which the test names.

use super::programs::{ENABLED, Folder, run, text};

const OWN: Folder = Folder("claims");

/// A program with a table that it only reads: `over` follows from the count alone where an element is 7.
fn table(declared: &str, condition: &str) -> String {
    format!(
        "PROGRAM p
VAR_INPUT part : BOOL; size : INT(0..1000); END_VAR
VAR_OUTPUT over : BOOL; END_VAR
VAR c : CTU; END_VAR
{declared}
c(CU := part, R := c.CV > 4, PV := 2);
over := c.CV > 2 AND {condition};
END_PROGRAM
"
    )
}

const TO_OPENPLC: [&str; 6] = ["--from", "iec", "--to", "openplc", "--vars", "over"];

/// Nothing writes the table, so no element is 7, also not one that starts at 0; it can be assumed to be written.
#[test]
fn a_table_that_is_only_read_is_no_input() {
    let tables = [
        ("array", "VAR t : ARRAY[0..3] OF INT := [0, 10, 20, 30]; END_VAR", "t[size MOD 4] = 7"),
        ("zeros", "VAR t : ARRAY[0..3] OF INT; END_VAR", "t[size MOD 4] = 7"),
        ("members", "VAR t : STRUCT a, b : INT := 3; z : INT; END_STRUCT; END_VAR", "t.z = 7"),
        ("rows", "VAR t : ARRAY[0..3, 0..1] OF INT := [0, 10, 20, 30, 0]; END_VAR", "t[size MOD 4, 0] = 7"),
    ];
    for (name, declared, condition) in tables {
        let (code, text) = OWN.compare(name, &table(declared, condition), &TO_OPENPLC);
        assert!(text.contains("nothing writes t"), "{name}: {text}");
        assert!(!text.contains("differ after"), "{name}: {text}");
        assert_ne!(code, Some(1), "{name}: {text}");
    }
    let source = table(tables[0].1, "t[0] = 7");
    let (code, text) = OWN.compare("not_assumed", &source, &TO_OPENPLC);
    assert_eq!(code, Some(0), "{text}");
    let assumed = OWN.written("assumed.txt", "t[0] 0..10\n");
    let (code, text) = OWN.compare("assumed", &source, &[&TO_OPENPLC[..], &["--assume", &assumed]].concat());
    assert_eq!(code, Some(1), "{text}");
    // A variable that is RETAIN, or has an address, can be written from outside.
    for declared in ["VAR RETAIN t : ARRAY[0..1] OF INT; END_VAR", "VAR t AT %MW0 : ARRAY[0..1] OF INT; END_VAR"] {
        let (code, text) = OWN.compare("from_outside", &table(declared, "t[0] = 7"), &TO_OPENPLC);
        assert_eq!(code, Some(1), "{text}");
    }
    let written = table(tables[0].1, "t[0] = 7").replace("over :=", "IF size = 9 THEN t[0] := 7; END_IF over :=");
    let (code, text) = OWN.compare("written", &written, &TO_OPENPLC);
    assert_eq!(code, Some(1), "{text}");
}

/// An index is tried where the elements change, which is all that it decides.
#[test]
fn a_long_table_is_looked_up_where_it_changes() {
    let of = |value: u32| {
        let declared = format!("VAR t : ARRAY[0..1000] OF INT := [613(0), {value}, 387(0)]; END_VAR");
        table(&declared, "t[size] = 7")
    };
    let started = std::time::Instant::now();
    let (code, text) = OWN.compare("long", &of(7), &TO_OPENPLC);
    assert_eq!(code, Some(1), "{text}");
    let passed = started.elapsed();
    assert!(passed.as_secs() < 4, "a look-up of 1,000 elements took {passed:?}");
    let (code, text) = OWN.compare("long_equal", &of(8), &TO_OPENPLC);
    assert_eq!(code, Some(0), "{text}");
}

/// CODESYS holds a DT in 32 bits of seconds (its help, "DATE"). That is not followed: nothing is called equal that computes
/// with one; a comparison does not.
#[test]
fn a_rule_that_is_not_followed_is_never_equal() {
    let source = "PROGRAM p
VAR_INPUT on : BOOL; END_VAR
VAR a : DT := DT#2024-01-01-00:00:01; d : DT; late : BOOL; END_VAR
d := a + T#1s;
late := on AND d > a;
END_PROGRAM
";
    let no_run = OWN.written("unfollowed.txt", "no run\n");
    for (from, to) in [("iec", "codesys"), ("codesys", "openplc")] {
        let arguments = ["--from", from, "--to", to, "--assume", no_run.as_str()];
        let (code, text) = OWN.compare("time", source, &arguments);
        assert_eq!(code, Some(4), "{text}");
        assert!(text.contains("DT of CODESYS, which Staunch does not follow and line 4 uses"), "{text}");
        let compared = source.replace("a + T#1s", "a");
        let (code, text) = OWN.compare("compared", &compared, &arguments);
        assert_eq!(code, Some(0), "{text}");
    }
}

/// A TIME of CODESYS has 32 bits of milliseconds without a sign, so that `T#1s - T#2s` is not negative; and no input is
/// tried that it does not have.
#[test]
fn a_time_of_codesys_has_no_sign() {
    let no_run = OWN.written("unsigned_time.txt", "no run\n");
    let source = "PROGRAM p
VAR_INPUT on : BOOL; a : TIME; END_VAR
VAR_OUTPUT below : BOOL; END_VAR
below := on AND a - T#2s < T#0s;
END_PROGRAM
";
    let (code, text) =
        OWN.compare("unsigned_time", source, &["--from", "iec", "--to", "codesys", "--assume", no_run.as_str()]);
    assert_eq!(code, Some(1), "{text}");
    let never = source.replace("a - T#2s < T#0s", "a < T#0s");
    let (code, text) =
        OWN.compare("never_below", &never, &["--from", "iec", "--to", "codesys", "--assume", no_run.as_str()]);
    assert_eq!(code, Some(0), "{text}");
}

/// An LTIME of CODESYS has no sign; those that both systems have are tried.
#[test]
fn an_ltime_of_codesys_has_no_sign() {
    let no_run = OWN.written("unsigned_ltime.txt", "no run\n");
    let arguments = ["--from", "iec", "--to", "codesys", "--assume", no_run.as_str()];
    let source = "PROGRAM p
VAR_INPUT on : BOOL; a : LTIME; END_VAR
VAR_OUTPUT late : BOOL; END_VAR
VAR d : LTIME; END_VAR
d := a - LTIME#1s;
late := on AND d > LTIME#2s;
END_PROGRAM
";
    let (code, text) = OWN.compare("unsigned_ltime", source, &arguments);
    assert_eq!(code, Some(1), "{text}");
    // It is not a counter, whose count the advice would keep within limits.
    assert!(!text.contains("Trap 8"), "{text}");
    let (code, text) = OWN.compare("equal_ltime", &source.replace("a - LTIME#1s", "a"), &arguments);
    assert_eq!(code, Some(0), "{text}");
}

/// Where the first difference needs STOP -> RUN, which most programs from CODESYS have, the next one is shown as well.
#[test]
fn the_search_goes_on_past_stop_to_run() {
    let source = |preset: u32| {
        format!(
            "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR_OUTPUT over : BOOL; END_VAR
VAR c : CTU; e : R_TRIG; END_VAR
e(CLK := s); c(e.Q, c.CV > 3, {preset});
over := c.CV > 2;
END_PROGRAM
"
        )
    };
    let arguments = ["--from", "codesys", "--to", "openplc", "--vars", "c.CV"];
    let (code, text) = OWN.compare("past_run", &source(2), &arguments);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 11"), "{text}");
    let next = text.lines().find(|it| it.starts_with("If nobody switches it to STOP (`no run`")).unwrap_or_default();
    assert!(next.contains("the two differ after 5 scans") && next.contains("Trap 15 (`c`)"), "{text}");
    let (_, text) = OWN.compare("past_run_equal", &source(9), &arguments);
    assert!(text.contains("the two are equal: every reachable state was seen."), "{text}");
    // What is of other systems than these is not listed.
    assert!(!text.contains("of the two systems"), "{text}");
}

/// A number that is computed with is sampled: another value may make a difference sooner.
#[test]
fn nothing_is_called_shortest_of_sampled_numbers() {
    let source = "PROGRAM p
VAR_INPUT x : BOOL; n : INT; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTU; f : INT; END_VAR
f := (f * 3 + n) / 4;
c(CU := x AND (f > 600 AND f < 610), R := FALSE, PV := 1);
o := c.CV > 1;
END_PROGRAM
";
    let (code, text) = OWN.compare("sampled", source, &["--from", "iec", "--to", "cscape", "--vars", "o"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(!text.contains("no shorter"), "{text}");
}

/// An input called `En` of a PROGRAM stops nothing on any system: `lamp` follows it. Of a FUNCTION_BLOCK without ENO it stops the body
/// on IEC and OPENPLC, and is an ordinary input on S7, CSCAPE and OPENPLC4: `Off` is TRUE there.
#[test]
fn an_input_called_en_is_what_it_is_on_each_system() {
    let program = "PROGRAM p
VAR_INPUT En, part : BOOL; END_VAR
VAR_OUTPUT lamp : BOOL; END_VAR
VAR c : CTU; END_VAR
c(CU := part, PV := 2);
lamp := En AND c.Q;
END_PROGRAM
";
    let spelled = [program.to_owned(), program.replace("En", "EN")];
    for (number, source) in spelled.iter().enumerate() {
        for to in ["siemens", "openplc", "openplc4"] {
            let name = format!("en_program_{number}_{to}");
            let (code, text) = OWN.compare(&name, source, &["--from", "iec", "--to", to, "--vars", "lamp"]);
            assert_eq!(code, Some(0), "{name}: {text}");
        }
    }
    for (to, expected) in [("openplc", 0), ("siemens", 1), ("cscape", 1), ("openplc4", 1)] {
        let (code, text) =
            OWN.compare(&format!("en_block_{to}"), ENABLED, &["--from", "iec", "--to", to, "--vars", "off"]);
        assert_eq!(code, Some(expected), "{to}: {text}");
        assert!(expected == 0 || text.starts_with(&format!("iec and {to} differ after 1 scan:")), "{text}");
    }
}

/// OpenPLC has no check of subranges, nor has CODESYS without functions for it (its help, "Subrange type"): what is a fault
/// on both sides here is one on the other system alone.
#[test]
fn a_fault_of_a_subrange_is_none_on_systems_that_store_it() {
    let source = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR n : INT (0..3); END_VAR
VAR_OUTPUT o : BOOL; END_VAR
IF s THEN n := n + 1; END_IF;
o := n > 2;
END_PROGRAM
";
    let assumed = OWN.written("no_run_of_subrange.txt", "no run\n");
    for (from, to) in [("openplc", "cscape"), ("iec", "openplc4"), ("iec", "codesys")] {
        let (code, text) =
            OWN.compare("subrange", source, &["--from", from, "--to", to, "--vars", "o", "--assume", &assumed]);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains("one system faults here, and the other continues"), "{text}");
    }
    let (code, text) =
        OWN.compare("subrange", source, &["--from", "iec", "--to", "cscape", "--vars", "o", "--assume", &assumed]);
    assert_eq!(code, Some(4), "{text}");
    assert!(text.contains("a fault that ends both programs here, value outside its subrange in line 5"), "{text}");
}

/// An integer divided by 0 ends a program on x86, and is 0 on ARM of 64 bits ("SDIV"); CODESYS leaves it to the target (its
/// help, "DIV"). Where it is reached, nothing is called equal to a system that does otherwise; where it is not, it is.
#[test]
fn a_division_by_zero_that_is_reached_is_not_equal() {
    let source = "PROGRAM p
VAR_INPUT d : INT(0..3); END_VAR
VAR_OUTPUT o : INT; END_VAR
o := 12 / d;
END_PROGRAM
";
    let assumed = OWN.written("no_run_of_division.txt", "no run\n");
    let guarded = source.replace("o := ", "IF d > 0 THEN o := ").replace("12 / d;", "12 / d; END_IF");
    for (from, to) in [("iec", "openplc"), ("openplc4", "iec"), ("iec", "codesys"), ("codesys", "openplc")] {
        let arguments = ["--from", from, "--to", to, "--assume", &assumed];
        let (code, text) = OWN.compare("divided", source, &arguments);
        assert_eq!(code, Some(4), "{text}");
        assert!(text.contains("a fault that ends both programs here, division by zero in line 4; "), "{text}");
        let (code, text) = OWN.compare("guarded", &guarded, &arguments);
        assert_eq!(code, Some(0), "{text}");
    }
}

/// What a system leaves undefined, or does otherwise, is never called equal: neither where both sides are one program.
#[test]
fn what_a_system_does_otherwise_is_not_equal() {
    let asked = [
        ("limit", "openplc", "i : USINT", "q := 0; FOR i := 250 TO k DO q := q + 1; END_FOR;", "the loop does not end"),
        ("index", "openplc", "a : ARRAY[0..3] OF DINT", "a[n] := 5; q := a[2];", "it is not checked"),
        ("shift", "openplc4", "w : DWORD", "w := SHR(DWORD#16#FFFF, n); q := DWORD_TO_DINT(w);", "past the width"),
        ("sum", "openplc", "b : BOOL", "b := n + 1 > n; IF b THEN q := 1; ELSE q := 0; END_IF", "signed overflow"),
        ("minus", "openplc4", "b : BOOL", "b := -n < 0; IF b THEN q := 1; ELSE q := 0; END_IF", "signed overflow"),
        ("half", "openplc", "b : BOOL", "q := (n + n) / 2;", "signed overflow"),
        ("absolute", "openplc4", "b : BOOL", "q := ABS(n) / 2;", "signed overflow"),
        ("chosen", "openplc", "b : BOOL", "CASE n + 1 OF 5: q := 1; ELSE q := 0; END_CASE", "signed overflow"),
        ("rest", "openplc", "m : DINT := -1", "m := -1; q := n MOD m;", "signed overflow"),
        (
            "kept",
            "siemens",
            "t : TON := (PT := T#20ms)",
            "IF n > 0 THEN t(PT := T#50ms); ELSE t(IN := n < 0); END_IF",
            "PT that moves",
        ),
        ("quotient", "openplc", "b : BOOL", "b := n = 0; q := n / SEL(b, DINT#1, DINT#-1);", "signed overflow"),
        (
            "moved",
            "siemens",
            "t : TON",
            "IF n > 0 THEN t.PT := T#50ms; ELSE t.PT := T#20ms; END_IF t(IN := n > 1);",
            "PT that moves",
        ),
        (
            "moved_by_calls",
            "siemens",
            "t : TON",
            "IF n > 0 THEN t(PT := T#50ms); ELSE t(PT := T#20ms); END_IF",
            "PT that moves",
        ),
    ];
    for (name, to, declared, body, why) in asked {
        let source = format!(
            "PROGRAM p\nVAR_INPUT n : DINT; k : USINT; END_VAR\nVAR_OUTPUT q : DINT; END_VAR\nVAR {declared}; END_VAR\n{body}\nEND_PROGRAM\n"
        );
        let (code, text) = OWN.compare(name, &source, &["--from", "iec", "--to", to, "-A", "warnings"]);
        assert!(code == Some(4) && text.contains(why), "{name}: {text}");
    }
    // A limit that leaves the counter values is none, nor is one PT that every call gives.
    let same = "PROGRAM p\nVAR_INPUT k : USINT; b : BOOL; END_VAR\nVAR_OUTPUT q : DINT; END_VAR\nVAR i, small : INT; t : TON; wait : TIME := T#20ms; u : ARRAY[1..2] OF TON; END_VAR\n";
    let bodies = [
        ("openplc4", "q := 0; FOR i := 0 TO k DO q := q + 1; END_FOR"),
        ("codesys", "q := 0; small := 2; FOR i := 0 TO small - 1 DO q := q + 1; END_FOR"),
        ("siemens", "IF k > 3 THEN t(IN := b, PT := T#20ms); END_IF"),
        ("siemens", "IF b THEN t(IN := b, PT := T#20ms); ELSE t(IN := FALSE); END_IF"),
        ("siemens", "t(IN := b, PT := wait); u[1](IN := b, PT := T#1s); u[2](IN := b, PT := T#2s);"),
    ];
    for (to, body) in bodies {
        let source = format!("{same}{body}\nEND_PROGRAM\n");
        let (code, text) = OWN.compare("same", &source, &["--from", "iec", "--to", to, "-A", "warnings"]);
        assert!(code == Some(0), "{to}: {text}");
    }
}

/// A DINT that passes its range is said to wrap, since C leaves it undefined: also where it is stored first.
#[test]
fn a_stored_overflow_is_said() {
    let source = "PROGRAM p\nVAR_INPUT n : DINT; END_VAR\nVAR_OUTPUT q, r : DINT; END_VAR\nq := n + 1;\nr := q MOD 7;\nEND_PROGRAM\n";
    let (_, text) = OWN.compare("stored", source, &["--from", "openplc", "--to", "openplc4"]);
    assert!(
        text.contains("OPENPLC do not specify a DINT or LINT that passes its range (line 4); Staunch: wraps"),
        "{text}"
    );
    assert!(text.contains("OPENPLC4 do not specify"), "{text}");
    let (_, text) = OWN.compare("small", &source.replace("DINT", "INT"), &["--from", "openplc", "--to", "openplc4"]);
    assert!(!text.contains("passes its range"), "{text}");
}

/// A program's own block does not take the place of the instruction that its counters need in Logix.
#[test]
fn an_own_block_with_the_name_of_an_instruction_is_refused_for_logix() {
    let source = "FUNCTION_BLOCK RES\nVAR_INPUT x : BOOL; END_VAR\nEND_FUNCTION_BLOCK\nPROGRAM p\nVAR_INPUT u, r : BOOL; END_VAR\n\
                  VAR_OUTPUT q : BOOL; END_VAR\nVAR c : CTU; own : RES; END_VAR\nc(CU := u, R := r, PV := 3); q := c.Q; own(x := q);\nEND_PROGRAM\n";
    let path = OWN.written("own_res.st", source);
    let output = run(&format!("{path} --from iec --to logix"));
    let text = text(&output.stderr);
    assert!(output.status.code() == Some(2) && text.contains("the program's own `RES`"), "{text}");
}
