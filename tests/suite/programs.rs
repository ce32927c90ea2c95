//! Random programs do the same on the interpreter, as native code and as generated Rust.

use staunch_frontend::{Format, Options, Severity, Source, Sources, Style, render};
use staunch_host::Machine;
use staunch_runtime::Context;
use staunch_tests::execute::Executor;
use staunch_tests::leaf::Leaves;
use staunch_tests::random;
use std::ops::Range;

const PROGRAMS: u64 = 300;
const SCANS: i64 = 6;

#[test]
fn random_programs_agree_as_native_code() {
    hold(0..PROGRAMS / 2, Executor::Native);
}

#[test]
fn more_random_programs_agree_as_native_code() {
    hold(PROGRAMS / 2..PROGRAMS, Executor::Native);
}

#[test]
fn random_programs_agree_as_generated_rust() {
    hold(0..random::PRINTED, Executor::Rust);
}

fn hold(seeds: Range<u64>, executor: Executor) {
    let count = seeds.end - seeds.start;
    let faults: u64 = seeds.map(|seed| u64::from(agree(seed, executor))).sum();
    // Most programs run through: one that faults at once compares little.
    assert!(faults * 2 < count, "{faults} of {count} fault");
}

/// Whether the program faulted.
fn agree(seed: u64, executor: Executor) -> bool {
    let text = random::program(seed);
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", text.clone()));
    let compilation = staunch_frontend::compile(&sources, &Options::default());
    let messages = || {
        let errors = compilation
            .diagnostics
            .iter()
            .filter(|it| it.severity == Severity::Error)
            .map(|it| render(it, &sources, Format::Human, Style::default()));
        errors.collect::<String>()
    };
    let program = compilation.program.as_ref().unwrap_or_else(|| panic!("seed {seed}: {}\n{text}", messages()));
    let leaves = Leaves::new(program);
    let mut machines = [Executor::Interpreter, executor].map(|it| it.machine(program, &random::module(seed)).unwrap());
    for scan in 0..SCANS {
        let cx = Context::new(scan * 10_000_000, scan == 0);
        let ends = machines.each_mut().map(|it: &mut Box<dyn Machine + '_>| it.scan(0, &cx));
        let [a, b] = machines.each_ref().map(|it| leaves.of(it.state()));
        let different = a.iter().zip(&b).find(|(a, b)| a != b);
        assert!(different.is_none(), "seed {seed}, scan {scan}: {different:?}\n{text}");
        assert_eq!(ends[0], ends[1], "seed {seed}, scan {scan}\n{text}");
        if ends[0].is_err() {
            return true;
        }
    }
    false
}
