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
    let (code, text) = OWN.compare("open_run", source, &arguments);
    assert_eq!(code, Some(1), "{text}");
    let other = "With `ctu-stop-at-pv = true`, the two differ after 2 scans; without STOP -> RUN, the two are equal.";
    assert!(text.contains(other), "{text}");
    let shown = "The advice is right with `ctu-stop-at-pv = false`; with other settings it may not be.";
    assert!(text.contains("the two differ after 7 scans") && text.contains(shown), "{text}");
    let (_, json) = OWN.compare("open_run_json", source, &[&arguments[..], &["--message-format", "json"]].concat());
    assert!(json.contains("\"verdict\":\"different\",\"without_run\":\"equal\"}]"), "{json}");
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
