//! Debug information: DWARF for a program whose code is [made for debugging](crate::Aim::Debugging).
//!
//! While code is made, [`note`] says which statement each instruction belongs to, and keeps what a debugger asks for in the
//! frame; [`notes`] collects it function by function. When the object is complete, [`unit`] writes what is known as entries:
//! the [`lines`], the [`types`], and the [`variables`] of the program and of each function.
//!
//! A program's state is where its host has put it. A word of the object, which entry points fill, leads to it.

mod entries;
mod lines;
mod note;
pub(crate) mod noted;
pub(crate) mod notes;
mod sections;
mod types;
mod unit;
mod variables;

pub(crate) use unit::write;
