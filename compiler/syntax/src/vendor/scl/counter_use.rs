//! Where counters of S7 are declared and called.

use super::counter::{Called, Counters, INSTRUCTIONS, block, instruction, is_one};
use super::{Kind, Scl};

impl Scl<'_> {
    /// The block that is declared as a counter.
    pub fn counter(&self, ty: &str, name: &str) -> String {
        let called = self.counters.get(&name.to_ascii_lowercase()).copied().unwrap_or(Called::Nowhere);
        block(ty, called)
    }

    /// Whether `"C".CTU(…)` is a call of the block `C`.
    pub fn is_counter_called_as(&self, name: &str, called: &str) -> bool {
        let counter = self.counters.get(&name.to_ascii_lowercase());
        matches!(counter, Some(Called::As(it)) if it.eq_ignore_ascii_case(called))
    }

    /// What is declared as a counter, in lower case, and the instruction that its type or its calls name, `"C".CTU(…)`.
    pub fn called_counters(&self) -> Counters {
        let mut counters = Counters::default();
        for at in 1..self.tokens.len() {
            let ty = self.text(at).to_ascii_uppercase();
            if !is_one(&ty) {
                continue;
            }
            let head = if self.text(at - 1) == ":" { Some(self.declared_before(at)) } else { self.data_block_of(at) };
            if let Some(head) = head {
                let own = instruction(&ty).map_or(Called::Nowhere, |it| Called::As(it.0));
                // What is given for an in-out may be called under its own name, in another file.
                let called = if self.is_in_out(head) { Called::Otherwise } else { own };
                let known = counters.entry(self.name(head).to_ascii_lowercase()).or_insert(called);
                *known = if *known == called { called } else { Called::Otherwise };
            }
        }
        for at in 2..self.tokens.len() {
            let is_call = self.text(at - 1) == "." && self.text(at + 1) == "(";
            if let Some(instruction) = INSTRUCTIONS.into_iter().find(|it| is_call && self.is(at, it))
                && let Some(called) = counters.get_mut(&self.name(at - 2).to_ascii_lowercase())
            {
                let is_same = matches!(*called, Called::Nowhere) || *called == Called::As(instruction);
                *called = if is_same { Called::As(instruction) } else { Called::Otherwise };
            }
        }
        counters
    }

    fn is_in_out(&self, at: usize) -> bool {
        let is_section = |it: &usize| self.text(*it).get(..3).is_some_and(|it| it.eq_ignore_ascii_case("VAR"));
        let is_past = |it: &usize| self.is(*it, "DATA_BLOCK") || self.is(*it, "END_VAR");
        let section = (0..at).rev().take_while(|it| !is_past(it)).find(is_section);
        section.is_some_and(|it| self.is(it, "VAR_IN_OUT"))
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
