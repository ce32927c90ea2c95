//! How the two sides may come to differ: the traps of counters and what else there is, and which of it is accepted.

pub mod kind;

pub mod pitfall;

pub mod accept;
pub mod beyond;
