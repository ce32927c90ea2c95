//! What a finding can be about.

use crate::program::scalar::Instance;

/// What a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    Counter,
    Timer,
    OneShot,
    Latch,
    /// A variable that the two systems compute by other rules, or in other types.
    Width,
    /// A variable at an address whose bits others share on one of the two alone, or that is computed of one.
    Address,
    /// A variable that an event leaves as it is on one of the two.
    Retention,
    Fault,
    /// A variable that differs, and no trap or kind says why.
    Variable,
    /// An output that differs because of an accepted finding.
    Output,
}

impl Kind {
    pub const ALL: [Self; 10] = [
        Self::Counter,
        Self::Timer,
        Self::OneShot,
        Self::Latch,
        Self::Width,
        Self::Address,
        Self::Retention,
        Self::Fault,
        Self::Variable,
        Self::Output,
    ];

    /// In findings, and in the lines that accept them.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Counter => "counter",
            Self::Timer => "timer",
            Self::OneShot => "one-shot",
            Self::Latch => "latch",
            Self::Width => "width",
            Self::Address => "address",
            Self::Retention => "retention",
            Self::Fault => "fault",
            Self::Variable => "variable",
            Self::Output => "output",
        }
    }

    /// Why it differs, where no trap says so; of one program on both systems, or of two.
    pub const fn reason(self, is_one_program: bool) -> &'static str {
        match self {
            Self::Counter => "its inputs differ, or no trap explains it",
            Self::Timer | Self::OneShot | Self::Latch => "the inputs of the block differ",
            Self::Width => "the two systems compute it by different rules, or in different types",
            Self::Address => "only one of the two systems shares the bits at an address",
            Self::Retention => "only one system keeps it",
            Self::Fault => "one system faults here, and the other continues",
            Self::Variable if is_one_program => "no trap explains it: the two systems run the program differently",
            Self::Variable => "no trap explains it: the two programs are not the same",
            Self::Output => "it is an output that follows from an accepted finding",
        }
    }

    /// Of a standard block that does not count.
    pub fn of(instance: &Instance) -> Self {
        let info = instance.block.info();
        if info.instructions.iter().any(|it| it.needs_context) {
            Self::Timer
        } else if info.pin("CLK").is_some() {
            Self::OneShot
        } else {
            Self::Latch
        }
    }
}
