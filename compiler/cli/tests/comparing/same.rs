//! Programs that do the same on both systems are equal, whatever numbers they are given; and those that do it for most numbers
//! only are not.

use super::programs::Folder;

const OWN: Folder = Folder("same");

/// With inputs `a`, `b` and `k` of 16 bits, `d` of 32, and what is computed of them.
fn program(body: &str) -> String {
    format!(
        "FUNCTION Twice : INT
VAR_INPUT x : INT; END_VAR
Twice := x * 2;
END_FUNCTION
PROGRAM p
VAR_INPUT a, b, k : INT; d : DINT; on : BOOL; END_VAR
VAR_OUTPUT n : INT; m : DINT; hot : BOOL; END_VAR
VAR t : ARRAY[0..3] OF INT; i, kept : INT; END_VAR
{body}
END_PROGRAM
"
    )
}

fn verdict(name: &str, body: &str, (from, to): (&str, &str)) -> (Option<i32>, String) {
    let quiet = OWN.written(&format!("{name}_quiet.txt"), "no run\nno restart\nno reset\n");
    OWN.compare(name, &program(body), &["--from", from, "--to", to, "--assume", &quiet, "--budget", "20000"])
}

/// INTs are computed as such in `iec`, and as DINTs in the others.
#[test]
fn what_fits_is_the_same_in_any_type() {
    let bodies = [
        "IF a >= 0 AND a <= 27648 THEN n := a / 10; ELSE n := -1; END_IF; hot := n > 100;",
        "IF k >= 0 AND k <= 3 THEN t[k] := a; END_IF; n := t[1];",
        "IF NOT (k < 0 OR k > 3) THEN n := t[k]; END_IF;",
        "IF b <> 0 THEN n := a / b; END_IF;",
        "IF b > 0 THEN n := a MOD b; END_IF;",
        "IF a > -16000 AND a < 16000 AND b >= -16000 AND b <= 16000 THEN hot := a + b > 20000; END_IF;",
        "n := a + b * 3 - 1;",
        "m := INT_TO_DINT(a) + INT_TO_DINT(b);",
        "n := LIMIT(0, a, 10) * 3; hot := n > 20;",
        "n := MIN(MAX(a, -100), 100) * 300 / 7;",
        "CASE a OF 1..50: n := a * 600 / 3; ELSE n := 0; END_CASE;",
        "IF on AND kept < 20 THEN kept := kept + 1; END_IF; n := kept * 1000 / 3;",
        "FOR i := 0 TO 3 DO t[i] := i * 8000; END_FOR; n := t[3];",
        "kept := a MOD 100; n := kept * 300 / 2;",
        "n := Twice(a) / 2;",
        "IF d >= 0 AND d <= 27648 THEN m := d * 100 / 27648; END_IF;",
    ];
    for (at, body) in bodies.iter().enumerate() {
        for systems in [("iec", "openplc"), ("siemens", "iec"), ("openplc4", "siemens"), ("iec", "codesys")] {
            let (code, text) = verdict(&format!("fits_{at}"), body, systems);
            assert_eq!(code, Some(0), "{systems:?}: {body}\n{text}");
        }
    }
    for body in [bodies[3], bodies[4], bodies[0]] {
        let (code, text) = verdict("of_logix", body, ("logix", "iec"));
        assert_eq!(code, Some(0), "{body}\n{text}");
    }
}

/// What the documents leave open is named where the program may come to it.
#[test]
fn an_overflow_that_cannot_be_is_not_spoken_of() {
    for (body, is_named) in
        [("IF on AND m < 100 THEN m := m + 1; END_IF;", false), ("IF on THEN m := m + d; END_IF;", true)]
    {
        let (_, text) = verdict(&format!("overflow_{is_named}"), body, ("iec", "openplc"));
        assert_eq!(text.contains("passes its range"), is_named, "{text}");
    }
}

/// A guard that lets one number too many through, or that is over before it is relied on.
#[test]
fn what_does_not_fit_is_not_called_the_same() {
    let bodies = [
        "IF a > -16000 AND a < 17000 AND b <= 16384 THEN hot := a + b > 20000; END_IF;",
        "hot := a + b > 20000;",
        "n := a * 3 / 2;",
        "CASE a OF 1..60: n := a * 600 / 3; ELSE n := 0; END_CASE;",
        "IF on AND kept < 40 THEN kept := kept + 1; END_IF; n := kept * 1000 / 3;",
        "IF a >= 0 AND a <= 100 THEN a := b; n := a * 300 / 2; END_IF;",
        "kept := a MOD 100; IF on THEN kept := b; END_IF; n := kept * 300 / 2;",
        "kept := a MOD 100; FOR i := 0 TO 3 DO n := kept * 300 / 2; kept := b; END_FOR;",
        "IF a < 100 OR b > 5 THEN hot := a * 300 > 0; END_IF;",
        "i := 1; FOR i := 100 TO i + 20 DO n := i * 300 / 3; END_FOR; FOR i := 300 TO 310 DO n := i * 300 / 3; END_FOR;",
    ];
    for (at, body) in bodies.iter().enumerate() {
        for systems in [("iec", "openplc"), ("iec", "codesys")] {
            let (code, text) = verdict(&format!("passes_{at}"), body, systems);
            assert_ne!(code, Some(0), "{systems:?}: {body}\n{text}");
        }
    }
}

/// What both systems do after a fault is not known to be the same.
#[test]
fn what_may_fault_is_not_called_the_same() {
    for (at, body) in [
        "IF k >= 0 AND k <= 4 THEN t[k] := a; END_IF;",
        "IF b >= 0 THEN n := a / b; END_IF;",
        "IF k >= 0 AND k <= 3 THEN k := k + 1; t[k] := a; END_IF;",
        "IF b <> 0 THEN b := b - 1; n := a / b; END_IF;",
        "IF k = 0 THEN t[k] := 1; ELSE t[k] := 2; END_IF;",
        "b := 1; FOR b := 0 TO 5 / b DO n := 1; END_FOR;",
    ]
    .iter()
    .enumerate()
    {
        let (code, text) = verdict(&format!("faults_{at}"), body, ("iec", "openplc"));
        assert!(code != Some(0) || !text.contains("run the same program"), "{body}\n{text}");
    }
}

/// A FOR whose body may give its counter the last number of the type ends with that turn here, and never on these systems.
#[test]
fn a_counter_that_the_body_writes_may_reach_the_end_of_its_type() {
    let body = "FOR i := 0 TO 10 DO IF on THEN i := 32767; END_IF; n := i; END_FOR;";
    for systems in [("codesys", "openplc4"), ("openplc4", "codesys")] {
        let (code, text) = verdict("counter", body, systems);
        assert!(code != Some(0) && text.contains("FOR to the limit of its counter's type"), "{systems:?}: {text}");
    }
    let text = program("FOR i := 32760 TO 32767 DO n := i; END_FOR; hot := a + b > 20000;");
    let (code, json) =
        OWN.compare("counter_json", &text, &["--from", "iec", "--to", "openplc", "--message-format", "json"]);
    assert!(code == Some(1) && json.contains("\"not_followed\":[\"FOR to the limit"), "{json}");
}

/// Programs that are text for text the same, and whose systems differ in what the text does not show.
#[test]
fn what_is_in_a_call_counts_too() {
    let texts = [
        // A structure in a call starts with other values than the one of the program.
        (
            "member",
            "TYPE S : STRUCT x : INT := 5; END_STRUCT END_TYPE
PROGRAM p VAR q : INT; m : S; END_VAR VAR_TEMP t : S := (x := 0); END_VAR q := 10 / t.x + m.x; END_PROGRAM",
        ),
        (
            "guarded",
            "TYPE S : STRUCT x : INT := 5; END_STRUCT END_TYPE
FUNCTION f : INT
VAR_INPUT a : INT; END_VAR VAR t : S := (x := 1000); END_VAR
IF a > 100 OR a < -100 THEN f := 0; RETURN; END_IF;
f := a * t.x / 7;
END_FUNCTION
PROGRAM p VAR_INPUT a : INT; END_VAR VAR q : INT; m : S; END_VAR q := f(a) + m.x; END_PROGRAM",
        ),
        // The result is cut at 126 characters on OPENPLC.
        (
            "capacity",
            "PROGRAM p VAR_INPUT a, b : STRING[200]; END_VAR VAR_OUTPUT n : INT; END_VAR n := LEN(CONCAT(a, b)); END_PROGRAM",
        ),
        // OPENPLC's CTU stops at PV.
        (
            "block",
            "PROGRAM p VAR_OUTPUT q : INT; END_VAR VAR_TEMP c : CTU; END_VAR
c(CU := TRUE, PV := 1); c(CU := FALSE, PV := 1); c(CU := TRUE, PV := 1); q := c.CV; END_PROGRAM",
        ),
        (
            "block_of_a_function",
            "FUNCTION f : INT VAR c : CTU; END_VAR
c(CU := TRUE, PV := 1); c(CU := FALSE, PV := 1); c(CU := TRUE, PV := 1); f := c.CV; END_FUNCTION
PROGRAM p VAR_OUTPUT q : INT; END_VAR q := f(); END_PROGRAM",
        ),
    ];
    for (name, text) in texts {
        let (code, text) = OWN.compare(name, text, &["--from", "iec", "--to", "openplc", "--budget", "20000"]);
        assert_ne!(code, Some(0), "{name}: {text}");
    }
}

/// What the verdict rests on is said with it.
#[test]
fn what_is_assumed_is_said() {
    let global = "VAR_GLOBAL d : INT := 5; END_VAR
PROGRAM p VAR_EXTERNAL d : INT; END_VAR VAR_INPUT a : INT; END_VAR VAR_OUTPUT q : INT; END_VAR q := a / d; END_PROGRAM";
    let narrow = "PROGRAM p VAR_INPUT a : INT(1..10); END_VAR VAR_OUTPUT q : INT; END_VAR q := 10 / a; END_PROGRAM";
    for (name, text, said) in [
        ("global", global, "nothing else is written from outside"),
        ("global", global, "nothing writes d (5), so only the initial value was tried"),
        ("narrow", narrow, "inputs have values of their subranges"),
    ] {
        let (code, text) = OWN.compare(name, text, &["--from", "iec", "--to", "openplc"]);
        assert!(code == Some(0) && text.contains("run the same program") && text.contains(said), "{name}: {text}");
    }
}
