//! What a move of a program from one system to another changes: two programs side by side, the search for inputs that make them
//! differ, and what it has found.
//!
//! The folders are layers, and each imports from those before it: what is asked, the program's text for the other system, what
//! each program's text says, both side by side, what the vendors' documents leave open, what their inputs may be, how they may come
//! to differ, the search for inputs that make them, what it has found, what that comes to, and all of it together. What reads
//! files and prints is the command's.
#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod request;

pub mod other;
pub mod program;

pub mod pair;

pub mod variants;

pub mod inputs;

pub mod difference;

pub mod search;

pub mod findings;

pub mod verdict;

pub mod compared;
