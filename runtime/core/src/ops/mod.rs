//! Every operation on elementary values, once. `op_table.rs` lists them; the compiler's
//! interpreter, generated Rust and native code all end up in these functions, so what a doc
//! comment says here is what a program does everywhere.

mod class;

mod arithmetic;
mod bits;
mod compare;
mod math;
mod select;

mod convert;
mod index;
mod step;

pub use arithmetic::{abs, add, div, modulo, mul, neg, sub};
pub use bits::{and, not, or, rol, ror, sar, shl, shr, xor};
pub use class::{Bits, Integer, Number, Real};
pub use compare::{eq, ge, gt, le, lt, ne};
pub use convert::{ConvertTo, TruncateTo, convert, convert_value, trunc, trunc_value};
pub use index::{checked_index, index};

pub use math::{acos, asin, atan, atan2, cos, exp, expt, ln, log, sin, sqrt, tan};
pub use select::{in_range, limit, max, min, sel};
pub use step::{step, step_value};
