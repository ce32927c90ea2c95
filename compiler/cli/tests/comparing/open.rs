//! What a vendor leaves open: every setting is tried, and the verdict names it.

use super::programs::Folder;

const OWN: Folder = Folder("open");

/// `over` where the count passes its preset, up to where it is reset.
fn past_preset(reset: &str) -> String {
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
}

/// The count passes PV on IEC; on CODESYS it does by some of its documents, and stops by others (Beckhoff's older page of
/// Tc2_Standard: "CV is increased by 1 as long as CV is less than PV").
#[test]
fn what_a_vendor_leaves_open_is_tried_both_ways() {
    let arguments = |from: &'static str, to: &'static str| ["--from", from, "--to", to, "--vars", "over"];
    let passes = past_preset("c.CV > 5");
    for (from, to, shown, other) in [
        ("iec", "codesys", "`ctu-stop-at-pv = true`", "With `ctu-stop-at-pv = false`, the two are equal."),
        ("codesys", "openplc", "`ctu-stop-at-pv = false`", "With `ctu-stop-at-pv = true`, the two are equal."),
    ] {
        let no_run = OWN.written("no_run.txt", "no run\n");
        let (code, text) = OWN.compare("open", &passes, &[&arguments(from, to)[..], &["--assume", &no_run]].concat());
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains(&format!("The verdict above is with {shown}. {other}")), "{text}");
    }
    // What never reaches its preset is the same either way, and that is said.
    let below = past_preset("c.CV > 1");
    let no_run = OWN.written("no_run.txt", "no run\n");
    let arguments = [&arguments("iec", "codesys")[..], &["--assume", &no_run]].concat();
    let (code, text) = OWN.compare("open_below", &below, &arguments);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("With `ctu-stop-at-pv = true`, the two are equal."), "{text}");
    let (_, json) = OWN.compare("open_json", &below, &[&arguments[..], &["--message-format", "json"]].concat());
    let settings = "\"settings\":{\"ctu-stop-at-pv\":false},\"other_settings\":[{\"settings\":{\"ctu-stop-at-pv\":true},\"verdict\":\"equal\"}]";
    assert!(json.contains(settings), "{json}");
}

/// CODESYS keeps the count over STOP -> RUN whatever CTU does at its preset; without that, only the CTU that counts further differs
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
    let (code, text) = OWN.compare("open_run", source, &arguments);
    assert_eq!(code, Some(1), "{text}");
    let other = "With `ctu-stop-at-pv = true`, the two differ after 2 scans; without STOP -> RUN, the two are equal.";
    assert!(text.contains(other), "{text}");
    let shown = "The advice is valid with `ctu-stop-at-pv = false`, but perhaps not with other settings.";
    assert!(text.contains("the two differ after 7 scans") && text.contains(shown), "{text}");
    let (_, json) = OWN.compare("open_run_json", source, &[&arguments[..], &["--message-format", "json"]].concat());
    assert!(json.contains("\"verdict\":\"different\",\"without_run\":\"equal\"}]"), "{json}");
}

/// Of a number with a fraction next to a REAL, CODESYS and Beckhoff say on one page that it is an LREAL, and on another that it is what
/// its place asks for.
#[test]
fn a_number_with_a_fraction_is_tried_as_both_types() {
    let source = "PROGRAM p
VAR_INPUT a : BOOL; END_VAR
VAR_OUTPUT k : BOOL; END_VAR
VAR r : REAL := 0.1; END_VAR
k := a AND r = 0.1;
END_PROGRAM
";
    let no_run = OWN.written("no_run.txt", "no run\n");
    let arguments = ["--from", "codesys", "--to", "iec", "--assume", &no_run];
    let (code, text) = OWN.compare("fraction", source, &arguments);
    assert_eq!(code, Some(1), "{text}");
    let shown = "The verdict above is with `codesys-real-literals = \"lreal\"`. With `codesys-real-literals = \"place\"`, the two are equal.";
    assert!(text.contains(shown), "{text}");
    let (code, text) = OWN.compare("exact_fraction", &source.replace("0.1", "0.5"), &arguments);
    assert!(code == Some(0) && !text.contains("codesys-real-literals"), "{text}");
}

/// A project that has asked its vendor decides it.
#[test]
fn what_the_project_decides_is_the_verdict() {
    OWN.written("decided/staunch.toml", "ctu-stop-at-pv = false\n");
    let arguments = ["--from", "iec", "--to", "codesys", "--vars", "over", "--assume"];
    let no_run = OWN.written("never_run.txt", "no run\n");
    let (code, text) =
        OWN.compare("decided/p", &past_preset("c.CV > 5"), &[&arguments[..], &[no_run.as_str()]].concat());
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("With `ctu-stop-at-pv = true`, the two differ after 7 scans."), "{text}");
}

/// MATIEC's `T#1300ms` is 1299999999 ns on x86-64, and `T#1.3s` another number; whole seconds and halves are exact everywhere.
#[test]
fn times_that_openplc_may_not_hold_are_not_called_equal() {
    let source = |condition: &str| {
        format!(
            "PROGRAM p
VAR_INPUT a : BOOL; END_VAR
VAR_OUTPUT k : BOOL; END_VAR
VAR x : TIME := T#1300ms; d : TON; END_VAR
d(IN := a, PT := T#2s);
k := {condition};
END_PROGRAM
"
        )
    };
    for (name, condition, code) in [
        ("times_equal", "x = T#1.3s", 4),
        ("times_of_a_timer", "d.ET > T#130ms", 4),
        ("times_of_two", "d.ET > x", 4),
        ("times_of_minutes", "x = T#1.15m", 4),
        ("times_exact", "d.ET > T#500ms", 0),
    ] {
        for to in ["openplc", "iec"] {
            let from = if to == "iec" { "openplc" } else { "iec" };
            let (found, text) = OWN.compare(name, &source(condition), &["--from", from, "--to", to, "--vars", "k"]);
            assert_eq!(found, Some(code), "{text}");
            assert_eq!(
                text.contains("a comparison of TIMEs of OPENPLC, which Staunch does not follow"),
                code == 4,
                "{text}"
            );
        }
    }
}

/// A verdict that nothing differs names what the documents do not specify.
#[test]
fn values_that_a_vendor_leaves_open_are_named() {
    let source = "PROGRAM p
VAR_INPUT a : BOOL; END_VAR
VAR_OUTPUT k : BOOL; END_VAR
VAR n : INT; END_VAR
n := (n + 1) MOD 3;
k := a AND n MOD 2 = 1;
END_PROGRAM
";
    let no_run = OWN.written("no_run.txt", "no run\n");
    let arguments = ["--from", "codesys", "--to", "iec", "--assume", &no_run];
    let (code, text) = OWN.compare("left_open", source, &arguments);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("The documents of CODESYS do not specify `MOD` of a negative number (line 5)"), "{text}");
    let (_, json) = OWN.compare("left_open", source, &[&arguments[..], &["--message-format", "json"]].concat());
    assert!(json.contains("\"open\":[\"The documents of CODESYS do not specify `MOD`"), "{json}");
    let exact = source.replace("MOD", "*");
    let (_, text) = OWN.compare("nothing_open", &exact, &arguments);
    assert!(!text.contains("do not specify"), "{text}");
}

/// Between a system with nanoseconds and one with milliseconds, an input has what both have, and the verdict says so.
#[test]
fn inputs_are_times_of_both_systems() {
    let source = |assigned: &str| {
        format!("PROGRAM p\nVAR_INPUT a : TIME; END_VAR\nVAR_OUTPUT b : TIME; END_VAR\nb := {assigned};\nEND_PROGRAM\n")
    };
    let arguments = ["--from", "iec", "--to", "siemens"];
    for (name, assigned) in [("greater", "MAX(a, T#1s)"), ("limited", "LIMIT(T#1s, a, T#5s)")] {
        let (code, text) = OWN.compare(name, &source(assigned), &arguments);
        assert_eq!(code, Some(4), "{text}");
        assert!(text.contains("Of `a`, only what both systems have is tried: T#-24d20h31m23s648ms to "), "{text}");
    }
    let (code, text) = OWN.compare("tripled", &source("a * 3"), &["--from", "codesys", "--to", "siemens"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(!text.contains("us") || !text.contains("ns"), "{text}");
    let (_, json) =
        OWN.compare("greater_json", &source("MAX(a, T#1s)"), &[&arguments[..], &["--message-format", "json"]].concat());
    assert!(json.contains("\"in_common\":[\"Of `a`, only what both"), "{json}");
}

/// A timer of CODESYS counts whole milliseconds, whatever the scan's time.
#[test]
fn timers_in_parts_of_a_millisecond_are_not_called_equal() {
    let source = "PROGRAM p
VAR_INPUT a : BOOL; END_VAR
VAR_OUTPUT q : BOOL; END_VAR
VAR t : TON; END_VAR
t(IN := a, PT := T#3ms);
q := t.ET > T#0ms AND t.ET < T#1ms;
END_PROGRAM
";
    let never = OWN.written("never.txt", "no run\nno restart\nno reset\n");
    for (name, cycle, code) in [("parts", "700us", 4), ("whole", "2ms", 0)] {
        let arguments = ["--from", "iec", "--to", "codesys", "--cycle", cycle, "--assume", &never];
        let (found, text) = OWN.compare(name, source, &arguments);
        assert_eq!(found, Some(code), "{text}");
        assert_eq!(text.contains("the time between scans is not a whole number of milliseconds"), code == 4, "{text}");
    }
}
