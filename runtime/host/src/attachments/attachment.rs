//! What all attachments are.

use crate::{Error, Machine};

/// How a run has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ended {
    Well,
    Fault,
}

/// Work before and after each scan. It neither waits nor allocates, except at the end.
pub(crate) trait Attachment {
    /// Writes inputs, and what the world outside has written elsewhere, into the state.
    fn before(&mut self, machine: &mut dyn Machine);
    /// Shows the outputs of a whole scan outside.
    fn after(&mut self, state: &[u8]);
    /// The error where something is lost that the run must not continue without.
    fn lost(&self) -> Option<Error> {
        None
    }
    /// The run is over: outputs take their safe values.
    fn end(&mut self, ended: Ended);
}
