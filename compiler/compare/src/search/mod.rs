//! The search for inputs that make the two sides differ, in every way that they can.

pub mod sighting;
pub mod trace;

pub mod tolerance;
pub mod world;

pub mod look;
pub mod progress;
pub mod shrink;

mod exhaustive;
mod guided;
mod novelty;
mod random;

pub mod strategy;
