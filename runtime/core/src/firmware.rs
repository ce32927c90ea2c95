//! What a firmware asks of the program that is compiled into it: what runs when, which variable is at
//! which direct address, and what it retains. Generated Rust holds the tables.

mod image;
mod named;
mod retained;

pub use image::{Areas, Place, ProcessImage, Width};
pub use named::{Name, Value};
pub use retained::{Carried, Carrier, NotRetained, RECORD_OVERHEAD, Stamp, load, save, stamp};

/// A PROGRAM that runs, as its TASK says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Task {
    /// The instance's name, in Structured Text.
    pub instance: &'static str,
    /// The PROGRAM's name.
    pub program: &'static str,
    /// Nanoseconds from the start of one scan to that of the next; `None` where the source leaves it open.
    pub interval: Option<i64>,
    /// Of instances that are due together, the one with the lowest number runs first.
    pub priority: u32,
}

/// A variable at a direct address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Io {
    /// As Structured Text writes it, `%IX0.0`.
    pub address: &'static str,
    /// The variable's name.
    pub variable: &'static str,
    /// Where it lies.
    pub area: Area,
    /// The levels above the place in an address of a hierarchy: 1 and 2 in `%IW1.2.3`. Empty for `%IW3`.
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
