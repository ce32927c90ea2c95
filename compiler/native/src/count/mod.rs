//! How many instructions a call of a function takes at most: the machine code as blocks, and the longest way through them.
//!
//! ```text
//! code of a function ─ x86 ─▶ blocks ─ marks, calls ─▶ Counted ─ longest ─▶ instructions
//! ```
//!
//! It reads the bytes that were made, so whatever the code generator did to them is counted. They do not show
//! how often a loop is repeated: a mark on the instruction that leads back says it, where the loop is emitted. A loop
//! without a mark, and an instruction that is not known, make the count unknown; they are never guessed.

mod blocks;
mod flow;
mod graph;
mod mark;
mod unmarked;
mod x86;

mod function;
mod sizes;

use cranelift_codegen::CompiledCode;
use std::collections::BTreeSet;

pub(crate) use blocks::Run;
pub use function::Gap;
pub(crate) use function::{Call, CodeOf, Counted};
pub(crate) use graph::{Costs, longest};
pub(crate) use mark::{Mark, Marks, Numbered};
pub use mark::{Repeats, Why};
pub(crate) use sizes::sizes;
pub(crate) use unmarked::is_marked;

/// The blocks of a function of x86-64; `None` if an instruction is not known.
pub(crate) fn runs_of(code: &CompiledCode) -> Option<Vec<Run>> {
    let starts: Option<BTreeSet<usize>> = code.bb_starts.iter().map(|it| usize::try_from(*it).ok()).collect();
    blocks::runs(code.code_buffer(), &starts?, &x86::instruction)
}
