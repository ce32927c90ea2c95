//! What the command itself takes for `check`, `build --emit rust` and `build --emit obj`, of a few programs, and for keys in an
//! editor, by cachegrind, which counts faster than callgrind.
//!
//! It is the command that the tests have, of their profile: a release takes a tenth of that, but what makes one slower makes the
//! other slower too. It runs in a folder of its own, without an environment, on files of fixed names, so that the checkout's
//! path does not count. Counts vary by less than 0.2 %, by the seeds of hash tables and of the allocator.

use crate::editing;
use crate::measure::{ONE_MEMCPY, succeeds};
use crate::root;
use crate::table::Measured;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A program: its name, its dialect, and the texts of its files.
type Subject = (&'static str, &'static str, Vec<String>);

fn subjects() -> Vec<Subject> {
    let file = |path: &str| fs::read_to_string(root().join(path)).unwrap();
    let twincat = ["twincat.st", "twincat.2.st", "twincat.3.st", "twincat.4.st"];
    let twincat = twincat.map(|it| file(&format!("tests/cases/vendor/{it}")));
    vec![
        ("small", "iec", vec![file("tests/perf/programs/garage.st")]),
        ("objects", "codesys", vec![file("tests/perf/programs/heirs.st")]),
        ("timers_and_counters", "iec", vec![file("st_examples/small_plant/small_plant.st")]),
        ("twincat", "twincat", twincat.to_vec()),
        (MEDIUM, "iec", vec![stations(10)]),
        (LARGE, "iec", vec![stations(100)]),
    ]
}

/// The program that is edited.
const MEDIUM: &str = "medium";
/// Its machine code is not made: cachegrind would take a minute.
const LARGE: &str = "large";

/// Stations of fifty lines, each a type, a function, and a block with a loop, a CASE, a timer, a counter and a text.
fn stations(count: usize) -> String {
    let mut text = String::new();
    for n in 0..count {
        write!(text, "{}", STATION.replace('@', &n.to_string())).unwrap();
    }
    text.push_str("PROGRAM Main\nVAR start : BOOL; total : DINT;\n");
    (0..count).for_each(|n| writeln!(text, "s{n} : Station{n};").unwrap());
    text.push_str("END_VAR\ntotal := 0;\n");
    for n in 0..count {
        writeln!(text, "s{n}(start := start, limit := {n});\ntotal := total + INT_TO_DINT(s{n}.full);").unwrap();
    }
    text.push_str("END_PROGRAM\n");
    text
}

const STATION: &str = "\
(* Station @ counts what it fills. *)
TYPE
    State@ : (Idle@, Filling@, Full@);
    Part@ : STRUCT
        weight : REAL;
        count : INT;
        label : STRING[16];
    END_STRUCT
END_TYPE
FUNCTION Mean@ : REAL
VAR_IN_OUT
    parts : ARRAY[0..9] OF Part@;
END_VAR
VAR
    i : INT;
    sum : REAL;
END_VAR
FOR i := 0 TO 9 DO
    sum := sum + parts[i].weight * INT_TO_REAL(parts[i].count + @);
END_FOR
Mean@ := sum / 10.0;
END_FUNCTION
FUNCTION_BLOCK Station@
VAR_INPUT start : BOOL; limit : INT; END_VAR
VAR_OUTPUT full : INT; mean : REAL; END_VAR
VAR
    state : State@;
    parts : ARRAY[0..9] OF Part@;
    wait : TON;
    filled : CTU;
END_VAR
wait(IN := start AND state <> Full@, PT := T#250ms);
filled(CU := wait.Q, R := NOT start, PV := 10);
CASE state OF
    Idle@:
        IF start THEN state := Filling@; END_IF
    Filling@:
        parts[filled.CV MOD 10].count := limit;
        parts[filled.CV MOD 10].label := CONCAT('part ', INT_TO_STRING(limit));
        IF filled.Q OR limit > 90 AND start THEN
            state := Full@;
        END_IF
    Full@:
        full := full + 1;
        state := Idle@;
END_CASE
mean := Mean@(parts := parts);
END_FUNCTION_BLOCK
";

/// Every program, two ways at a time.
pub fn measured() -> BTreeMap<String, Measured<4>> {
    let mut measured = BTreeMap::new();
    for (name, dialect, texts) in subjects() {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compiling").join(name);
        fs::create_dir_all(&folder).unwrap();
        let files: Vec<String> = (1..=texts.len()).map(|at| format!("program_{at}.st")).collect();
        files.iter().zip(&texts).for_each(|(file, text)| fs::write(folder.join(file), text).unwrap());
        link(&folder.join("staunch"));
        let count = |before: &[&str]| instructions(&folder, before, dialect, &files);
        let figures = std::thread::scope(|scope| {
            let rust = scope.spawn(|| count(&["build", "--emit", "rust", "-o", "program.rs"]));
            let native = (name != LARGE).then(|| count(&["build", "--emit", "obj", "-o", "program.o"]));
            let edited = (name == MEDIUM).then(|| edited(&folder, dialect, &files[0], &texts[0]));
            [Some(count(&["check"])), Some(rust.join().expect("it is measured")), native, edited]
        });
        measured.insert(name.to_owned(), figures);
    }
    measured
}

fn instructions(folder: &Path, before: &[&str], dialect: &str, files: &[String]) -> u64 {
    let mut valgrind = counted(folder);
    valgrind.args(before).args(["--quiet", "--dialect", dialect]).args(files);
    of_report(&String::from_utf8_lossy(&succeeds(&mut valgrind).stderr))
}

fn edited(folder: &Path, dialect: &str, file: &str, text: &str) -> u64 {
    let mut valgrind = counted(folder);
    of_report(&editing::session(valgrind.args(["lsp", "--dialect", dialect]), &folder.join(file), text))
}

/// The command, under cachegrind.
fn counted(folder: &Path) -> Command {
    let mut valgrind = Command::new(valgrind_path());
    valgrind.args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null", "./staunch"]);
    valgrind.current_dir(folder).env_clear().env(ONE_MEMCPY.0, ONE_MEMCPY.1);
    valgrind
}

fn of_report(report: &str) -> u64 {
    let counted = report.lines().find_map(|line| line.rsplit_once(" refs:")).unwrap().1;
    counted.trim().replace(',', "").parse().unwrap()
}

/// The environment is empty where it runs.
fn valgrind_path() -> PathBuf {
    let path = std::env::var_os("PATH").unwrap();
    std::env::split_paths(&path).map(|it| it.join("valgrind")).find(|it| it.is_file()).unwrap()
}

/// The command, by a path of fixed length.
fn link(to: &Path) {
    let _ = fs::remove_file(to);
    std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_staunch"), to).unwrap();
}
