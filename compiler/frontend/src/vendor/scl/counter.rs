//! The counters of S7, whose rules Siemens' documents leave open: each is refused, with what a family has in its place.

use super::{Kind, Scl};
use core::ops::Range;
use rustc_hash::FxHashMap;
use staunch_runtime::{BLOCKS, Family};

/// Data of a counter, which does not say which one it is of, and the suffix of a counter of its numbers.
const DATA: [(&str, &str); 8] = [
    ("IEC_COUNTER", ""),
    ("IEC_SCOUNTER", ""),
    ("IEC_DCOUNTER", "_DINT"),
    ("IEC_LCOUNTER", "_LINT"),
    ("IEC_UCOUNTER", ""),
    ("IEC_USCOUNTER", ""),
    ("IEC_UDCOUNTER", "_UDINT"),
    ("IEC_ULCOUNTER", "_ULINT"),
];

const INSTRUCTIONS: [&str; 3] = ["CTUD", "CTU", "CTD"];

pub type Counters = FxHashMap<String, Option<&'static str>>;

/// Whether a type, in capitals, is one of the system's counters.
pub fn is_one(ty: &str) -> bool {
    DATA.iter().any(|it| it.0 == ty) || instruction(ty).is_some()
}

/// The counter, and what follows its name: `_INT`.
fn instruction(ty: &str) -> Option<(&'static str, &str)> {
    let named = |name: &'static str| Some((name, ty.strip_prefix(name)?));
    INSTRUCTIONS.into_iter().find_map(named).filter(|it| it.1.is_empty() || it.1.starts_with('_'))
}

/// What the standard's family has in place of a counter with the numbers of a type, `CTD_INT`.
fn of_the_standard(name: &str, numbers: &str) -> String {
    let full = format!("{name}{numbers}");
    let has = BLOCKS.iter().any(|it| it.family == Family::Iec && it.is_named(&full));
    format!("IEC.{}", if has { full.as_str() } else { name })
}

impl Scl<'_> {
    /// Refuses a counter; what is read in its place.
    pub fn refuse_counter(&mut self, ty: &str, name: &str, place: Range<usize>) -> String {
        let upper = ty.to_ascii_uppercase();
        let family = match instruction(&upper) {
            Some((counter, numbers)) => of_the_standard(counter, numbers),
            None => {
                let numbers = DATA.iter().find(|it| it.0 == upper).map_or("", |it| it.1);
                of_the_standard(
                    self.counters.get(&name.to_ascii_lowercase()).copied().flatten().unwrap_or("CTUD"),
                    numbers,
                )
            }
        };
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
