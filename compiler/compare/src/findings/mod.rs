//! What the search has found: of each difference that is possible, whether it can be reached.

pub mod finding;

mod enable;
pub mod reason;
