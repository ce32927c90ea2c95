//! Which values are tried, what is taken to be written from outside, and what assumptions leave out.

use super::programs::{difference, run, text, written};
use std::path::PathBuf;

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
        // A variable that is written as a whole is not an input.
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
        out.contains("under every value of the inputs (s); it is assumed that nothing else is written from outside"),
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
    assert!(out.contains("nothing writes n (5), so only the initial value was tried"), "{out}");
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
