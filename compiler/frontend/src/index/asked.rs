//! What an editor asks about a program, and that it does not wait for the answer any more.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What an editor asks about a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Asked {
    /// What is wrong with it, and what each name means.
    #[default]
    All,
    /// What the names mean that are around a byte of a file: the other bodies are not checked, and nothing is reported.
    Around(u16, u32),
    /// The same, and what else a name could be that begins there, or less than so many bytes after it.
    Names(u16, u32, u32),
}

impl Asked {
    /// The place that it is about.
    pub(super) fn place(self) -> Option<(u16, u32)> {
        match self {
            Self::All => None,
            Self::Around(file, at) | Self::Names(file, at, _) => Some((file, at)),
        }
    }
}

/// Ends the making of an index that nobody waits for any more: its text is another one now.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
