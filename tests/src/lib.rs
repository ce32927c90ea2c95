//! Golden cases, counter vectors and agreement of the three executors: interpreter, generated
//! Rust and native code must do the same, and what the files next to a case say.
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod bounded;
pub mod case;
pub mod scan;

pub mod execute;
mod generated;
pub mod leaf;

pub mod difference;
pub mod golden;

pub mod long_line;
pub mod operation;
pub mod pointers;
pub mod random;
pub mod rows;
pub mod vector;

use std::path::PathBuf;

/// The folder of this crate.
pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The folder of the golden cases.
pub fn cases() -> PathBuf {
    folder().join("cases")
}

/// The folder of the project.
pub fn project() -> PathBuf {
    folder().parent().map_or_else(folder, PathBuf::from)
}
