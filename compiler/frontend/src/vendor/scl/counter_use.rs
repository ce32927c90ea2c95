//! Where counters of S7 are declared and called. Siemens' documents leave their rules open: each is refused, with what a
//! family has in its place.

use super::counter::{Counters, INSTRUCTIONS, is_one, of_the_standard};
use super::{Kind, Scl};
use core::ops::Range;

impl Scl<'_> {
    /// Refuses a counter; what is read in its place.
    pub fn refuse_counter(&mut self, ty: &str, name: &str, place: Range<usize>) -> String {
        let called = self.counters.get(&name.to_ascii_lowercase()).copied().flatten();
        let family = of_the_standard(ty, called);
        let message = format!("`{ty}` is a counter of S7, whose rules its documents leave open");
        self.refuse(place, message);
        self.out.help(format!("a family says what its counters do: write `{family}` in Structured Text"));
        family
    }

    /// What is declared as a counter, in lower case, and the instruction that a call of it names, `"C".CTU(…)`.
    pub fn called_counters(&self) -> Counters {
        let mut counters = Counters::default();
        for at in 1..self.tokens.len() {
            if !is_one(&self.text(at).to_ascii_uppercase()) {
                continue;
            }
            let head = if self.text(at - 1) == ":" { Some(self.declared_before(at)) } else { self.data_block_of(at) };
            if let Some(head) = head {
                counters.insert(self.name(head).to_ascii_lowercase(), None);
            }
        }
        for at in 2..self.tokens.len() {
            let is_call = self.text(at - 1) == "." && self.text(at + 1) == "(";
            if let Some(instruction) = INSTRUCTIONS.into_iter().find(|it| is_call && self.is(at, it))
                && let Some(called) = counters.get_mut(&self.name(at - 2).to_ascii_lowercase())
            {
                *called = Some(instruction);
            }
        }
        counters
    }

    /// What the type at a token is declared for; pragmas may be between.
    pub fn declared_before(&self, at: usize) -> usize {
        let before = (0..at.saturating_sub(1)).rev();
        before.into_iter().find(|it| self.token(*it).is_some_and(|it| it.kind != Kind::Pragma)).unwrap_or_default()
    }

    /// The name of the data block whose type is at a token.
    fn data_block_of(&self, at: usize) -> Option<usize> {
        if self.text(at + 1) == ":" {
            return None;
        }
        let is_head = |it: &usize| self.is(*it, "DATA_BLOCK");
        let is_past = |it: &usize| self.is(*it, "BEGIN") || self.text(*it) == ";";
        (0..at).rev().take_while(|it| !is_past(it)).find(is_head).map(|it| it + 1)
    }
}
