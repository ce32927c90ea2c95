//! The advice to count in variables of the program's own, taken word for word: what `staunch compare` prints is put in place
//! of the counter's call, and by all reachable states the program is then equal to the original, on every system, around 0
//! and at both limits of the count.

use super::programs::{Folder, command, printed};
use std::path::{Path, PathBuf};

/// A system, and what decides the rules that its documents leave open.
#[derive(Clone, Copy)]
struct System {
    dialect: &'static str,
    setting: &'static str,
    /// The limits of its counts.
    limits: [i64; 2],
}

const fn system(dialect: &'static str, setting: &'static str, limits: [i64; 2]) -> System {
    System { dialect, setting, limits }
}

impl System {
    /// CSCAPE has no CTUD.
    fn has(self, block: &str) -> bool {
        (self.dialect, block) != ("cscape", "CTUD")
    }
}

const INT: [i64; 2] = [-32768, 32767];
const DINT: [i64; 2] = [-2_147_483_648, 2_147_483_647];

const FROM: [System; 10] = [
    system("iec", "", INT),
    system("siemens", "s7-ld = \"level\"", INT),
    system("siemens", "s7-ld = \"edge\"", INT),
    system("codesys", "ctu-stop-at-pv = false", [0, 65535]),
    system("codesys", "ctu-stop-at-pv = true", [0, 65535]),
    system("openplc", "", [0, 32767]),
    system("openplc4", "openplc4-cd-edge = \"falling\"", [0, 32767]),
    system("openplc4", "openplc4-cd-edge = \"rising\"", [0, 32767]),
    system("cscape", "", [0, 32767]),
    system("logix", "", DINT),
];

const TO: [&str; 7] = ["codesys", "iec", "siemens", "openplc", "openplc4", "cscape", "logix"];

const INPUTS: &str = "VAR_INPUT s, p, clear, load : BOOL; preset : INT({range}) := 1; END_VAR
VAR sensor, pulse : BOOL; END_VAR
VAR_OUTPUT count : DINT; first, second : BOOL; END_VAR";

/// One kind of counter on one system, from a count on.
struct Case {
    from: System,
    block: &'static str,
    start: i64,
}

impl Case {
    fn name(&self) -> String {
        let setting: String = self.from.setting.chars().filter(char::is_ascii_alphanumeric).collect();
        format!("{}_{}_{setting}_{}", self.from.dialect, self.block, self.start)
    }

    fn is_logix(&self) -> bool {
        self.from.dialect == "logix"
    }

    /// The inputs, such that few counts are reached: around 0 and at the limits.
    fn guarded(&self) -> String {
        let [least, greatest] = self.from.limits;
        let near = |further: i64| {
            let [low, high] = [least.min(-9) + 3, greatest - 3].map(|it| it + further);
            format!("(count > {} AND count < {} OR count < {low} OR count > {high})", further - 5, further + 4)
        };
        format!("sensor := s AND {}; pulse := p AND {};", near(0), near(1))
    }

    fn inputs(&self) -> String {
        // A negative number is not a preset of a WORD.
        INPUTS.replace("{range}", if self.from.dialect == "codesys" { "0..2" } else { "-1..2" })
    }

    fn original(&self) -> String {
        let from = self.from.dialect;
        let count = match from {
            "logix" => "c.ACC",
            "cscape" => "kept",
            _ => "c.CV",
        };
        let preset = if from == "codesys" { "INT_TO_WORD(preset)" } else { "preset" };
        let block = match (from, self.block) {
            ("logix", "CTUD") => "FBD_COUNTER",
            ("logix", _) => "COUNTER",
            ("cscape", "CTU") => "R_CTU",
            ("cscape", _) => "R_CTD",
            (_, block) => block,
        };
        let own = format!(" := ({} := {})", &count[2..], self.start);
        // What CSCAPE keeps of a counter is a variable of its own.
        let (section, start, kept) = match from {
            "logix" => ("VAR", own, String::new()),
            "cscape" => ("VAR", String::new(), format!("VAR RETAIN kept : INT := {}; END_VAR", self.start)),
            _ => ("VAR RETAIN", own, String::new()),
        };
        let (call, outputs) = match (from, self.block) {
            ("logix", "CTU") => ("c.PRE := preset; CTU(c, sensor); RES(c, clear);".to_owned(), ["DN", "DN"]),
            ("logix", "CTD") => ("c.PRE := preset; CTD(c, pulse); RES(c, clear);".to_owned(), ["DN", "DN"]),
            ("logix", _) => (
                "c.PRE := preset; c.CUEnable := sensor; c.CDEnable := pulse; c.Reset := clear; CTUD(c);".to_owned(),
                ["DN", "DN"],
            ),
            ("cscape", "CTU") => ("c(sensor, clear, preset, kept);".to_owned(), ["Q", "Q"]),
            ("cscape", _) => ("c(pulse, load, preset, kept);".to_owned(), ["Q", "Q"]),
            (_, "CTU") => (format!("c(sensor, clear, {preset});"), ["Q", "Q"]),
            (_, "CTD") => (format!("c(pulse, load, {preset});"), ["Q", "Q"]),
            _ => (format!("c(sensor, pulse, clear, load, {preset});"), ["QU", "QD"]),
        };
        let [first, second] = outputs;
        let wide = if from == "codesys" { format!("WORD_TO_DINT({count})") } else { count.to_owned() };
        let guarded = self.guarded();
        format!(
            "PROGRAM p\n{}\n{section} c : {block}{start}; END_VAR {kept}\ncount := {wide}; {guarded}\n{call}\ncount := {wide}; first := c.{first}; second := c.{second};\nEND_PROGRAM\n",
            self.inputs()
        )
    }

    /// The same, with one call more that leaves inputs out: then no shorter advice holds.
    fn left_out(&self) -> String {
        let kept = if self.from.dialect == "cscape" { ", RCV := kept" } else { "" };
        let call = match (self.is_logix(), self.block) {
            (true, _) => return self.original(),
            (false, "CTD") => format!("c(CD := FALSE{kept})"),
            (false, _) => format!("c(CU := FALSE{kept})"),
        };
        self.original().replacen("count := ", &format!("IF s AND NOT s THEN {call}; END_IF\ncount := "), 1)
    }

    /// With the statements of the advice in place of the counter.
    fn advised(&self, statements: &str, to: &str) -> String {
        let outputs = match self.block {
            _ if self.is_logix() => ["full", "full"],
            "CTU" => ["full", "full"],
            "CTD" => ["empty", "empty"],
            _ => ["full", "empty"],
        };
        let kept = if to == "logix" { "VAR" } else { "VAR RETAIN" };
        let (edges, initial) = if self.is_logix() { ("VAR", " := TRUE") } else { (kept, "") };
        let [first, second] = outputs;
        let width = if self.from.limits == DINT || self.from.limits[1] > 32767 { "DINT" } else { "INT" };
        format!(
            "PROGRAM p\n{}\n{kept} n : {width} := {}; full, empty, turned, over, under : BOOL; END_VAR\n{edges} before, bu, bd : BOOL{initial}; END_VAR\n\
             VAR edge, eu, ed, rung, first_ : BOOL; END_VAR {kept} loaded : BOOL; END_VAR\n\
             count := n; {}\n{}\ncount := n; first := {first}; second := {second};\nEND_PROGRAM\n",
            self.inputs(),
            self.start,
            self.guarded(),
            statements.replace("first", "first_"),
        )
    }
}

fn folder(case: &Case) -> PathBuf {
    let path = Folder("own").path().join(case.name());
    std::fs::create_dir_all(&path).expect("a folder");
    let settings = ["s7-ld = \"level\"", "openplc4-cd-edge = \"falling\"", "ctu-stop-at-pv = false"];
    let word = |it: &str| it.split(' ').next().map(str::to_owned);
    let others = settings.iter().filter(|it| word(it) != word(case.from.setting));
    let lines: Vec<&str> = others.copied().chain([case.from.setting]).collect();
    std::fs::write(path.join("staunch.toml"), lines.join("\n")).expect("a project file");
    std::fs::write(path.join("assumed.txt"), "no run\n").expect("assumptions");
    std::fs::write(path.join("calm.txt"), "no run\nno restart\nno reset\n").expect("assumptions");
    path
}

fn compare(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = command();
    command.args(arguments).args(["-A", "warnings", "--vars", "count,first,second"]);
    let output = command.current_dir(folder).output().expect("it starts");
    (output.status.code(), printed(&output))
}

/// The statements that are advised for a counter, on a move to a system where it differs.
fn statements(case: &Case, folder: &Path) -> String {
    let left_out = Case { start: 0, ..*case }.left_out();
    std::fs::write(folder.join("left_out.st"), left_out).expect("a program");
    let systems = FROM.into_iter().filter(|it| it.dialect != case.from.dialect && it.has(case.block));
    for from in systems {
        let other = Case { from, block: case.block, start: 0 }.original();
        // DN of an FBD_COUNTER is one for both ways.
        let other = if case.is_logix() { other.replace("c.QD", "c.QU") } else { other };
        let other = if case.from.dialect == "codesys" { other.replace("-1..2", "0..2") } else { other };
        std::fs::write(folder.join("other.st"), other).expect("a program");
        let arguments = [
            "left_out.st",
            "--from",
            case.from.dialect,
            "--to",
            from.dialect,
            "--against",
            "other.st",
            "--assume",
            "calm.txt",
        ];
        let (_, text) = compare(folder, &arguments);
        let mut advice =
            text.lines().filter_map(|it| it.split_once("In place of each call, count in variables of your own, "));
        if let Some((_, advice)) = advice.next_back() {
            let statements: Vec<&str> = advice.split('`').filter(|it| it.contains(":=")).collect();
            return statements.join(" ");
        }
    }
    panic!("{}: no advice", case.name());
}

fn holds(case: &Case) {
    let folder = folder(case);
    let statements = statements(case, &folder);
    std::fs::write(folder.join("original.st"), case.original()).expect("a program");
    // At the limits numbers alone matter, which every system computes with.
    let systems = if case.start == 0 { &TO[..] } else { &TO[..1] };
    for to in systems.iter().filter(|it| **it != case.from.dialect || case.start != 0) {
        let advised = format!("{to}.st");
        std::fs::write(folder.join(&advised), case.advised(&statements, to)).expect("a program");
        let systems = ["original.st", "--from", case.from.dialect, "--to", to];
        let (code, text) =
            compare(&folder, &[&systems[..], &["--against", &advised, "--assume", "assumed.txt"]].concat());
        assert_eq!(code, Some(0), "{} -> {to}: {statements}\n{text}", case.name());
    }
}

#[test]
fn a_counter_in_variables_as_advised_is_equal_on_every_system() {
    let mut cases = Vec::new();
    for from in FROM {
        for block in ["CTU", "CTD", "CTUD"].into_iter().filter(|it| from.has(it)) {
            let mut starts = vec![0, from.limits[1]];
            starts.extend(Some(from.limits[0]).filter(|it| *it < 0));
            cases.extend(starts.into_iter().map(|start| Case { from, block, start }));
        }
    }
    std::thread::scope(|scope| {
        for first in 0..4 {
            let cases = &cases;
            scope.spawn(move || cases.iter().skip(first).step_by(4).for_each(holds));
        }
    });
}
