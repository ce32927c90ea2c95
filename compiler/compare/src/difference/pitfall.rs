//! The pitfalls of a move between systems, which of them a difference shows, and which cannot happen.

mod list;

mod classify;

mod parting;
mod relevant;
mod suspects;

mod cause;

mod impossible;

mod advice;

pub use cause::{Cause, cause};
pub use classify::Habits;
pub use impossible::{OF_OTHERS, Use, impossible, uses};
pub use list::Pitfall;
pub use parting::seen;
