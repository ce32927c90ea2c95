//! The advice of `staunch compare`, proved by running it: the program as it is parts from itself by the
//! trap on the other system, and the program changed as advised is equal to the original.

use std::path::PathBuf;
use std::process::{Command, Output};

/// One advice, taken.
struct Taken {
    trap: usize,
    from: &'static str,
    to: &'static str,
    vars: &'static str,
    /// The variables that all texts declare.
    declared: &'static str,
    original: &'static str,
    /// The original as it would be written on the other system without the advice.
    moved: &'static str,
    advised: &'static str,
}

const RISING: &str = "VAR_INPUT sensor, clear : BOOL; END_VAR VAR full, over : BOOL; c : CTU; e : R_TRIG; END_VAR";
const FALLING: &str = "VAR_INPUT pulse, load : BOOL; END_VAR VAR c : CTD; e : R_TRIG; END_VAR";

const TAKEN: &[Taken] = &[
    Taken {
        trap: 1,
        from: "iec",
        to: "cscape",
        vars: "full",
        declared: RISING,
        original: "c(CU := sensor AND NOT full, R := clear, PV := 3); full := c.Q;",
        moved: "c(CU := sensor AND NOT full, RESET := clear, PV := 3); full := c.Q;",
        advised: "e(CLK := sensor AND NOT full); c(CU := e.Q, RESET := clear, PV := 3); full := c.Q;",
    },
    Taken {
        trap: 2,
        from: "iec",
        to: "cscape",
        vars: "over",
        declared: RISING,
        original: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, R := clear, PV := 3); over := c.CV > 4;",
        moved: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, RESET := clear, PV := 3); over := c.CV > 4;",
        advised: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, RESET := clear, PV := 32767); over := c.CV > 4;",
    },
    Taken {
        trap: 3,
        from: "codesys",
        to: "iec",
        vars: "c.CV,c.Q",
        declared: FALLING,
        original: "c(CD := pulse, LOAD := load, PV := 3);",
        moved: "c(CD := pulse, LD := load, PV := 3);",
        advised: "e(CLK := pulse); c(CD := e.Q AND c.CV > 0, LD := load, PV := 3);",
    },
    Taken {
        trap: 6,
        from: "iec",
        to: "cscape",
        vars: "full",
        declared: RISING,
        original: "c(CU := sensor AND c.CV < 3, R := clear, PV := 2); full := c.CV >= 2;",
        moved: "c(CU := sensor AND c.CV < 3, RESET := clear, PV := 2); full := c.CV >= 2;",
        advised: "e(CLK := sensor AND c.CV < 3); c(CU := e.Q, RESET := clear, PV := 32767); full := c.CV >= 2;",
    },
    Taken {
        trap: 8,
        from: "iec",
        to: "codesys",
        vars: "c.CV",
        declared: "VAR_INPUT pulse : BOOL; END_VAR VAR c : CTU := (CV := 32764); e : R_TRIG; END_VAR",
        original: "e(CLK := pulse); c(CU := e.Q, R := FALSE, PV := 10);",
        moved: "e(CLK := pulse); c(CU := e.Q, RESET := FALSE, PV := 10);",
        advised: "e(CLK := pulse); c(CU := e.Q AND c.CV < 32767, RESET := FALSE, PV := 10);",
    },
    Taken {
        trap: 8,
        from: "iec",
        to: "codesys",
        vars: "full",
        declared: "VAR_INPUT sensor : BOOL; preset : INT(-2..3); END_VAR VAR full : BOOL; c : CTU; END_VAR",
        original: "c(CU := sensor AND c.CV < 3, R := FALSE, PV := preset); full := c.Q;",
        moved: "c(CU := sensor AND c.CV < 3, RESET := FALSE, PV := INT_TO_WORD(preset)); full := c.Q;",
        advised: "c(CU := sensor AND c.CV < 3, RESET := FALSE, PV := INT_TO_WORD(MAX(preset, 0))); full := c.Q;",
    },
    Taken {
        trap: 10,
        from: "iec",
        to: "cscape",
        vars: "full",
        declared: "VAR_INPUT sensor : BOOL; preset : INT(1..3) := 1; END_VAR VAR full : BOOL; c : CTU; e : R_TRIG; END_VAR",
        original: "e(CLK := sensor); c(CU := e.Q AND c.CV < 4, R := FALSE, PV := preset); full := c.Q;",
        moved: "e(CLK := sensor); c(CU := e.Q AND c.CV < 4, RESET := FALSE, PV := preset); full := c.Q;",
        advised: "e(CLK := sensor); c(CU := e.Q AND c.CV < 4, RESET := FALSE, PV := 32767); full := c.CV >= preset;",
    },
    Taken {
        trap: 14,
        from: "codesys",
        to: "iec",
        vars: "c.CV,c.Q",
        declared: FALLING,
        original: "c(CD := pulse, LOAD := load, PV := 3);",
        moved: "c(CD := pulse AND c.CV > 0, LD := load, PV := 3);",
        advised: "e(CLK := pulse); c(CD := e.Q AND c.CV > 0, LD := load, PV := 3);",
    },
    Taken {
        trap: 15,
        from: "iec",
        to: "openplc",
        vars: "over",
        declared: RISING,
        original: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, R := clear, PV := 3); over := c.CV > 4;",
        moved: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, R := clear, PV := 3); over := c.CV > 4;",
        advised: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, R := clear, PV := 32767); over := c.CV > 4;",
    },
    Taken {
        trap: 15,
        from: "iec",
        to: "openplc",
        vars: "low",
        declared: "VAR_INPUT pulse, load : BOOL; END_VAR VAR low : BOOL; n : INT; c : CTD; e : R_TRIG; END_VAR",
        original: "e(CLK := pulse); c(CD := e.Q AND c.CV > -3, LD := load, PV := 2); low := c.CV < -1;",
        moved: "e(CLK := pulse); c(CD := e.Q AND c.CV > -3, LD := load, PV := 2); low := c.CV < -1;",
        advised: "e(CLK := pulse); IF load THEN n := 2; ELSIF e.Q AND n > -3 THEN n := n - 1; END_IF low := n < -1;",
    },
    Taken {
        trap: 16,
        from: "iec",
        to: "openplc",
        vars: "full",
        declared: "VAR_INPUT sensor : BOOL; END_VAR VAR full, fell, before : BOOL; c : CTU; e : F_TRIG; END_VAR",
        original: "e(CLK := sensor); c(CU := e.Q AND NOT full, R := FALSE, PV := 3); full := c.Q;",
        moved: "e(CLK := sensor); c(CU := e.Q AND NOT full, R := FALSE, PV := 3); full := c.Q;",
        advised: "fell := before AND NOT sensor; before := sensor; c(CU := fell AND NOT full, R := FALSE, PV := 3); full := c.Q;",
    },
    // The other way round.
    Taken {
        trap: 1,
        from: "cscape",
        to: "iec",
        vars: "full,c.CV",
        declared: RISING,
        original: "c(CU := sensor, RESET := clear, PV := 3); full := c.Q;",
        moved: "c(CU := sensor, R := clear, PV := 3); full := c.Q;",
        advised: "c(CU := FALSE, R := clear, PV := 3); c(CU := sensor AND c.CV < 3, R := clear, PV := 3); full := c.Q;",
    },
    Taken {
        trap: 2,
        from: "cscape",
        to: "iec",
        vars: "over,c.CV",
        declared: RISING,
        original: "e(CLK := sensor); c(CU := e.Q, RESET := clear, PV := 3); over := c.CV > 3;",
        moved: "e(CLK := sensor); c(CU := e.Q, R := clear, PV := 3); over := c.CV > 3;",
        advised: "e(CLK := sensor); c(CU := e.Q AND c.CV < 3, R := clear, PV := 3); over := c.CV > 3;",
    },
    Taken {
        trap: 15,
        from: "openplc",
        to: "iec",
        vars: "over,c.CV",
        declared: RISING,
        original: "c(CU := sensor, R := clear, PV := 3); over := c.CV > 3;",
        moved: "c(CU := sensor, R := clear, PV := 3); over := c.CV > 3;",
        advised: "e(CLK := sensor); c(CU := e.Q AND c.CV < 3, R := clear, PV := 3); over := c.CV > 3;",
    },
    Taken {
        trap: 15,
        from: "openplc",
        to: "iec",
        vars: "c.CV,c.Q",
        declared: FALLING,
        original: "c(CD := pulse, LD := load, PV := 3);",
        moved: "c(CD := pulse, LD := load, PV := 3);",
        advised: "e(CLK := pulse); c(CD := e.Q AND c.CV > 0, LD := load, PV := 3);",
    },
    // A preset of a wider counter.
    Taken {
        trap: 15,
        from: "iec",
        to: "openplc",
        vars: "over",
        declared: "VAR_INPUT sensor, clear : BOOL; END_VAR VAR over : BOOL; c : CTU_DINT; e : R_TRIG; END_VAR",
        original: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, R := clear, PV := 3); over := c.CV > 4;",
        moved: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, R := clear, PV := 3); over := c.CV > 4;",
        advised: "e(CLK := sensor); c(CU := e.Q AND c.CV < 6, R := clear, PV := 2147483647); over := c.CV > 4;",
    },
    Taken {
        trap: 3,
        from: "iec",
        to: "cscape",
        vars: "low",
        declared: "VAR_INPUT pulse, load : BOOL; END_VAR VAR low : BOOL; n : INT; c : CTD; e : R_TRIG; END_VAR",
        original: "e(CLK := pulse); c(CD := e.Q AND c.CV > -3, LD := load, PV := 2); low := c.CV < -1;",
        moved: "e(CLK := pulse); c(CD := e.Q AND c.CV > -3, LOAD := load, PV := 2); low := c.CV < -1;",
        advised: "e(CLK := pulse); IF load THEN n := 2; ELSIF e.Q AND n > -3 THEN n := n - 1; END_IF low := n < -1;",
    },
    Taken {
        trap: 3,
        from: "iec",
        to: "codesys",
        vars: "low",
        declared: "VAR_INPUT pulse, load : BOOL; END_VAR VAR low : BOOL; n : INT; c : CTD; e : R_TRIG; END_VAR",
        original: "e(CLK := pulse); c(CD := e.Q AND c.CV > -3, LD := load, PV := 2); low := c.CV <= 0 AND NOT load;",
        moved: "e(CLK := pulse); c(CD := e.Q AND c.CV > 1, LOAD := load, PV := 2); low := c.CV <= 0 AND NOT load;",
        advised: "e(CLK := pulse); IF load THEN n := 2; ELSIF e.Q AND n > -3 THEN n := n - 1; END_IF low := n <= 0 AND NOT load;",
    },
    Taken {
        trap: 10,
        from: "cscape",
        to: "iec",
        vars: "full",
        declared: "VAR_INPUT sensor : BOOL; preset : INT(1..3) := 1; END_VAR VAR full : BOOL; c : CTU; e : R_TRIG; END_VAR",
        original: "e(CLK := sensor); c(CU := e.Q, RESET := FALSE, PV := preset); full := c.Q;",
        moved: "e(CLK := sensor); c(CU := e.Q AND c.CV < preset, R := FALSE, PV := preset); full := c.Q;",
        advised: "e(CLK := sensor); c(CU := e.Q AND c.CV < preset, R := FALSE, PV := preset); full := c.CV = preset;",
    },
    Taken {
        trap: 16,
        from: "openplc",
        to: "iec",
        vars: "full",
        declared: "VAR_INPUT sensor : BOOL; END_VAR VAR full, fell : BOOL; before : BOOL := TRUE; c : CTU; e : F_TRIG; END_VAR",
        original: "e(CLK := sensor); c(CU := e.Q AND NOT full, R := FALSE, PV := 3); full := c.Q;",
        moved: "e(CLK := sensor); c(CU := e.Q AND NOT full, R := FALSE, PV := 3); full := c.Q;",
        advised: "fell := before AND NOT sensor; before := sensor; c(CU := fell AND NOT full, R := FALSE, PV := 3); full := c.Q;",
    },
];

fn scratch() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("compare_advice");
    std::fs::create_dir_all(&folder).expect("a folder for the programs");
    folder
}

fn program(name: &str, declared: &str, body: &str) -> PathBuf {
    let path = scratch().join(name);
    std::fs::write(&path, format!("PROGRAM p {declared}\n{body}\nEND_PROGRAM\n")).expect("a program");
    path
}

fn assumed(line: &str) -> PathBuf {
    let path = scratch().join(format!("{}.txt", line.replace(' ', "_")));
    std::fs::write(&path, line).expect("assumptions");
    path
}

fn compare(from: &str, to: &str, vars: &str, original: &PathBuf, other: &PathBuf) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.arg("compare").arg(original).args(["--from", from, "--to", to, "--vars", vars, "-A", "warnings"]);
    if from != to && [from, to].contains(&"codesys") && vars != "kept" {
        // What CODESYS keeps over STOP -> RUN is trap 11, which has a test of its own.
        command.arg("--assume").arg(assumed("no run"));
    }
    command.arg("--against").arg(other).env("NO_COLOR", "1").output().expect("the command starts")
}

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Without the advice the two part, and the trap is named; with it they are equal, by all states.
fn holds(name: &str, taken: &Taken) {
    let original = program(&format!("{name}_original.st"), taken.declared, taken.original);
    let moved = program(&format!("{name}_moved.st"), taken.declared, taken.moved);
    let advised = program(&format!("{name}_advised.st"), taken.declared, taken.advised);
    let parts = compare(taken.from, taken.to, taken.vars, &original, &moved);
    let text = out(&parts);
    assert_eq!(parts.status.code(), Some(1), "{name}: {text}");
    let named = text.lines().any(|it| it.starts_with(&format!("Trap {} ", taken.trap)));
    let listed = text.lines().any(|it| it.contains("reachable") && it.contains(&format!(": trap {}. ", taken.trap)));
    assert!(named || listed, "{name}: {text}");
    equal(name, taken.from, taken.to, taken.vars, [&original, &advised]);
}

fn equal(name: &str, from: &str, to: &str, vars: &str, [original, advised]: [&PathBuf; 2]) {
    let same = compare(from, to, vars, original, advised);
    let text = out(&same);
    assert_eq!(same.status.code(), Some(0), "{name}: {text}");
    assert!(text.contains("are equal: every reachable state was seen"), "{name}: {text}");
}

#[test]
fn a_program_changed_as_advised_is_equal_to_the_original() {
    for (at, taken) in TAKEN.iter().enumerate() {
        holds(&format!("{at}_trap_{}", taken.trap), taken);
    }
}

/// Traps 4, 5, 6, 7, 11 and 13, which come together where a program moves to Logix.
#[test]
fn a_program_moved_to_logix_as_advised_is_equal_to_the_original() {
    let kept = "VAR_INPUT sensor, clear : BOOL; preset : INT(1..3) := 1; END_VAR
        VAR full : BOOL; END_VAR VAR RETAIN stopped, before, edge, rung : BOOL; c : ";
    let cases = [
        (
            "5_6_11_13",
            format!("{kept} CTU; END_VAR"),
            "c(CU := sensor AND NOT stopped, R := clear, PV := preset); full := c.Q; stopped := c.CV >= 3;",
            format!("{kept} COUNTER; END_VAR"),
            "rung := sensor AND NOT stopped; edge := rung AND NOT before; before := rung;
             c.PRE := preset; c.CU := FALSE; CTU(c, edge); RES(c, clear);
             full := c.ACC >= c.PRE; stopped := c.ACC >= 3;",
        ),
        (
            "4",
            "VAR_INPUT pulse, load : BOOL; END_VAR VAR full : BOOL; END_VAR VAR RETAIN e : R_TRIG; c : CTD; END_VAR".to_owned(),
            "e(CLK := pulse); c(CD := e.Q AND c.CV > 0, LD := load, PV := 3); full := c.Q;",
            "VAR_INPUT pulse, load : BOOL; END_VAR VAR full : BOOL; END_VAR VAR RETAIN before, edge : BOOL; c : COUNTER; END_VAR".to_owned(),
            "edge := pulse AND NOT before AND c.ACC > 0; before := pulse; c.PRE := 3; c.CD := FALSE; CTD(c, edge);
             IF load THEN c.ACC := c.PRE; END_IF full := c.ACC <= 0;",
        ),
        (
            "7",
            "VAR_INPUT pulse : BOOL; END_VAR VAR full : BOOL; END_VAR
             VAR RETAIN e : R_TRIG; c : CTU_DINT := (CV := 2147483644); END_VAR".to_owned(),
            "e(CLK := pulse); c(CU := e.Q, R := FALSE, PV := 2147483647); full := c.CV = 2147483647;",
            "VAR_INPUT pulse : BOOL; END_VAR VAR full : BOOL; END_VAR
             VAR RETAIN before, edge : BOOL; c : COUNTER := (ACC := 2147483644); END_VAR".to_owned(),
            "edge := pulse AND NOT before AND c.ACC < 2147483647; before := pulse; c.CU := FALSE; CTU(c, edge);
             full := c.ACC = 2147483647;",
        ),
    ];
    for (name, declared, original, declared_there, advised) in cases {
        let original = program(&format!("logix_{name}_original.st"), &declared, original);
        let advised = program(&format!("logix_{name}_advised.st"), &declared_there, advised);
        equal(name, "iec", "logix", "full", [&original, &advised]);
    }
}

/// Trap 11 on a move to CSCAPE.
#[test]
fn a_count_that_is_retained_as_advised_survives_a_restart() {
    let inputs = "VAR_INPUT sensor : BOOL; END_VAR VAR full : BOOL; END_VAR VAR RETAIN e : R_TRIG;";
    let call = "e(CLK := sensor); c(CU := e.Q AND c.CV < 3";
    let original = program(
        "11_original.st",
        &format!("{inputs} c : CTU; END_VAR"),
        &format!("{call}, R := FALSE, PV := 3); full := c.Q;"),
    );
    let moved = program(
        "11_moved.st",
        &format!("{inputs} c : CTU; END_VAR"),
        &format!("{call}, RESET := FALSE, PV := 3); full := c.Q;"),
    );
    let advised = program(
        "11_advised.st",
        &format!("{inputs} kept : INT; END_VAR VAR c : R_CTU; END_VAR"),
        &format!("{call}, RESET := FALSE, PV := 3, RCV := kept); full := c.Q;"),
    );
    let parts = compare("iec", "cscape", "full", &original, &moved);
    assert!(out(&parts).contains("Trap 11 "), "{}", out(&parts));
    equal("11", "iec", "cscape", "full", [&original, &advised]);
}

/// Trap 11 between IEC and CODESYS: what is RETAIN on both is kept over STOP -> RUN and a power cycle alike.
#[test]
fn what_is_retained_as_advised_survives_stop_to_run() {
    let text = |section: &str, pin: &str| {
        let declared =
            format!("VAR_INPUT sensor : BOOL; END_VAR VAR kept : BOOL; END_VAR {section} e : R_TRIG; c : CTU; END_VAR");
        (declared, format!("e(CLK := sensor); c(CU := e.Q AND c.CV < 3, {pin} := FALSE, PV := 3); kept := c.Q;"))
    };
    let write = |name: &str, (declared, body): (String, String)| program(name, &declared, &body);
    let plain = write("11_plain.st", text("VAR", "R"));
    let moved = write("11_plain_moved.st", text("VAR", "RESET"));
    let parts = compare("iec", "codesys", "kept", &plain, &moved);
    assert!(out(&parts).contains("Trap 11 ") && out(&parts).contains("run"), "{}", out(&parts));
    let original = write("11_retain.st", text("VAR RETAIN", "R"));
    let advised = write("11_retain_moved.st", text("VAR RETAIN", "RESET"));
    equal("11", "iec", "codesys", "kept", [&original, &advised]);
}

/// Trap 12: what the vendors write loses nothing on IEC, and the advice loses nothing of a CTUD or on
/// CSCAPE.
#[test]
fn a_counter_that_resets_itself_as_advised_loses_nothing() {
    let one = "VAR_INPUT item : BOOL; END_VAR VAR full : BOOL; boxes : INT(0..3); c : CTU; e, r : R_TRIG; END_VAR";
    let pack = "r(CLK := full); IF r.Q THEN boxes := (boxes + 1) MOD 3; END_IF";
    let pattern = |reset: &str, cu: &str| format!("{cu}, {reset} := full, PV := 3); full := c.Q; {pack}");
    let original = program("12_original.st", one, &pattern("R", "c(CU := item"));
    let moved = program("12_moved.st", one, &pattern("RESET", "c(CU := item"));
    let advised = program("12_advised.st", one, &pattern("RESET", "e(CLK := item); c(CU := e.Q"));
    let parts = compare("iec", "cscape", "boxes", &original, &moved);
    assert_eq!(parts.status.code(), Some(1), "{}", out(&parts));
    equal("12", "iec", "cscape", "boxes", [&original, &advised]);

    let two = "VAR_INPUT up, down : BOOL; END_VAR VAR full, low : BOOL; n : INT; c : CTUD; u, d : R_TRIG; END_VAR";
    let counted = program(
        "12_counted.st",
        two,
        "u(CLK := up); d(CLK := down AND NOT low);
         IF u.Q AND NOT d.Q THEN n := n + 1; END_IF
         IF d.Q AND NOT u.Q THEN n := n - 1; END_IF
         full := n >= 3; IF full THEN n := 0; END_IF low := n <= -1;",
    );
    let call = "c(CU := up, CD := down AND NOT low, R := ";
    let rest = ", LD := FALSE, PV := 3); full := c.QU;";
    let plain = program("12_plain.st", two, &format!("{call}full{rest} low := c.CV <= -1;"));
    let second = "IF full THEN c(R := TRUE); END_IF low := c.CV <= -1;";
    let advised = program("12_second.st", two, &format!("{call}FALSE{rest} {second}"));
    let parts = compare("iec", "iec", "full", &counted, &plain);
    assert_eq!(parts.status.code(), Some(1), "{}", out(&parts));
    equal("12 of a CTUD", "iec", "iec", "full", [&counted, &advised]);
}

/// Trap 9: by position, no pin's name matters.
#[test]
fn a_call_by_position_needs_no_change() {
    let path = program("9.st", RISING, "c(sensor AND NOT full, clear, 3); full := c.Q;");
    let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.arg("compare").arg(&path).args(["--from", "iec", "--to", "codesys"]);
    let output = command.arg("--assume").arg(assumed("no run")).output().expect("it starts");
    assert_eq!(output.status.code(), Some(0), "{}", out(&output));
    assert!(!out(&output).contains("Trap 9"), "{}", out(&output));
}
