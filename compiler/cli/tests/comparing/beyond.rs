//! What a move changes other than counters, planted one kind a program: `staunch compare` lists it at the user's own
//! line, with the scans that show it.

use super::programs::{self, Folder, moved};

const OWN: Folder = Folder("beyond");

struct Planted {
    name: &'static str,
    from: &'static str,
    to: &'static str,
    /// From the second line on; the first is the PROGRAM's head.
    source: &'static str,
    /// Of the finding, as JSON has it.
    kind: &'static str,
    subject: &'static str,
    line: u32,
    trap: Option<u32>,
    scans: u32,
}

const PLANTED: &[Planted] = &[
    // The count passes 2 on one system alone, in its third edge.
    Planted {
        name: "timer",
        from: "iec",
        to: "cscape",
        source: "VAR_INPUT item : BOOL; END_VAR VAR e : R_TRIG; c : CTU; END_VAR
VAR late : TON; END_VAR
e(CLK := item); c(e.Q, FALSE, 2);
late(IN := c.CV > 2, PT := T#20ms);",
        kind: "timer",
        subject: "late",
        line: 3,
        trap: None,
        scans: 6,
    },
    Planted {
        name: "one_shot",
        from: "iec",
        to: "cscape",
        source: "VAR_INPUT item : BOOL; END_VAR VAR e : R_TRIG; c : CTU; END_VAR
VAR over : R_TRIG; END_VAR
e(CLK := item); c(e.Q, FALSE, 2);
over(CLK := c.CV > 2);",
        kind: "one-shot",
        subject: "over",
        line: 3,
        trap: None,
        scans: 5,
    },
    Planted {
        name: "latch",
        from: "iec",
        to: "cscape",
        source: "VAR_INPUT item : BOOL; END_VAR VAR e : R_TRIG; c : CTU; END_VAR
VAR jam : SR; END_VAR
e(CLK := item); c(e.Q, FALSE, 2);
jam(c.CV > 2, FALSE);",
        kind: "latch",
        subject: "jam",
        line: 3,
        trap: None,
        scans: 5,
    },
    // Logix keeps a latch over a power cycle.
    Planted {
        name: "kept_latch",
        from: "iec",
        to: "logix",
        source: "VAR_INPUT on, off : BOOL; END_VAR
VAR lamp : RS; END_VAR
lamp(on, off);",
        kind: "latch",
        subject: "lamp",
        line: 3,
        trap: Some(11),
        scans: 2,
    },
    // The sum leaves INT: CODESYS computes at 32 bits.
    Planted {
        name: "width",
        from: "iec",
        to: "codesys",
        source: "VAR_INPUT a, b : INT; END_VAR VAR sum : DINT; END_VAR

sum := a + b;",
        kind: "width",
        subject: "sum",
        line: 4,
        trap: None,
        scans: 1,
    },
    Planted {
        name: "condition",
        from: "iec",
        to: "codesys",
        source: "VAR_INPUT a, b : SINT; END_VAR VAR hot : BOOL; END_VAR
hot := FALSE;
IF a + b > 100 THEN
    hot := TRUE;
END_IF",
        kind: "width",
        subject: "hot",
        line: 4,
        trap: None,
        scans: 1,
    },
    // On OPENPLC, `%QX` is not part of `%QW`.
    Planted {
        name: "address",
        from: "iec",
        to: "openplc",
        source: "VAR_INPUT s : BOOL; END_VAR VAR word AT %QW0 : WORD; bit AT %QX0.0 : BOOL; END_VAR

bit := s;",
        kind: "address",
        subject: "word",
        line: 4,
        trap: None,
        scans: 1,
    },
    // The byte that is copied is the low half of the word on one system alone, in both directions.
    Planted {
        name: "address_copied",
        from: "iec",
        to: "openplc",
        source: "VAR_INPUT n : BYTE; END_VAR VAR byte_out AT %QB0 : BYTE; word_out AT %QW0 : WORD; copy : BYTE; END_VAR
word_out := BYTE_TO_WORD(n);
copy := byte_out;",
        kind: "address",
        subject: "copy",
        line: 4,
        trap: None,
        scans: 1,
    },
    Planted {
        name: "address_from_openplc",
        from: "openplc",
        to: "iec",
        source: "VAR_INPUT s : BOOL; END_VAR VAR word AT %QW0 : WORD; bit AT %QX0.0 : BOOL; copy : WORD; END_VAR
bit := s;
copy := word;",
        kind: "address",
        subject: "word",
        line: 3,
        trap: None,
        scans: 1,
    },
    // A plain variable, which STOP -> RUN of CODESYS keeps.
    Planted {
        name: "retention",
        from: "iec",
        to: "codesys",
        source: "VAR_INPUT on : BOOL; END_VAR
VAR seen : BOOL; END_VAR
seen := seen OR on;",
        kind: "retention",
        subject: "seen",
        line: 3,
        trap: Some(11),
        scans: 2,
    },
    // The divisor is 0 when the count is 3, which CSCAPE does not reach.
    Planted {
        name: "fault",
        from: "iec",
        to: "cscape",
        source: "VAR_INPUT item : BOOL; END_VAR VAR e : R_TRIG; c : CTU; share : INT; END_VAR
e(CLK := item); c(e.Q, FALSE, 2);
share := 100 / (c.CV - 3);",
        kind: "fault",
        subject: "iec",
        line: 4,
        trap: None,
        scans: 5,
    },
];

#[test]
fn each_kind_is_found_at_its_line() {
    for it in PLANTED {
        let path = OWN.program(it.name, it.source);
        let (code, text) = moved(&path, it.from, it.to, &["--message-format", "json"]);
        assert_eq!(code, Some(1), "{}: {text}", it.name);
        let of = format!("\"kind\":\"{}\",\"at\":\"{}:{}\"", it.kind, path, it.line);
        let found =
            text.lines().find(|line| line.contains(&of) && line.contains(&format!("\"counter\":\"{}\"", it.subject)));
        let found = found.unwrap_or_else(|| panic!("{}: no {of}\n{text}", it.name));
        let trap = it.trap.map_or("null".to_owned(), |it| it.to_string());
        let shown = format!("\"trap\":{trap},\"verdict\":\"reachable\",\"scans\":{},", it.scans);
        assert!(found.contains(&shown), "{}: not {shown}\n{found}", it.name);
    }
}

/// The reason is found through copies, calls and conditions; it is the one that comes first.
#[test]
fn what_follows_from_a_finding_is_said_to() {
    let source = "VAR_INPUT n, k : INT; END_VAR
VAR low AT %MW0 : INT; both AT %MD0 : DINT; a, b : DINT; big : DINT; c : CTU; END_VAR VAR_OUTPUT hit, wide : BOOL; END_VAR
low := n; a := both; b := MAX(a, 0);
IF b > 10 THEN hit := TRUE; ELSE hit := FALSE; END_IF
c(CU := hit, R := FALSE, PV := 1);
big := n + k; wide := big > 40000;";
    let path = OWN.program("followed", source);
    for (from, to) in [("iec", "openplc"), ("openplc", "iec")] {
        for shown in ["hit", "c.Q", "b"] {
            let (code, text) = moved(&path, from, to, &["--vars", shown]);
            assert_eq!(code, Some(1), "{text}");
            let reason =
                format!("`{shown}` follows from `both` (address, {}:4): only one of the two systems shares", path);
            assert!(text.contains(&reason) && !text.contains("(variable, "), "{text}");
        }
    }
    let (_, text) = moved(&path, "iec", "codesys", &["--vars", "wide"]);
    assert!(text.contains(&format!("`wide` follows from `big` (width, {}:7): ", path)), "{text}");
}

/// What is the same on both systems is not said to differ, and what follows from a counter's trap fails no more than that.
#[test]
fn what_does_not_differ_is_not_found() {
    let timer = PLANTED.iter().find(|it| it.name == "timer").expect("it is planted");
    let path = OWN.program("accepted", timer.source);
    let accept = OWN.path().join("accepted.txt");
    std::fs::write(&accept, "c 2: nobody reads the count past its preset\nc 1: it is fed edges\n").expect("a file");
    let (code, text) = moved(&path, "iec", "cscape", &["--accept", &accept.display().to_string()]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("`late` (timer, ") && text.contains("the inputs of the block differ"), "{text}");
    let path = OWN.program(
        "alike",
        "VAR_INPUT a : BOOL; END_VAR VAR t : TON; n : BOOL; END_VAR\nt(IN := a, PT := T#30ms); n := t.Q;",
    );
    let (code, text) = moved(&path, "iec", "cscape", &[]);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("reachable after"), "{text}");
}

/// Whether a name changes does not depend on a lint's level; and it is the names of a counter's own pins that count.
#[test]
fn a_name_that_changes_is_one_whatever_the_lint_says() {
    let named = "VAR_INPUT s, r : BOOL; END_VAR VAR c, d : CTU; END_VAR\n";
    let body = "c(CU := s, R := r, PV := 3); d(s, r, 3);";
    for (name, allowed) in [("renamed", ""), ("renamed_allowed", "{allow W0609}\n")] {
        let path = OWN.program(name, &format!("{named}{allowed}{body}"));
        let (_, text) = moved(&path, "iec", "cscape", &["--message-format", "json", "--budget", "20000"]);
        for (counter, verdict) in [("c", "reachable"), ("d", "impossible")] {
            let found = format!("\"counter\":\"{counter}\",\"trap\":9,\"verdict\":\"{verdict}\"");
            assert!(text.contains(&found), "{found}\n{text}");
        }
    }
    let other = OWN.program(
        "renamed_other",
        "VAR_INPUT s : BOOL; END_VAR VAR c : CTU; latch : RS; END_VAR\nlatch(S := s, R1 := FALSE);",
    );
    let (_, text) = moved(&other, "iec", "codesys", &["--message-format", "json", "--budget", "20000"]);
    assert!(text.contains("\"counter\":\"c\",\"trap\":9,\"verdict\":\"impossible\""), "{text}");
}

/// An assumption beyond a subrange would make a stimulus that no run takes.
#[test]
fn an_assumption_lies_within_the_subrange() {
    let path = OWN.program("subrange", "VAR_INPUT t : INT(1..9); END_VAR VAR o : BOOL; END_VAR\no := t > 3;");
    let assume = OWN.path().join("beyond_subrange.txt");
    std::fs::write(&assume, "t 20..30\n").expect("a file");
    let (code, _) = moved(&path, "iec", "cscape", &["--assume", &assume.display().to_string()]);
    assert_eq!(code, Some(2));
}

/// Nor is a time one that only one of the systems has.
#[test]
fn an_assumption_is_of_times_that_both_systems_have() {
    let path = OWN.program("times", "VAR_INPUT t : TIME; END_VAR VAR o : BOOL; END_VAR\no := t < T#0s;");
    let assume = OWN.path().join("beyond_times.txt");
    for (line, code) in [("t T#-1s .. T#1s\n", 2), ("t T#0s .. T#1s\n", 0)] {
        std::fs::write(&assume, line).expect("a file");
        for [from, to] in [["iec", "codesys"], ["codesys", "iec"]] {
            assert_eq!(moved(&path, from, to, &["--assume", &assume.display().to_string()]).0, Some(code), "{line}");
        }
    }
}

/// A guard after an edge, as trap 14 advises, makes no edge: it is another program.
#[test]
fn a_guard_that_makes_no_edge_is_no_trap() {
    let text = |guard: &str| {
        format!(
            "VAR_INPUT p, l : BOOL; END_VAR VAR c : CTD; e : R_TRIG; low : BOOL; END_VAR
e(CLK := p); c(e.Q{guard}, l, 2); low := c.CV < 0;"
        )
    };
    let (plain, guarded) = (OWN.program("unguarded", &text("")), OWN.program("guarded", &text(" AND c.CV > 0")));
    let (code, text) = moved(&plain, "iec", "iec", &["--against", &guarded]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("None of the traps explains it") && !text.contains("reachable after"), "{text}");
}

/// Findings of a kind are accepted by its name.
#[test]
fn a_kind_is_accepted_by_its_name() {
    let retention = PLANTED.iter().find(|it| it.name == "retention").expect("it is planted");
    let path = OWN.program("accepted_kind", retention.source);
    let accept = OWN.path().join("accepted_kind.txt");
    std::fs::write(&accept, "seen retention: the plant is never stopped while it runs\n").expect("a file");
    let (code, text) = moved(&path, "iec", "codesys", &["--accept", &accept.display().to_string()]);
    assert_eq!(code, Some(0), "{text}");
}

/// What the other system lacks is said at the user's own line, by what is known of each system.
#[test]
fn what_is_lacking_is_said_at_its_line() {
    let path = OWN.program(
        "lacking",
        "VAR_INPUT a : BOOL; END_VAR
VAR t : TON; latch : SR; mask : WORD; END_VAR
t(IN := a, PT := T#30ms); latch(t.Q, FALSE); mask := 3;",
    );
    let (code, text) = moved(&path, "codesys", "logix", &[]);
    assert_eq!(code, Some(1), "{text}");
    for line in [
        "LOGIX does not have TON (`t`)",
        "LOGIX does not have SR (`latch`): use SETD",
        "LOGIX does not have WORD (`mask`)",
    ] {
        assert!(text.contains(&format!("{}:3: {line}", path)), "{line}\n{text}");
    }
    let (_, json) = moved(&path, "codesys", "logix", &["--message-format", "json"]);
    let found = format!("\"kind\":\"missing\",\"at\":\"{}:3\",\"counter\":\"mask\"", path);
    assert!(json.contains(&found), "{json}");
    let wide = OWN.program(
        "second_edition",
        "VAR_INPUT a : BOOL; END_VAR\nVAR t : LTIME; w : WSTRING; END_VAR\nt := t + LTIME#1ms;",
    );
    let (code, text) = moved(&wide, "iec", "openplc", &[]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("OPENPLC does not have LTIME (`t`): use TIME"), "{text}");
    assert!(text.contains("OPENPLC does not have WSTRING (`w`)"), "{text}");
    let (_, text) = moved(&wide, "iec", "cscape", &[]);
    assert!(
        text.contains("Not known: no public document says whether CSCAPE has LTIME (`t`), WSTRING (`w`)."),
        "{text}"
    );
    let path =
        OWN.program("no_ctud", "VAR_INPUT a : BOOL; END_VAR\nVAR c : CTUD; END_VAR\nc(a, FALSE, FALSE, FALSE, 3);");
    let (code, text) = programs::compare(&[&path, "--from", "iec", "--to", "cscape"]);
    assert_eq!(code, Some(1));
    assert!(text.contains("no_ctud.st:3:"), "{text}");
}

/// What the event itself parts is the finding, also where the scan after it hides that; not what follows from it.
#[test]
fn what_an_event_parts_is_named_and_not_what_follows() {
    let path = OWN.program(
        "lost_by_an_event",
        "VAR_INPUT i : BOOL; END_VAR
VAR RETAIN keep : INT; END_VAR
VAR m : BOOL; END_VAR
IF i AND NOT m THEN keep := keep + 1; END_IF;
m := i;",
    );
    let (code, text) = moved(&path, "iec", "codesys", &[]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("`m` (retention") && text.contains("  reachable after 2 scans: trap 11"), "{text}");
    assert!(!text.contains("`keep` (retention"), "both systems keep it:\n{text}");
    let accept = OWN.path().join("lost_by_an_event.txt");
    std::fs::write(&accept, "m 11: the plant is never stopped while it runs\n").expect("a file");
    let (code, text) = moved(&path, "iec", "codesys", &["--accept", &accept.display().to_string()]);
    // The search may end before every state was seen.
    assert!(matches!(code, Some(0 | 4)) && text.contains("That is accepted."), "{text}");
}

/// The verdict is the exit code, also where nobody reads what is printed.
#[test]
fn a_reader_that_leaves_does_not_change_the_verdict() {
    let path = OWN.program("left_early", "VAR_INPUT i : BOOL; END_VAR\nVAR c : CTU; END_VAR\nc(CU := i, PV := 2);");
    let command = |arguments: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_staunch"));
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        command.args(arguments).stdout(writer.try_clone().expect("a handle")).stderr(writer);
        command.status().expect("it starts").code()
    };
    assert_eq!(command(&["compare", &path, "--from", "iec", "--to", "codesys"]), Some(1));
    assert_eq!(command(&["check", &path]), Some(0));
    assert_eq!(command(&["check", &path, "--dialect", "logix"]), Some(1));
    assert_eq!(command(&["check", "there/is/no/such/file.st"]), Some(2));
}
