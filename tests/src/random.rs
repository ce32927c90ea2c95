//! Which of the witness's random programs are also compiled as generated Rust.

use staunch_frontend::{Source, Sources, parse};
use staunch_runtime::{Context, Family};
use staunch_witness::{Machine, generate};

/// So many programs.
const PRINTED: usize = 20;
/// Scans of each.
pub const SCANS: i64 = 5;

/// The programs: of those that end, the first.
pub fn seeds() -> impl Iterator<Item = u64> {
    (0..).filter(|seed| ends(&generate::program(*seed))).take(PRINTED)
}

pub fn program(seed: u64) -> String {
    generate::program(seed)
}

/// The name of a program among the generated modules.
pub fn module(seed: u64) -> String {
    format!("random_{seed}")
}

pub fn context(scan: i64) -> Context {
    Context::new(scan * 10_000_000, scan == 0)
}

/// Whether each scan ends soon, and without a fault.
fn ends(text: &str) -> bool {
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", text.to_owned()));
    let files = [parse(0, text, &mut Vec::new())];
    let machine = Machine::new(&sources, &files, Family::Iec, &["Main"]);
    machine.is_ok_and(|mut it| (0..SCANS).all(|scan| it.scan("Main", &context(scan)).is_ok()))
}
