//! The advice of `staunch compare`, proved by running it: the program as it is differs from itself by the
//! trap on the other system, and the program changed as advised is equal to the original.

use super::programs::{self, Folder};
use std::path::PathBuf;
use std::process::Output;

const CASES: &str = include_str!("../compare/advice.txt");

/// Cases that run at once.
const THREADS: usize = 4;

/// One advice, taken in its directions.
struct Taken {
    trap: &'static str,
    from: Vec<&'static str>,
    to: Vec<&'static str>,
    vars: &'static str,
    lines: Vec<(&'static str, &'static str)>,
}

impl Taken {
    fn read(block: &'static str) -> Option<Self> {
        let mut lines = block.lines().filter(|it| !it.starts_with('#') && !it.is_empty());
        let (trap, rest) = lines.next()?.strip_prefix("trap ")?.split_once(": ")?;
        let parts: Vec<_> = rest.split("; ").collect();
        let (from, to) = parts[0].split_once(" -> ")?;
        let lines = lines.map(|it| it.split_once(' ').expect("a word and a text")).collect();
        Some(Self { trap, from: from.split(", ").collect(), to: to.split(", ").collect(), vars: parts[1], lines })
    }

    fn line(&self, word: &str) -> Option<&'static str> {
        self.lines.iter().find(|it| it.0 == word).map(|it| it.1)
    }

    /// Without the advice the two part, and the trap is named; with it they are equal, by all states.
    fn holds(&self, number: usize, from: &str, to: &str) {
        let name = format!("{number}_trap_{}_{from}_{to}", self.trap);
        let text = |word: &str| self.line(word).unwrap_or_else(|| panic!("{name}: no `{word}`"));
        let folder = self.line("setting").map_or_else(String::new, |it| decided(&name, it));
        let write = |kind: &str, declared: &str, body: &str, dialect: &str| {
            program(&format!("{folder}{name}_{kind}.st"), &in_words_of(declared, dialect), &in_words_of(body, dialect))
        };
        let declared = text("declared");
        let there = self.line("there").unwrap_or(declared);
        let original = write("original", declared, text("original"), from);
        let advised = write("advised", there, text("advised"), to);
        if let Some(moved) = self.line("moved") {
            let moved = write("moved", self.line("as").unwrap_or(there), moved, to);
            let parts = compare(from, to, self.vars, &original, &moved);
            let text = out(&parts);
            assert_eq!(parts.status.code(), Some(1), "{name}: {text}");
            let named = text.lines().any(|it| it.starts_with(&format!("Trap {} ", self.trap)));
            let seen = |it: &str| it.contains("reachable") && it.contains(&format!(": trap {}. ", self.trap));
            assert!(named || text.lines().any(seen), "{name}: {text}");
            assert!(!text.contains("No rewrite has been proved"), "{name}: {text}");
        }
        equal(&name, from, to, self.vars, [&original, &advised]);
    }
}

/// The text with the system's names of pins, and its conversion of presets.
fn in_words_of(text: &str, dialect: &str) -> String {
    let (reset, load) = match dialect {
        "cscape" | "codesys" => ("RESET", "LOAD"),
        _ => ("R", "LD"),
    };
    let convert = if dialect == "codesys" { "INT_TO_WORD" } else { "" };
    text.replace("{R}", reset).replace("{LD}", load).replace("{N}", convert)
}

const RISING: &str = "VAR_INPUT sensor, clear : BOOL; END_VAR VAR full, over : BOOL; c : CTU; e : R_TRIG; END_VAR";

fn scratch() -> PathBuf {
    let folder = Folder("advice").path();
    // What is left open is decided: the advice is for a CTU of CODESYS and Siemens that counts past its preset, a CTD of S7
    // that loads while LD is TRUE, and an Editor of OpenPLC that counts CD as it falls.
    static DECIDED: std::sync::Once = std::sync::Once::new();
    DECIDED.call_once(|| {
        let decided = "ctu-stop-at-pv = false\ns7-ld = \"level\"\nopenplc4-cd-edge = \"falling\"\n";
        std::fs::write(folder.join("staunch.toml"), decided).expect("a project file");
    });
    folder
}

/// A folder of its own, with a setting.
fn decided(name: &str, setting: &str) -> String {
    let folder = scratch().join(name);
    std::fs::create_dir_all(&folder).expect("a folder for the programs");
    let level = if setting.contains("s7-ld") { "" } else { "s7-ld = \"level\"\n" };
    std::fs::write(folder.join("staunch.toml"), format!("ctu-stop-at-pv = false\n{level}{setting}\n"))
        .expect("a project file");
    format!("{name}/")
}

fn program(name: &str, declared: &str, body: &str) -> PathBuf {
    let path = scratch().join(name);
    std::fs::write(&path, format!("PROGRAM p {declared}\n{body}\nEND_PROGRAM\n")).expect("a program");
    path
}

fn assumed(line: &str) -> PathBuf {
    static WRITTEN: std::sync::Mutex<()> = std::sync::Mutex::new(());
    let path = scratch().join(format!("{}.txt", line.replace(' ', "_")));
    // Others may read it meanwhile.
    let _only = WRITTEN.lock();
    if std::fs::read_to_string(&path).ok().as_deref() != Some(line) {
        std::fs::write(&path, line).expect("assumptions");
    }
    path
}

fn compare(from: &str, to: &str, vars: &str, original: &PathBuf, other: &PathBuf) -> Output {
    let mut command = programs::command();
    command.arg(original).args(["--from", from, "--to", to, "--vars", vars, "-A", "warnings"]);
    if from != to && [from, to].contains(&"codesys") && vars != "kept" {
        // What CODESYS keeps over STOP -> RUN is trap 11, which has a test of its own.
        command.arg("--assume").arg(assumed("no run"));
    }
    command.arg("--against").arg(other).output().expect("the command starts")
}

fn out(output: &Output) -> String {
    programs::printed(output)
}

fn equal(name: &str, from: &str, to: &str, vars: &str, [original, advised]: [&PathBuf; 2]) {
    let same = compare(from, to, vars, original, advised);
    let text = out(&same);
    assert_eq!(same.status.code(), Some(0), "{name}: {text}");
    assert!(text.contains("are equal: every reachable state was seen"), "{name}: {text}");
}

#[test]
fn a_program_changed_as_advised_is_equal_to_the_original() {
    let taken: Vec<_> = CASES.split("\n\n").filter_map(Taken::read).collect();
    let mut all = Vec::new();
    for (number, it) in taken.iter().enumerate() {
        let directions = it.from.iter().flat_map(|from| it.to.iter().map(move |to| (*from, *to)));
        all.extend(directions.filter(|(from, to)| from != to).map(|(from, to)| (number, it, from, to)));
    }
    assert!(all.len() > 150, "{} directions are few", all.len());
    std::thread::scope(|scope| {
        for first in 0..THREADS {
            let all = &all;
            scope.spawn(move || all.iter().skip(first).step_by(THREADS).for_each(|it| it.1.holds(it.0, it.2, it.3)));
        }
    });
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

/// Trap 11 between IEC and CODESYS: what is RETAIN on both is kept through both STOP -> RUN and a power cycle.
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
    let mut command = programs::command();
    command.arg(&path).args(["--from", "iec", "--to", "codesys"]);
    let output = command.arg("--assume").arg(assumed("no run")).output().expect("it starts");
    assert_eq!(output.status.code(), Some(0), "{}", out(&output));
    assert!(!out(&output).contains("Trap 9"), "{}", out(&output));
}

/// What IEC refuses of CODESYS comes with what to write, which is equal.
#[test]
fn a_called_program_and_a_list_of_globals_say_what_to_write_elsewhere() {
    let file = |name: &str, text: &str| {
        let path = scratch().join(name);
        std::fs::write(&path, text).expect("a program");
        path
    };
    let original = file(
        "called_codesys.st",
        "{gvl 'Plant'}\nVAR_GLOBAL most : INT := 3; END_VAR\n\
         PROGRAM Sub VAR_INPUT go : BOOL; END_VAR VAR_OUTPUT full : BOOL; END_VAR VAR c : CTU; END_VAR\n\
         c(CU := go, PV := 2); full := c.Q; END_PROGRAM\n\
         PROGRAM p VAR_INPUT sensor : BOOL; END_VAR VAR full : BOOL; n : INT; END_VAR\n\
         Sub(go := sensor); full := Sub.full; n := MIN(n + 1, Plant.most); END_PROGRAM\n",
    );
    let moved = file(
        "called_iec.st",
        "VAR_GLOBAL most : INT := 3; END_VAR\n\
         FUNCTION_BLOCK Sub VAR_INPUT go : BOOL; END_VAR VAR_OUTPUT full : BOOL; END_VAR VAR c : CTU; END_VAR\n\
         c(CU := go, PV := 2); full := c.Q; END_FUNCTION_BLOCK\n\
         PROGRAM p VAR_INPUT sensor : BOOL; END_VAR VAR full : BOOL; n : INT; instance : Sub; END_VAR\n\
         instance(go := sensor); full := instance.full; n := MIN(n + 1, most); END_PROGRAM\n",
    );
    let alone = |more: &[&str]| {
        let mut command = programs::command();
        command.arg(&original).args(["--from", "codesys", "--to", "iec"]).args(more);
        command.output().expect("the command starts")
    };
    let refused = alone(&[]);
    let text = out(&refused);
    assert_eq!(refused.status.code(), Some(1), "{text}");
    assert!(text.contains("What to do: Change it as the message says.\n"), "{text}");
    assert!(text.contains("write it as FUNCTION_BLOCK Sub … END_FUNCTION_BLOCK, declare an instance of it"), "{text}");
    assert!(text.contains("write its variables without `Plant.`"), "{text}");
    equal("a called PROGRAM", "codesys", "iec", "full,n", [&original, &moved]);

    let png = alone(&["--trace", "picture.png"]);
    assert_eq!(png.status.code(), Some(2), "{}", out(&png));
    assert!(out(&png).contains("--trace picture.png: compare draws both systems as .svg"), "{}", out(&png));
}
