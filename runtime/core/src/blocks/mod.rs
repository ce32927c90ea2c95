//! The standard function blocks: plain structs whose members are in the order inputs, outputs,
//! memory, with no branch in a step where a select will do. Each family's module holds what its
//! vendor defines; `iec` also holds what all of them share.
//!
//! A block's `call` sets the inputs and runs one step; `step` runs one step with the present inputs,
//! and takes the context whether it needs it or not, so that native code can call any block.

pub mod codesys;
pub mod cscape;
pub mod iec;
pub mod logix;
pub mod openplc;
pub mod openplc4;
pub mod s7;

mod bistable;
mod clock;
mod edge;
mod timer;
