//! Loops that take their turns at once, or none where they have few: their number is known, and nothing ends early what
//! takes all.

use super::Verifier;
use super::statement::{Body, is_turn};
use crate::alias::Frame;
use crate::taking::{ends_early, has_loops};
use crate::turns;
use crate::{Block, Count, Location, Statement, Taking};

impl<'p> Verifier<'p> {
    pub(super) fn count(&mut self, body: &Body<'p>, block: &Block, continuing: &Block, count: &Count, at: Location) {
        self.expr_of(body, &count.bound, count.counter.ty);
        let frame = Frame::of(self.program, body.routine);
        let linear = turns::linear(&frame, block).filter(|_| continuing.is_empty());
        let is_so = linear.as_ref().is_some_and(|it| {
            (it.step, it.offset) == (count.step, count.offset) && it.counter.is_same_variable(&count.counter)
        });
        self.require(is_so, at, "a loop that does not have the turns which it is said to have");
        let Some(it) = linear else { return };
        self.taking(count.taking, !(it.has_others && count.taking.is_ahead()), it.test, it.rest, at);
    }

    /// `is_known` says that only the loop's bounds decide about its turns, and what ends it early in its body.
    pub(super) fn taking(
        &mut self,
        taking: Taking,
        is_known: bool,
        test: &[Statement],
        body: &[Statement],
        at: Location,
    ) {
        if let Taking::Ahead(at) | Taking::AheadOfMany(at) = taking {
            self.location(at);
        }
        let (turn, rest) = match body.split_first() {
            Some((first, rest)) if is_turn(first) => (true, rest),
            _ => (false, body),
        };
        let is_innermost = ![test, rest].iter().any(|it| has_loops(it, &self.loopers));
        let is_so = match taking {
            Taking::Each => true,
            Taking::EachOfMany => is_known && turn && is_innermost,
            Taking::Ahead(_) => is_known && !turn && !ends_early(rest),
            Taking::AheadOfMany(_) => is_known && !turn && !ends_early(rest) && is_innermost,
        };
        self.require(is_so, at, "a loop that cannot take its turns so");
    }
}
