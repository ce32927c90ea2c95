//! What a firmware needs to know about the program that is compiled into it: when it runs, which variable is at
//! which direct address, and what it retains. The tables are in the generated Rust.

mod image;
mod named;
mod retained;

pub use image::{Areas, Place, ProcessImage, Width};
pub use named::{Name, Value};
pub use retained::{Carried, Carrier, NotRetained, RECORD_OVERHEAD, Stamp, load, save, stamp};

/// An instance of a PROGRAM, with the settings of its TASK.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Task {
    /// The instance's name, in Structured Text.
    pub instance: &'static str,
    /// The PROGRAM's name.
    pub program: &'static str,
    /// Nanoseconds from the start of one scan to that of the next; `None` if the source does not set it.
    pub interval: Option<i64>,
    /// Of instances that are due at the same time, the one with the lowest number runs first.
    pub priority: u32,
}

/// A variable at a direct address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Io {
    /// The address as in Structured Text, `%IX0.0`.
    pub address: &'static str,
    /// The variable's name.
    pub variable: &'static str,
    /// Its area.
    pub area: Area,
    /// The upper levels of a hierarchical address: 1 and 2 in `%IW1.2.3`. Empty for `%IW3`.
    pub module: &'static [u32],
    /// Its first bit in the area, or in the module's part of it.
    pub bit: u64,
    /// How many bits it takes: 1, 8, 16, 32 or 64.
    pub width: u8,
}

/// The area of a direct address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Area {
    /// `%I`: the firmware sets it before a scan.
    Input,
    /// `%Q`: the firmware reads it after a scan.
    Output,
    /// `%M`
    Memory,
}
