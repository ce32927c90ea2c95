//! What holds in every program the front end hands over. **Verified IR cannot make a back end
//! fail or panic**: each of their `expect("verified IR: …")` relies on a check here.
//!
//! - Ids are in range; structures and arrays come after their parts, callees before callers.
//! - Types have a layout within the limit; constants have the shape of their types.
//! - Every expression, place, argument, pin input and case label has the type its user wants.
//! - Nothing writes what is constant; EXIT and CONTINUE are where they mean something.

mod expression;
mod place;
mod routine;
mod statement;
mod taking;
mod types;

use crate::reference;
use crate::{Location, Program};
use core::fmt::{self, Display};

/// An invariant that does not hold: a bug in the front end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The type, routine or instance that it is in.
    pub within: String,
    pub at: Location,
    pub message: String,
}

/// Checks every invariant. A back end takes only what passes.
pub fn verify(program: &Program) -> Result<(), Vec<Violation>> {
    let mut verifier = Verifier { program, loopers: Vec::new(), within: String::new(), violations: Vec::new() };
    // Later steps rely on ids and types that the earlier ones found sound.
    for step in [Verifier::types, Verifier::routines, Verifier::bodies, Verifier::reach] {
        step(&mut verifier);
        if !verifier.violations.is_empty() {
            return Err(verifier.violations);
        }
    }
    Ok(())
}

struct Verifier<'p> {
    program: &'p Program,
    /// Which routines have loops.
    loopers: Vec<bool>,
    within: String,
    violations: Vec<Violation>,
}

impl Verifier<'_> {
    fn reach(&mut self) {
        let Some(known) = &self.program.reached else { return };
        let is_covered = known.covers(&reference::reach(self.program));
        self.within = "references".to_owned();
        self.require(is_covered, Location::default(), "the address of a variable that they are said not to reach");
    }

    fn report(&mut self, at: Location, message: impl Display) {
        let violation = Violation { within: self.within.clone(), at, message: message.to_string() };
        self.violations.push(violation);
    }

    /// Reports `message` unless `holds`; returns `holds`.
    fn require(&mut self, holds: bool, at: Location, message: impl Display) -> bool {
        if !holds {
            self.report(at, message);
        }
        holds
    }

    /// A back end looks up the file of every location it prints.
    fn location(&mut self, at: Location) {
        let known = usize::from(at.file) < self.program.files.len();
        self.require(known, at, "a location in a file that does not exist");
    }
}

impl Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Location { file, line, column } = self.at;
        write!(f, "{} (file {file}, line {line}, column {column}): {}", self.within, self.message)
    }
}

impl core::error::Error for Violation {}

#[cfg(test)]
mod tests;
