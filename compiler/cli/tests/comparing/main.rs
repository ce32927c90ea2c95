//! `staunch compare`: each module is a promise of `docs/compare.md`, and the programs that hold it to that.

mod programs;

mod accepted;
mod advice;
mod advised;
mod beyond;
mod blamed;
mod calls;
mod charts;
mod claims;
mod idle;
mod open;
mod own;
mod planted;
mod port;
mod reports;
mod same;
mod settled;
mod sides;
mod traps;
mod tried;
mod values;
