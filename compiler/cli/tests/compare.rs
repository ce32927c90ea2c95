//! `staunch compare`: each of the twelve traps in a small program, and what is printed of it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/compare")
}

fn run(arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.arg("compare").args(arguments.split_whitespace()).current_dir(folder()).env("NO_COLOR", "1");
    command.output().expect("the command starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// What is printed where a difference is found.
fn difference(arguments: &str) -> String {
    let output = run(arguments);
    let out = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{arguments}\n{out}{}", text(&output.stderr));
    out
}

fn trap(arguments: &str) -> String {
    let out = difference(arguments);
    let line = out.lines().find_map(|it| it.strip_prefix("Trap "));
    let number = line.and_then(|it| it.split([' ', ':']).next());
    number.unwrap_or_else(|| panic!("{arguments}: no trap\n{out}")).to_owned()
}

#[test]
fn the_twelve_traps_are_found() {
    for (arguments, expected) in [
        ("held.st --from iec --to cscape", "1"),
        ("past_preset.st --from iec --to cscape", "2"),
        ("below_zero.st --from iec --to cscape", "3"),
        ("below_zero.st --from iec --to codesys", "3"),
        ("done_drops.st --from iec --to logix", "4"),
        ("start_up.st --from iec --to logix", "5"),
        ("after_reset.st --from iec --to logix --vars parts.CV --stimulus after_reset.csv", "6"),
        ("after_reset.st --from iec --to cscape --stimulus after_reset.csv", "6"),
        ("wraps.st --from iec --to logix --vars parts.CV --stimulus wraps.csv", "7"),
        ("limit.st --from iec --to codesys", "8"),
        ("widths.st --from iec --to codesys", "8"),
        ("preset_lowered.st --from iec --to cscape", "10"),
        ("restart.st --from iec --to logix", "11"),
        ("retained.st --from iec --to cscape", "11"),
        ("retained.st --from iec --to cscape --stimulus retained.csv", "11"),
        ("feeds_itself.st --from iec --to cscape", "12"),
    ] {
        assert_eq!(trap(arguments), expected, "{arguments}\n{}", difference(arguments));
    }
}

#[test]
fn an_input_is_held_for_as_long_as_it_takes() {
    for (arguments, expected) in [
        ("held_long.st --from iec --to cscape", "1"),
        ("held_after.st --from iec --to cscape", "1"),
        ("held_full.st --from iec --to cscape --vars full", "1"),
        ("held_full.st --from iec --to cscape --vars parts.Q", "1"),
        ("waves.st --from iec --to cscape", "2"),
        ("held_together.st --from iec --to cscape", "1"),
    ] {
        assert_eq!(trap(arguments), expected, "{arguments}\n{}", difference(arguments));
    }
}

#[test]
fn a_long_trace_shows_the_scans_in_which_something_happens() {
    let out = difference("held_after.st --from iec --to cscape");
    let table = "iec and cscape differ after 53 scans:\n\
         \n\
         \x20 scan  start  sensor  parts.CV iec  parts.CV cscape\n\
         \x20    1   TRUE   FALSE             0                0\n\
         \x20    2  FALSE    TRUE             0                0\n\
         \x20    …\n\
         \x20   52  FALSE    TRUE             1                1\n\
         \x20   53  FALSE    TRUE             1                2 ◀\n";
    assert!(out.starts_with(table), "{out}");
}

#[test]
fn initial_values_are_rewritten_for_logix() {
    let out = difference("initial.st --from iec --to logix");
    assert!(out.contains("c : COUNTER := (ACC := 32766, PRE := 3, DN := TRUE);"), "{out}");
    assert!(out.contains("d : COUNTER := (CD := FALSE, ACC := 2, PRE := 3);"), "{out}");
    assert!(out.contains("e : FBD_COUNTER := (ACC := 2, DN := FALSE, CUEnable := TRUE, Reset := TRUE);"), "{out}");
    assert!(out.contains("f : COUNTER;"), "{out}");
    assert!(out.contains("again := e.CUEnable;"), "{out}");
    assert!(out.contains(" differ after "), "{out}");
}

#[test]
fn the_shortest_trace_is_a_table() {
    assert_eq!(
        difference("held.st --from iec --to cscape"),
        "iec and cscape differ after 2 scans:\n\
         \n\
         \x20 scan  sensor  parts.CV iec  parts.CV cscape\n\
         \x20    1    TRUE             1                1\n\
         \x20    2    TRUE             1                2 ◀\n\
         \n\
         Trap 1 (`parts`): CU held TRUE counts once everywhere except CSCAPE, where it counts every call.\n\
         What to do: Put an R_TRIG before the counter's input on CSCAPE; elsewhere, call the counter with pulses.\n"
    );
}

#[test]
fn names_that_change_are_lints_and_not_differences() {
    let output = run("names.st --from iec --to codesys");
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    let lints = text(&output.stderr);
    assert_eq!(lints.matches("warning[W0609]").count(), 6, "{lints}");
    assert!(lints.contains("write `RESET`, or give the inputs by position"), "{lints}");
    let few = run("names.st --from iec --to codesys --budget 20000");
    assert_eq!(few.status.code(), Some(0), "{}", text(&few.stdout));
    assert!(text(&few.stdout).starts_with("No difference between iec and codesys: "), "{}", text(&few.stdout));
    let denied = run("names.st --from iec --to codesys --budget 20000 -D W0609");
    assert_eq!(denied.status.code(), Some(1));
}

#[test]
fn one_system_does_not_differ_from_itself() {
    for dialect in ["iec", "cscape", "codesys"] {
        let output = run(&format!("held.st --from {dialect} --to {dialect} --budget 50000"));
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
    }
}

#[test]
fn what_a_system_lacks_is_said() {
    let out = difference("names.st --from iec --to cscape");
    assert!(out.contains("cannot be compared: CSCAPE rejects the program"), "{out}");
    assert!(out.contains("Use a CTU and a CTD"), "{out}");
    let out = difference("kept.st --from cscape --to iec");
    assert!(out.contains("Trap 11: ") && out.contains("Use a CTU in VAR RETAIN"), "{out}");
}

#[test]
fn a_rewritten_program_is_compared_with_the_first() {
    let out = difference("start_up.st --from iec --to logix");
    assert!(out.contains("LOGIX needs the program rewritten; compared as:"), "{out}");
    assert!(out.contains("  + parts.PRE := 3; CTU(parts, sensor);"), "{out}");
    assert!(difference("start_up.st --from iec --to logix --against rewritten.st").contains("Trap 5"));
}

#[test]
fn one_object_holds_the_trace() {
    let out = difference("held.st --from iec --to cscape --message-format json");
    assert_eq!(out.lines().count(), 1, "{out}");
    for part in [
        r#""reason":"compare","from":"iec","to":"cscape","differs":true,"trap":1"#,
        r#"{"scan":2,"event":null,"inputs":{"sensor":"TRUE"},"from":{"parts.CV":"1"},"to":{"parts.CV":"2"}}"#,
    ] {
        assert!(out.contains(part), "{out}");
    }
}

#[test]
fn a_run_gives_the_same_answer_again() {
    let arguments = "limit.st --from iec --to codesys";
    assert_eq!(difference(arguments), difference(arguments));
}
