//! The counters of the FOR loops around a statement.

use super::window::Window;
use staunch_ir::{For, Place, alias};

/// The counter of a FOR loop around a statement.
#[derive(Clone, Debug)]
pub(crate) struct Counter {
    /// The loop, without its body.
    pub head: For,
    pub shown: Option<Shown>,
    /// How many loops are around its body.
    pub depth: usize,
}

/// The variable that a loop's local is the value of.
#[derive(Clone, Debug)]
pub(crate) struct Shown {
    pub place: Place,
    pub view: Option<Window>,
}

impl Counter {
    pub fn is(&self, frame: &alias::Frame<'_>, place: &Place, view: Option<Window>) -> bool {
        let (own, of) = match &self.shown {
            Some(it) => (&it.place, it.view),
            None => (&self.head.counter, None),
        };
        let bits = |it: Window| (it.bit, it.ty);
        of.map(bits) == view.map(bits) && alias::alias(frame, own, place) == alias::Alias::Must
    }
}
