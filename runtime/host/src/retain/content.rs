//! What was recovered of a file, and why nothing was.

use staunch_runtime::Time;

/// Version 1 named types without what they mean.
pub(super) const VERSION: &str = "3";
/// The version before, which was text alone, written as a whole.
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
    /// The other slot holds something that is no whole record: its writing did not end, or it was damaged.
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
                format!("its format is version {other}, and this Staunch reads version {VERSION} and {TEXT_VERSION}")
            }
            Self::Damaged(what) => format!("it is damaged: {what}"),
        }
    }
}
