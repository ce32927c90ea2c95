//! What decides nothing of what is compared is left out of the search, and nothing else is.

use super::programs::{self, Folder};

const OWN: Folder = Folder("idle");

/// With a counter that counts `x` and one that counts `y`.
fn program(before: &str, variables: &str, body: &str) -> String {
    format!(
        "{before}
PROGRAM p
VAR_INPUT x, y : BOOL; END_VAR
VAR_OUTPUT z : BOOL; END_VAR
VAR c, d : CTU; {variables} END_VAR
c(CU := x, PV := 4);
d(CU := y, PV := 20000);
{body}
END_PROGRAM
"
    )
}

fn compare(name: &str, [a, b]: [&str; 2], systems: [&str; 2], more: &[&str]) -> (Option<i32>, String) {
    let (path, other) = (OWN.written(&format!("{name}_a.st"), a), OWN.written(&format!("{name}_b.st"), b));
    let assumed = OWN.written(&format!("{name}.txt"), "no run\nno restart\nno reset\n");
    let mut arguments = vec![path.as_str(), "--from", systems[0], "--to", systems[1], "--budget", "100000"];
    if a != b {
        arguments.extend(["--against", &other]);
    }
    arguments.extend(more);
    if !more.contains(&"--assume") {
        arguments.extend(["--assume", &assumed]);
    }
    arguments.extend(["-A", "warnings"]);
    programs::compare(&arguments)
}

/// 20,000 counts of each decide nothing of `z`.
#[test]
fn a_counter_that_decides_nothing_is_not_searched() {
    let own = program("", "n : INT;", "z := c.Q; IF d.Q THEN n := 1 / n; END_IF;");
    let (code, text) = compare("fault", [&own; 2], ["iec", "codesys"], &["--vars", "z"]);
    assert_eq!(code, Some(4), "a fault ends the scan: {text}");
    let own = program("", "n : INT;", "z := c.Q; IF d.Q THEN n := 1; END_IF;");
    let (code, text) = compare("apart", [&own; 2], ["iec", "codesys"], &["--vars", "z"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains(" scans) of all that decides what is compared, "), "{text}");
    assert!(text.contains("`d`") && text.contains("undecided: trap 8"), "{text}");
    let (code, text) = compare("whole", [&own; 2], ["iec", "codesys"], &["--vars", "z,d.Q"]);
    assert_eq!(code, Some(4), "{text}");
}

/// In each, what the counter has counted comes to `z` by another way: with a preset of 5 it comes later.
#[test]
fn what_decides_by_any_way_is_searched() {
    let block = "FUNCTION_BLOCK f
VAR_INPUT i : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR_IN_OUT v : BOOL; END_VAR
VAR kept : BOOL; END_VAR
METHOD PUBLIC keep VAR_INPUT k : BOOL; END_VAR kept := k; END_METHOD
METHOD PUBLIC is_kept : BOOL is_kept := kept; END_METHOD
o := i; v := i;
END_FUNCTION_BLOCK
TYPE s : STRUCT a, b : BOOL; END_STRUCT; END_TYPE
INTERFACE is_told METHOD tell : BOOL END_METHOD END_INTERFACE
FUNCTION_BLOCK teller IMPLEMENTS is_told
VAR told : BOOL; END_VAR
METHOD PUBLIC tell : BOOL tell := told; END_METHOD
METHOD PUBLIC hear VAR_INPUT k : BOOL; END_VAR THIS.told := k; END_METHOD
END_FUNCTION_BLOCK
VAR_GLOBAL shared : BOOL; END_VAR
FUNCTION swap : BOOL VAR_IN_OUT a, b : BOOL; END_VAR VAR t : BOOL; END_VAR t := a; a := b; b := t; swap := t; END_FUNCTION
FUNCTION_BLOCK outer
VAR_INPUT i : BOOL; END_VAR VAR_OUTPUT o : BOOL; END_VAR
VAR inner : CTU; before : BOOL; END_VAR
inner(CU := i AND NOT before, PV := 1); before := i; o := inner.Q;
END_FUNCTION_BLOCK
FUNCTION g : BOOL VAR_INPUT i : BOOL; END_VAR g := i; END_FUNCTION
FUNCTION h : INT VAR_INPUT i : BOOL; END_VAR VAR_OUTPUT o : BOOL; END_VAR IF i THEN o := TRUE; RETURN; END_IF; o := FALSE; END_FUNCTION
";
    let ways = [
        ("", "z := c.Q;"),
        ("", "z := c.CV >= c.PV;"),
        ("a, b : BOOL;", "z := b; b := a; a := c.Q;"),
        ("n : INT;", "IF c.Q THEN n := 1; END_IF; z := n = 1;"),
        ("n : INT;", "CASE n OF 0: z := FALSE; ELSE z := TRUE; END_CASE; n := SEL(c.Q, 0, 2);"),
        ("u : f; b : BOOL;", "u(i := c.Q, v := b); z := u.o;"),
        ("u : f; b : BOOL;", "u(i := c.Q, v := b); z := b;"),
        ("u : f; b : BOOL;", "IF c.Q THEN u(i := TRUE, v := b); END_IF; z := u.o;"),
        ("u : f;", "u.keep(c.Q); z := u.is_kept();"),
        ("", "z := g(c.Q);"),
        ("n : INT;", "n := h(i := c.Q, o => z);"),
        ("t : s;", "t.b := c.Q; z := t.b;"),
        ("t, w : s;", "t.b := c.Q; w := t; z := w.b;"),
        ("t : ARRAY[0..1] OF BOOL;", "t[0] := TRUE; t[1] := c.Q; z := t[1];"),
        ("t : ARRAY[0..1] OF BOOL := [FALSE, TRUE];", "z := t[BOOL_TO_INT(c.Q)];"),
        (
            "i : INT;",
            "z := TRUE; FOR i := 0 TO 3 DO IF NOT c.Q THEN EXIT; END_IF; IF i = 3 THEN z := FALSE; END_IF; END_FOR;",
        ),
        ("", "z := FALSE; IF NOT c.Q THEN RETURN; END_IF; z := TRUE;"),
        ("e : CTU;", "e(CU := c.Q, PV := 1); z := e.Q;"),
        ("t : TON;", "t(IN := c.Q, PT := T#0ms); z := t.Q;"),
        ("r : REF_TO BOOL; a, b : BOOL;", "a := TRUE; r := REF(b); IF c.Q THEN r := REF(a); END_IF; z := r^;"),
        ("r : REF_TO BOOL; a : BOOL;", "r := REF(a); r^ := c.Q; z := a;"),
        ("w : WORD;", "w.%X3 := c.Q; z := w = 8;"),
        ("u : f; b : BOOL;", "u(i := c.Q, v := b, o => z);"),
        ("u : teller; i : is_told;", "i := u; u.hear(c.Q); z := i.tell();"),
        ("", "shared := c.Q; z := shared;"),
        ("a, b, r : BOOL;", "a := c.Q; b := FALSE; r := swap(a, b); z := b;"),
        ("a, b, r : BOOL;", "a := c.Q; z := swap(a, b);"),
        ("u : outer;", "u(i := c.Q); z := u.o;"),
        ("us : ARRAY[0..1] OF outer;", "us[1](i := c.Q); z := us[1].o;"),
        ("t : ARRAY[0..1] OF s;", "t[1].a := c.Q; z := t[1].a;"),
        ("n, i : INT;", "n := 0; FOR i := 1 TO SEL(c.Q, 0, 2) DO n := n + 1; END_FOR; z := n = 2;"),
        ("e : R_TRIG; l : SR;", "e(CLK := c.Q); l(S1 := e.Q, R := FALSE); z := l.Q1;"),
        ("k : STRING[4];", "IF c.Q THEN k := 'ok'; END_IF; z := k = 'ok';"),
    ];
    for (at, (variables, body)) in ways.iter().enumerate() {
        let own = program(block, variables, body);
        let other = own.replace("PV := 4", "PV := 5");
        let (code, text) = compare(&format!("way_{at}"), [&own, &other], ["iec"; 2], &["--vars", "z"]);
        assert_eq!(code, Some(1), "{body}: {text}");
    }
}

/// A preset that the panel keeps within a few values is as good as one of a subrange.
#[test]
fn an_assumed_range_is_one() {
    let own = "PROGRAM p
VAR_INPUT x : BOOL; n : INT; END_VAR
VAR_OUTPUT z : BOOL; END_VAR
VAR c : CTU; END_VAR
c(CU := x, PV := n);
z := c.Q;
END_PROGRAM
";
    let ranged = own.replace("n : INT", "n : INT(2..5)");
    let assumed = OWN.written("two_to_five.txt", "n 2..5\nno run\nno restart\nno reset\n");
    let (code, text) = compare("range", [own; 2], ["iec", "siemens"], &["--assume", &assumed, "--vars", "z,c.CV"]);
    assert_eq!(code, Some(0), "{text}");
    let (code, of_subrange) = compare("subrange", [&ranged; 2], ["iec", "siemens"], &["--vars", "z,c.CV"]);
    assert_eq!(code, Some(0), "{of_subrange}");
    // A value outside of it decides where the assumption is not made.
    let other = own.replace("z := c.Q", "z := c.Q AND n < 6");
    let within = ["--assume", &assumed, "--vars", "z"];
    let (code, text) = compare("within", [own, &other], ["iec"; 2], &within);
    assert_eq!(code, Some(0), "{text}");
    let (code, text) = compare("beyond", [own, &other], ["iec"; 2], &["--vars", "z"]);
    assert_eq!(code, Some(1), "{text}");
}
