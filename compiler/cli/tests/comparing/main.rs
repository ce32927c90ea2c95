//! `staunch compare`: each module is a promise of `docs/compare.md`, and the programs that hold it to that.

mod programs;

mod advice;
mod beyond;
mod claims;
mod own;
mod planted;
mod reports;
mod settled;
mod traps;
mod values;
