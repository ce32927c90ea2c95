//! Which VAR_IN_OUTs are passed as references, and what a check finds of that.

use crate::Span;
use rustc_hash::FxHashSet;

/// The names of a routine and of its VAR_IN_OUT; a FUNCTION_BLOCK has none, since what extends it has another.
pub(crate) type InOut = (String, String);

#[derive(Clone, Debug, Default)]
pub(crate) struct Polymorphic {
    pub known: FxHashSet<InOut>,
    /// Where those are declared that were given other classes.
    pub asked: FxHashSet<Span>,
    /// Which of them are passed on to which.
    pub passed: FxHashSet<(Span, Span)>,
}

impl Polymorphic {
    pub fn ask(&mut self, declared: Span) {
        self.asked.insert(declared);
    }

    pub fn pass(&mut self, from: Span, to: Span) {
        self.passed.insert((from, to));
    }
}
