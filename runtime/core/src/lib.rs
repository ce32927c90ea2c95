//! What compiled Structured Text needs at run time: exact IEC arithmetic and the standard
//! function blocks. No allocation, no `std`, no `unsafe`, no clock.
//!
//! Every executor shares this crate. Generated Rust calls it, native code calls it through
//! `staunch-runtime-abi`, and the compiler's interpreter calls it to fold constants. A rule
//! written here holds everywhere.
#![no_std]
#![forbid(unsafe_code)]

mod context;
mod crc;
mod elementary;
mod fault;
mod repr;

mod op_table;
pub mod ops;
mod signature;
mod turns;

pub mod calendar;
mod decimal;
pub mod exception;
pub mod format;
pub mod literal;
pub mod reference;
pub mod text;
pub mod time;

pub mod firmware;
pub mod json;

mod family;

mod block;
mod block_table;
pub mod blocks;

pub use block::{
    Block, BlockInfo, BlockOption, Direction, Facts, Instruction, KeptCount, OtherPin, Pin, PinRole, Prescan,
    Replacement, Retention,
};
pub use block_table::BLOCKS;
pub use blocks::{codesys, cscape, iec, logix, openplc, openplc4, s7};
pub use context::{Context, MinorFaults};
pub use crc::{Crc32, crc32};
pub use elementary::{Class, Elementary};
pub use family::{Family, Keeps};
pub use fault::{Fault, FaultKind, FaultOf, Location, OrFault, Outcome};
pub use reference::Reference;
pub use repr::{Repr, Scalar, Value};
pub use signature::{Kind, Parameter, Signature};
pub use text::{StringType, Text, WideText};
pub use time::Time;
#[doc(hidden)]
pub use turns::Strips;

/// Includes the Rust code that `staunch_build` generated from Structured Text, by its name: the stem of the source file.
///
/// ```ignore
/// mod plc {
///     staunch_runtime::include_st!("parking_garage");
/// }
/// ```
#[macro_export]
macro_rules! include_st {
    ($name:literal) => {
        include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));
    };
}
