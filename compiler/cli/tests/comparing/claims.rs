//! `staunch compare` claims no more than it has shown. What each program must come to follows from the systems' rules,
//! which the test names.

use super::programs::{Folder, command, printed};

const OWN: Folder = Folder("claims");

/// The exit code, and what is printed.
fn compare(name: &str, source: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let path = OWN.written(&format!("{name}.st"), source);
    let output = command().arg(&path).args(arguments).output().expect("it starts");
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
    let counters = OWN.written("counters.txt", "c 15: nobody reads the count past its preset\nd 15: same\n");
    let (code, text) = compare("motor", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &counters]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Not accepted: `motor output`.") && text.contains("`motor output: reason`"), "{text}");
    let all = OWN.written("all.txt", "* 15: nobody reads the count past its preset\n* output: nobody looks\n");
    let (code, text) = compare("motor_all", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &all]);
    assert_eq!(code, Some(1), "{text}");
    let own = OWN.written("own.txt", "c 15: nobody reads it\nd 15: same\nmotor output: it is not wired\n");
    let (code, text) = compare("motor_own", MOTOR, &["--from", "iec", "--to", "openplc", "--accept", &own]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("not compared after an accepted finding: c.Q, c.CV, d.Q, d.CV, motor."), "{text}");
}

/// What `--vars` names is compared until a line names it, and so is what lies at `%Q`; a variable inside follows.
#[test]
fn what_is_named_and_what_is_wired_are_outputs() {
    let plain = MOTOR.replace("VAR_OUTPUT motor", "VAR motor");
    let counters = OWN.written("counters_of_vars.txt", "c 15: nobody reads the count past its preset\nd 15: same\n");
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

/// A program with a table that it only reads: `over` follows from the count alone where an element is 7.
fn table(declared: &str, condition: &str) -> String {
    format!(
        "PROGRAM p
VAR_INPUT part : BOOL; size : INT(0..1000); END_VAR
VAR_OUTPUT over : BOOL; END_VAR
VAR c : CTU; END_VAR
{declared}
c(CU := part, R := c.CV > 4, PV := 2);
over := c.CV > 2 AND {condition};
END_PROGRAM
"
    )
}

const TO_OPENPLC: [&str; 6] = ["--from", "iec", "--to", "openplc", "--vars", "over"];

/// Nothing writes the table, so no element is 7, also not one that starts at 0; it can be assumed to be written.
#[test]
fn a_table_that_is_only_read_is_no_input() {
    let tables = [
        ("array", "VAR t : ARRAY[0..3] OF INT := [0, 10, 20, 30]; END_VAR", "t[size MOD 4] = 7"),
        ("zeros", "VAR t : ARRAY[0..3] OF INT; END_VAR", "t[size MOD 4] = 7"),
        ("members", "VAR t : STRUCT a, b : INT := 3; z : INT; END_STRUCT; END_VAR", "t.z = 7"),
        ("rows", "VAR t : ARRAY[0..3, 0..1] OF INT := [0, 10, 20, 30, 0]; END_VAR", "t[size MOD 4, 0] = 7"),
    ];
    for (name, declared, condition) in tables {
        let (code, text) = compare(name, &table(declared, condition), &TO_OPENPLC);
        assert!(text.contains("nothing writes t"), "{name}: {text}");
        assert!(!text.contains("differ after"), "{name}: {text}");
        assert_ne!(code, Some(1), "{name}: {text}");
    }
    let source = table(tables[0].1, "t[0] = 7");
    let (code, text) = compare("not_assumed", &source, &TO_OPENPLC);
    assert_eq!(code, Some(0), "{text}");
    let assumed = OWN.written("assumed.txt", "t[0] 0..10\n");
    let (code, text) = compare("assumed", &source, &[&TO_OPENPLC[..], &["--assume", &assumed]].concat());
    assert_eq!(code, Some(1), "{text}");
    // What is RETAIN, or has an address, is there for the world outside to write.
    for declared in ["VAR RETAIN t : ARRAY[0..1] OF INT; END_VAR", "VAR t AT %MW0 : ARRAY[0..1] OF INT; END_VAR"] {
        let (code, text) = compare("from_outside", &table(declared, "t[0] = 7"), &TO_OPENPLC);
        assert_eq!(code, Some(1), "{text}");
    }
    let written = table(tables[0].1, "t[0] = 7").replace("over :=", "IF size = 9 THEN t[0] := 7; END_IF over :=");
    let (code, text) = compare("written", &written, &TO_OPENPLC);
    assert_eq!(code, Some(1), "{text}");
}

/// An index is tried where the elements change, which is all that it decides.
#[test]
fn a_long_table_is_looked_up_where_it_changes() {
    let of = |value: u32| {
        let declared = format!("VAR t : ARRAY[0..1000] OF INT := [613(0), {value}, 387(0)]; END_VAR");
        table(&declared, "t[size] = 7")
    };
    let started = std::time::Instant::now();
    let (code, text) = compare("long", &of(7), &TO_OPENPLC);
    assert_eq!(code, Some(1), "{text}");
    let passed = started.elapsed();
    assert!(passed.as_secs() < 4, "a look-up of 1,000 elements took {passed:?}");
    let (code, text) = compare("long_equal", &of(8), &TO_OPENPLC);
    assert_eq!(code, Some(0), "{text}");
}

/// The count passes PV on IEC; on CODESYS it does by some of its documents, and stops by others (Beckhoff's older page of
/// Tc2_Standard: "CV is increased by 1 as long as CV is less than PV").
#[test]
fn what_a_vendor_leaves_open_is_tried_both_ways() {
    let source = |reset: &str| {
        format!(
            "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR_OUTPUT over : BOOL; END_VAR
VAR c : CTU; END_VAR
c(s, {reset}, 3);
over := c.CV > 3;
END_PROGRAM
"
        )
    };
    let arguments = |from: &'static str, to: &'static str| ["--from", from, "--to", to, "--vars", "over"];
    let passes = source("c.CV > 5");
    for (from, to, shown, other) in [
        ("iec", "codesys", "`ctu-stop-at-pv = true`", "With `ctu-stop-at-pv = false`, the two are equal."),
        ("codesys", "openplc", "`ctu-stop-at-pv = false`", "With `ctu-stop-at-pv = true`, the two are equal."),
    ] {
        let no_run = OWN.written("no_run.txt", "no run\n");
        let (code, text) = compare("open", &passes, &[&arguments(from, to)[..], &["--assume", &no_run]].concat());
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains(&format!("The verdict above is with {shown}. {other}")), "{text}");
    }
    // What never reaches its preset is the same either way, and that is said.
    let below = source("c.CV > 1");
    let no_run = OWN.written("no_run.txt", "no run\n");
    let arguments = [&arguments("iec", "codesys")[..], &["--assume", &no_run]].concat();
    let (code, text) = compare("open_below", &below, &arguments);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("With `ctu-stop-at-pv = true`, the two are equal."), "{text}");
    let (_, json) = compare("open_json", &below, &[&arguments[..], &["--message-format", "json"]].concat());
    let settings = "\"settings\":{\"ctu-stop-at-pv\":false},\"other_settings\":[{\"settings\":{\"ctu-stop-at-pv\":true},\"verdict\":\"equal\"}]";
    assert!(json.contains(settings), "{json}");
}

/// CODESYS keeps the count over STOP -> RUN whatever CTU does at its preset; without that, only the CTU that goes on parts
/// from OPENPLC, which stops there.
#[test]
fn each_setting_says_what_differs_without_stop_to_run() {
    let source = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR c : CTU; END_VAR
c(s, r OR c.CV > 5, 3);
END_PROGRAM
";
    let arguments = ["--from", "codesys", "--to", "openplc", "--vars", "c.CV"];
    let (code, text) = compare("open_run", source, &arguments);
    assert_eq!(code, Some(1), "{text}");
    let other = "With `ctu-stop-at-pv = true`, the two differ after 2 scans; without STOP -> RUN, the two are equal.";
    assert!(text.contains(other), "{text}");
    let shown = "The advice is right with `ctu-stop-at-pv = false`; with other settings it may not be.";
    assert!(text.contains("the two differ after 7 scans") && text.contains(shown), "{text}");
    let (_, json) = compare("open_run_json", source, &[&arguments[..], &["--message-format", "json"]].concat());
    assert!(json.contains("\"verdict\":\"different\",\"without_run\":\"equal\"}]"), "{json}");
}

/// A project that has asked its vendor decides it.
#[test]
fn what_the_project_decides_is_the_verdict() {
    OWN.written("decided/staunch.toml", "ctu-stop-at-pv = false\n");
    let source = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR_OUTPUT over : BOOL; END_VAR
VAR c : CTU; END_VAR
c(s, c.CV > 5, 3);
over := c.CV > 3;
END_PROGRAM
";
    let arguments = ["--from", "iec", "--to", "codesys", "--vars", "over", "--assume"];
    let no_run = OWN.written("never_run.txt", "no run\n");
    let (code, text) = compare("decided/p", source, &[&arguments[..], &[no_run.as_str()]].concat());
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("With `ctu-stop-at-pv = true`, the two differ after 7 scans."), "{text}");
}

/// Both systems keep a RETAIN count in every event: a count below 0 is trap 3 there, whatever happens before it.
#[test]
fn a_restart_is_blamed_where_both_keep_nothing_alike() {
    let source = "PROGRAM p
VAR_INPUT s, l : BOOL; END_VAR
VAR RETAIN c : CTD; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
c(s, l, 3);
o := c.CV < 0;
END_PROGRAM
";
    let accepted = OWN.written("below.txt", "c 3: the count below 0 is not used\n");
    let (code, text) = compare("kept", source, &["--from", "iec", "--to", "codesys", "--accept", &accepted]);
    assert_eq!(code, Some(1), "{text}");
    assert!(!text.contains("reachable after 2 scans: trap 11"), "{text}");
    assert!(text.contains("Not accepted: `o output`."), "{text}");
}

/// `lamp` follows from the second counter; the first parts before it, and decides nothing of it.
#[test]
fn the_counter_that_is_blamed_decides_the_difference() {
    for input in ["s", "s OR c.CV > 90"] {
        let source = format!(
            "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR c, d : CTU; END_VAR
VAR_OUTPUT lamp : BOOL; END_VAR
c(CU := s, R := r, PV := 2);
d(CU := {input}, R := r, PV := 3);
lamp := d.CV > 5;
END_PROGRAM
"
        );
        let (code, text) = compare("blame", &source, &["--from", "iec", "--to", "openplc", "--vars", "lamp"]);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains("Trap 15 (`d`)"), "{text}");
    }
}

/// No flag of Logix is Q of a CTD, which is TRUE while nothing is left: DN is TRUE while ACC >= PRE (1756-RM003, "CTD").
#[test]
fn the_port_of_a_ctd_asks_for_what_is_left() {
    let source = "PROGRAM p
VAR_INPUT s, ld : BOOL; END_VAR
VAR RETAIN k : CTD; e : R_TRIG; END_VAR
VAR_OUTPUT empty, some : BOOL; END_VAR
e(CLK := s); k(CD := e.Q, LD := ld, PV := 3, Q => empty);
some := NOT k.Q;
END_PROGRAM
";
    let file = OWN.path().join("port.st").display().to_string();
    let arguments = ["--from", "iec", "--to", "logix", "--vars", "empty,some", "--write", &file];
    let (_, text) = compare("ctd", source, &arguments);
    assert!(!text.contains("Trap 4"), "{text}");
    let port = std::fs::read_to_string(&file).expect("it is written");
    assert!(port.contains("empty := k.ACC <= 0") && port.contains("some := NOT (k.ACC <= 0);"), "{port}");
}

/// What is written for Logix says which of its lines are rungs in Studio 5000: CTU, CTD and RES are there in ladder only.
#[test]
fn what_is_written_says_what_is_ladder() {
    let source = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR c : CTU; END_VAR
c(CU := s, R := r, PV := 3);
END_PROGRAM
";
    let path = OWN.written("ladder.st", source);
    let file = OWN.path().join("written.st").display().to_string();
    let arguments = ["--from", "iec", "--to", "logix", "--write", &file];
    let said = printed(&command().arg(&path).args(arguments).output().expect("it starts"));
    assert!(said.contains("Studio 5000 has CTU and RES in ladder only") && said.contains("(line 4)"), "{said}");
}

/// A CTUD on Logix is no CTU, so that advice for one is not given for the other.
#[test]
fn advice_is_for_the_kind_of_counter() {
    let source = "PROGRAM p
VAR_INPUT up, down, r : BOOL; END_VAR
VAR c : CTUD; END_VAR
VAR_OUTPUT full : BOOL; END_VAR
c(CU := up, CD := down, R := r, LD := FALSE, PV := 5); full := c.QU;
END_PROGRAM
";
    let (code, text) = compare("both_ways", source, &["--from", "iec", "--to", "logix"]);
    assert_eq!(code, Some(1), "{text}");
    let advice = text.lines().find(|it| it.starts_with("What to do: ")).unwrap_or_default();
    assert!(advice.contains("ed := pulse AND NOT bd") && !advice.contains("CTU(c"), "{text}");
}

/// CODESYS holds a TIME in 32 bits without a sign (its help, "TIME, LTIME"), so that `T#1s - T#2s` is no negative time.
/// That is not followed: nothing is called equal that computes with one; a timer does not.
#[test]
fn a_rule_that_is_not_followed_is_never_equal() {
    let source = "PROGRAM p
VAR_INPUT on : BOOL; END_VAR
VAR a : TIME := T#1s; b : TIME := T#2s; d : TIME; neg : BOOL; END_VAR
d := a - b;
neg := on AND d < T#0s;
END_PROGRAM
";
    let no_run = OWN.written("unfollowed.txt", "no run\n");
    for (from, to) in [("iec", "codesys"), ("codesys", "openplc")] {
        let arguments = ["--from", from, "--to", to, "--assume", no_run.as_str()];
        let (code, text) = compare("time", source, &arguments);
        assert_eq!(code, Some(4), "{text}");
        assert!(text.contains("TIME of CODESYS, which is not followed here and is used in line 4"), "{text}");
        let timer = "PROGRAM p
VAR_INPUT on : BOOL; END_VAR
VAR t : TON; END_VAR
t(IN := on, PT := T#30ms);
END_PROGRAM
";
        let (code, text) = compare("timer", timer, &arguments);
        assert_eq!(code, Some(0), "{text}");
    }
}

/// Where the first difference needs STOP -> RUN, which most programs from CODESYS have, the next one is shown as well.
#[test]
fn the_search_goes_on_past_stop_to_run() {
    let source = |preset: u32| {
        format!(
            "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR_OUTPUT over : BOOL; END_VAR
VAR c : CTU; e : R_TRIG; END_VAR
e(CLK := s); c(e.Q, c.CV > 3, {preset});
over := c.CV > 2;
END_PROGRAM
"
        )
    };
    let arguments = ["--from", "codesys", "--to", "openplc", "--vars", "c.CV"];
    let (code, text) = compare("past_run", &source(2), &arguments);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 11"), "{text}");
    let next = text.lines().find(|it| it.starts_with("Where nobody switches it to STOP (`no run`")).unwrap_or_default();
    assert!(next.contains("the two differ after 5 scans") && next.contains("Trap 15 (`c`)"), "{text}");
    let (_, text) = compare("past_run_equal", &source(9), &arguments);
    assert!(text.contains("the two are equal: every reachable state was seen."), "{text}");
    // What is of other systems than these is not listed.
    assert!(!text.contains("of the two systems"), "{text}");
}

/// A number that is computed with is sampled: another value may make a difference sooner.
#[test]
fn nothing_is_called_shortest_of_sampled_numbers() {
    let source = "PROGRAM p
VAR_INPUT x : BOOL; n : INT; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTU; f : INT; END_VAR
f := (f * 3 + n) / 4;
c(CU := x AND (f > 600 AND f < 610), R := FALSE, PV := 1);
o := c.CV > 1;
END_PROGRAM
";
    let (code, text) = compare("sampled", source, &["--from", "iec", "--to", "cscape", "--vars", "o"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(!text.contains("no shorter"), "{text}");
}

/// A counter that is inherited is rewritten for Logix where an heir calls it.
#[test]
fn an_inherited_counter_is_written_for_logix() {
    let source = "FUNCTION_BLOCK A
VAR c : CTU; END_VAR
VAR_INPUT x : BOOL; END_VAR
END_FUNCTION_BLOCK
FUNCTION_BLOCK B EXTENDS A
VAR_OUTPUT n : INT; END_VAR
c(CU := x, PV := 3);
n := WORD_TO_INT(c.CV);
END_FUNCTION_BLOCK
PROGRAM P
VAR_INPUT i : BOOL; END_VAR
VAR b : B; END_VAR
VAR_OUTPUT q : INT; END_VAR
b(x := i); q := b.n;
END_PROGRAM
";
    let (code, text) = compare("inherited", source, &["--from", "codesys", "--to", "logix"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("+ c.PRE := 3; CTU(c, x);") && text.contains("codesys and logix differ after"), "{text}");
}

/// An input called `En` of a PROGRAM stops nothing on any system: `lamp` follows it. Of a FUNCTION_BLOCK without ENO it stops the body
/// on IEC and OPENPLC, and is an ordinary input on S7, CSCAPE and OPENPLC4: `Off` is TRUE there.
#[test]
fn an_input_called_en_is_what_it_is_on_each_system() {
    let program = "PROGRAM p
VAR_INPUT En, part : BOOL; END_VAR
VAR_OUTPUT lamp : BOOL; END_VAR
VAR c : CTU; END_VAR
c(CU := part, PV := 2);
lamp := En AND c.Q;
END_PROGRAM
";
    let block = "FUNCTION_BLOCK Pump
VAR_INPUT En : BOOL; END_VAR
VAR_OUTPUT Off : BOOL; END_VAR
Off := NOT En;
END_FUNCTION_BLOCK
PROGRAM p
VAR_INPUT on : BOOL; END_VAR
VAR pump : Pump; END_VAR
VAR_OUTPUT off : BOOL; END_VAR
pump(En := on);
off := pump.Off;
END_PROGRAM
";
    let spelled = [program.to_owned(), program.replace("En", "EN")];
    for (number, source) in spelled.iter().enumerate() {
        for to in ["siemens", "openplc", "openplc4"] {
            let name = format!("en_program_{number}_{to}");
            let (code, text) = compare(&name, source, &["--from", "iec", "--to", to, "--vars", "lamp"]);
            assert_eq!(code, Some(0), "{name}: {text}");
        }
    }
    for (to, expected) in [("openplc", 0), ("siemens", 1), ("cscape", 1), ("openplc4", 1)] {
        let (code, text) = compare(&format!("en_block_{to}"), block, &["--from", "iec", "--to", to, "--vars", "off"]);
        assert_eq!(code, Some(expected), "{to}: {text}");
        assert!(expected == 0 || text.starts_with(&format!("iec and {to} differ after 1 scan:")), "{text}");
    }
}

/// A number of a TIME is of milliseconds on IEC and OPENPLC4, and of seconds on OPENPLC: that it is given another PT is why
/// the timer differs, not that it looks at the time in a later call.
#[test]
fn a_timer_that_is_given_another_preset_is_not_blamed() {
    let source = "PROGRAM p
VAR_INPUT go : BOOL; END_VAR
VAR_OUTPUT lamp : BOOL; END_VAR
VAR ms : DINT := 1500; t : TON; END_VAR
t(IN := go, PT := DINT_TO_TIME(ms));
lamp := t.Q;
END_PROGRAM
";
    let (code, text) = compare("another_preset", source, &["--from", "openplc", "--to", "iec"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("what the block is given differs") && !text.contains("trap 19"), "{text}");
    let same = source.replace("DINT_TO_TIME(ms)", "T#0s");
    let (code, text) = compare("same_preset", &same, &["--from", "openplc", "--to", "iec"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 19 (`t`): TON, TOF and TP on OPENPLC, before and from v4.1,"), "{text}");
}

/// Reset wins over the load on IEC, OPENPLC, CODESYS and S7; the port loads after CTUD, which has reset before it. What it
/// resets and loads it may read the counter itself, as it was before the call.
#[test]
fn the_port_of_a_ctud_lets_reset_win_over_load() {
    let none = OWN.written("no_event.txt", "no run\nno restart\nno reset\n");
    let arguments = ["--to", "logix", "--vars", "o", "--assume", &none, "--from"];
    OWN.written("level/staunch.toml", "s7-ld = \"level\"\n");
    for from in ["iec", "openplc", "siemens", "codesys"] {
        for (name, load) in [("plain", "l"), ("both", "l OR r"), ("own", "c.CV = 0 AND l")] {
            let source = format!(
                "PROGRAM p
VAR_INPUT r, l : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTUD; END_VAR
c(FALSE, FALSE, r, {load}, 3);
o := c.CV > 0;
END_PROGRAM
"
            );
            let (code, text) = compare(&format!("level/{name}_{from}"), &source, &[&arguments[..], &[from]].concat());
            assert_eq!(code, Some(0), "{from}: {text}");
        }
    }
}

/// A load on Logix comes after CTUD, which evaluates DN: QU is asked of the count.
#[test]
fn the_port_of_a_loaded_ctud_asks_for_the_count() {
    let none = OWN.written("no_event.txt", "no run\nno restart\nno reset\n");
    let loaded = "PROGRAM p
VAR_INPUT l : BOOL; END_VAR
VAR_OUTPUT o, q : BOOL; END_VAR
VAR c : CTUD; END_VAR
c(FALSE, FALSE, FALSE, l, 3, QU => q);
o := c.QU;
END_PROGRAM
";
    let arguments = ["--from", "iec", "--to", "logix", "--vars", "o,q", "--assume", &none];
    let (code, text) = compare("loaded", loaded, &arguments);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("o := (c.ACC >= c.PRE);") && text.contains("q := c.ACC >= c.PRE;"), "{text}");
    let (_, text) = compare("not_loaded", &loaded.replace(", l, 3", ", FALSE, 3"), &arguments);
    assert!(text.contains("o := c.DN;"), "{text}");
}

/// An Editor of OpenPLC that counts CD as it rises is not given CD negated.
#[test]
fn advice_is_for_the_edge_that_is_counted() {
    OWN.written("rising/staunch.toml", "openplc4-cd-edge = \"rising\"\n");
    let source = "PROGRAM p
VAR_INPUT up, down : BOOL; END_VAR
VAR_OUTPUT full : BOOL; END_VAR
VAR c : CTUD; END_VAR
c(CU := up, CD := down, R := FALSE, LD := FALSE, PV := 2); full := c.QU;
END_PROGRAM
";
    let (code, text) = compare("rising/p", source, &["--from", "openplc", "--to", "openplc4", "--vars", "full"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 18 (`c`)") && text.contains("CD := d.Q AND NOT u.Q, …)"), "{text}");
    let (_, text) = compare("falls", source, &["--from", "openplc", "--to", "openplc4"]);
    assert!(text.contains("CD := NOT (d.Q AND NOT u.Q), …)"), "{text}");
}

/// RESET and LOAD on CODESYS and CSCAPE, R and LD elsewhere; a CTD counts by CD.
#[test]
fn advice_has_the_pins_of_the_block() {
    let logix = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR c : COUNTER; END_VAR
CTU(c, s); RES(c, r);
END_PROGRAM
";
    for (to, reset, load) in [("codesys", "RESET", "LOAD"), ("cscape", "RESET", "LOAD"), ("iec", "R", "LD")] {
        let (_, text) = compare(&format!("pins_{to}"), logix, &["--from", "logix", "--to", to]);
        assert!(text.contains(&format!("c(CU := rung, {reset} := clear, ")), "{to}: {text}");
        assert!(text.contains(&format!("c(CD := rung, {load} := load, ")), "{to}: {text}");
    }
    let down = "PROGRAM p
VAR_INPUT s, l : BOOL; END_VAR
VAR c : CTD; END_VAR
c(s, l, 3);
END_PROGRAM
";
    for from in ["codesys", "openplc"] {
        let none = OWN.written("no_event.txt", "no run\nno restart\nno reset\n");
        let (_, text) = compare(&format!("cd_{from}"), down, &["--from", from, "--to", "cscape", "--assume", &none]);
        let advice = text.lines().find(|it| it.starts_with("What to do: ")).unwrap_or_default();
        assert!(advice.contains("c(CD := e.Q, …)") && !advice.contains("CU :="), "{from}: {text}");
    }
}

/// What is one program on both systems is never said to be two: a counter below 0 in one of its calls, a division by zero,
/// an EN that stops a body.
#[test]
fn one_program_is_not_two() {
    let calls = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTD; END_VAR
c(s, FALSE, 1);
c(CD := FALSE);
o := c.CV < 0;
END_PROGRAM
";
    let division = "PROGRAM p
VAR_INPUT on : BOOL; END_VAR
VAR x : DINT := 7; z : DINT; END_VAR
VAR_OUTPUT y : DINT; END_VAR
y := x / z;
END_PROGRAM
";
    let enable = "FUNCTION_BLOCK Pump
VAR_INPUT En : BOOL; END_VAR
VAR_OUTPUT Off : BOOL; END_VAR
Off := NOT En;
END_FUNCTION_BLOCK
PROGRAM p
VAR_INPUT on : BOOL; END_VAR
VAR pump : Pump; END_VAR
VAR_OUTPUT off : BOOL; END_VAR
pump(En := on);
off := pump.Off;
END_PROGRAM
";
    let none = OWN.written("no_event.txt", "no run\nno restart\nno reset\n");
    for (name, source, vars, to, said) in [
        ("calls", calls, "o", "openplc", "Trap 15 (`c`)"),
        ("calls", calls, "o", "codesys", "Trap 3 (`c`)"),
        ("division", division, "y", "logix", "a division by zero ("),
        ("enable", enable, "off", "siemens", "`En` stops the body of `Pump` on iec alone"),
        ("enable", enable, "off", "codesys", "`En` stops the body of `Pump` on iec alone"),
    ] {
        let arguments = ["--from", "iec", "--to", to, "--vars", vars, "--assume", &none];
        let (code, text) = compare(&format!("one_{name}_{to}"), source, &arguments);
        assert_eq!(code, Some(1), "{name}: {text}");
        assert!(text.contains(said) && !text.contains("programs are not the same"), "{name}: {text}");
    }
}

/// Of a timer with a PT that is not over at once, no call of OPENPLC comes too late: what differs is what it is given.
#[test]
fn a_timer_that_starts_otherwise_is_not_late() {
    let source = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTU; t : TON; END_VAR
c(s, r, 2);
t(IN := c.CV > 2, PT := T#30ms);
o := t.Q;
END_PROGRAM
";
    let accepted = OWN.written("timer.accept", "c 15: known\no output: known\n");
    let (code, text) =
        compare("timer", source, &["--from", "iec", "--to", "openplc", "--vars", "o", "--accept", &accepted]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("what the block is given differs") && !text.contains("trap 19"), "{text}");
}

/// S7 has the standard's SR here, and is not called IEC.
#[test]
fn a_pin_is_called_as_on_the_system_of_the_move() {
    let source = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR c : CTU; t : SR; END_VAR
c(CU := s, RESET := FALSE, PV := 3);
t(SET1 := s, RESET := FALSE);
END_PROGRAM
";
    let path = OWN.written("pin_names.st", source);
    let arguments = ["--from", "codesys", "--to", "siemens"];
    let output = command().arg(&path).args(arguments).output().expect("it starts");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("`RESET` is called `R` in S7") && said.contains("`SET1` is called `S1` in SIEMENS"),
        "{said}"
    );
    assert!(!said.contains(" in IEC"), "{said}");
}

/// Of two counters that part, the one is blamed without whose rule nothing would differ: here the second comes to differ
/// first, and what is asked of it does not depend on that.
#[test]
fn the_counter_that_is_blamed_makes_the_difference_alone() {
    let second = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTU; d : CTD; END_VAR
c(s, FALSE, 3);
d(s, c.CV = 4, 2);
o := d.Q;
END_PROGRAM
";
    let element = "PROGRAM p
VAR_INPUT x, y : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTD; i : INT; a : ARRAY[0..1] OF CTD; END_VAR
IF NOT y THEN c(x, x, 1); END_IF;
IF y THEN i := 1; ELSE i := 0; END_IF;
a[i](y OR x, c.Q, 1);
o := a[1].Q;
END_PROGRAM
";
    let none = OWN.written("no_event.txt", "no run\nno restart\nno reset\n");
    for (number, source, from, to, said) in [
        (0, second, "iec", "openplc", "Trap 15 (`c`)"),
        (1, second, "codesys", "siemens", "Trap 2 (`c`)"),
        (2, element, "siemens", "openplc4", "Trap 17 (`c`)"),
    ] {
        let arguments = ["--from", from, "--to", to, "--vars", "o", "--assume", &none];
        let (code, text) = compare(&format!("alone_{number}"), source, &arguments);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains(said), "{text}");
    }
}

/// DN of a CTD that is put in place of a block is asked for by nothing, and is no reason.
#[test]
fn what_the_port_does_not_read_is_no_reason() {
    let below = "PROGRAM p
VAR_INPUT s, l : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTD; m, b : BOOL; END_VAR
b := s AND NOT m; m := s;
c(b, l, 3);
o := c.CV < 0;
END_PROGRAM
";
    let two = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR d : CTD; c : CTU; END_VAR
d(FALSE, FALSE, 2);
c(s, r, 2);
o := d.Q AND c.Q;
END_PROGRAM
";
    let none = OWN.written("no_event.txt", "no run\nno restart\nno reset\n");
    for (name, source, from, said) in
        [("below", below, "openplc", "Trap 15 (`c`)"), ("two", two, "iec", "Trap 5 (`c`)")]
    {
        let arguments = ["--from", from, "--to", "logix", "--vars", "o", "--assume", &none, "--budget", "100000"];
        let (code, text) = compare(&format!("unread_{name}"), source, &arguments);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains(said) && !text.contains("Trap 4"), "{text}");
    }
}

/// OpenPLC has no check of subranges, nor has CODESYS without functions for it (its help, "Subrange type"): what is a fault
/// on both sides here is one on the other system alone.
#[test]
fn a_fault_of_a_subrange_is_none_on_systems_that_store_it() {
    let source = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR n : INT (0..3); END_VAR
VAR_OUTPUT o : BOOL; END_VAR
IF s THEN n := n + 1; END_IF;
o := n > 2;
END_PROGRAM
";
    let assumed = OWN.written("no_run_of_subrange.txt", "no run\n");
    for (from, to) in [("openplc", "cscape"), ("iec", "openplc4"), ("iec", "codesys")] {
        let (code, text) =
            compare("subrange", source, &["--from", from, "--to", to, "--vars", "o", "--assume", &assumed]);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains("one system faults here, and the other goes on"), "{text}");
    }
    let (code, text) =
        compare("subrange", source, &["--from", "iec", "--to", "cscape", "--vars", "o", "--assume", &assumed]);
    assert_eq!(code, Some(0), "{text}");
}

/// An integer divided by 0 ends a program on x86, and is 0 on ARM of 64 bits ("SDIV"); CODESYS leaves it to the target (its
/// help, "DIV"). Where it is reached, nothing is called equal to a system that does otherwise; where it is not, it is.
#[test]
fn a_division_by_zero_that_is_reached_is_not_equal() {
    let source = "PROGRAM p
VAR_INPUT d : INT(0..3); END_VAR
VAR_OUTPUT o : INT; END_VAR
o := 12 / d;
END_PROGRAM
";
    let assumed = OWN.written("no_run_of_division.txt", "no run\n");
    let guarded = source.replace("o := ", "IF d > 0 THEN o := ").replace("12 / d;", "12 / d; END_IF");
    for (from, to) in [("iec", "openplc"), ("openplc4", "iec"), ("iec", "codesys"), ("codesys", "openplc")] {
        let arguments = ["--from", from, "--to", to, "--assume", &assumed];
        let (code, text) = compare("divided", source, &arguments);
        assert_eq!(code, Some(4), "{text}");
        assert!(text.contains("a fault that ends both programs here, division by zero in line 4; "), "{text}");
        let (code, text) = compare("guarded", &guarded, &arguments);
        assert_eq!(code, Some(0), "{text}");
    }
}
