//! What an executable takes for a scan in addition to its program, without a trace.

use crate::measure::{ONE_MEMCPY, succeeds};
use crate::perf;
use std::path::Path;
use std::process::Command;

/// In instructions, with `--quiet`: less than 10 ns.
const MOST: u64 = 150;

pub fn holds() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("instructions");
    std::fs::create_dir_all(&folder).unwrap();
    for backend in ["native", "rust"] {
        let executable = folder.join(format!("null_{backend}"));
        let mut build = Command::new(env!("CARGO_BIN_EXE_staunch"));
        build.args(["build", "--quiet", "--backend", backend, "-o"]).arg(&executable);
        build.arg(perf().join("programs/null.st"));
        build.env("STAUNCH_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"));
        succeeds(&mut build);
        let [few, many] = [10_000, 30_000].map(|it| instructions(&executable, it));
        let each = (many - few) / 20_000;
        assert!(each <= MOST, "{backend}: {each} instructions for a scan, {MOST} at most");
        println!("{backend}: {each} instructions for a scan of an empty program");
    }
}

fn instructions(executable: &Path, scans: u32) -> u64 {
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(executable);
    valgrind.args(["--quiet", "--scans"]).arg(scans.to_string()).env(ONE_MEMCPY.0, ONE_MEMCPY.1);
    let output = succeeds(&mut valgrind);
    let report = String::from_utf8_lossy(&output.stderr);
    report.lines().find_map(|line| line.split_once("Collected :")).unwrap().1.trim().parse().unwrap()
}
