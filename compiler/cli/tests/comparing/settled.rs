//! Counts past all that they are compared with are taken as one: what is equal by that, and what must not be. In each pair
//! that differs, only a count beyond 3, which the counter's call names, shows it.

use super::programs::{self, Folder};

const OWN: Folder = Folder("settled");
const INPUTS: &str = "VAR_INPUT x, y, r : BOOL; END_VAR VAR_OUTPUT z : BOOL; END_VAR";
const CALL: &str = "c(CU := x, PV := 3);";

/// A program with these variables, after these types and blocks.
fn program(before: &str, variables: &str, body: &str) -> String {
    format!("{before}\nPROGRAM p {INPUTS} VAR {variables} END_VAR\n{body}\nEND_PROGRAM\n")
}

/// The exit code, and what is printed.
fn compare(name: &str, [a, b]: [&str; 2], systems: [&str; 2], vars: &str) -> (Option<i32>, String) {
    let (path, other) = (OWN.written(&format!("{name}_a.st"), a), OWN.written(&format!("{name}_b.st"), b));
    let assumed = OWN.written(&format!("{name}.txt"), "no run\nno restart\nno reset\n");
    let mut arguments = vec![path.as_str(), "--from", systems[0], "--to", systems[1], "--vars", vars];
    if a != b {
        arguments.extend(["--against", &other]);
    }
    if systems[1] == "logix" {
        // No budget leads to 2,147,483,647 counts.
        arguments.extend(["--budget", "100000"]);
    }
    arguments.extend(["--assume", &assumed, "-A", "warnings"]);
    programs::compare(&arguments)
}

/// The number of scans after which the two differ.
fn differs(name: &str, programs: [&str; 2], dialect: &str, vars: &str, scans: usize) {
    let (code, text) = compare(name, programs, [dialect; 2], vars);
    assert_eq!(code, Some(1), "{name}: {text}");
    assert!(text.starts_with(&format!("{dialect} and {dialect} differ after {scans} scans")), "{name}: {text}");
}

fn equal(name: &str, programs: [&str; 2], systems: [&str; 2], vars: &str) {
    let (code, text) = compare(name, programs, systems, vars);
    assert_eq!(code, Some(0), "{name}: {text}");
    assert!(
        text.contains(", with all counts past the values that they are compared with taken as one state, "),
        "{name}: {text}"
    );
}

/// Counters that nothing resets reach 65,535 each; where no program asks for more than whether a few were counted, few
/// states decide.
#[test]
fn what_is_compared_with_constants_alone_is_equal() {
    let two = program("", "c, d : CTU;", "c(CU := x, PV := 3); d(CU := y, PV := 4); z := c.Q AND d.CV > 3;");
    equal("constants", [&two, &two], ["iec", "codesys"], "z");
    let case = program("", "c : CTU;", "c(CU := x, PV := 4); CASE c.CV OF 2..3: z := TRUE; ELSE z := FALSE; END_CASE");
    equal("labels", [&case, &case], ["iec", "codesys"], "z");
    let down =
        program("", "c : CTD_DINT; n : INT(1..4);", "c(CD := x, LD := r, PV := INT_TO_DINT(n)); z := c.CV = -2;");
    let other = down.replace("c.CV = -2", "-2 = c.CV");
    equal("down", [&down, &other], ["iec", "iec"], "z,c.Q");
    // The counts themselves are compared here, and go to 2,147,483,647.
    let own = program("", "c : CTU_DINT;", "c(CU := x, R := r, PV := 3); z := c.Q;");
    equal("compared", [&own, &own.replace("z := c.Q", "z := c.CV >= 3")], ["iec", "iec"], "z,c.CV");
}

/// An INT stops at 32,767, a WORD at 65,535; a COUNTER of Logix turns round after 2,147,483,647.
#[test]
fn counts_that_end_otherwise_are_not_equal() {
    let own = program("", "c : CTU;", "c(CU := x, PV := 3); z := c.Q;");
    let (code, text) = compare("widths", [&own, &own], ["iec", "codesys"], "c.CV");
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 8"), "{text}");
    let far = program("", "c : CTU;", "c(CU := x, PV := 32767); z := c.Q AND c.CV > 32767;");
    let (code, text) = compare("far", [&far, &far], ["iec", "codesys"], "z");
    assert_eq!(code, Some(1), "{text}");
    let wide =
        program("", "c : CTU_DINT; before : BOOL;", "c(CU := x AND NOT before, PV := 3); before := x; z := c.Q;");
    let logix = program(
        "",
        "c : COUNTER := (PRE := 3); edge, before : BOOL;",
        "edge := x AND NOT before; before := x; c.CU := FALSE; CTU(c, edge); z := c.ACC >= 3;",
    );
    let (code, text) = compare("turns", [&wide, &logix], ["iec", "logix"], "z");
    assert!(code != Some(0), "{text}");
}

/// What reads the count otherwise than by a comparison with a constant.
#[test]
fn any_other_use_of_the_count_counts() {
    let none = program("", "c : CTU; n, i : INT;", &format!("{CALL} z := FALSE;"));
    let reads = [
        ("z := t[LIMIT(0, c.CV, 60)];", 99),
        ("z := MIN(c.CV, 60) > 50;", 101),
        ("z := c.CV MOD 64 = 50;", 99),
        ("z := c.CV.5;", 63),
        ("z := INT_TO_USINT(c.CV) > 50;", 101),
        ("z := INT_TO_REAL(c.CV) > 50.0;", 101),
        ("z := INT_TO_STRING(c.CV) = '50';", 99),
        ("n := c.CV; z := n > 50;", 101),
        ("c(CV => n); z := n > 50;", 101),
        ("CASE c.CV + 1 OF 50..60: z := TRUE; ELSE z := FALSE; END_CASE", 97),
        ("n := 0; FOR i := 1 TO c.CV DO n := n + 1; END_FOR z := n > 50;", 101),
        ("i := 0; WHILE i < c.CV DO i := i + 1; END_WHILE z := i > 50;", 101),
    ];
    for (at, (read, scans)) in reads.into_iter().enumerate() {
        let variables = "c : CTU; n, i : INT; t : ARRAY[0..60] OF BOOL := [50(FALSE), 11(TRUE)];";
        let a = program("", variables, &format!("{CALL} {read}"));
        differs(&format!("read_{at}"), [&a, &none], "iec", "z", scans);
    }
    let reset = "c(CU := x, R := c.CV >= 50, PV := 3); z := FALSE;";
    let read = program("", "c : CTU;", &reset.replace("FALSE", "c.CV = 50"));
    differs("reset", [&read, &program("", "c : CTU;", reset)], "iec", "z", 99);
}

/// A preset that moves past the count.
#[test]
fn a_preset_that_changes_counts() {
    let none = program("", "c : CTU := (PV := 3);", "c(CU := x); z := FALSE;");
    let up = "FUNCTION_BLOCK Up VAR_IN_OUT n : INT; END_VAR VAR_INPUT x : BOOL; END_VAR \
              IF x AND n < 60 THEN n := n + 1; END_IF END_FUNCTION_BLOCK";
    let moves = [
        ("IF y AND n < 60 THEN n := n + 1; END_IF c(CU := x, PV := n);", 101),
        ("IF y AND n < 60 THEN n := n + 1; END_IF c.PV := n; c(CU := x);", 101),
        ("IF y AND c.PV < 60 THEN c.PV := c.PV + 1; END_IF c(CU := x);", 101),
        ("u(n := c.PV, x := y); c(CU := x);", 101),
        ("IF y THEN FOR c.PV := 1 TO 60 DO n := n; END_FOR END_IF c(CU := x);", 121),
    ];
    for (at, (call, scans)) in moves.into_iter().enumerate() {
        let a = program(up, "c : CTU := (PV := 3); n : INT := 3; u : Up;", &format!("{call} z := c.Q AND c.PV > 50;"));
        differs(&format!("preset_{at}"), [&a, &none], "iec", "z", scans);
    }
}

const LOOK: &str = "FUNCTION_BLOCK Look VAR_IN_OUT a : WHOLE; END_VAR VAR_OUTPUT hot : BOOL; END_VAR \
                    hot := COUNT > 50; END_FUNCTION_BLOCK";
const S: &str = "TYPE S : STRUCT c : CTU; END_STRUCT END_TYPE\n";

/// A counter is read by what it, or the whole of which it is a part, is handed to.
#[test]
fn what_a_parameter_leads_to_counts() {
    let shapes = [
        ("", "c : CTU;", "c", "CTU", "a.CV"),
        ("", "c : ARRAY[1..2] OF CTU;", "c[1]", "ARRAY[1..2] OF CTU", "a[1].CV"),
        (S, "c : S;", "c.c", "S", "a.c.CV"),
    ];
    for (at, (before, variable, counter, whole, count)) in shapes.into_iter().enumerate() {
        let look = LOOK.replace("WHOLE", whole).replace("COUNT", count);
        let variables = format!("{variable} l : Look;");
        let call = CALL.replace("c(", &format!("{counter}("));
        let a = program(&format!("{before}{look}"), &variables, &format!("{call} l(a := c); z := l.hot;"));
        let b = program(before, variable, &format!("{call} z := FALSE;"));
        differs(&format!("handed_{at}"), [&a, &b], "iec", "z", 101);
    }
}

/// And through references, copies, METHODs and what is inherited.
#[test]
fn what_a_reference_leads_to_counts() {
    let none = |before: &str, variable: &str, call: &str| program(before, variable, &format!("{call} z := FALSE;"));
    let block = "FUNCTION_BLOCK B\nVAR_INPUT x : BOOL; END_VAR VAR_OUTPUT hot : BOOL; END_VAR VAR c : CTU; q : POINTER TO CTU; END_VAR\n\
                 METHOD PUBLIC Look\nhot := c.CV > 50;\nEND_METHOD\nc(CU := x, PV := 3); LOOKS\nEND_FUNCTION_BLOCK\n\
                 FUNCTION_BLOCK D EXTENDS B\nc(CU := x, PV := 4); LOOKS\nEND_FUNCTION_BLOCK\n";
    let by = |looks: &str| block.replace("LOOKS", looks);
    let call = "c[1](CU := x, PV := 3);";
    let cases = [
        (String::new(), "c : CTU; q : POINTER TO CTU;", CALL, "q := ADR(c); z := q^.CV > 50;"),
        (String::new(), "c : CTU; q : REFERENCE TO CTU;", CALL, "q REF= c; z := q.CV > 50;"),
        (String::new(), "c, d : CTU;", CALL, "d := c; z := d.CV > 50;"),
        (String::new(), "c : ARRAY[1..2] OF CTU; q : POINTER TO CTU;", call, "q := ADR(c[1]); z := q^.CV > 50;"),
        (S.to_owned(), "c, d : S; q : POINTER TO S;", "c.c(CU := x, PV := 3);", "q := ADR(c); z := q^.c.CV > 50;"),
        (S.to_owned(), "c, d : S;", "c.c(CU := x, PV := 3);", "d := c; z := d.c.CV > 50;"),
        (by("Look();"), "b : B;", "b(x := x);", "z := b.hot;"),
        (by("Look();"), "b : D;", "b(x := x);", "z := b.hot;"),
        (by("hot := THIS^.c.CV > 50;"), "b : B;", "b(x := x);", "z := b.hot;"),
        (by("q := ADR(THIS^.c); hot := q^.CV > 50;"), "b : B;", "b(x := x);", "z := b.hot;"),
    ];
    for (at, (before, variables, call, read)) in cases.into_iter().enumerate() {
        let a = program(&before, variables, &format!("{call} {read}"));
        differs(&format!("reference_{at}"), [&a, &none(&before, variables, call)], "codesys", "z", 101);
    }
}

/// Where the counts are compared, one that has come to its limit hides what another would show: 7 counts a scan, which a reset
/// brings back from 32,767, and a difference after 5,000 scans.
#[test]
fn a_count_at_its_limit_hides_nothing() {
    let variables = "c : CTU; k : INT; d : INT(0..6000); e : R_TRIG;";
    let body = "e(CLK := x); IF e.Q AND d < 6000 THEN d := d + 1; END_IF \
                FOR k := 1 TO 7 DO c(CU := FALSE, R := r, PV := 3); c(CU := e.Q, R := r, PV := 3); END_FOR z := FALSE;";
    let a = program("", variables, body);
    let b = program("", variables, &body.replace("CU := e.Q", "CU := e.Q AND NOT (d > 5000 AND c.CV > 3)"));
    differs("limit", [&a, &b], "iec", "c.CV", 10_001);
}

/// From a state with a lesser count it would differ, but that cannot be reached: no difference is claimed, and no equality.
#[test]
fn a_difference_that_the_limit_hides_is_not_claimed() {
    let variables = "c : CTU := (CV := 32760); n : INT(0..10); e : R_TRIG;";
    let body = "e(CLK := x); IF e.Q AND n < 10 THEN n := n + 1; END_IF c(CU := x, PV := 3); z := FALSE;";
    let a = program("", variables, body);
    let b = program("", variables, &body.replace("CU := x", "CU := x AND n < 10"));
    let (code, text) = compare("hidden", [&a, &b], ["iec", "iec"], "c.CV");
    assert_eq!(code, Some(4), "{text}");
}

/// A value written from outside to a counter's pins is not a constant.
#[test]
fn a_counter_that_is_an_input_counts() {
    let of = |z: &str| {
        format!("PROGRAM p VAR_INPUT c : CTU; END_VAR VAR_OUTPUT z : BOOL; END_VAR\nc(); z := {z};\nEND_PROGRAM\n")
    };
    let (code, text) = compare("given", [&of("c.Q AND c.PV > 50"), &of("FALSE")], ["iec", "iec"], "z");
    assert!(code != Some(0), "{text}");
}

/// A count is compared with what has a range, or is kept where nothing asks for it.
#[test]
fn what_is_compared_with_a_range_or_kept_for_nobody_is_equal() {
    let ranged = |most: u32| {
        let variables = format!("c : CTU; END_VAR VAR_INPUT n : INT(1..{most});");
        program("", &variables, "c(CU := x, PV := 3); z := c.CV >= n;")
    };
    let three = ranged(3);
    equal("range", [&three, &three], ["iec", "openplc"], "z");
    let four = ranged(4);
    let (code, text) = compare("wide_range", [&four, &four], ["iec", "openplc"], "z");
    assert!(code == Some(1) && text.starts_with("iec and openplc differ after 7 scans"), "{text}");
    let kept =
        |asked: &str| program("", "c : CTU; m : INT;", &format!("c(CU := x, PV := 3); m := c.CV; z := {asked};"));
    equal("kept_for_nobody", [&kept("c.Q"), &kept("c.Q")], ["iec", "openplc"], "z");
    let asked = kept("m > 3");
    let (code, text) = compare("kept", [&asked, &asked], ["iec", "openplc"], "z");
    assert!(code == Some(1) && text.starts_with("iec and openplc differ after 7 scans"), "{text}");
}
