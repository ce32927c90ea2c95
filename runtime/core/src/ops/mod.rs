//! Every operation on elementary values, once. `op_table.rs` lists them; the compiler's
//! interpreter, generated Rust and native code all end up in these functions, so a program does
//! what a doc comment says here everywhere.

mod class;

mod arithmetic;
mod bits;
mod compare;
mod math;
mod select;

mod convert;
mod dates;
mod index;
mod low_bits;
mod matiec;
mod step;

pub use arithmetic::*;
pub use bits::*;
pub use class::*;
pub use compare::*;
pub use convert::*;
pub use dates::*;
pub use index::*;
pub use low_bits::*;
pub use math::*;
pub use matiec::*;
pub use select::*;
pub use step::*;
