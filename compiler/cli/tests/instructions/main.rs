//! How many instructions a scan takes, and how many the compiler does: exact, and the same on every x86-64 machine with this
//! toolchain.
//!
//! Each program in `tests/perf/programs` is built as a library by both back ends, and called from C with the inputs that its
//! first lines give. Where `tests/perf/by_hand` has the same program, written by hand in Rust, that is called as well, and the
//! outputs that the first lines name must be equal after each scan. `tests/perf/instructions.tsv` holds the counts, by
//! callgrind; `tests/perf/compiling.tsv` those of the command, for a few programs. One that rises by more than 2 % fails the
//! test until it is blessed with a reason, which stays in its row:
//!
//! ```sh
//! STAUNCH_BLESS='why a scan takes more' cargo test -p staunch --test instructions scans
//! STAUNCH_BLESS='why compiling takes more' cargo test -p staunch --test instructions compiling
//! ```
//!
//! That writes `docs/performance.md` as well.
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod compiling;
mod driver;
mod editing;
#[path = "../support/editor.rs"]
mod editor;
mod executable;
mod measure;
mod page;
mod subject;
mod table;

use std::path::{Path, PathBuf};
use std::process::Command;
use table::{COMPILING, SCANS};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

fn perf() -> PathBuf {
    root().join("tests/perf")
}

fn can_measure() -> bool {
    let has_valgrind = Command::new("valgrind").arg("--version").output().is_ok_and(|it| it.status.success());
    if !has_valgrind {
        assert!(std::env::var_os("CI").is_none(), "valgrind is missing");
        println!("SKIPPED: instructions, for want of valgrind");
    }
    has_valgrind
}

#[test]
fn scans_take_no_more_instructions() {
    if can_measure() && SCANS.hold(&measure::measured()) {
        page::write();
    }
}

#[test]
fn compiling_takes_no_more_instructions() {
    if can_measure() && COMPILING.hold(&compiling::measured()) {
        page::write();
    }
}

#[test]
fn the_page_shows_the_tables() {
    assert!(
        page::is_of_tables(),
        "docs/performance.md does not show tests/perf/*.tsv: bless it by the commands in this test's first lines"
    );
}

#[test]
fn an_executable_adds_few_instructions_to_a_scan() {
    if can_measure() {
        executable::holds();
    }
}
