//! How many instructions a scan takes, by callgrind: exact, and the same on every x86-64 machine with this toolchain.
//!
//! Each program in `tests/perf/programs` is built as a library by both back ends and called from C with the inputs that its
//! first lines give. `tests/perf/instructions.tsv` holds the counts. A count may fall; one that rises by more than 2 % fails
//! the test until it is blessed with a reason, which stays in its row:
//!
//! ```sh
//! STAUNCH_BLESS='why a scan takes more' cargo test -p staunch --test instructions
//! ```
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Mutex;

const BACK_ENDS: [&str; 2] = ["rust", "native"];
/// A rise of up to 1 in 50, or of one instruction, is noise of the optimiser.
const SLACK: u64 = 50;

fn perf() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/perf").canonicalize().unwrap()
}

/// A program, and how it is called.
struct Subject {
    name: String,
    path: PathBuf,
    dialect: Option<String>,
    scans: u32,
    /// `START = s & 1`: a variable of the PROGRAM, and its value in scan `s`, in C.
    inputs: Vec<(String, String)>,
    /// The PROGRAM, as macros of the header spell it.
    program: String,
}

impl Subject {
    fn of_several(mut self, dialect: &str) -> Self {
        self.name = format!("{}.{dialect}", self.name);
        self
    }
}

/// A program in each of the dialects that it names, else in the default one.
fn subjects_of(path: &Path) -> Vec<Subject> {
    let text = fs::read_to_string(path).unwrap();
    let named = text.lines().find_map(|line| line.strip_prefix("// dialect: ")).unwrap_or_default();
    let dialects: Vec<_> = named.split_whitespace().collect();
    match dialects.as_slice() {
        [] => vec![subject(path, &text, None)],
        [one] => vec![subject(path, &text, Some(*one))],
        several => several.iter().map(|it| subject(path, &text, Some(*it)).of_several(it)).collect(),
    }
}

fn subject(path: &Path, text: &str, dialect: Option<&str>) -> Subject {
    let heads = |key: &str| -> Vec<String> {
        let start = format!("// {key}: ");
        text.lines().filter_map(|line| line.strip_prefix(&start)).map(str::to_owned).collect()
    };
    let input =
        |line: &String| line.split_once(" = ").map(|(name, value)| (name.to_owned(), value.to_owned())).unwrap();
    let program = text.lines().filter_map(|line| line.strip_prefix("PROGRAM ")).next_back().unwrap();
    Subject {
        name: path.file_stem().unwrap().to_str().unwrap().to_owned(),
        dialect: dialect.map(str::to_owned),
        scans: heads("scans").pop().unwrap().parse().unwrap(),
        inputs: heads("in").iter().map(input).collect(),
        program: program.trim().to_uppercase(),
        path: path.to_owned(),
    }
}

fn subjects() -> Vec<Subject> {
    let mut paths: Vec<_> = fs::read_dir(perf().join("programs")).unwrap().map(|it| it.unwrap().path()).collect();
    paths.sort();
    paths.iter().flat_map(|it| subjects_of(it)).collect()
}

/// C that calls the scans, and prints a hash of the state that they leave.
fn driver(subject: &Subject) -> String {
    let mut inputs = String::new();
    for (name, value) in &subject.inputs {
        writeln!(inputs, "        STAUNCH_{}_{name}(state) = {value};", subject.program).unwrap();
    }
    let scans = subject.scans;
    format!(
        r#"#include "program.h"
#include <stdio.h>
int main(void) {{
    static _Alignas(64) uint8_t state[STAUNCH_STATE_SIZE];
    staunch_init(state);
    for (uint32_t s = 0; s < {scans}; s++) {{
{inputs}        staunch_context cx = {{ (int64_t)s * 1000000, s == 0, STAUNCH_TURNS, 1000000 }};
        if (staunch_scan(state, &cx, STAUNCH_{program}) != 0) return 1;
    }}
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint32_t i = 0; i < STAUNCH_STATE_SIZE; i++) hash = (hash ^ state[i]) * 0x100000001b3u;
    printf("%016llx", (unsigned long long)hash);
    return 0;
}}
"#,
        program = subject.program,
    )
}

fn succeeds(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    output
}

fn staunch(subject: &Subject, emit: &str, backend: &str, to: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.args(["build", "--quiet", "--emit", emit, "--backend", backend, "-o"]).arg(to).arg(&subject.path);
    command.args(subject.dialect.iter().flat_map(|it| ["--dialect", it]));
    command.env("STAUNCH_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"));
    succeeds(&mut command);
}

/// The instructions of a scan, and the hash of the state after all of them.
fn measure(subject: &Subject, backend: &str) -> (u64, String) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("instructions").join(&subject.name).join(backend);
    fs::create_dir_all(&folder).unwrap();
    let (library, program) = (folder.join("program.a"), folder.join("program"));
    staunch(subject, "header", backend, &folder.join("program.h"));
    staunch(subject, "lib", backend, &library);
    fs::write(folder.join("driver.c"), driver(subject)).unwrap();
    let mut cc = Command::new("cc");
    succeeds(cc.current_dir(&folder).args(["-O1", "driver.c"]).arg(&library).args(["-lm", "-o"]).arg(&program));
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=callgrind", "--toggle-collect=staunch_scan", "--callgrind-out-file=/dev/null"]);
    // One memcpy for all processors.
    valgrind.env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-ERMS,-FSRM");
    let output = succeeds(valgrind.arg(&program));
    let report = String::from_utf8_lossy(&output.stderr);
    let collected = report.lines().find_map(|line| line.split_once("Collected :")).unwrap().1;
    let total: u64 = collected.trim().parse().unwrap();
    (total / u64::from(subject.scans), String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The counts of a program by back end, and why they last rose.
#[derive(Clone, Default, PartialEq)]
struct Row {
    counts: [u64; BACK_ENDS.len()],
    reason: String,
}

fn table() -> PathBuf {
    perf().join("instructions.tsv")
}

fn written() -> BTreeMap<String, Row> {
    let text = fs::read_to_string(table()).unwrap_or_default();
    let row = |line: &str| {
        let cells: Vec<_> = line.split('\t').collect();
        let counts = [cells[1].parse().unwrap(), cells[2].parse().unwrap()];
        (cells[0].to_owned(), Row { counts, reason: cells.get(3).copied().unwrap_or_default().to_owned() })
    };
    text.lines().skip(1).map(row).collect()
}

fn write(rows: &BTreeMap<String, Row>) {
    let mut text = "program\trust\tnative\twhy it last rose\n".to_owned();
    for (name, Row { counts: [rust, native], reason }) in rows {
        writeln!(text, "{name}\t{rust}\t{native}\t{reason}").unwrap();
    }
    fs::write(table(), text).unwrap();
}

fn measured() -> BTreeMap<String, [u64; BACK_ENDS.len()]> {
    let left = Mutex::new(subjects());
    let done = Mutex::new(BTreeMap::new());
    let work = || {
        loop {
            let next = left.lock().unwrap().pop();
            let Some(subject) = next else { return };
            let [(rust, a), (native, b)] = BACK_ENDS.map(|it| measure(&subject, it));
            assert_eq!(a, b, "{}: the back ends leave other states", subject.name);
            done.lock().unwrap().insert(subject.name, [rust, native]);
        }
    };
    std::thread::scope(|scope| {
        let threads = [scope.spawn(work), scope.spawn(work)];
        threads.into_iter().for_each(|it| it.join().expect("each program is measured"));
    });
    done.into_inner().unwrap()
}

fn has_valgrind() -> bool {
    Command::new("valgrind").arg("--version").output().is_ok_and(|it| it.status.success())
}

#[test]
fn scans_take_no_more_instructions() {
    if !has_valgrind() {
        assert!(std::env::var_os("CI").is_none(), "valgrind is missing");
        println!("SKIPPED: instructions of scans, for want of valgrind");
        return;
    }
    let (before, mut after) = (written(), BTreeMap::new());
    let reason = std::env::var("STAUNCH_BLESS").ok();
    let mut risen = String::new();
    for (name, counts) in measured() {
        let old = before.get(&name).cloned().unwrap_or_default();
        let rises = |at: usize| counts[at] > old.counts[at] + old.counts[at] / SLACK + 1;
        for at in (0..BACK_ENDS.len()).filter(|at| rises(*at)) {
            writeln!(risen, "{name}, {}: {} instructions a scan, {} before", BACK_ENDS[at], counts[at], old.counts[at])
                .unwrap();
        }
        let has_risen = before.contains_key(&name) && (0..BACK_ENDS.len()).any(rises);
        let reason = reason.clone().filter(|_| has_risen).unwrap_or(old.reason);
        after.insert(name, Row { counts, reason });
    }
    if reason.is_some() {
        write(&after);
        return;
    }
    assert!(risen.is_empty(), "scans take more instructions than {} says:\n{risen}", table().display());
    assert!(before.keys().eq(after.keys()), "{} names other programs", table().display());
}
