//! Golden cases with a few of their words changed: where `check` accepts one, the witness and the interpreter do the same
//! under the case's stimulus. So the shapes that the cases have are met in combinations that nobody wrote.
//!
//! `STAUNCH_CHANGES=first..end` chooses the changes of each case, `STAUNCH_CASE=name` the cases.

use crate::case::{Case, Pin, discover};
use crate::compare::Verdict;
use crate::golden::compare;
use crate::range;
use staunch_frontend::{Source, Sources};
use staunch_witness::random::Random;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Of each case, in each run of the tests.
const CHANGES: Range<u64> = 0..2;
/// Changes that are tried for one that is accepted.
const TRIES: usize = 8;

#[test]
fn changed_cases() {
    let (cases, _) = discover(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases"));
    let chosen = std::env::var("STAUNCH_CASE").unwrap_or_default();
    let cases: Vec<_> = cases.iter().filter(|it| is_text(it) && it.name.contains(&chosen)).collect();
    let changes = std::env::var("STAUNCH_CHANGES").map_or(CHANGES, |it| range(&it));
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(2);
    let parts: Vec<[usize; 3]> = std::thread::scope(|scope| {
        let part =
            |at| cases.iter().skip(at).step_by(threads).flat_map(|it| changes.clone().map(move |seed| (it, seed)));
        let run = |at| scope.spawn(move || tally(part(at)));
        let parts: Vec<_> = (0..threads).map(run).collect();
        parts.into_iter().map(|it| it.join().unwrap()).collect()
    });
    let [same, other, wrong] = parts.into_iter().fold([0; 3], |[a, b, c], [d, e, f]| [a + d, b + e, c + f]);
    println!("{same} changed cases are the same, {other} are not known");
    assert_eq!(wrong, 0, "of {same} changed cases");
    assert!(!chosen.is_empty() || same > other, "only {same} of {} were compared", same + other);
}

/// Whether a case has a run, and is not a vendor's file.
fn is_text(case: &Case) -> bool {
    case.pins.contains(&Pin::Scan) && !case.name.starts_with("vendor/")
}

/// How many are the same, are not compared, and differ.
fn tally<'c>(tried: impl Iterator<Item = (&'c &'c Case, u64)>) -> [usize; 3] {
    let mut counts = [0; 3];
    let shows = std::env::var_os("STAUNCH_SHOW").is_some();
    for (case, seed) in tried {
        let Some((sources, text)) = accepted(case, seed) else { continue };
        let verdict = catch_unwind(AssertUnwindSafe(|| compare(case, &sources))).unwrap_or_else(|panic| {
            let said = panic.downcast_ref::<String>().map_or("", |it| it);
            Ok(Verdict::Differs(format!("a panic: {said}")))
        });
        let at = match verdict {
            Ok(Verdict::Same { .. }) => 0,
            // There is nothing to compare in what has no end.
            Ok(Verdict::Endless) => continue,
            // The stimulus may name what is no longer there.
            Ok(Verdict::Rejected(reason)) | Err(reason) => {
                if shows {
                    println!("{}, change {seed}, is not compared: {reason}", case.name);
                }
                1
            }
            Ok(Verdict::Differs(how)) => {
                println!("// {}, change {seed}: {how}\n{text}", case.name);
                2
            }
        };
        counts[at] += 1;
    }
    counts
}

/// The sources of a case with a change that is accepted, and the text of the first.
fn accepted(case: &Case, seed: u64) -> Option<(Sources, String)> {
    let (sources, options) = (case.sources(), case.settings().options);
    let text = &sources.files()[0].text;
    let mut random = Random::new(seed.wrapping_mul(0x9E37_79B9) + text.len() as u64);
    let tried = (0..TRIES).map(|_| changed(text, &mut random)).map(|it| (with_first(&sources, &it), it));
    let compiles = |it: &Sources| staunch_frontend::compile(it, &options).program.is_some();
    // A panic is found again when it is compared.
    let is_accepted = |it: &Sources| catch_unwind(AssertUnwindSafe(|| compiles(it))).unwrap_or(true);
    tried.filter(|it| it.1 != *text).find(|it| is_accepted(&it.0))
}

/// The sources with another text for the first of them.
fn with_first(sources: &Sources, text: &str) -> Sources {
    let mut changed = Sources::default();
    for (at, file) in sources.files().iter().enumerate() {
        changed.add(if at == 0 { Source::new(&file.path, text.to_owned()) } else { file.clone() });
    }
    changed
}

/// Words that can replace each other, a row each.
const ROWS: [&[&str]; 9] = [
    &["+", "-", "*", "/", "MOD", "**"],
    &["<", "<=", ">", ">=", "=", "<>"],
    &["AND", "OR", "XOR", "AND_THEN", "OR_ELSE"],
    &["TRUE", "FALSE"],
    &["SINT", "INT", "DINT", "LINT", "USINT", "UINT", "UDINT", "ULINT", "REAL", "LREAL"],
    &["BOOL", "BYTE", "WORD", "DWORD", "LWORD"],
    &["VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR_TEMP", "VAR RETAIN", "VAR CONSTANT"],
    &["0", "1", "2", "3", "5", "7", "10", "-1", "2.5"],
    &["100", "127", "255", "1000", "32767", "16#80"],
];

fn changed(text: &str, random: &mut Random) -> String {
    let mut words = words(text);
    for _ in 0..=random.below(2) {
        change(&mut words, random);
    }
    words.concat()
}

fn change(words: &mut Vec<&str>, random: &mut Random) {
    match random.below(6) {
        // A statement is missing, there again, or somewhere else.
        0 => {
            let statement = statement(words, random);
            let taken: Vec<_> = match random.below(2) {
                0 => words.drain(statement).collect(),
                _ => words[statement].to_vec(),
            };
            if random.below(3) != 0 {
                let ends: Vec<_> = (0..words.len()).filter(|at| words[*at] == ";").collect();
                let at = if ends.is_empty() { 0 } else { random.one_of(&ends) + 1 };
                words.splice(at..at, taken);
            }
        }
        1 => {
            let at = random.below(words.len());
            if is_name(words.get(at).copied().unwrap_or_default()) {
                words.insert(at, *random.one_of(&["NOT ", "-", "2 * ", "1 + ", "NOT NOT "]));
            }
        }
        2 | 3 => {
            let others: Vec<_> = words.iter().copied().filter(|it| is_name(it)).collect();
            let places: Vec<_> = (0..words.len()).filter(|at| is_name(words[*at])).collect();
            if !places.is_empty() {
                let at = *random.one_of(&places);
                words[at] = *random.one_of(&others);
            }
        }
        _ => {
            let row = |word: &str| {
                let meant = match word {
                    _ if !is_number(word) => word,
                    // Bounds of arrays stay small.
                    _ if word.len() < 3 => "0",
                    _ => "100",
                };
                ROWS.into_iter().find(|it| it.contains(&meant))
            };
            let places: Vec<_> = (0..words.len()).filter_map(|at| Some((at, row(words[at])?))).collect();
            if !places.is_empty() {
                let (at, row) = *random.one_of(&places);
                words[at] = *random.one_of(row);
            }
        }
    }
}

/// From after a `;` to the next one.
fn statement(words: &[&str], random: &mut Random) -> Range<usize> {
    let end = random.below(words.len());
    let end = (end..words.len()).find(|at| words[*at] == ";").map_or(words.len(), |it| it + 1);
    let start = (0..end.saturating_sub(1)).rev().find(|at| words[*at] == ";").map_or(0, |it| it + 1);
    start..end
}

fn is_name(word: &str) -> bool {
    word.starts_with(|it: char| it.is_ascii_alphabetic() || it == '_')
}

fn is_number(word: &str) -> bool {
    word.starts_with(|it: char| it.is_ascii_digit())
}

/// Names and numbers, runs of spaces, operators, and comments and texts as a whole.
fn words(text: &str) -> Vec<&str> {
    let (mut words, mut rest) = (Vec::new(), text);
    while let Some(first) = rest.chars().next() {
        let until = |close: &str| rest[1..].find(close).map_or(rest.len(), |it| 1 + it + close.len());
        let run = |is: fn(char) -> bool| rest.find(|it| !is(it)).unwrap_or(rest.len());
        let end = match first {
            _ if rest.starts_with("//") => until("\n"),
            _ if rest.starts_with("(*") => until("*)"),
            '\'' | '"' => until(&rest[..1]),
            '{' => until("}"),
            _ if first.is_ascii_alphanumeric() => run(|it| it.is_ascii_alphanumeric() || "_#".contains(it)),
            _ if first.is_whitespace() => run(char::is_whitespace),
            _ => ["**", "<=", ">=", "<>", ":=", "=>", ".."]
                .into_iter()
                .find(|it| rest.starts_with(it))
                .map_or(first.len_utf8(), str::len),
        };
        let (word, after) = rest.split_at(end);
        words.push(word);
        rest = after;
    }
    words
}
