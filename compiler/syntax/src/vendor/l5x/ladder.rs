//! Ladder diagrams: the rungs of a routine as statements of Structured Text.
//!
//! ```text
//! XIC(go)[XIO(stop) ,XIC(jog) ]OTE(run);        run [:=] go AND (NOT stop OR jog);
//!
//! XIC(go)OTE(run)TON(t,?,?);                    R_rung := go;
//!                                               run [:=] R_rung;
//!                                               TON(Timer := t, RungIn := R_rung);
//! ```
//!
//! The condition of a rung is an expression until an output reads it, and a variable where several do. Operands stay text of the
//! file: what they are other names for is written when they are copied, as in a routine that is text.

mod call;
mod condition;
mod found;
mod jump;
mod operands;
mod parse;
mod rows;
mod shown;
mod special;
mod subroutine;
#[cfg(test)]
mod tests;
mod text;
mod write;

pub use found::{is_rung, starts_as_rung};
pub use rows::described;
pub use shown::shown;
pub use subroutine::subroutine;
pub use text::Text;
pub use write::{Ladder, Variable, statements};
