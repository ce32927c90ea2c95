//! What is accepted passes, and nothing else: an output needs a line of its own.

use super::programs::{Folder, difference, moved, run, text, written};

const OWN: Folder = Folder("accepted");

/// `c.CV > 2` holds on IEC alone, and decides the motor: that the counter's finding is accepted does not accept that.
const MOTOR: &str = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR c, d : CTU; END_VAR
VAR_OUTPUT motor, lamp : BOOL; END_VAR
c(CU := s, R := r, PV := 2);
motor := c.CV > 2;
d(CU := s, R := r, PV := 3);
lamp := d.Q;
END_PROGRAM
";

/// An output needs a line of its own, and `*` is none.
#[test]
fn an_accepted_counter_does_not_accept_an_output() {
    let counters = OWN.written("counters.txt", "c 15: nobody reads the count past its preset\nd 15: same\n");
    let (code, text) = OWN.compare("motor", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &counters]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Not accepted: `motor output`.") && text.contains("`motor output: reason`"), "{text}");
    let all = OWN.written("all.txt", "* 15: nobody reads the count past its preset\n* output: nobody looks\n");
    let (code, text) = OWN.compare("motor_all", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &all]);
    assert_eq!(code, Some(1), "{text}");
    let own = OWN.written("own.txt", "c 15: nobody reads it\nd 15: same\nmotor output: it is not wired\n");
    let (code, text) = OWN.compare("motor_own", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &own]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("not compared after an accepted finding: c.Q, c.CV, d.Q, d.CV, motor."), "{text}");
}

/// What `--vars` names is compared until a line names it, and so is a variable at `%Q`; a variable inside follows.
#[test]
fn what_is_named_and_what_is_wired_are_outputs() {
    let plain = MOTOR.replace("VAR_OUTPUT motor", "VAR motor");
    let counters = OWN.written("counters_of_vars.txt", "c 15: nobody reads the count past its preset\nd 15: same\n");
    let arguments = ["--from", "iec", "--to", "openplc", "--accept", counters.as_str()];
    let (code, text) = OWN.compare("inside", &plain, &arguments);
    assert_eq!(code, Some(0), "{text}");
    let handed_on = plain.replace("motor := c.CV > 2;", "motor := Over(c.CV);");
    let over = "FUNCTION Over : BOOL VAR_INPUT n : INT; END_VAR Over := n > 2; END_FUNCTION\n";
    let (code, text) = OWN.compare("handed_on", &format!("{over}{handed_on}"), &arguments);
    assert_eq!(code, Some(0), "{text}");
    let (code, text) = OWN.compare("named", &plain, &[&arguments[..], &["--vars", "motor,lamp"]].concat());
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Not accepted: `motor output`."), "{text}");
    let wired = MOTOR.replace("VAR_OUTPUT motor, lamp : BOOL;", "VAR motor AT %QX0.0 : BOOL; lamp : BOOL;");
    let (code, text) = OWN.compare("wired", &wired, &arguments);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Not accepted: `motor output`."), "{text}");
}

#[test]
fn accepted_findings_do_not_fail() {
    let all = written(
        "accepted.txt",
        "parts 1: the barrier is never held\nparts 2: nobody reads the count\nfull output: it is not wired\n",
    );
    let output = run(&format!("held.st --from iec --to cscape --accept {}", all.display()));
    let out = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{out}");
    assert!(out.contains("(accepted)"), "{out}");
    let stale = written(
        "stale.txt",
        "parts 1: never held\nparts 2: not read\nparts 4: no CTD here\nfull output: it is not wired\n",
    );
    let output = run(&format!("held.st --from iec --to cscape --accept {}", stale.display()));
    assert_eq!(output.status.code(), Some(0));
    let said = text(&output.stderr);
    assert!(said.contains("stale.txt:3: trap 4 of `parts` is accepted, but is impossible: "), "{said}");
    let one = written("one.txt", "parts 2: nobody reads the count\n");
    let some = difference(&format!("held.st --from iec --to cscape --accept {}", one.display()));
    assert!(some.contains("\nNot accepted: `parts 1`.\n"), "{some}");
    assert!(!out.contains("Not accepted"), "{out}");
}

/// Which outputs follow is known when all else is accepted: until then, no line for an output is called needless.
#[test]
fn a_line_for_an_output_waits_for_the_others() {
    let some = OWN.written("some.txt", "c 15: nobody reads it\nmotor output: it is not wired\n");
    let output = OWN.output("waits", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &some]);
    let (said, shown) = (text(&output.stderr), text(&output.stdout));
    assert_eq!(output.status.code(), Some(1), "{shown}");
    assert!(shown.contains("Not accepted: `d 15`."), "{shown}");
    assert!(!said.contains("is accepted, but"), "{said}");
    let other =
        OWN.written("other.txt", "c 15: not read\nd 15: same\nmotor output: not wired\nlamp output: not wired\n");
    let output = OWN.output("other", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &other]);
    let said = text(&output.stderr);
    assert!(said.contains("other.txt:4: output of `lamp` is accepted, but does not exist"), "{said}");
}

/// Only what is accepted passes: the search continues past it, and compares what does not follow from it.
#[test]
fn what_is_not_accepted_fails() {
    let accept = |name: &str, lines: &str| {
        let path = OWN.path().join(format!("{name}.txt"));
        std::fs::write(&path, lines).expect("a file");
        path.display().to_string()
    };
    let traps = accept("traps", "* 1: ok\n* 2: ok\n");
    let text_apart = OWN.program(
        "text_apart",
        "VAR_INPUT s : BOOL; END_VAR VAR c : CTU; END_VAR
VAR y : STRING; END_VAR VAR_OUTPUT q : BOOL; END_VAR
c(s, FALSE, 3); y := CONCAT(y, 'aaaaaaaaaa'); q := LEN(y) > 90;",
    );
    let (code, text) = moved(&text_apart, "iec", "cscape", &["--accept", &traps]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("`y` (width, "), "{text}");
    let all = accept("traps_and_width", "* 1: ok\n* 2: ok\ny width: never so long\nq output: it is not wired\n");
    let (code, text) = moved(&text_apart, "iec", "cscape", &["--accept", &all]);
    assert_eq!(code, Some(0), "{text}");
    // The programs themselves are not the same, where no counter has parted.
    let declared = "VAR_INPUT s : BOOL; END_VAR VAR c : CTU; END_VAR VAR_OUTPUT x : BOOL; END_VAR\n";
    let one = OWN.program("one_text", &format!("{declared}c(s, FALSE, 3); x := c.CV = 1 AND NOT s;"));
    let other = OWN.program("other_text", &format!("{declared}c(s, FALSE, 3); x := FALSE;"));
    let against = ["--accept", &traps, "--against", &other];
    let (code, text) = moved(&one, "iec", "cscape", &against);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("`x` (variable, ") && text.contains("None of the traps explains it"), "{text}");
    let known = accept("known", "* 1: ok\n* 2: ok\nx variable: it has no lamp\n");
    let against = ["--accept", &known, "--against", &other];
    let (code, text) = moved(&one, "iec", "cscape", &against);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("Apart from it and its consequences, the two are equal"), "{text}");
}

/// "Not found" rules nothing out, whatever is accepted.
#[test]
fn nothing_found_is_not_accepted() {
    let path = OWN.program(
        "untried",
        "VAR_INPUT v, w : DINT; END_VAR VAR y : STRING; END_VAR VAR_OUTPUT q : BOOL; END_VAR
IF v * v + w * w = 20193797 AND v > 100 AND w > 100 THEN y := CONCAT(y, 'aaaaaaaaaa'); END_IF q := LEN(y) > 90;",
    );
    let accept = OWN.path().join("nobody.txt");
    std::fs::write(&accept, "* 1: nobody\n").expect("a file");
    let (code, text) = moved(&path, "iec", "cscape", &["--accept", &accept.display().to_string()]);
    assert_eq!(code, Some(4), "{text}");
}

/// Of two counters of one declaration one is accepted: what the other decides is not ruled out.
#[test]
fn what_is_declared_with_what_is_accepted_is_not() {
    let declared =
        "VAR_INPUT s : BOOL; END_VAR VAR c : ARRAY[1..2] OF CTU; END_VAR VAR_OUTPUT over, alarm : BOOL; END_VAR\n";
    let path = OWN.program(
        "beside",
        &format!(
            "{declared}c[1](s, c[1].CV > 2, 2); c[2](s, c[2].CV > 2, 9); over := c[1].CV > 2; alarm := c[2].CV > 2;"
        ),
    );
    let accept = OWN.path().join("beside.txt");
    std::fs::write(&accept, "c[1] 15: nobody reads it\nover output: it is not wired\n").expect("a file");
    let arguments = ["--accept", &accept.display().to_string()];
    let (code, text) = moved(&path, "iec", "openplc", &arguments);
    assert_eq!(code, Some(4), "{text}");
    assert!(text.contains("the effect of c[2], declared together with an accepted difference"), "{text}");
    std::fs::write(&accept, "* 15: nobody reads it\nover output: it is not wired\nalarm output: nor is this\n")
        .expect("a file");
    let (code, text) = moved(&path, "iec", "openplc", &arguments);
    assert_eq!(code, Some(0), "{text}");
}
