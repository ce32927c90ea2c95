//! The witness: a naive interpreter of the syntax tree.
//!
//! The executors share one front end, so that they agree proves back ends, not meaning. The witness
//! shares none of it: it walks the tree as it was parsed, in the order in which it is written, over
//! a memory of whole values. It has no IR, folds nothing and hoists nothing. From elsewhere it only uses
//! the parser, the runtime's arithmetic on two values, and the runtime's blocks.
//!
//! It takes programs that `check` accepts, and does not look for mistakes. Where it says
//! [`Stop::Unknown`] it does not know a construct.
//!
//! It is written for reading: what a call, a FOR loop or an in-out means is in `calls`,
//! `statements` and `places`, in some twenty lines each.
#![forbid(unsafe_code)]

mod types;

mod constants;
mod declarations;
mod names;
mod shared;
mod starts;
mod storage;
mod texts;

mod machine;
mod runs;
mod statements;
mod traces;

mod addresses;
mod bindings;
mod calls;
mod classes;
mod construction;
mod dates;
mod edges;
mod exceptions;
mod expressions;
mod functions;
mod operators;
mod places;
mod pools;
mod promotion;
mod references;

pub mod generate;
pub mod random;
pub mod shrink;

pub use machine::{Machine, Stop};
pub use traces::Input;
