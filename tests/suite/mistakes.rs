//! What people type while they write is full of mistakes: no case with a few of its words changed makes the compiler
//! panic, neither where it refuses nor where it accepts.

use staunch_frontend::{Source, Sources, compile};
use staunch_tests::case::{self, Case};
use staunch_tests::cases;
use staunch_witness::random::Random;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// For each case.
const CHANGES: u64 = 16;
/// What the command gives itself.
const STACK: usize = 256 << 20;

#[test]
fn no_mistake_makes_the_compiler_panic() {
    let found = std::thread::Builder::new().stack_size(STACK).spawn(findings).unwrap().join().unwrap();
    assert!(found.is_empty(), "{} of them do, the first is\n{}", found.len(), found[0]);
}

fn findings() -> Vec<String> {
    let (cases, _) = case::discover(&cases());
    let texts: Vec<String> = cases.iter().map(|it| it.sources().files()[0].text.clone()).collect();
    let words: Vec<Vec<&str>> = texts.iter().map(|it| words(it)).collect();
    let tried = cases.iter().enumerate().flat_map(|(at, case)| (0..CHANGES).map(move |seed| (at, case, seed)));
    let tried: Vec<_> = tried.filter(|(_, case, _)| case.sources.len() == 1).collect();
    assert!(tried.len() > 10_000, "{}", tried.len());
    tried.into_iter().filter_map(|(at, case, seed)| finding(case, changed(&words, at, seed))).collect()
}

/// The text, if it makes the compiler panic.
fn finding(case: &Case, text: String) -> Option<String> {
    let mut sources = Sources::default();
    sources.add(Source::new("mistake.st", text.clone()));
    let options = case.settings().options;
    let ended = catch_unwind(AssertUnwindSafe(|| compile(&sources, &options)));
    ended.is_err().then(|| format!("// {}, {:?}\n{text}", case.name, options.dialect))
}

/// The case's words with up to four changes: some are missing, or others are among them.
fn changed(words: &[Vec<&str>], at: usize, seed: u64) -> String {
    let mut random = Random::new(seed * 10_000 + at as u64);
    let mut changed = words[at].clone();
    for _ in 0..=random.below(4) {
        let place = random.below(changed.len() + 1);
        match random.below(4) {
            0 => {
                let end = changed.len().min(place + 1 + random.below(4));
                changed.drain(place..end);
            }
            1 => {
                let own = part(&changed, random.below(changed.len()), random.below(20));
                changed.splice(place..place, own);
            }
            it => {
                let other = random.one_of(words);
                let other = part(other, random.below(other.len()), random.below(if it == 2 { 2 } else { 20 }));
                changed.splice(place..place, other);
            }
        }
    }
    changed.concat()
}

fn part<'t>(words: &[&'t str], from: usize, count: usize) -> Vec<&'t str> {
    words.iter().skip(from).take(count + 1).copied().collect()
}

/// Names and numbers, runs of spaces, and single signs.
fn words(text: &str) -> Vec<&str> {
    let class = |it: char| match it {
        _ if it.is_alphanumeric() || it == '_' => 0,
        _ if it.is_whitespace() => 1,
        _ => 2,
    };
    let (mut words, mut rest) = (Vec::new(), text);
    while let Some(first) = rest.chars().next() {
        let end = match class(first) {
            2 => first.len_utf8(),
            kind => rest.find(|it| class(it) != kind).unwrap_or(rest.len()),
        };
        let (word, after) = rest.split_at(end);
        words.push(word);
        rest = after;
    }
    words
}
