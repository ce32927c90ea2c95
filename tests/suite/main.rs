//! All tests of this crate: one program, so that the executors are linked once.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod fixes;
mod formatted;
mod golden;
mod mistakes;
mod vectors;

mod constants;
mod converted;
mod effects;
mod facts;
mod long_lines;
mod native_code;
mod operations;
mod own_names;
mod pointers;
mod programs;
mod rows;
mod stack;
mod state;
mod turns;

mod architecture;
mod documents;
mod editors;
mod index;
mod layers;
mod layout;
mod packages;
mod pages;
mod rules;
