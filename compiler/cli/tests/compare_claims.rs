//! `staunch compare` claims no more than it has shown. What each program must come to follows from the systems' rules,
//! which the test names.

use std::path::PathBuf;
use std::process::Command;

fn folder() -> PathBuf {
    let path = std::env::temp_dir().join(format!("staunch-compare-claims-{}", std::process::id()));
    std::fs::create_dir_all(&path).expect("a folder");
    path
}

/// A file of the test's own.
fn written(name: &str, text: &str) -> String {
    let path = folder().join(name);
    std::fs::write(&path, text).expect("a file");
    path.display().to_string()
}

/// The exit code, and what is printed.
fn compare(name: &str, source: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let path = written(&format!("{name}.st"), source);
    let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
    let output = command.args(["compare", &path]).args(arguments).output().expect("it starts");
    (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
}

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
    let counters = written("counters.txt", "c 15: nobody reads the count past its preset\nd 15: same\n");
    let (code, text) = compare("motor", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &counters]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Not accepted: `motor output`.") && text.contains("`motor output: reason`"), "{text}");
    let all = written("all.txt", "* 15: nobody reads the count past its preset\n* output: nobody looks\n");
    let (code, text) = compare("motor_all", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &all]);
    assert_eq!(code, Some(1), "{text}");
    let own = written("own.txt", "c 15: nobody reads it\nd 15: same\nmotor output: it is not wired\n");
    let (code, text) = compare("motor_own", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &own]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("not compared after an accepted finding: c.Q, c.CV, d.Q, d.CV, motor."), "{text}");
}

/// What `--vars` names is compared until a line names it, and so is what lies at `%Q`; a variable inside follows.
#[test]
fn what_is_named_and_what_is_wired_are_outputs() {
    let plain = MOTOR.replace("VAR_OUTPUT motor", "VAR motor");
    let counters = written("counters_of_vars.txt", "c 15: nobody reads the count past its preset\nd 15: same\n");
    let arguments = ["--from", "iec", "--to", "openplc", "--accept", counters.as_str()];
    let (code, text) = compare("inside", &plain, &arguments);
    assert_eq!(code, Some(0), "{text}");
    let (code, text) = compare("named", &plain, &[&arguments[..], &["--vars", "motor,lamp"]].concat());
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Not accepted: `motor output`."), "{text}");
    let wired = MOTOR.replace("VAR_OUTPUT motor, lamp : BOOL;", "VAR motor AT %QX0.0 : BOOL; lamp : BOOL;");
    let (code, text) = compare("wired", &wired, &arguments);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Not accepted: `motor output`."), "{text}");
}
