//! What is right, and was hardly meant.

pub(crate) mod checks;
pub(crate) mod hides;
pub(crate) mod otherwise;
pub(crate) mod result;
pub(crate) mod siblings;
pub(crate) mod unused;
