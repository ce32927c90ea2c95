//! What was recovered from a file, or why nothing was.

use staunch_runtime::Time;

/// Version 1 named types without what they mean.
pub(super) const VERSION: &str = "4";
/// The version before, whose slots have no room for a fault.
pub(super) const WITHOUT_FAULT: &str = "3";
/// The one before that, which was text alone, written as a whole.
pub(super) const TEXT_VERSION: &str = "2";

/// One of the two slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    First,
    Second,
}

impl Slot {
    pub const BOTH: [Self; 2] = [Self::First, Self::Second];

    pub const fn other(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }
}

/// What a file holds, whatever its version.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Content {
    pub programs: String,
    pub clock: Time,
    /// Of each variable the path, the type, and the bytes if they can be read.
    pub variables: Vec<(String, String, Option<Vec<u8>>)>,
    /// Where the values were, in a file with slots.
    pub found: Option<Found>,
}

/// The record that was taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Found {
    pub slot: Slot,
    pub sequence: u64,
    pub values: Vec<u8>,
    /// The fault that ended a run, since which none has ended well; empty without one.
    pub fault: String,
    /// The other slot holds an incomplete record: its writing did not end, or it was damaged.
    pub other_is_broken: bool,
}

/// Why nothing can be recovered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    Foreign,
    Version(String),
    Damaged(&'static str),
}

impl Refusal {
    pub fn text(&self) -> String {
        match self {
            Self::Foreign => "it does not hold retained variables".to_owned(),
            Self::Version(other) => {
                format!("its format is version {other}, and this Staunch reads versions {TEXT_VERSION} to {VERSION}")
            }
            Self::Damaged(what) => format!("it is damaged: {what}"),
        }
    }
}
