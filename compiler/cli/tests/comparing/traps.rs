//! Each of the traps in a small program, and how a difference is shown: tables, traces, stimuli, pictures, objects.

use super::programs::{difference, run, text, written};

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

/// A counter that nothing calls has no trap, seen or not; one that is called through a reference or a parameter has.
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
            "`idle`\n  impossible: trap 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 17, 18, 20, 21, 22: it is never"
        ),
        "{out}"
    );
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
fn the_shortest_trace_is_a_table() {
    let out = difference("held.st --from iec --to cscape");
    let table = "iec and cscape differ after 2 scans:\n\
         \n\
         \x20 scan  sensor  parts.CV iec  parts.CV cscape\n\
         \x20    1    TRUE             1                1\n\
         \x20    2    TRUE             1                2 ◀\n\
         \x20 no shorter sequence of these inputs shows a difference\n\
         \n\
         Trap 1 (`parts`): CU held TRUE counts once everywhere except CSCAPE, where it counts every call.\n\
         What to do: Feed the counter from an R_TRIG: `e(CLK := sensor); c(CU := e.Q, …)`.\n";
    assert!(out.starts_with(table), "{out}");
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
        text(&output.stderr).contains(":1: `rain` is not an event; expected restart, run or reset"),
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
