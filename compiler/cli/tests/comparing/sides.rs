//! What is compared with what: two systems, by the names that both have, and what one of them lacks.

use super::programs::{self, Folder, command, difference, folder, run, text, written};
use std::path::Path;
use std::process::Output;

/// Of programs in the folder, where the project decides what CODESYS leaves open.
fn decided(arguments: &str) -> Output {
    let folder = Folder("decided").path();
    static WRITTEN: std::sync::Once = std::sync::Once::new();
    WRITTEN.call_once(|| {
        std::fs::write(folder.join("staunch.toml"), "ctu-stop-at-pv = false\n").expect("a project file");
        for name in ["names.st", "no_run.txt"] {
            std::fs::copy(programs::folder().join(name), folder.join(name)).expect("a copy");
        }
    });
    command().args(arguments.split_whitespace()).current_dir(folder).output().expect("the command starts")
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
        out.starts_with("No difference between iec and codesys was found, but none is ruled out.\nTried: "),
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
        (
            "twincat",
            "codesys",
            "`twincat` and `codesys` are the same system: the program would be compared with itself",
        ),
        ("iec", "iec --against held.st", "--against is the program itself"),
    ] {
        let output = run(&format!("held.st --from {from} --to {to}"));
        assert_eq!(output.status.code(), Some(2), "{from} {to}");
        assert!(text(&output.stderr).contains(why), "{}", text(&output.stderr));
    }
    let source = std::fs::read_to_string(folder().join("held.st")).expect("it exists");
    let copy = written("held_copy.st", &source);
    let output = run(&format!("held.st --from iec --to iec --against {}", copy.display()));
    assert_eq!(output.status.code(), Some(0));
    let out = text(&output.stdout);
    assert!(out.starts_with("iec and iec are equal: every reachable state was seen"), "{out}");
}

#[test]
fn a_file_or_a_name_that_fixes_its_system_is_not_compared_with_itself() {
    let pragma =
        written("fixed.st", "{dialect 'codesys'}\nPROGRAM p\nVAR x : BOOL; END_VAR\nx := TRUE;\nEND_PROGRAM\n");
    let output = run(&format!("{} --from iec --to cscape", pragma.display()));
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("fixed.st:1: the dialect of the file is `codesys`, but --from says `iec`"));
    let name = written(
        "qualified.st",
        "PROGRAM p\nVAR c : ARRAY[1..2] OF CODESYS.CTU; END_VAR\nc[1](CU := TRUE);\nEND_PROGRAM\n",
    );
    let output = run(&format!("{} --from codesys --to iec", name.display()));
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert!(text(&output.stderr).contains("qualified.st:2: `CODESYS.CTU` belongs to CODESYS on every system"));
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
    assert!(out.contains("hours.st:3: LOGIX does not have TON (`tick`): use TONR with an FBD_TIMER there"), "{out}");
    // Logix keeps every tag over a power cycle, so that the timer continues there.
    assert!(out.contains("iec and logix differ after 2 scans:") && out.contains("Trap 11 (`tick`): Restart"), "{out}");
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
    assert!(
        moved.contains("shared_bits.st:3: LOGIX does not have BYTE (`low`)") && !moved.contains("bits_of"),
        "{moved}"
    );
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
    fails(format!("{arguments} --vars s"), "--vars names only inputs");
    fails(format!("{arguments} --vars c.PV"), "--vars: `c.PV` is a CONSTANT or an input of a block");
    let against = |path: &Path| format!("{arguments} --against {}", path.display());
    fails(format!("{} --vars full,alarm", against(&one)), "only one of the two programs has a variable `alarm`");
    fails(against(&one), "only the first program has the output `alarm`");
    fails(against(&other), "only the first program has the output");
    // A name may begin with the PROGRAM, as it may for a run; what one program alone has otherwise is said.
    let output = run(&format!("{} --vars p.full,c.CV", against(&one)));
    assert_ne!(output.status.code(), Some(2), "{}", text(&output.stderr));
    let output = run(&format!("{} --assume no_run.txt --vars full", against(&more)));
    assert!(
        text(&output.stdout).contains("not compared, since only one program has it: n"),
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

/// Lists of globals with names, and addresses that the devices' configuration gives, are forms of the old system: they move.
#[test]
fn lists_and_open_addresses_of_codesys_move() {
    let folder = Folder("lists").path();
    let program = |address: &str| {
        format!(
            "{{gvl 'Plant'}}\nVAR_GLOBAL\n    start AT %{address} : BOOL;\n    total : INT;\n    parts : CTU;\nEND_VAR\n\
             PROGRAM Main\nVAR\n    own : INT;\nEND_VAR\n\
             Plant.parts(CU := Plant.start, PV := 3);\nIF Plant.parts.Q THEN\n    Plant.total := Plant.total + 1;\nEND_IF\n\
             IF Plant.parts.CV > 3 THEN\n    own := 1;\nEND_IF\nEND_PROGRAM\n"
        )
    };
    std::fs::write(folder.join("open.st"), program("I*")).expect("a program");
    std::fs::write(folder.join("bound.st"), program("IX0.0")).expect("a program");
    std::fs::write(folder.join("no_run.txt"), "no run\n").expect("assumptions");
    let compared = |arguments: &str| {
        command().args(arguments.split_whitespace()).current_dir(&folder).output().expect("the command starts")
    };
    for to in ["iec", "siemens", "cscape", "openplc"] {
        let output = compared(&format!("open.st --from codesys --to {to} --budget 2000"));
        let lints = text(&output.stderr);
        assert!(matches!(output.status.code(), Some(1 | 4)), "{to}: {lints}");
        assert!(lints.contains("W0617") && lints.contains("W0618"), "{to}: {lints}");
    }
    // What the devices' configuration gives is an input on both sides: the count passes PV in CODESYS alone.
    for name in ["open", "bound"] {
        let output =
            compared(&format!("{name}.st --from codesys --to cscape --assume no_run.txt --vars own --budget 20000"));
        let out = text(&output.stdout);
        assert_eq!(output.status.code(), Some(1), "{name}: {out}");
        assert!(out.starts_with("codesys and cscape differ after 7 scans:\n"), "{name}: {out}");
    }
    let output = compared("bound.st --from codesys --to iec --budget 2000 --write moved.st");
    assert!(matches!(output.status.code(), Some(1 | 4)), "{}", text(&output.stderr));
    let moved = std::fs::read_to_string(folder.join("moved.st")).expect("it is written");
    assert!(moved.contains("\nparts(CU := start, PV := 3);") && !moved.contains("Plant"), "{moved}");
}
