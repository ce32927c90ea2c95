//! The witness and the executors do the same: on random programs, and on the golden cases as far as
//! the witness knows what they use.
//!
//! `STAUNCH_SEEDS=first..end` chooses the programs, `STAUNCH_PROGRAM=file.st` compares one file, `STAUNCH_CASE=name` one
//! golden case.
#![allow(clippy::unwrap_used)]

#[expect(dead_code, reason = "sources are compiled by themselves")]
#[path = "../../../src/case.rs"]
mod case;
mod changed;
mod compare;
mod golden;
#[path = "../../../src/leaf.rs"]
mod leaf;
mod recorded;
#[expect(dead_code, reason = "only the stimulus is read")]
#[path = "../../../src/scan.rs"]
mod scan;

use compare::{Verdict, compare};
use staunch_witness::{generate, shrink};
use std::collections::BTreeMap;
use std::ops::Range;

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
            // A panic is made again and again then.
            let hook = std::panic::take_hook();
            std::panic::set_hook(Box::new(|_| {}));
            let small =
                shrink::shrink(&generate::program(*seed), &|it| matches!(caught(it, native), Verdict::Differs(_)));
            std::panic::set_hook(hook);
            println!("{}\n{small}", caught(&small, native));
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
        // A panic is shown with its seed, and its program is made small as others are.
        match caught(&text, seed % native_every() == 0) {
            Verdict::Same { faulted } => tally.faulted += u64::from(faulted),
            Verdict::Endless => tally.endless += 1,
            Verdict::Rejected(reason) => tally.rejected.entry(reason).or_insert((0, seed)).0 += 1,
            Verdict::Differs(how) => tally.different.push((seed, how)),
        }
    }
    tally
}

fn caught(text: &str, with_native: bool) -> Verdict {
    std::panic::catch_unwind(|| compare(text, with_native)).unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map_or("", |it| it);
        Verdict::Differs(format!("a panic: {said}"))
    })
}

/// Native code of each so many programs is compared: of all where it is compiled fast.
fn native_every() -> u64 {
    if cfg!(debug_assertions) { 8 } else { 1 }
}

fn range(text: &str) -> Range<u64> {
    let (first, end) = text.split_once("..").expect("first..end");
    first.parse().unwrap()..end.parse().unwrap()
}

/// Prints the program of `STAUNCH_SEED`.
#[test]
#[ignore = "for looking at one program"]
fn show() {
    print!("{}", generate::program(std::env::var("STAUNCH_SEED").unwrap().parse().unwrap()));
}
