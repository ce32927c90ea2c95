//! `staunch compare`: each of the traps in a small program, what is printed of it, and the exit codes.

use super::programs::{Folder, command};
use std::path::{Path, PathBuf};
use std::process::Output;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/compare")
}

fn run(arguments: &str) -> Output {
    let mut command = command();
    command.args(arguments.split_whitespace()).current_dir(folder());
    if !arguments.contains("--budget") {
        // Tests are built without optimisation; what they look for is found soon.
        command.args(["--budget", "1000000"]);
    }
    command.output().expect("the command starts")
}

/// Of programs in the folder, where the project decides what CODESYS leaves open.
fn decided(arguments: &str) -> Output {
    let folder = Folder("decided").path();
    static WRITTEN: std::sync::Once = std::sync::Once::new();
    WRITTEN.call_once(|| {
        std::fs::write(folder.join("staunch.toml"), "ctu-stop-at-pv = false\n").expect("a project file");
        for name in ["names.st", "no_run.txt"] {
            std::fs::copy(self::folder().join(name), folder.join(name)).expect("a copy");
        }
    });
    command().args(arguments.split_whitespace()).current_dir(folder).output().expect("the command starts")
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
fn the_traps_are_found() {
    for (arguments, expected) in [
        ("held.st --from iec --to cscape", "1"),
        ("past_preset.st --from iec --to cscape", "2"),
        ("below_zero.st --from iec --to cscape", "3"),
        ("below_zero.st --from iec --to codesys", "3"),
        // The port asks for `ACC <= 0` in place of Q; with DN in its place, as it is compared here, the flag turns round.
        ("done_drops.st --from iec --to logix --vars stock.Q", "4"),
        ("done_drops.st --from iec --to logix", "5"),
        ("start_up.st --from iec --to logix", "5"),
        ("after_reset.st --from iec --to logix --vars parts.CV --stimulus after_reset.csv", "6"),
        ("after_reset.st --from iec --to cscape --stimulus after_reset.csv", "6"),
        ("wraps.st --from iec --to logix --vars parts.CV --stimulus wraps.csv", "7"),
        ("limit.st --from iec --to codesys --assume no_run.txt", "8"),
        ("widths.st --from iec --to codesys --assume no_run.txt", "8"),
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
        ("held_together.st --from iec --to cscape --budget 8000000", "1"),
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
    let out = difference("held.st --from iec --to cscape");
    let table = "iec and cscape differ after 2 scans:\n\
         \n\
         \x20 scan  sensor  parts.CV iec  parts.CV cscape\n\
         \x20    1    TRUE             1                1\n\
         \x20    2    TRUE             1                2 ◀\n\
         \x20 no shorter sequence of these inputs makes a difference\n\
         \n\
         Trap 1 (`parts`): CU held TRUE counts once everywhere except CSCAPE, where it counts every call.\n\
         What to do: Feed the counter from an R_TRIG: `e(CLK := sensor); c(CU := e.Q, …)`.\n";
    assert!(out.starts_with(table), "{out}");
}

#[test]
fn names_that_change_are_lints_and_not_differences() {
    let output = run("names.st --from iec --to codesys");
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    let lints = text(&output.stderr);
    assert_eq!(lints.matches("warning[W0609]").count(), 6, "{lints}");
    assert!(lints.contains("write `RESET`, or give the inputs by position"), "{lints}");
    let few = decided("names.st --from iec --to codesys --assume no_run.txt --budget 2000");
    assert_eq!(few.status.code(), Some(4), "{}", text(&few.stdout));
    let denied = decided("names.st --from iec --to codesys --assume no_run.txt --budget 2000 -D W0609");
    assert_eq!(denied.status.code(), Some(1));
}

#[test]
fn what_is_not_found_is_not_ruled_out() {
    let output = decided("names.st --from iec --to codesys --assume no_run.txt --budget 2000");
    let out = text(&output.stdout);
    assert_eq!(output.status.code(), Some(4), "{out}");
    assert!(
        out.starts_with("No difference between iec and codesys was found, and none is ruled out.\nTried: "),
        "{out}"
    );
    assert!(out.contains("Not tried: longer sequences; a larger --budget tries more of them.\n"), "{out}");
    let object = text(
        &decided("names.st --from iec --to codesys --assume no_run.txt --budget 2000 --message-format json").stdout,
    );
    let last = object.lines().last().unwrap_or_default();
    assert!(last.contains(r#""reason":"compare","from":"iec","to":"codesys","verdict":"not found""#), "{object}");
}

#[test]
fn a_system_has_the_name_that_it_is_asked_for_by() {
    let source =
        "PROGRAM Main VAR_INPUT up : BOOL; END_VAR VAR n : INT; END_VAR IF up THEN n := n + 1; END_IF END_PROGRAM";
    let (path, copy) = (written("asked", source), written("asked_copy", source));
    let out = run(&format!("{} --from TwinCAT --to codesys --against {}", path.display(), copy.display()));
    assert!(text(&out.stdout).starts_with("twincat and codesys are equal"), "{}", text(&out.stdout));
}

/// A comparison of a program with itself would always end well.
#[test]
fn a_program_is_not_compared_with_itself() {
    for (from, to, why) in [
        ("iec", "iec", "--from and --to are both `iec`: the program would be compared with itself"),
        ("twincat", "codesys", "`twincat` and `codesys` are one system: the program would be compared with itself"),
        ("iec", "iec --against held.st", "--against is the program itself"),
    ] {
        let output = run(&format!("held.st --from {from} --to {to}"));
        assert_eq!(output.status.code(), Some(2), "{from} {to}");
        assert!(text(&output.stderr).contains(why), "{}", text(&output.stderr));
    }
    let source = std::fs::read_to_string(folder().join("held.st")).expect("it is there");
    let copy = written("held_copy.st", &source);
    let output = run(&format!("held.st --from iec --to iec --against {}", copy.display()));
    assert_eq!(output.status.code(), Some(0));
    let out = text(&output.stdout);
    assert!(out.starts_with("iec and iec are equal: every reachable state was seen"), "{out}");
}

/// What nothing calls has no trap, seen or not; what is called by a reference or a parameter is no such thing.
#[test]
fn a_counter_that_is_never_called_says_so() {
    let path = written(
        "never_called.st",
        "FUNCTION_BLOCK F VAR_IN_OUT k : CTU; END_VAR VAR_INPUT on : BOOL; END_VAR k(on, FALSE, 1); END_FUNCTION_BLOCK
PROGRAM p
VAR_INPUT a, b : DINT; END_VAR
VAR idle, lent, referred : CTU; f : F; r : REF_TO CTU; n : INT; END_VAR
f(k := lent, on := a * b > 7); r := REF(referred); r^(a * a > 8, FALSE, 2); n := idle.CV;
END_PROGRAM
",
    );
    let out = text(&run(&format!("{} --from iec --to cscape --budget 2000", path.display())).stdout);
    assert_eq!(out.matches("it is never called").count(), 1, "{out}");
    assert!(
        out.contains(
            "`idle`\n  impossible: trap 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 17, 18, 20: it is never"
        ),
        "{out}"
    );
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
fn an_object_for_each_finding_and_one_for_the_verdict() {
    let out = difference("held.st --from iec --to cscape --message-format json");
    let last = out.lines().last().unwrap_or_default();
    for part in [
        r#""reason":"compare","from":"iec","to":"cscape","verdict":"different""#,
        r#""trap":1,"#,
        r#"{"scan":2,"event":null,"inputs":{"sensor":"TRUE"},"from":{"parts.CV":"1"},"to":{"parts.CV":"2"}}"#,
        r#""stimulus":"scan,sensor\n1,TRUE\n2,TRUE\n""#,
    ] {
        assert!(last.contains(part), "{part}\n{out}");
    }
    let finding = out.lines().find(|it| it.contains(r#""counter":"parts","trap":1,"#)).unwrap_or_default();
    assert!(finding.contains(r#""verdict":"reachable","scans":2,"stimulus":"scan,sensor\n1,TRUE\n2,TRUE\n""#), "{out}");
    let ruled_out = out.lines().find(|it| it.contains(r#""trap":4,"#)).unwrap_or_default();
    assert!(ruled_out.contains(r#""verdict":"impossible""#), "{out}");
}

#[test]
fn a_run_gives_the_same_answer_again() {
    let arguments = "limit.st --from iec --to codesys";
    assert_eq!(difference(arguments), difference(arguments));
}

/// A program in a folder of the test's own.
fn written(name: &str, source: &str) -> PathBuf {
    Folder("traps").written(name, source).into()
}

#[test]
fn shared_bits_have_the_names_of_their_variables() {
    let path = written(
        "shared_bits.st",
        "TYPE Probe : STRUCT n : INT; ok : BOOL; END_STRUCT; END_TYPE
PROGRAM Main
VAR probe AT %IW0 : Probe; raw AT %IW0 : UINT; q AT %QW0 : Probe; low AT %QB0 : BYTE; c : CTU; END_VAR
c(CU := probe.ok, PV := 3);
q := probe;
q.n := q.n + c.CV;
IF c.Q THEN low := 0; END_IF
END_PROGRAM
",
    );
    let assumed = written("shared_bits.txt", "probe.n 2..5\n");
    let assume = format!("--assume {} --all-inputs", assumed.display());
    let out = run(&format!("{} --from iec --to codesys {assume}", path.display()));
    let out = text(&out.stdout);
    assert!(!out.contains("bits_of"), "{out}");
    assert!(out.contains("scan  @event  probe.n  probe.ok  c.CV iec  c.CV codesys  q.n iec  q.n codesys"), "{out}");
    assert!(out.contains("assumed: probe.n 2..5"), "{out}");
    let moved = text(&run(&format!("{} --from iec --to logix", path.display())).stdout);
    assert!(moved.contains("shared_bits.st:3: LOGIX has no BYTE (`low`)") && !moved.contains("bits_of"), "{moved}");
}

#[test]
fn members_of_a_union_are_inputs_by_their_names() {
    let path = written(
        "union_input.st",
        "TYPE Both : STRUCT OVERLAP w AT %B0 : WORD; b AT %X0.0 : BOOL; END_STRUCT; END_TYPE
PROGRAM Main
VAR_INPUT both : Both; END_VAR
VAR c : CTU; END_VAR
c(CU := both.b, PV := 3);
END_PROGRAM
",
    );
    let out = text(&run(&format!("{} --from iec --to codesys", path.display())).stdout);
    assert!(out.contains("scan  @event  both.w  c.CV iec  c.CV codesys"), "{out}");
}

#[test]
fn what_the_other_system_rejects_is_said_of_the_users_own_text() {
    let path = written(
        "word_preset.st",
        "PROGRAM p\nVAR_INPUT s : BOOL; target : WORD; END_VAR\nVAR c : CTU; END_VAR\n\
         c(CU := s, RESET := FALSE, PV := target);\nEND_PROGRAM\n",
    );
    let output = run(&format!("{} --from codesys --to logix", path.display()));
    let err = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.contains("word_preset.st:4:"), "{err}");
    assert!(err.contains("c(CU := s, RESET := FALSE, PV := target);") && !err.contains("c.PRE := target"), "{err}");
}

#[test]
fn what_the_other_system_has_not_is_said_at_its_declaration() {
    let path = written(
        "hours.st",
        "PROGRAM p\nVAR_INPUT run : BOOL; END_VAR\nVAR tick : TON; c : CTU; END_VAR\n\
         tick(IN := run AND NOT tick.Q, PT := T#300ms);\nc(CU := tick.Q, R := FALSE, PV := 60);\nEND_PROGRAM\n",
    );
    let out = difference(&format!("{} --from iec --to logix", path.display()));
    assert!(out.contains("hours.st:3: LOGIX has no TON (`tick`): there it is TONR with an FBD_TIMER"), "{out}");
    // Logix keeps every tag over a power cycle, so that the timer goes on there.
    assert!(out.contains("iec and logix differ after 2 scans:") && out.contains("Trap 11: Restart"), "{out}");
}

#[test]
fn a_file_or_a_name_that_fixes_its_system_is_not_compared_with_itself() {
    let pragma =
        written("fixed.st", "{dialect 'codesys'}\nPROGRAM p\nVAR x : BOOL; END_VAR\nx := TRUE;\nEND_PROGRAM\n");
    let output = run(&format!("{} --from iec --to cscape", pragma.display()));
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("fixed.st:1: the file is of the dialect `codesys`, and --from says `iec`"));
    let name = written(
        "qualified.st",
        "PROGRAM p\nVAR c : ARRAY[1..2] OF CODESYS.CTU; END_VAR\nc[1](CU := TRUE);\nEND_PROGRAM\n",
    );
    let output = run(&format!("{} --from codesys --to iec", name.display()));
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert!(text(&output.stderr).contains("qualified.st:2: `CODESYS.CTU` is CODESYS's on every system"));
}

/// A difference that needs a sequence of inputs, constants of the program, and depth.
const BATCH: &str = "PROGRAM p\nVAR_INPUT start, item : BOOL; recipe, level : INT; END_VAR\n\
     VAR_OUTPUT over : BOOL; END_VAR\nVAR on : BOOL; c : CTU; e : R_TRIG; END_VAR\n\
     IF start AND recipe = 417 THEN on := TRUE; END_IF\n\
     e(CLK := item AND on AND level > 80);\nc(e.Q, FALSE, 120);\nIF c.CV > 120 THEN over := TRUE; END_IF\nEND_PROGRAM\n";

#[test]
fn a_trace_replays_as_a_stimulus_under_both() {
    let path = written("batch.st", BATCH);
    let saved = written("batch.csv", "");
    let arguments = format!("{} --from iec --to cscape --vars over", path.display());
    let out = difference(&format!("{arguments} --save-stimulus {}", saved.display()));
    assert!(out.contains("iec and cscape differ after 241 scans:") && out.contains("Trap 2 (`c`)"), "{out}");
    let again = difference(&format!("{arguments} --stimulus {}", saved.display()));
    assert!(again.contains("iec and cscape differ after 241 scans:"), "{again}");
    let short = run(&format!("{arguments} --stimulus {} --scans 240", saved.display()));
    assert_eq!(short.status.code(), Some(4), "{}", text(&short.stdout));
}

#[test]
fn tasks_keep_their_intervals_in_a_trace() {
    let path = written(
        "tasks.st",
        "PROGRAM A VAR_INPUT x : BOOL; END_VAR VAR c : CTU; END_VAR c(CU := x, PV := 30); END_PROGRAM\n\
         CONFIGURATION k RESOURCE r ON plc TASK fast(INTERVAL := T#10ms, PRIORITY := 1);\n\
         TASK slow(INTERVAL := T#70ms, PRIORITY := 2); PROGRAM p1 WITH fast : A; PROGRAM p2 WITH slow : A;\n\
         END_RESOURCE END_CONFIGURATION\n",
    );
    let saved = written("tasks.csv", "");
    let arguments = format!("{} --from iec --to cscape --vars p2.c", path.display());
    let out = difference(&format!("{arguments} --save-stimulus {}", saved.display()));
    // The slow program runs for the second time in the eighth scan.
    assert!(out.contains("iec and cscape differ after 8 scans:"), "{out}");
    assert!(difference(&format!("{arguments} --stimulus {}", saved.display())).contains("after 8 scans:"));
}

#[test]
fn assumptions_bound_what_is_tried() {
    let path = written(
        "assumed.st",
        "PROGRAM p\nVAR_INPUT item, gate : BOOL; END_VAR\nVAR full : BOOL; c : CTU; END_VAR\n\
         c(item AND gate AND NOT full, FALSE, 3); full := c.Q;\nEND_PROGRAM\n",
    );
    let arguments = format!("{} --from iec --to cscape --vars full", path.display());
    assert!(difference(&arguments).contains("differ after 3 scans"));
    let never = written("never.txt", "not (item and gate)\n");
    let output = run(&format!("{arguments} --assume {}", never.display()));
    let out = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{out}");
    assert!(
        out.contains("are equal: every reachable state was seen") && out.contains("assumed: not (item and gate)"),
        "{out}"
    );
    let slow = written("slow.txt", "item for at least 2 scans\ngate for at least 4 scans\n");
    assert!(difference(&format!("{arguments} --assume {}", slow.display())).contains("differ after 3 scans"));
    let wrong = written("wrong.txt", "item for ever\n");
    let output = run(&format!("{arguments} --assume {}", wrong.display()));
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("wrong.txt:1: `for` is not expected here"), "{}", text(&output.stderr));
}

/// A trace may be made simpler by the values that inputs hold before they are given, which the plant may never give.
#[test]
fn a_trace_keeps_to_the_assumptions_from_its_first_scan_on() {
    let path = written(
        "assumed_first.st",
        "PROGRAM p\nVAR_INPUT item : BOOL; target : INT; END_VAR\nVAR full : BOOL; n : INT; c : CTU; END_VAR\n\
         c(NOT item, FALSE, 3); full := c.Q; n := target;\nEND_PROGRAM\n",
    );
    let (assumed, saved) = (written("first.txt", "target 2..500\n"), written("first.csv", ""));
    let arguments =
        format!("{} --from iec --to cscape --vars full --save-stimulus {}", path.display(), saved.display());
    let stimulus = |more: &str| {
        assert!(difference(&format!("{arguments}{more}")).contains("differ after 3 scans"));
        std::fs::read_to_string(&saved).expect("a stimulus")
    };
    assert_eq!(stimulus(""), "scan,item,target\n1,FALSE,0\n3,FALSE,0\n");
    assert_eq!(stimulus(&format!(" --assume {}", assumed.display())), "scan,item,target\n1,FALSE,2\n3,FALSE,2\n");
}

/// CODESYS keeps every variable over STOP -> RUN; IEC keeps what is RETAIN over both events.
#[test]
fn what_only_stop_to_run_keeps_is_found() {
    let latch = |section: &str| {
        format!("PROGRAM p\nVAR_INPUT on : BOOL; END_VAR\n{section} n : BOOL; END_VAR\nn := n OR on;\nEND_PROGRAM\n")
    };
    let path = written("latch.st", &latch("VAR"));
    let saved = written("latch.csv", "");
    let arguments = format!("{} --from iec --to codesys", path.display());
    let table = "iec and codesys differ after 2 scans:\n\
         \n\
         \x20 scan  @event     on  n iec  n codesys\n\
         \x20    1           TRUE   TRUE       TRUE\n\
         \x20    2     run  FALSE  FALSE       TRUE ◀\n";
    let out = difference(&format!("{arguments} --save-stimulus {}", saved.display()));
    assert!(out.starts_with(table) && out.contains("Trap 11 (`n`): Restart"), "{out}");
    assert_eq!(std::fs::read_to_string(&saved).expect("it is saved"), "scan,on,@event\n1,TRUE,\n2,FALSE,run\n");
    let again = difference(&format!("{arguments} --stimulus {}", saved.display()));
    assert!(again.contains("     2     run  FALSE  FALSE       TRUE ◀"), "{again}");
    let object = difference(&format!("{arguments} --message-format json"));
    assert!(
        object.contains(r#"{"scan":2,"event":"run","inputs":{"on":"FALSE"},"from":{"n":"FALSE"},"to":{"n":"TRUE"}}"#)
    );
    let never = run(&format!("{arguments} --assume no_run.txt"));
    assert_eq!(never.status.code(), Some(0), "{}", text(&never.stdout));
    assert!(text(&never.stdout).contains("assumed: no run"), "{}", text(&never.stdout));
    let retained = written("latch_retained.st", &latch("VAR RETAIN"));
    let alike = run(&format!("{} --from iec --to codesys", retained.display()));
    assert_eq!(alike.status.code(), Some(0), "{}", text(&alike.stdout));
    let wrong = written("no_such_event.txt", "no rain\n");
    let output = run(&format!("{arguments} --assume {}", wrong.display()));
    assert!(
        text(&output.stderr).contains(":1: `rain` is no event; they are restart, run, reset"),
        "{}",
        text(&output.stderr)
    );
}

/// A stimulus names its own events.
#[test]
fn the_events_of_a_stimulus_are_told_apart() {
    let path = written(
        "events.st",
        "PROGRAM p\nVAR_INPUT x : BOOL; END_VAR\nVAR c : CTU; END_VAR\nc(x, FALSE, 30000);\nEND_PROGRAM\n",
    );
    let stimulus =
        written("events.csv", "scan,x,@event\n1,FALSE,\n2,FALSE,restart\n3,FALSE,reset\n4,TRUE,\n5,FALSE,run\n");
    let out =
        difference(&format!("{} --from iec --to codesys --stimulus {} --trace", path.display(), stimulus.display()));
    for row in ["     2  restart", "     3    reset", "     5      run"] {
        assert!(out.contains(row), "{row}\n{out}");
    }
}

#[test]
fn both_systems_are_drawn_one_above_the_other() {
    let picture = written("held.svg", "");
    let out = difference(&format!("held.st --from iec --to cscape --trace {}", picture.display()));
    assert!(out.contains("differ after 2 scans"), "{out}");
    let svg = std::fs::read_to_string(&picture).expect("it is drawn");
    assert_eq!((svg.matches("<svg ").count(), svg.matches("</svg>").count()), (3, 3), "{svg}");
    let at = |text: &str| svg.find(text).unwrap_or_else(|| panic!("no {text}\n{svg}"));
    assert!(at(">iec</text>") < at(">cscape</text>"));
    // The count rises to 2 on one system alone, and the input does not change.
    let lanes = |part: &str| part.matches(">parts.CV</text>").count();
    let (iec, cscape) = svg.split_at(at(">cscape</text>"));
    assert_eq!((lanes(iec), lanes(cscape)), (0, 1), "{svg}");
    assert!(iec.contains("parts.CV = 1"), "{svg}");
    // A source may follow the flag.
    let all = difference("--trace held.st --from iec --to cscape");
    assert!(all.contains("     1    TRUE             1                1"), "{all}");
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
    assert!(said.contains("stale.txt:3: trap 4 of `parts` is accepted, and is impossible: "), "{said}");
    let one = written("one.txt", "parts 2: nobody reads the count\n");
    let some = difference(&format!("held.st --from iec --to cscape --accept {}", one.display()));
    assert!(some.contains("\nNot accepted: `parts 1`.\n"), "{some}");
    assert!(!out.contains("Not accepted"), "{out}");
}

#[test]
fn what_is_written_is_the_other_systems() {
    let folder = written(
        "write.st",
        "{dialect 'iec'}\nPROGRAM p VAR_INPUT s : BOOL; END_VAR VAR c : CTU; END_VAR c(s, FALSE, 3); END_PROGRAM\n",
    );
    let target = folder.with_file_name("write_logix.st");
    let _ = std::fs::remove_file(&target);
    run(&format!("{} --from iec --to logix --write {} --budget 2000", folder.display(), target.display()));
    let text_written = std::fs::read_to_string(&target).expect("it is written");
    assert!(text_written.starts_with("{dialect 'logix'}"), "{text_written}");
    let of_user = run(&format!("held.st --from iec --to cscape --against held.st --write {}", target.display()));
    assert_eq!(of_user.status.code(), Some(2), "{}", text(&of_user.stderr));
}

fn check(dialect: &str, path: &Path) -> Output {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.args(["check", "--dialect", dialect]).arg(path).output().expect("the command starts")
}

/// The program as it is written for another system; `None` where nothing is.
fn migrated(source: &Path, to: &str) -> Option<String> {
    let target = source.with_extension(format!("{to}.out"));
    let _ = std::fs::remove_file(&target);
    run(&format!("{} --from iec --to {to} --write {} --budget 2000", source.display(), target.display()));
    let found = std::fs::read_to_string(&target).ok()?;
    let checked = check(to, &target);
    assert_eq!(checked.status.code(), Some(0), "{to}: {found}{}", text(&checked.stderr));
    Some(found)
}

#[test]
fn pins_have_the_other_systems_names_in_what_is_written() {
    let source = written(
        "write_pins.st",
        "{dialect := 'iec'}\nFUNCTION_BLOCK F VAR_INPUT a : BOOL; END_VAR VAR c : ARRAY[1..2] OF CTU; d : CTD; END_VAR\n\
         c[1](CU := a, R := c[1].Q, PV := 3); c[2](CU := a, (* R := *) R := FALSE, PV := 4);\n\
         d(CD := a, LD := c[2].R, PV := 3);\nEND_FUNCTION_BLOCK\n\
         PROGRAM p VAR_INPUT a : BOOL; END_VAR VAR f, g : F; END_VAR f(a := a); g(a := NOT a); END_PROGRAM\n",
    );
    for (to, load) in [("cscape", "LOAD := c[2].RESET"), ("codesys", "LOAD := c[2].RESET"), ("openplc", "LD := c[2].R")]
    {
        let found = migrated(&source, to).expect("it is written");
        assert!(found.starts_with(&format!("{{dialect '{to}'}}")) && found.contains(load), "{found}");
        assert!(found.contains("(* R := *)"), "{found}");
    }
    assert_eq!(migrated(&source, "logix"), None, "a COUNTER has no reset to read");
    let by_count = written(
        "write_by_count.st",
        "PROGRAM p VAR_INPUT a : BOOL; END_VAR VAR c : ARRAY[0..1] OF CTU; END_VAR\n\
         c[c[0].CV MOD 2](CU := a, R := FALSE, PV := 3);\nEND_PROGRAM\n",
    );
    assert_eq!(migrated(&by_count, "logix"), None, "counting moves the index");
}

#[test]
fn counters_in_arrays_and_structures_are_written_for_logix() {
    let source = written(
        "write_parts.st",
        "TYPE Cell : STRUCT k : CTU := (PV := 2); v : INT; END_STRUCT Pairs : ARRAY[0..1] OF CTU; END_TYPE\n\
         FUNCTION_BLOCK F VAR_OUTPUT c : CTD; END_VAR c(CD := TRUE, LD := FALSE, PV := 1); END_FUNCTION_BLOCK\n\
         PROGRAM p VAR_INPUT a, b : BOOL; END_VAR\n\
         VAR n : ARRAY[0..1] OF CTU := [(PV := 5), (PV := 6, CU := FALSE)]; m : Pairs; s : Cell; t : ARRAY[1..2, 0..1] OF Cell;\n\
         f : F; i, x : INT; full : BOOL; END_VAR\n\
         FOR i := 0 TO 1 DO n[i](CU := a, R := b); m[i](CU := a, R := FALSE, PV := 3, CV => x); END_FOR\n\
         s.k(CU := a, R := t[1, 0].k.Q); t[2, x MOD 2].k(CU := m[s.k.CV MOD 2].Q, R := b, PV := 4);\n\
         f(); full := n[0].Q AND f.c.Q AND s.k.CV = n[1].CV;\nEND_PROGRAM\n",
    );
    let found = migrated(&source, "logix").expect("it is written");
    for line in [
        "STRUCT k : COUNTER := (PRE := 2);",
        "Pairs : ARRAY[0..1] OF COUNTER;",
        "n : ARRAY[0..1] OF COUNTER := [(PRE := 5), (PRE := 6, CU := FALSE)]; m : Pairs; s : Cell;",
        "CTU(n[i], a); RES(n[i], b); m[i].PRE := 3;",
        "RES(s.k, t[1, 0].k.DN)",
        "CTU(t[2, x MOD 2].k, m[DINT_TO_INT(s.k.ACC) MOD 2].DN)",
        "full := n[0].DN AND (f.c.ACC <= 0) AND s.k.ACC = n[1].ACC;",
    ] {
        assert!(found.contains(line), "{line}\n{found}");
    }
}

#[test]
fn what_cannot_be_rewritten_is_refused_with_a_way_that_is_accepted() {
    let wide = |name: &str, ty: &str| {
        written(
            name,
            &format!(
                "PROGRAM p VAR_INPUT a : BOOL; END_VAR VAR c : {ty}; END_VAR c(CU := a, R := FALSE, PV := 3); END_PROGRAM\n"
            ),
        )
    };
    let source = wide("write_wide.st", "CTU_ULINT");
    let refused = run(&format!("{} --from iec --to logix", source.display()));
    let help = "in a program for `logix`, which `--against` compares with this one, name the family: `IEC.CTU_ULINT`";
    assert!(text(&refused.stderr).contains(help), "{}", text(&refused.stderr));
    let named = wide("write_named.st", "IEC.CTU_ULINT");
    let equal = run(&format!(
        "{} --from iec --to logix --against {} --vars c.CV --budget 2000",
        source.display(),
        named.display()
    ));
    assert_ne!(equal.status.code(), Some(2), "{}", text(&equal.stderr));
    let fixed = run(&format!("{} --from iec --to logix", named.display()));
    assert_eq!(fixed.status.code(), Some(2), "{}", text(&fixed.stderr));
}

#[test]
fn what_a_variable_holds_that_nothing_writes_is_tried() {
    let held = [
        ("plain", "", "k : INT := 4321;", "t = k"),
        ("element", "", "k : ARRAY[1..3] OF INT := [17, 4321, 9]; i : INT := 2;", "t = k[i]"),
        ("member", "TYPE L : STRUCT high : INT := 4321; END_STRUCT END_TYPE", "k : L;", "t = k.high"),
        (
            "instance",
            "FUNCTION_BLOCK F VAR_INPUT t : INT; END_VAR VAR_OUTPUT is : BOOL; END_VAR VAR k : INT; END_VAR is := t = k; END_FUNCTION_BLOCK",
            "f : F := (k := 4321);",
            "f.is",
        ),
    ];
    for (name, types, variable, condition) in held {
        let call = if name == "instance" { "f(t := t);" } else { "" };
        let path = written(
            &format!("held_{name}.st"),
            &format!(
                "{types}\nPROGRAM p VAR_INPUT s : BOOL; t : INT; END_VAR VAR c : CTU; {variable} END_VAR VAR_OUTPUT o : BOOL; END_VAR\n\
                 {call} IF {condition} THEN c(s, FALSE, 1); END_IF o := c.CV > 1;\nEND_PROGRAM\n"
            ),
        );
        let out = difference(&format!("{} --from iec --to cscape --vars o -A warnings", path.display()));
        assert!(out.starts_with("iec and cscape differ after 3 scans:") && out.contains("4321"), "{name}: {out}");
    }
}

/// IEC counts past the preset, OPENPLC does not: seen where the two parts of `condition` come in turn.
fn counts_while(name: &str, variables: &str, condition: &str) -> PathBuf {
    let source = format!(
        "PROGRAM p\n{variables}\nVAR_OUTPUT o : BOOL; END_VAR\nVAR c : CTU; END_VAR\n\
         c({condition}, FALSE, 1); o := c.CV > 1;\nEND_PROGRAM\n"
    );
    written(&format!("{name}.st"), &source)
}

#[test]
fn what_decides_is_among_the_values_that_are_tried() {
    let programs = [
        ("large", "VAR_INPUT a : ULINT; END_VAR", "a > 18446744073709551610 AND a < 18446744073709551612"),
        ("lent", "VAR_INPUT a : INT; END_VAR VAR r : REF_TO INT; END_VAR r := REF(a);", "r^ = 1717"),
        ("scaled", "VAR_INPUT a : INT; END_VAR VAR l : INT; END_VAR l := a / 10;", "l = 35"),
        ("twice", "VAR_INPUT a : INT; END_VAR VAR k, l : INT; END_VAR k := a - 40; l := k * 3;", "l = 300"),
        (
            "real",
            "VAR_INPUT a : INT; END_VAR VAR l : REAL; END_VAR l := INT_TO_REAL(a) / 276.48;",
            "l > 40.0 AND l < 60.0",
        ),
        ("bits", "VAR_INPUT a : WORD; END_VAR", "a.3 AND NOT a.5 AND a.9"),
        ("remainder", "VAR_INPUT a : INT; END_VAR", "a MOD 97 = 13 AND a > 5000"),
        // What nothing writes, though it starts at zero or is retained, is written from outside.
        ("unwritten", "VAR_INPUT a : BOOL; END_VAR VAR able : BOOL; END_VAR", "a AND able"),
        ("memory", "VAR_INPUT a : BOOL; END_VAR VAR able AT %MX0.0 : BOOL; END_VAR", "a AND able"),
        ("setpoint", "VAR_INPUT a : BOOL; END_VAR VAR RETAIN n : INT := 5; END_VAR", "a AND n = 3"),
    ];
    for (name, variables, condition) in programs {
        let declared = variables.replacen(" END_VAR r :=", " END_VAR\nr :=", 1);
        let (variables, statements) = match declared.rfind("END_VAR") {
            Some(at) => declared.split_at(at + "END_VAR".len()),
            None => (declared.as_str(), ""),
        };
        let path = written(
            &format!("decides_{name}.st"),
            &format!(
                "PROGRAM p\n{variables}\nVAR_OUTPUT o : BOOL; END_VAR\nVAR c : CTU; END_VAR\n{statements}\n\
                 c({condition}, FALSE, 1); o := c.CV > 1;\nEND_PROGRAM\n"
            ),
        );
        let out = difference(&format!("{} --from iec --to openplc --vars o -A warnings", path.display()));
        assert!(out.starts_with("iec and openplc differ after "), "{name}: {out}");
        // What was drawn by chance is not said to be the shortest.
        let drawn = ["bits", "remainder"].contains(&name);
        assert!(!drawn || !out.contains("no shorter sequence"), "{name}: {out}");
    }
}

#[test]
fn what_the_world_outside_writes_is_told_apart_by_variable() {
    let panel =
        "TYPE Panel : STRUCT start : BOOL; lamp : BOOL; END_STRUCT END_TYPE\nVAR_GLOBAL one, two : Panel; END_VAR\n";
    let recipe = "TYPE Recipe : STRUCT n : INT; on : BOOL; END_STRUCT END_TYPE\n";
    let programs = [
        // Of two panels the program writes one.
        ("members", panel, "", "IF s THEN one.start := FALSE; END_IF", "c(s AND two.start, FALSE, 1); o := c.CV > 1;"),
        // What is written as a whole is no input.
        ("whole", recipe, "rec : Recipe;", "", "o := cur.on; c(s, c.CV > 1, 1); IF c.CV > 1 THEN cur := rec; END_IF"),
    ];
    for (name, types, input, first, last) in programs {
        let source = format!(
            "{types}PROGRAM p VAR_INPUT s : BOOL; {input} END_VAR VAR c : CTU; {} END_VAR VAR_OUTPUT o : BOOL; END_VAR\n\
             {first} {last}\nEND_PROGRAM\n",
            if name == "whole" { "cur : Recipe;" } else { "" }
        );
        let path = written(&format!("outside_{name}.st"), &source);
        let out = difference(&format!("{} --from iec --to openplc --vars o -A warnings", path.display()));
        let scans = if name == "whole" { 4 } else { 3 };
        assert!(out.starts_with(&format!("iec and openplc differ after {scans} scans:")), "{name}: {out}");
    }
    // A command that the program takes back, and a text.
    let globals = "VAR_GLOBAL reset : BOOL; END_VAR\n";
    let body = "c(s AND reset, FALSE, 1); o := c.CV > 1; IF reset AND s THEN reset := FALSE; END_IF";
    let program = |variables: &str, body: &str| {
        format!(
            "PROGRAM p VAR_INPUT s : BOOL; END_VAR VAR c : CTU; {variables} END_VAR VAR_OUTPUT o : BOOL; END_VAR\n{body}\nEND_PROGRAM\n"
        )
    };
    let path = written("outside_taken_back.st", &format!("{globals}{}", program("", body)));
    let arguments = format!("{} --from iec --to openplc --vars o -A warnings", path.display());
    let out = text(&run(&arguments).stdout);
    assert!(
        out.contains("under every value of the inputs (s); nothing else is taken to be written from outside"),
        "{out}"
    );
    let assumed = written("outside.txt", "input reset\n");
    let out = difference(&format!("{arguments} --assume {}", assumed.display()));
    assert!(out.starts_with("iec and openplc differ after 3 scans:"), "{out}");
    // The table has what is given, not what the program leaves of it.
    assert!(out.lines().any(|it| it.split_whitespace().take(3).eq(["1", "TRUE", "TRUE"])), "{out}");
    let stimulus = written("outside_taken_back.csv", "scan,s,reset\n1,TRUE,TRUE\n2,FALSE,FALSE\n3,TRUE,TRUE\n");
    let out = difference(&format!("{arguments} --stimulus {}", stimulus.display()));
    assert!(out.lines().any(|it| it.split_whitespace().take(3).eq(["1", "TRUE", "TRUE"])), "{out}");
    let path = written("outside_text.st", &program("mode : STRING;", "c(s AND mode = 'GO', FALSE, 1); o := c.CV > 1;"));
    let out = difference(&format!("{} --from iec --to openplc --vars o -A warnings", path.display()));
    assert!(out.starts_with("iec and openplc differ after 3 scans:"), "{out}");
}

#[test]
fn what_one_program_alone_reads_of_the_outside_is_an_input() {
    let program = |name: &str, last: &str| {
        let source = format!(
            "VAR_GLOBAL block : BOOL; END_VAR\nPROGRAM p VAR_INPUT s : BOOL; END_VAR VAR c : CTU; END_VAR VAR_OUTPUT o : BOOL; END_VAR\n\
             c(s, FALSE, 3); o := c.Q{last};\nEND_PROGRAM\n"
        );
        written(name, &source)
    };
    let (one, other) = (program("with_block.st", " AND NOT block"), program("without_block.st", ""));
    let arguments = format!("{} --from iec --to iec --against {} -A warnings", one.display(), other.display());
    assert!(difference(&arguments).starts_with("iec and iec differ after 5 scans:"));
}

#[test]
fn what_keeps_its_value_is_said_and_an_assumption_makes_it_an_input() {
    let path = counts_while("kept_at", "VAR_INPUT a : BOOL; END_VAR VAR n : INT := 5; END_VAR", "a AND n = 3");
    let arguments = format!("{} --from iec --to openplc --vars o -A warnings", path.display());
    let output = run(&arguments);
    let out = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{out}");
    assert!(out.contains("nothing writes n (5), and the initial value was all that was tried"), "{out}");
    let free = written("free.txt", "n 1..4   # the panel's\n");
    let out = difference(&format!("{arguments} --assume {}", free.display()));
    assert!(out.starts_with("iec and openplc differ after 3 scans:"), "{out}");
}

#[test]
fn assumptions_have_values_of_every_type_and_values_around_them_are_tried() {
    let all = "VAR_INPUT s : BOOL; n : INT; r : REAL; t : TIME; m : (Off, Fill, Drain); END_VAR";
    let programs = [
        ("n > 50", "not s or n = 75", 3),
        ("n > 50", "n > 60 and n < 100", 3),
        ("r > 50.0", "r 0.5..50.0", 0),
        ("r > 50.0", "r 0..60.5", 3),
        ("t > T#2s", "t T#0s..T#2s", 0),
        ("t > T#2s", "t < T#2s or t > T#1h", 3),
        ("m = Drain", "m <> Drain", 0),
        ("m = Drain", "m = Drain or m = Fill", 3),
    ];
    for (at, (condition, line, scans)) in programs.into_iter().enumerate() {
        let path = counts_while(&format!("typed_{at}"), all, &format!("s AND {condition}"));
        let assumed = written(&format!("typed_{at}.txt"), &format!("{line}  # of the panel\n"));
        let arguments =
            format!("{} --from iec --to openplc --vars o -A warnings --assume {}", path.display(), assumed.display());
        if scans > 0 {
            let out = difference(&arguments);
            assert!(out.starts_with(&format!("iec and openplc differ after {scans} scans:")), "{line}: {out}");
        } else {
            let output = run(&arguments);
            assert_ne!(output.status.code(), Some(1), "{line}: {}", text(&output.stdout));
        }
    }
    let wrong = written("typed_wrong.txt", "t 0..x\n");
    let path = counts_while("typed_wrong", all, "s");
    let output = run(&format!("{} --from iec --to openplc --assume {}", path.display(), wrong.display()));
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("typed_wrong.txt:1: t: "), "{}", text(&output.stderr));
}

#[test]
fn what_is_compared_is_there_on_both_sides() {
    let of = |name: &str, outputs: &str, last: &str| {
        let source = format!(
            "PROGRAM p\nVAR_INPUT s : BOOL; END_VAR\nVAR_OUTPUT {outputs} END_VAR\nVAR c : CTU; END_VAR\n\
             c(s, FALSE, 3); {last}\nEND_PROGRAM\n"
        );
        written(name, &source)
    };
    let both = of("two_outputs.st", "full, alarm : BOOL;", "full := c.Q; alarm := c.CV > 9;");
    let one = of("one_output.st", "full : BOOL;", "full := c.Q;");
    let other = written(
        "no_output.st",
        "PROGRAM p\nVAR_INPUT x : BOOL; END_VAR\nVAR a : BOOL; END_VAR\na := x;\nEND_PROGRAM\n",
    );
    let more = of("more.st", "full, alarm : BOOL; END_VAR VAR n : INT;", "n := n + 1; full := c.Q; alarm := c.CV > 9;");
    let fails = |arguments: String, expected: &str| {
        let output = run(&arguments);
        let err = text(&output.stderr);
        assert!(output.status.code() == Some(2) && err.contains(expected), "{arguments}: {err}");
    };
    let arguments = format!("{} --from iec --to codesys", both.display());
    fails(format!("{arguments} --vars full,alrm"), "--vars: there is no variable `alrm`");
    fails(format!("{arguments} --vars s"), "--vars names nothing but inputs");
    fails(format!("{arguments} --vars c.PV"), "--vars: `c.PV` is a CONSTANT, or an input of a block");
    let against = |path: &Path| format!("{arguments} --against {}", path.display());
    fails(format!("{} --vars full,alarm", against(&one)), "only one of the two programs has a variable `alarm`");
    fails(against(&one), "`alarm` is an output of the first program alone");
    fails(against(&other), "is an output of the first program alone");
    // A name may begin with the PROGRAM, as it may for a run; what one program alone has otherwise is said.
    let output = run(&format!("{} --vars p.full,c.CV", against(&one)));
    assert_ne!(output.status.code(), Some(2), "{}", text(&output.stderr));
    let output = run(&format!("{} --assume no_run.txt --vars full", against(&more)));
    assert!(
        text(&output.stdout).contains("not compared, since one program alone has it: n"),
        "{}",
        text(&output.stdout)
    );
}

#[test]
fn variables_of_one_name_and_wide_texts_are_told_apart() {
    // A local variable and a global one are both called `n`; one of them differs.
    let source = "VAR_GLOBAL n : BOOL; END_VAR\nPROGRAM p VAR_INPUT s : BOOL; END_VAR VAR c : CTU; q : Q; END_VAR VAR n : BOOL; END_VAR\n\
                  c(s, FALSE, 1); n := s; q(x := c.CV > 1);\nEND_PROGRAM\n\
                  FUNCTION_BLOCK Q VAR_INPUT x : BOOL; END_VAR VAR_EXTERNAL n : BOOL; END_VAR n := x; END_FUNCTION_BLOCK\n";
    let path = written("one_name.st", source);
    let out = difference(&format!("{} --from iec --to openplc --vars n -A warnings", path.display()));
    assert!(out.starts_with("iec and openplc differ after 3 scans:"), "{out}");
    // The first halves of the texts are the same.
    let source = "PROGRAM p VAR_INPUT s : BOOL; END_VAR VAR c : CTU; END_VAR VAR_OUTPUT o : WSTRING[8]; END_VAR\n\
                  c(s, FALSE, 1); IF c.CV > 1 THEN o := \"abXY\"; ELSE o := \"abcd\"; END_IF\nEND_PROGRAM\n";
    let path = written("wide_texts.st", source);
    let out = difference(&format!("{} --from iec --to openplc --vars o -A warnings", path.display()));
    assert!(out.contains("abXY") && out.contains("abcd"), "{out}");
}

#[test]
fn an_assumption_names_what_a_list_holds_and_only_values_there_are() {
    let source = "TYPE Mode : (Off, Fill := 5, Drain := 10); END_TYPE\n\
                  NAMESPACE Panel VAR_GLOBAL level : INT := 9; mode : Mode; END_VAR END_NAMESPACE\n\
                  PROGRAM p VAR_INPUT s : BOOL; END_VAR VAR c : CTU; END_VAR VAR_OUTPUT o : BOOL; END_VAR\n\
                  c(s AND Panel.level = 3 AND Panel.mode > Off AND Panel.mode <> Fill, FALSE, 1); o := c.CV > 1;\nEND_PROGRAM\n";
    let path = written("panel.st", source);
    let verdict = |lines: &str| {
        let assumed = written("panel.txt", lines);
        let output = run(&format!(
            "{} --from iec --to openplc --vars o -A warnings --assume {}",
            path.display(),
            assumed.display()
        ));
        (output.status.code(), text(&output.stdout) + &text(&output.stderr))
    };
    let (code, out) = verdict("Panel.level 1..4\n");
    assert!(code == Some(1) && out.starts_with("iec and openplc differ after 3 scans:"), "{out}");
    // Between Off and Fill, by their numbers, is nothing.
    let (code, out) = verdict("Panel.level 1..4\nPanel.mode Off..Fill\n");
    assert_eq!(code, Some(0), "{out}");
}
