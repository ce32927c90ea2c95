//! What the report says of a difference, or of none: what is blamed, what is left open, and by which names.

use super::programs::{self, Folder};

const OWN: Folder = Folder("reports");

const CALM: &str = "no run\nno restart\nno reset\n";

fn program(name: &str, declared: &str, body: &str) -> String {
    OWN.written(&format!("{name}.st"), &format!("PROGRAM p\n{declared}\n{body}\nEND_PROGRAM\n"))
}

fn compare(path: &str, [from, to]: [&str; 2], more: &[&str]) -> (Option<i32>, String) {
    programs::compare(&[&[path, "--from", from, "--to", to, "-A", "warnings"], more].concat())
}

const PULSES: &str = "VAR_INPUT s : BOOL; END_VAR VAR_OUTPUT o : BOOL; END_VAR";
const EDGE: &str = "b := s AND NOT m; m := s;";

/// The counter is RETAIN on both; it is the edge flag that Logix alone keeps over the restart.
#[test]
fn what_one_system_keeps_is_blamed_and_not_the_counter_that_it_feeds() {
    let ours = program(
        "kept_edge",
        &format!("{PULSES} VAR c : COUNTER; b, m : BOOL; END_VAR"),
        &format!("{EDGE} c.PRE := 2; c.CU := FALSE; CTU(c, b); o := c.ACC >= 2;"),
    );
    let body = format!("{EDGE} c(b, FALSE, 2); o := c.CV >= 2;");
    let theirs =
        program("kept_edge_moved", &format!("{PULSES} VAR RETAIN c : CTU; END_VAR VAR b, m : BOOL; END_VAR"), &body);
    let (code, text) = compare(&ours, ["logix", "openplc"], &["--against", &theirs, "--vars", "o"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 11 (`m`): ") && !text.contains("Trap 5 "), "{text}");
    // A counter that one program declares and never calls is not to blame.
    let declared = format!("{PULSES} VAR RETAIN c : CTU; n : INT; END_VAR VAR b, m : BOOL; END_VAR");
    let theirs = program(
        "counted_otherwise",
        &declared,
        &format!("{EDGE} IF b AND n < 3 THEN n := n + 1; END_IF; o := n >= 2;"),
    );
    let (code, text) = compare(&ours, ["logix", "openplc"], &["--against", &theirs, "--vars", "o"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 11 (`m`): "), "{text}");
    assert!(text.contains(": one of the two programs never calls it") && !text.contains("trap 15."), "{text}");
    // An edge flag that starts otherwise is another program.
    let declared = format!("{PULSES} VAR RETAIN c : CTU; END_VAR VAR b : BOOL; m : BOOL := TRUE; END_VAR");
    let theirs = program("other_edge", &declared, &body);
    let (code, text) = compare(&ours, ["logix", "openplc"], &["--against", &theirs, "--vars", "o"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("None of the traps explains it"), "{text}");
}

/// What a CASE chooses is 5, 10 or 20, or 0 before that: counts past those are one. What adds to itself may be anything.
#[test]
fn a_preset_that_the_program_chooses_is_one_of_a_few() {
    let declared = "VAR_INPUT part, load : BOOL; recipe : INT(1..3); END_VAR VAR_OUTPUT done : BOOL; END_VAR
        VAR rest : CTD; e : R_TRIG; target, chosen : INT; END_VAR";
    let body = "CASE recipe OF 1: chosen := 5; 2: chosen := 10; 3: chosen := 20; END_CASE; target := chosen;
        e(CLK := load); rest(CD := part, LD := e.Q, PV := target); done := rest.Q;";
    let path = program("recipe", declared, body);
    let (code, text) = compare(&path, ["siemens", "iec"], &[]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("all counts past the values that they are compared with taken as one state"), "{text}");
    let path = program("recipe_grows", declared, &body.replace("3: chosen := 20", "3: chosen := chosen + 1"));
    let (code, text) = compare(&path, ["siemens", "iec"], &["--budget", "20000"]);
    assert_eq!(code, Some(4), "{text}");
}

/// Ten inputs have 1024 combinations: that the count has passed 3 on one system shows in one of them alone.
#[test]
fn all_combinations_of_many_inputs_are_tried() {
    let declared =
        "VAR_INPUT a, b, d, e, f, g, h, i, j, k : BOOL; END_VAR VAR_OUTPUT o : BOOL; END_VAR VAR c : CTU; END_VAR";
    let all = "a AND b AND d AND e AND f AND g AND h AND i AND j AND k";
    let body = |shown: &str| format!("c(CU := a XOR b, R := FALSE, PV := 3); o := {shown} AND {all};");
    let path = program("ten", declared, &body("c.Q"));
    let (code, text) = compare(&path, ["iec", "openplc"], &["--vars", "o"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("under every value of the inputs (a, b, d, e, f, g, h, i, j, k)"), "{text}");
    let path = program("ten_differ", declared, &body("c.CV > 3"));
    let (code, text) = compare(&path, ["iec", "openplc"], &["--vars", "o"]);
    assert_eq!(code, Some(1), "{text}");
    // 2^14 are as many as are tried.
    let more = declared.replace("a, b", "a, b, l, m, n, p0, q");
    let path = program("fifteen", &more, &body("c.Q"));
    let (code, text) = compare(&path, ["iec", "openplc"], &["--vars", "o"]);
    assert_eq!(code, Some(4), "{text}");
    assert!(text.contains("combinations of inputs other than the 16384 in which few of them change"), "{text}");
}

/// 1756-RM003, "CTU": a count past 2,147,483,647 continues at -2,147,483,648. No budget reaches that.
#[test]
fn a_count_of_logix_that_nothing_resets_is_said_to_go_on() {
    let declared = format!("{PULSES} VAR RETAIN c : CTU; e : R_TRIG; END_VAR");
    let ours = program("never_reset", &declared, "e(CLK := s); c(e.Q AND c.CV < 4, FALSE, 2); o := c.CV >= 2;");
    let declared = format!("{PULSES} VAR c : COUNTER; b, m : BOOL; END_VAR");
    let call = "c.PRE := 2; c.CU := FALSE; CTU(c, b); o := c.ACC >= 2;";
    let theirs = program("never_reset_logix", &declared, &format!("{EDGE} {call}"));
    let arguments = ["--against", &theirs, "--vars", "o", "--budget", "20000"];
    let (code, text) = compare(&ours, ["iec", "logix"], &arguments);
    assert_eq!(code, Some(4), "{text}");
    assert!(
        text.contains("the whole count of `c`, which nothing resets: ACC of Logix wraps after 2147483647"),
        "{text}"
    );
    let theirs = program("reset_logix", &declared, &format!("{EDGE} {call} RES(c, FALSE AND s OR c.ACC > 3);"));
    let (_, text) = compare(&ours, ["iec", "logix"], &["--against", &theirs, "--vars", "o", "--budget", "20000"]);
    assert!(!text.contains("which nothing resets"), "{text}");
}

/// A DN that nothing reads makes no trap reachable.
#[test]
fn a_flag_that_nothing_reads_shows_nothing() {
    let calm = OWN.written("calm.txt", CALM);
    let ours = program(
        "loaded",
        "VAR_INPUT l : BOOL; END_VAR VAR_OUTPUT o : BOOL; END_VAR VAR c : CTUD; d : CTD; END_VAR",
        "c(FALSE, FALSE, FALSE, l, 3); d(FALSE, FALSE, 2); o := c.QU AND d.Q;",
    );
    let declared = "VAR_INPUT l : BOOL; END_VAR VAR_OUTPUT o : BOOL; END_VAR VAR c : FBD_COUNTER; d : COUNTER; END_VAR";
    let call = "c.PRE := 3; c.CUEnable := FALSE; c.CDEnable := FALSE; c.Reset := FALSE; CTUD(c);
        IF l THEN c.ACC := c.PRE; END_IF; d.PRE := 2; CTD(d, FALSE);";
    let theirs = program("loaded_logix", declared, &format!("{call} o := c.ACC >= c.PRE AND d.ACC <= 0;"));
    let arguments = ["--against", &theirs, "--vars", "o", "--assume", &calm];
    let (code, text) = compare(&ours, ["iec", "logix"], &arguments);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("reachable after") && !text.contains("undecided"), "{text}");
    assert!(text.contains("impossible: trap 13: nothing reads its DN"), "{text}");
    assert!(text.contains("impossible: trap 4: nothing reads its DN or loads it"), "{text}");
    // One that is read, before ACC is loaded, does.
    let theirs = program("read_logix", declared, &format!("{call} o := c.DN AND d.ACC <= 0;"));
    let arguments = ["--against", &theirs, "--vars", "o", "--assume", &calm];
    let (code, text) = compare(&ours, ["iec", "logix"], &arguments);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 13 (`c`)"), "{text}");
}

/// No name is left out of what a verdict rests on; of many elements of one array the first and the last stand for it.
#[test]
fn what_is_not_compared_is_named() {
    let declared = "VAR_INPUT s : BOOL; END_VAR VAR_OUTPUT o : BOOL; END_VAR VAR c : CTU; END_VAR";
    let ours = program("few", declared, "c(s, FALSE, 3); o := c.Q;");
    let more = "VAR aa, bb, cc, dd, ee, ff, gg : BOOL; t : ARRAY[0..9] OF BOOL; END_VAR";
    let theirs = program("more", &format!("{declared} {more}"), "c(s, FALSE, 3); o := c.Q;");
    let (code, text) = compare(&ours, ["iec", "openplc"], &["--against", &theirs, "--vars", "o"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(
        text.contains("not compared, since only one program has it: aa, bb, cc, dd, ee, ff, gg, t[0] to t[9]"),
        "{text}"
    );
}

/// With CTU that stops, the count is past PV on the other system after 3 scans; with one that counts further, the two differ in
/// the rising edge of the guard alone.
#[test]
fn the_shortest_is_so_by_one_setting() {
    let calm = OWN.written("settings/calm.txt", CALM);
    OWN.written("settings/staunch.toml", "ctu-stop-at-pv = false\n");
    let declared = format!("{PULSES} VAR c : CTU; e : R_TRIG; END_VAR");
    let body = "e(CLK := s); c(e.Q, c.CV > 5, 1); o := c.CV > 1 AND c.CV < {less};";
    let theirs = body.replace("{less}", "3");
    let ours = program("settings/ours", &declared, &body.replace("{less}", "4"));
    let theirs = program("settings/theirs", &declared, &theirs);
    let arguments = ["--against", &theirs, "--vars", "o", "--assume", &calm];
    let (code, text) = compare(&ours, ["codesys", "iec"], &arguments);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("codesys and iec differ after 5 scans"), "{text}");
    assert!(text.contains("shows a difference with these settings; with others, one does"), "{text}");
    assert!(text.contains("With `ctu-stop-at-pv = true`, the two differ after 3 scans."), "{text}");
}

/// Trap 2 is also that of a CTU of CODESYS that stops; its advice is proved with the others.
#[test]
fn a_ctu_of_codesys_that_stops_is_trap_2() {
    OWN.written("stops/staunch.toml", "ctu-stop-at-pv = true\n");
    let calm = OWN.written("stops/calm.txt", CALM);
    let path = program("stops/ctu", &format!("{PULSES} VAR c : CTU; END_VAR"), "c(s, FALSE, 1); o := c.CV > 1;");
    let (code, text) = compare(&path, ["codesys", "iec"], &["--vars", "o", "--assume", &calm]);
    assert_eq!(code, Some(1), "{text}");
    let sentence = "Trap 2 (`c`): Past PV: the count of a CTU of CODESYS and TwinCAT stays at PV \
        with `ctu-stop-at-pv = true`; others continue to count. Where it stays, `CV > PV` is never TRUE, and `CV = PV` stays TRUE.";
    // Nothing is said of systems that are not compared.
    assert!(text.contains(sentence) && !text.contains("CSCAPE"), "{text}");
    assert!(text.contains("ELSIF edge AND n < preset THEN n := n + 1; END_IF; full := n >= preset;"), "{text}");
}
