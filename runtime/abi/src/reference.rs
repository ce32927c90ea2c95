//! A shim for each kind of access through references.
//!
//! `words` points to a program's table of objects, whose third word is its length; `state` points to
//! the program's whole state.

use core::cell::Cell;
use core::slice;

use crate::text::{destination, units};
use staunch_runtime::FaultKind;
use staunch_runtime::reference::{Table, View, Wanted};

/// # Safety
/// `words` points to a table that lives as long as the program.
unsafe fn table(words: *const u32) -> Table<'static> {
    // SAFETY: the third word counts all, by the caller's promise.
    unsafe { Table::new(slice::from_raw_parts(words, words.add(2).read() as usize)) }
}

/// # Safety
/// `state` points to the state of the table's program, which is used only through this pointer during `'a`.
unsafe fn memory<'a>(table: &Table<'_>, state: *mut u8) -> &'a [Cell<u8>] {
    // SAFETY: the table says how large the state is; a cell of a byte is laid out as the byte.
    unsafe { slice::from_raw_parts(state.cast::<Cell<u8>>(), table.state_size()) }
}

fn code(outcome: Result<(), FaultKind>) -> u8 {
    outcome.err().map_or(0, |it| it as u8)
}

/// The reference to `size` bytes at `offset` of the state.
///
/// # Safety
/// As [`table`] says.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_reference_address(words: *const u32, offset: u64, size: u64) -> u64 {
    // SAFETY: the caller's promise.
    unsafe { table(words) }.address(offset as usize, size as usize)
}

/// Reads a value of `size` bytes to `out`.
///
/// # Safety
/// As [`table`] and [`memory`] say; `out` has `size` bytes, and is not part of the state.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_reference_load(
    words: *const u32,
    state: *mut u8,
    reference: u64,
    distance: u64,
    view: u32,
    size: u32,
    out: *mut u8,
) -> u8 {
    // SAFETY: the caller's promise.
    let (table, out) = unsafe { (table(words), slice::from_raw_parts_mut(out, size as usize)) };
    // SAFETY: the caller's promise.
    let memory = unsafe { memory(&table, state) };
    code(table.load_bytes(memory, reference, distance, View::from_code(view), out))
}

/// Writes a value of `size` bytes.
///
/// # Safety
/// As [`table`] and [`memory`] say; `value` has `size` bytes, and is not part of the state.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_reference_store(
    words: *const u32,
    state: *mut u8,
    reference: u64,
    distance: u64,
    view: u32,
    size: u32,
    value: *const u8,
) -> u8 {
    // SAFETY: the caller's promise.
    let (table, value) = unsafe { (table(words), slice::from_raw_parts(value, size as usize)) };
    // SAFETY: the caller's promise.
    let memory = unsafe { memory(&table, state) };
    code(table.store_bytes(memory, reference, distance, View::from_code(view), value))
}

/// Copies `count` bytes through two references.
///
/// # Safety
/// As [`table`] and [`memory`] say.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_reference_copy(
    words: *const u32,
    state: *mut u8,
    to: u64,
    from: u64,
    count: i64,
    step: i64,
) -> u8 {
    // SAFETY: the caller's promise.
    let table = unsafe { table(words) };
    // SAFETY: the caller's promise.
    let memory = unsafe { memory(&table, state) };
    code(table.copy(memory, to, from, count, step))
}

macro_rules! texts {
    ($($unit:ident $load:ident $store:ident;)*) => { $(
        /// Reads a string to the one at `out`.
        ///
        /// # Safety
        /// As [`table`] and [`memory`] say; `out` is a string of `capacity` units, and no part of the state.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $load(
            words: *const u32,
            state: *mut u8,
            reference: u64,
            distance: u64,
            out: *mut u8,
            capacity: u16,
        ) -> u8 {
            // SAFETY: the caller's promise.
            let (table, mut out) = unsafe { (table(words), destination::<$unit>(out, capacity)) };
            // SAFETY: the caller's promise.
            let memory = unsafe { memory(&table, state) };
            code(table.load_text(memory, reference, distance, &mut out))
        }

        /// Writes the string at `value`.
        ///
        /// # Safety
        /// As [`table`] and [`memory`] say; `value` is a string, and no part of the state.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $store(
            words: *const u32,
            state: *mut u8,
            reference: u64,
            distance: u64,
            value: *const u8,
        ) -> u8 {
            // SAFETY: the caller's promise.
            let (table, value) = unsafe { (table(words), units::<$unit>(value)) };
            // SAFETY: the caller's promise.
            let memory = unsafe { memory(&table, state) };
            code(table.store_text(memory, reference, distance, value))
        }
    )* };
}

texts! {
    u8 staunch_reference_load_text staunch_reference_store_text;
    u16 staunch_reference_load_wide_text staunch_reference_store_wide_text;
}

/// Writes to `out` the offset in the state of a variable of the wanted type.
///
/// # Safety
/// As [`table`] and [`memory`] say; `out` can be written, and is not part of the state.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_reference_find(
    words: *const u32,
    state: *mut u8,
    reference: u64,
    distance: u64,
    wanted: u32,
    out: *mut u64,
) -> u8 {
    // SAFETY: the caller's promise.
    let table = unsafe { table(words) };
    // SAFETY: the caller's promise.
    let memory = unsafe { memory(&table, state) };
    let found = table.find(memory, reference, distance, Wanted::from_code(wanted));
    code(found.map(|offset| {
        // SAFETY: the caller's promise.
        unsafe { out.write(offset as u64) }
    }))
}

pub(crate) fn for_each_symbol(each: &mut dyn FnMut(&'static str, *const u8)) {
    each("staunch_reference_address", staunch_reference_address as *const u8);
    each("staunch_reference_load", staunch_reference_load as *const u8);
    each("staunch_reference_store", staunch_reference_store as *const u8);
    each("staunch_reference_copy", staunch_reference_copy as *const u8);
    each("staunch_reference_load_text", staunch_reference_load_text as *const u8);
    each("staunch_reference_store_text", staunch_reference_store_text as *const u8);
    each("staunch_reference_load_wide_text", staunch_reference_load_wide_text as *const u8);
    each("staunch_reference_store_wide_text", staunch_reference_store_wide_text as *const u8);
    each("staunch_reference_find", staunch_reference_find as *const u8);
}
