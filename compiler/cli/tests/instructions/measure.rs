//! Builds the programs, and counts.

use crate::driver;
use crate::subject::{self, Subject};
use crate::table::Measured;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Mutex;

/// One memcpy for all processors.
pub const ONE_MEMCPY: (&str, &str) = ("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-ERMS,-FSRM");

struct Run {
    /// Of a scan.
    instructions: u64,
    /// Machine code of what is linked.
    text: u64,
    outputs: String,
    state: String,
}

pub fn succeeds(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    output
}

fn folder(subject: &Subject, what: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("instructions").join(&subject.name).join(what);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn staunch(subject: &Subject, emit: &str, backend: &str, to: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.args(["build", "--quiet", "--emit", emit, "--backend", backend, "-o"]).arg(to).arg(&subject.path);
    command.args(subject.dialect.iter().flat_map(|it| ["--dialect", it]));
    command.env("STAUNCH_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"));
    succeeds(&mut command);
}

fn compiled(subject: &Subject, backend: &str) -> Run {
    let folder = folder(subject, backend);
    let library = folder.join("program.a");
    staunch(subject, "header", backend, &folder.join("program.h"));
    staunch(subject, "lib", backend, &library);
    run(subject, &folder, &library, &driver::compiled(subject), "staunch_scan")
}

fn by_hand(subject: &Subject) -> Run {
    let folder = folder(subject, "by_hand");
    let (source, library) = (folder.join("around.rs"), folder.join("program.a"));
    fs::write(&source, driver::around_by_hand(subject)).unwrap();
    let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    rustc.args(["--edition=2024", "--crate-type=staticlib", "-Copt-level=3", "-Cpanic=abort", "-Aunsafe_code", "-o"]);
    succeeds(rustc.arg(&library).arg(&source));
    run(subject, &folder, &library, &driver::by_hand(subject), "by_hand_scan")
}

fn run(subject: &Subject, folder: &Path, library: &Path, driver: &str, scan: &str) -> Run {
    let program = folder.join("program");
    fs::write(folder.join("driver.c"), driver).unwrap();
    let mut cc = Command::new("cc");
    cc.current_dir(folder).args(["-O1", "-Wl,--gc-sections", "driver.c"]).arg(library).args(["-lm", "-o"]);
    succeeds(cc.arg(&program));
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(format!("--toggle-collect={scan}"));
    valgrind.env(ONE_MEMCPY.0, ONE_MEMCPY.1);
    let output = succeeds(valgrind.arg(&program));
    let report = String::from_utf8_lossy(&output.stderr);
    let collected = report.lines().find_map(|line| line.split_once("Collected :")).unwrap().1;
    let total: u64 = collected.trim().parse().unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let (outputs, state) = printed.split_once(' ').unwrap();
    Run {
        instructions: total / u64::from(subject.scans),
        text: text_bytes(&program),
        outputs: outputs.to_owned(),
        state: state.to_owned(),
    }
}

fn text_bytes(program: &Path) -> u64 {
    let output = succeeds(Command::new("size").args(["--format=sysv"]).arg(program));
    let listing = String::from_utf8_lossy(&output.stdout);
    let row = listing.lines().find_map(|line| line.strip_prefix(".text")).unwrap();
    row.split_whitespace().next().unwrap().parse().unwrap()
}

fn measure(subject: &Subject) -> Measured<5> {
    let [rust, native] = ["rust", "native"].map(|it| compiled(subject, it));
    assert_eq!(rust.state, native.state, "{}: the back ends leave other states", subject.name);
    let by_hand = subject.by_hand.as_ref().map(|_| by_hand(subject));
    if let Some(by_hand) = &by_hand {
        assert_eq!(rust.outputs, by_hand.outputs, "{}: the program by hand has other outputs", subject.name);
    }
    let counts = [&rust, &native].map(|it| Some(it.instructions));
    let text = [&rust, &native].map(|it| Some(it.text));
    [counts[0], counts[1], text[0], text[1], by_hand.map(|it| it.instructions)]
}

/// Every program, two at a time.
pub fn measured() -> BTreeMap<String, Measured<5>> {
    let left = Mutex::new(subject::all());
    let done = Mutex::new(BTreeMap::new());
    let work = || {
        loop {
            let next = left.lock().unwrap().pop();
            let Some(subject) = next else { return };
            let figures = measure(&subject);
            done.lock().unwrap().insert(subject.name, figures);
        }
    };
    std::thread::scope(|scope| {
        let threads = [scope.spawn(work), scope.spawn(work)];
        threads.into_iter().for_each(|it| it.join().expect("each program is measured"));
    });
    done.into_inner().unwrap()
}
