//! What the start of instances goes by.

use rustc_hash::FxHashMap;
use staunch_ir::StructId;

/// The inputs that every FB_init has.
pub(crate) const OF_THE_SYSTEM: [&str; 2] = ["bInitRetains", "bInCopyCode"];

#[derive(Debug, Default)]
pub(crate) struct Starts {
    /// Whether anything has a start: some FB_init, or a METHOD with `call_after_init`.
    pub is_any: bool,
    /// Whether starting a structure does anything, for those that were asked about.
    pub known: FxHashMap<StructId, bool>,
}
