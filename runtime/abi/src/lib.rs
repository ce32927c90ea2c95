//! The runtime as C symbols, for native code. Each shim calls one safe function of
//! `staunch-runtime`; this crate decides nothing, and holds the runtime's only `unsafe` code.
//!
//! Symbols and signatures (a BOOL is a byte that is 0 or 1):
//!
//! - `staunch_{function}_{repr}`: a row of the operation table. A total function takes its operands and
//!   returns its result. A function that may fault has an out pointer after its operands, and returns 0,
//!   or the fault's code without writing the result.
//! - `staunch_convert_{from}_{to}`, `staunch_trunc_{from}_{to}`: conversions.
//! - `staunch_text_{function}`, `staunch_text_copy`: strings. A string is a pointer to its header,
//!   a `u16` length, with the bytes right after it; a string result goes to a header and a
//!   capacity after the operands, and is appended to what the string holds.
//! - `staunch_text_append`, and `staunch_text_clear`, which must follow after a string was written from its start.
//! - `staunch_reference_{address, load, store, copy, load_text, store_text, find}`: accesses through references. They
//!   take the words of the table, and the state; those that can fault return 0 or the fault's code.
//! - the symbols in `BLOCKS`: instructions of the standard blocks take the instance, the context
//!   and the rung; prescans take the instance.
#![no_std]

mod block;
mod conversion;
mod operation;
mod reference;
mod text;

/// Calls `each` with the name and the address of every symbol, for a linker in memory.
pub fn for_each_symbol(each: &mut dyn FnMut(&'static str, *const u8)) {
    operation::for_each_symbol(each);
    conversion::for_each_symbol(each);
    text::for_each_symbol(each);
    block::for_each_symbol(each);
    reference::for_each_symbol(each);
}
