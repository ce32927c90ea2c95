//! What a comparison came to, and on what grounds.

pub mod scope;
pub mod stimulus;

pub mod judge;

use crate::difference::pitfall::Pitfall;
use crate::pair::Row;
use crate::search::trace::Trace;
use crate::variants::Variant;

/// What the comparison came to.
#[derive(Debug)]
pub enum Verdict {
    /// The rows up to the first difference.
    Differs { rows: Vec<Row>, trace: Option<Trace>, shortest: bool },
    /// Nothing differs, for this reason.
    Equal(String),
    /// Nothing was found to differ: what was tried, and what was not.
    NotFound { tried: Vec<String>, left: Vec<String> },
}

/// What the comparison came to; and, where all that it has found is accepted, what it comes to beyond that.
#[derive(Debug)]
pub struct Judged<'v> {
    pub verdict: &'v Verdict,
    pub rest: Option<&'v Verdict>,
    /// How it answers what the vendors' documents leave open.
    pub variant: &'v Variant,
    /// What the other answers came to.
    pub others: &'v [Other],
    pub without_run: Option<&'v WithoutRun>,
}

/// What the comparison comes to where nobody switches the system to STOP.
#[derive(Debug)]
pub struct WithoutRun {
    pub verdict: &'static str,
    /// As the end of a sentence.
    pub words: String,
    pub scans: Option<usize>,
    pub pitfall: Option<Pitfall>,
}

/// What a variant that is not shown came to.
#[derive(Debug)]
pub struct Other {
    pub variant: Variant,
    pub verdict: &'static str,
    pub scans: Option<usize>,
    /// Where the difference needs STOP -> RUN: the verdict without it, and after how many scans the two differ then.
    pub without_run: Option<(&'static str, Option<usize>)>,
}

impl Other {
    pub fn of(variant: Variant, verdict: &Verdict, rest: Option<&Verdict>, without_run: Option<&WithoutRun>) -> Self {
        let scans = match verdict {
            Verdict::Differs { rows, .. } => Some(rows.len()),
            Verdict::Equal(_) | Verdict::NotFound { .. } => None,
        };
        let verdict = match (weight(verdict, rest), scans) {
            (Weight::Equal, None) => "equal",
            (Weight::Equal, Some(_)) => "equal except for what is accepted",
            (Weight::NotFound, _) => "not found",
            (Weight::Differs, _) => "different",
        };
        Self { variant, verdict, scans, without_run: without_run.map(|it| (it.verdict, it.scans)) }
    }

    /// One of the two systems rejects the program.
    pub fn rejected(variant: Variant) -> Self {
        Self { variant, verdict: "rejected", scans: None, without_run: None }
    }

    /// As the end of a sentence.
    pub fn words(&self) -> String {
        let without =
            self.without_run.map(|(verdict, scans)| format!("; without STOP -> RUN, {}", words(verdict, scans)));
        words(self.verdict, self.scans) + &without.unwrap_or_default()
    }
}

fn words(verdict: &str, scans: Option<usize>) -> String {
    match (verdict, scans) {
        ("different", Some(1)) => "the two differ after 1 scan".to_owned(),
        ("different", Some(scans)) => format!("the two differ after {scans} scans"),
        ("not found", _) => "no difference was found, but none is ruled out".to_owned(),
        ("rejected", _) => "one of the two systems rejects the program".to_owned(),
        (other, _) => format!("the two are {other}"),
    }
}

/// How much a verdict asks for, the least first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Weight {
    Equal,
    NotFound,
    Differs,
}

/// Of a verdict, and of what the search beyond accepted findings came to.
pub fn weight(verdict: &Verdict, rest: Option<&Verdict>) -> Weight {
    match (verdict, rest) {
        (Verdict::Differs { .. }, None | Some(Verdict::Differs { .. })) => Weight::Differs,
        (Verdict::NotFound { .. }, _) | (Verdict::Differs { .. }, Some(Verdict::NotFound { .. })) => Weight::NotFound,
        (Verdict::Equal(_), _) | (Verdict::Differs { .. }, Some(Verdict::Equal(_))) => Weight::Equal,
    }
}
