//! What is asked.

use staunch_frontend::Dialect;
use std::path::PathBuf;

/// What is compared, under which inputs, and for how long.
#[derive(Clone, Debug)]
pub struct Request {
    pub from: Dialect,
    pub to: Dialect,
    /// The other program, if it is a text of the user's own.
    pub against: Option<PathBuf>,
    /// Only these variables are compared; none are named where all are.
    pub vars: Vec<String>,
    /// Inputs over time, in place of a search.
    pub stimulus: Option<PathBuf>,
    /// Scans with a stimulus.
    pub scans: Option<u64>,
    /// Nanoseconds from scan to scan, where that is not the program's to say.
    pub cycle: Option<i64>,
    /// Every sequence of inputs over at most so many scans is tried.
    pub depth: Option<usize>,
    /// Scans of the search.
    pub budget: u64,
    /// A file of assumptions about the inputs, and its text.
    pub assumed: Option<(PathBuf, String)>,
}
