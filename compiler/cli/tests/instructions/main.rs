//! How many instructions a scan takes, by callgrind: exact, and the same on every x86-64 machine with this toolchain.
//!
//! Each program in `tests/perf/programs` is built as a library by both back ends, and called from C with the inputs that its
//! first lines give. Where `tests/perf/by_hand` has the same program, written by hand in Rust, that is called as well, and the
//! outputs that the first lines name must be equal after each scan. `tests/perf/instructions.tsv` holds the counts. One that
//! rises by more than 2 % fails the test until it is blessed with a reason, which stays in its row:
//!
//! ```sh
//! STAUNCH_BLESS='why a scan takes more' cargo test -p staunch --test instructions
//! ```
//!
//! That writes `docs/performance.md` as well.
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod driver;
mod measure;
mod page;
mod subject;
mod table;

use measure::{Measured, measured};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use table::{FIGURES, GATED, Row, Table};

/// A rise of up to 1 in 50, or of one instruction, is noise of the optimiser.
const SLACK: u64 = 50;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

fn perf() -> PathBuf {
    root().join("tests/perf")
}

fn has_valgrind() -> bool {
    Command::new("valgrind").arg("--version").output().is_ok_and(|it| it.status.success())
}

/// The gated figures that are more than before, in words.
fn risen(name: &str, old: &Row, new: &Measured) -> Vec<String> {
    let rises = |at: &usize| match (old.figures[*at], new[*at]) {
        (Some(old), Some(new)) => new > old + old / SLACK + 1,
        _ => false,
    };
    let told = |at: usize| {
        let [old, new] = [old.figures[at], new[at]].map(Option::unwrap_or_default);
        format!("{name}, {}: {new}, {old} before", FIGURES[at])
    };
    (0..GATED).filter(rises).map(told).collect()
}

/// The table with what was measured; the reason goes to the rows where a figure rises.
fn blessed(before: &Table, measured: &BTreeMap<String, Measured>, reason: &str) -> Table {
    let row = |(name, new): (&String, &Measured)| {
        let old = before.0.get(name).cloned().unwrap_or_default();
        let has_risen = before.0.contains_key(name) && !risen(name, &old, new).is_empty();
        let reason = if has_risen { reason.to_owned() } else { old.reason };
        (name.clone(), Row { figures: *new, reason })
    };
    Table(measured.iter().map(row).collect())
}

#[test]
fn scans_take_no_more_instructions() {
    if !has_valgrind() {
        assert!(std::env::var_os("CI").is_none(), "valgrind is missing");
        println!("SKIPPED: instructions of scans, for want of valgrind");
        return;
    }
    let (before, measured) = (Table::read(), measured());
    if let Ok(reason) = std::env::var("STAUNCH_BLESS") {
        let after = blessed(&before, &measured, &reason);
        after.write();
        page::write(&after);
        return;
    }
    let mut complaints = String::new();
    for (name, new) in &measured {
        for line in before.0.get(name).map(|old| risen(name, old, new)).unwrap_or_default() {
            writeln!(complaints, "{line}").unwrap();
        }
    }
    assert!(complaints.is_empty(), "more than {} says:\n{complaints}", table::path().display());
    assert!(before.0.keys().eq(measured.keys()), "{} names other programs", table::path().display());
}

#[test]
fn the_page_shows_the_table() {
    assert!(
        page::is_of(&Table::read()),
        "docs/performance.md does not show tests/perf/instructions.tsv: bless it by the command in this test's first lines"
    );
}
