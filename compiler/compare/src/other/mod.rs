//! The program's text for the other system: what it is rewritten to, what it lacks there, and the file that it is
//! written to.

pub mod fixed;
pub mod logix;
pub mod missing;
pub mod renamed;
