//! What a comparison came to, and on what grounds.

pub mod scope;
pub mod stimulus;

pub mod judge;

use crate::compare::difference::pitfall::Pitfall;
use crate::compare::pair::Row;
use crate::compare::search::trace::Trace;
use crate::compare::variants::{Other, Variant};

/// What the comparison came to.
pub enum Verdict {
    /// The rows up to the first difference.
    Differs { rows: Vec<Row>, trace: Option<Trace>, shortest: bool },
    /// Nothing differs, for this reason.
    Equal(String),
    /// Nothing was found to differ: what was tried, and what was not.
    NotFound { tried: Vec<String>, left: Vec<String> },
}

/// What the comparison came to; and, where all that it has found is accepted, what it comes to beyond that.
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
