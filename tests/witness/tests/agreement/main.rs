//! The witness and the executors do the same: on random programs, and on the golden cases as far as
//! the witness knows what they use.
//!
//! `STAUNCH_SEEDS=first..end` chooses the programs, `STAUNCH_PROGRAM=file.st` compares one file.
#![allow(clippy::unwrap_used)]

mod compare;
#[path = "../../../src/leaf.rs"]
mod leaf;

use compare::{Verdict, compare};
use staunch_witness::{generate, shrink};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Programs that each run of the tests compares.
const PROGRAMS: u64 = 1000;
/// Programs that are made small, of those that differ.
const SHRUNK: usize = 3;

#[test]
fn random_programs() {
    if let Ok(path) = std::env::var("STAUNCH_PROGRAM") {
        let text = std::fs::read_to_string(path).unwrap();
        println!("{}", compare(&text, true));
        return;
    }
    let seeds = std::env::var("STAUNCH_SEEDS").ok();
    let seeds = seeds.map_or(0..PROGRAMS, |it| range(&it));
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(2);
    let tallies: Vec<Tally> = std::thread::scope(|scope| {
        let parts: Vec<_> = (0..threads)
            .map(|part| (part, seeds.clone()))
            .map(|(part, seeds)| scope.spawn(move || tally(seeds.skip(part).step_by(threads))))
            .collect();
        parts.into_iter().map(|it| it.join().unwrap()).collect()
    });
    let mut all = Tally::default();
    tallies.into_iter().for_each(|it| all.add(it));
    let count = seeds.end - seeds.start;
    println!("{count} programs: {} faulted, {} endless", all.faulted, all.endless);
    for (reason, (times, seed)) in &all.rejected {
        println!("{times} not compared, as seed {seed}: {reason}");
    }
    let rejected: u64 = all.rejected.values().map(|it| it.0).sum();
    for (number, (seed, how)) in all.different.iter().enumerate() {
        println!("seed {seed}: {how}");
        if number < SHRUNK {
            let native = how.contains("native");
            let small =
                shrink::shrink(&generate::program(*seed), &|it| matches!(compare(it, native), Verdict::Differs(_)));
            println!("{}\n{small}", compare(&small, native));
        }
    }
    assert!(all.different.is_empty(), "{} of {count} programs differ", all.different.len());
    assert!(rejected * 20 <= count, "{rejected} of {count} programs are not compared");
    assert!(all.faulted * 2 <= count, "{} of {count} programs fault", all.faulted);
}

#[derive(Default)]
struct Tally {
    faulted: u64,
    endless: u64,
    /// Why programs were not compared: how many, and the first's seed.
    rejected: BTreeMap<String, (u64, u64)>,
    different: Vec<(u64, String)>,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.faulted += other.faulted;
        self.endless += other.endless;
        for (reason, (times, seed)) in other.rejected {
            self.rejected.entry(reason).or_insert((0, seed)).0 += times;
        }
        self.different.extend(other.different);
    }
}

fn tally(seeds: impl Iterator<Item = u64>) -> Tally {
    let mut tally = Tally::default();
    for seed in seeds {
        let text = generate::program(seed);
        match compare(&text, seed % native_every() == 0) {
            Verdict::Same { faulted } => tally.faulted += u64::from(faulted),
            Verdict::Endless => tally.endless += 1,
            Verdict::Rejected(reason) => tally.rejected.entry(reason).or_insert((0, seed)).0 += 1,
            Verdict::Differs(how) => tally.different.push((seed, how)),
        }
    }
    tally
}

/// Native code of each so many programs is compared: of all where it is compiled fast.
fn native_every() -> u64 {
    if cfg!(debug_assertions) { 8 } else { 1 }
}

fn range(text: &str) -> Range<u64> {
    let (first, end) = text.split_once("..").expect("first..end");
    first.parse().unwrap()..end.parse().unwrap()
}

/// The golden cases that run, without their stimulus.
#[test]
fn golden_cases() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases");
    let mut unknown = BTreeMap::new();
    let (mut compared, mut wrong) = (0, 0);
    for path in programs(&cases) {
        let text = std::fs::read_to_string(&path).unwrap();
        match compare(&text, true) {
            Verdict::Same { .. } => compared += 1,
            Verdict::Endless => {}
            Verdict::Rejected(reason) => *unknown.entry(reason).or_insert(0) += 1,
            Verdict::Differs(how) => {
                println!("{}: {how}", path.display());
                wrong += 1;
            }
        }
    }
    for (reason, times) in unknown.iter().filter(|it| it.0.starts_with("the witness")) {
        println!("{times} {reason}");
    }
    println!("{compared} cases compared");
    assert_eq!(wrong, 0, "of {compared} cases");
}

/// The cases with a `.scan` file, of one source file.
fn programs(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(programs(&path));
        } else if path.extension().is_some_and(|it| it == "st") && path.with_extension("scan").exists() {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Prints the program of `STAUNCH_SEED`.
#[test]
#[ignore = "for looking at one program"]
fn show() {
    print!("{}", generate::program(std::env::var("STAUNCH_SEED").unwrap().parse().unwrap()));
}
