//! How tests went.

use staunch_frontend::{Span, Test};

/// How a test went.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    Passed,
    Failed {
        /// The number of the assertion, from 0.
        assertion: usize,
        actual: Option<String>,
        expected: Option<String>,
        tolerance: Option<String>,
        message: Option<String>,
    },
    /// What a table expected otherwise, a line each.
    Differs(Vec<String>),
    /// The test faulted: where, and why.
    Faulted(String),
    /// The test did not run: why.
    Skipped(String),
}

impl Outcome {
    /// Whether nothing is wrong.
    pub fn is_fine(&self) -> bool {
        matches!(self, Self::Passed | Self::Skipped(_))
    }
}

/// A test that has run: a TEST, or one of a suite's.
pub struct Case {
    pub title: String,
    pub span: Span,
    pub outcome: Outcome,
}

/// The variables of a test after its scans, by their names.
pub type Values<'v> = dyn Fn(&str) -> Result<String, String> + 'v;

/// The assertion that failed, with what is kept of it.
pub fn failed(test: &Test, values: &Values<'_>) -> Result<Outcome, String> {
    // A suite without assertions has no such variable.
    let number = if test.failed.is_empty() { 0 } else { values(&test.failed)?.parse::<usize>().unwrap_or(0) };
    let Some(assertion) = number.checked_sub(1) else { return Ok(Outcome::Passed) };
    let made = test.assertions.get(assertion).ok_or_else(|| format!("assertion {number} is not known"))?;
    let shown = |name: &Option<String>| name.as_deref().map(values).transpose();
    let (actual, expected) = (shown(&made.actual)?, shown(&made.expected)?);
    let (tolerance, message) = (shown(&made.tolerance)?, shown(&made.message)?);
    Ok(Outcome::Failed { assertion, actual, expected, tolerance, message })
}
