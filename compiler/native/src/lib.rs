//! The native back end: verified IR to object code, or to code in memory that runs at once,
//! through Cranelift. 64-bit targets only.
//!
//! [`object`] and [`Jit`] make the same functions: each POU becomes one (and one for its prescan),
//! and the entry points are the program's C symbols. Operations and standard blocks are the
//! runtime's: code calls them by symbol, or has them inline where a test proves the same meaning.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod error;
mod target;

mod address;
mod at_32_bits;
mod away;
mod compiled;
mod count;
mod dying;
mod inline_routine;
mod measure;
mod module;
mod operands;
mod overstored;
mod reloaded;
mod schedule;
mod signature;
mod tidy;
mod trimmed;
mod unused;

mod scan;

mod at_once;
mod expectation;
mod expected;
mod folded;
mod follow;
mod function;
mod grouped;
mod lanes;
mod looked_up;
mod loop_start;
mod loops;
mod marked;
mod moved;
mod object_in_line;
mod quiet;
mod statement;
mod turns;
mod unrolled;

mod block_loop;
mod by_table;
mod byte_copy;
mod call;
mod case;
mod expression;
mod external;
mod index;
mod numbers;
mod place;
mod seen;
mod text;

mod inline_block;
mod inline_conversion;
mod inline_op;
mod inline_timer;
mod members;
mod runtime_call;
mod single_bit;

mod attempt;
mod fault;
mod memory;

mod debug;

mod control;
mod entry;
mod program;

mod jit;
mod listing;
mod object;
mod outside;

mod longest;

pub use count::{Gap, Why};
pub use error::Error;
pub use jit::{Init, Jit, Scan};
pub use listing::{clif, frames, measures};
pub use longest::{Longest, Unknown};
pub use measure::{Callee, Measure, Measures};
pub use object::{object, object_named};
pub use outside::stack_outside;
pub use target::{Aim, Target};
