//! A shim for each string function.
//!
//! A result is appended to its string, and cut at the capacity that is passed. To replace the string, set its length to 0
//! before the call, and clear the rest of its old units after it. A function that exists for both kinds of strings has two
//! shims.

use core::slice;

use staunch_runtime::text::Unit;
use staunch_runtime::{carried, for_each_text_op, text};

/// Offset of the first character of a string from its header.
const UNITS: usize = size_of::<u16>();

/// The units of the string at `header`.
///
/// # Safety
/// `header` points to a string of these units, aligned for its length, that nobody writes to during `'a`.
pub(crate) unsafe fn units<'a, U: Unit>(header: *const u8) -> &'a [U] {
    // SAFETY: a string starts with its length, and has that many units after it; the length's alignment
    // is theirs.
    unsafe { slice::from_raw_parts(header.add(UNITS).cast::<U>(), usize::from(header.cast::<u16>().read())) }
}

/// The length and the units of the string at `header`.
///
/// # Safety
/// `header` points to a string of `capacity` units, aligned for its length, that nobody else
/// reads or writes during `'a`.
unsafe fn parts<'a, U: Unit>(header: *mut u8, capacity: u16) -> (&'a mut u16, &'a mut [U]) {
    // SAFETY: the length and the units do not overlap; the rest is the caller's promise.
    unsafe {
        let units = slice::from_raw_parts_mut(header.add(UNITS).cast::<U>(), usize::from(capacity));
        (&mut *header.cast::<u16>(), units)
    }
}

/// The string at `header` as a destination that replaces it.
///
/// # Safety
/// `header` points to a string of `capacity` units, aligned for its length, that nobody else
/// reads or writes during `'a`.
pub(crate) unsafe fn destination<'a, U: Unit>(header: *mut u8, capacity: u16) -> text::Destination<'a, U> {
    // SAFETY: the caller's promise.
    let (len, units) = unsafe { parts(header, capacity) };
    text::Destination::new(len, units)
}

/// The string at `header` as a destination that appends to it.
///
/// # Safety
/// As [`destination`].
unsafe fn end<'a, U: Unit>(header: *mut u8, capacity: u16) -> text::Destination<'a, U> {
    // SAFETY: the caller's promise.
    let (len, units) = unsafe { parts(header, capacity) };
    text::Destination::at_end(len, units)
}

/// Assigns a STRING, cut at the capacity of the target; both may be the same variable.
///
/// # Safety
/// Both point to strings, aligned for their lengths; `out` has `capacity` bytes, and the strings
/// are one or do not overlap.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_text_copy(from: *const u8, out: *mut u8, capacity: u16) {
    // SAFETY: the caller's promise.
    unsafe { copy::<u8>(from, out, capacity) }
}

/// The same for a WSTRING.
///
/// # Safety
/// As [`staunch_text_copy`], of `capacity` units.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_wide_text_copy(from: *const u8, out: *mut u8, capacity: u16) {
    // SAFETY: the caller's promise.
    unsafe { copy::<u16>(from, out, capacity) }
}

/// # Safety
/// As [`staunch_text_copy`].
unsafe fn copy<U: Unit>(from: *const u8, out: *mut u8, capacity: u16) {
    if !core::ptr::eq(from, out) {
        // SAFETY: the caller's promise, and they are not one.
        unsafe { append(&mut destination::<U>(out, capacity), units(from)) };
    }
}

/// Appends as much of `units` as still fits, as a block: here the optimiser does not see that they are other memory.
fn append<U: Unit>(out: &mut text::Destination<'_, U>, units: &[U]) {
    let room = out.lengthen(units.len());
    if room.is_empty() {
        return;
    }
    // SAFETY: `room` is no longer than `units`, and it is borrowed alone.
    unsafe { room.as_mut_ptr().copy_from_nonoverlapping(units.as_ptr(), room.len()) };
}

/// Appends a STRING, cut at the capacity of the target.
///
/// # Safety
/// Both point to strings, aligned for their lengths; `out` has `capacity` bytes, and the strings do not overlap.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_text_append(from: *const u8, out: *mut u8, capacity: u16) {
    // SAFETY: the caller's promise.
    unsafe { append(&mut end::<u8>(out, capacity), units(from)) }
}

/// The same for a WSTRING.
///
/// # Safety
/// As [`staunch_text_append`], of `capacity` units.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_wide_text_append(from: *const u8, out: *mut u8, capacity: u16) {
    // SAFETY: the caller's promise.
    unsafe { append(&mut end::<u16>(out, capacity), units(from)) }
}

/// Sets the bytes between the present length of a STRING and its length `before` to zero.
///
/// # Safety
/// `out` points to a string, aligned for its length, whose capacity is at least `before`.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_text_clear(out: *mut u8, before: u16) {
    // SAFETY: the caller's promise.
    unsafe { clear::<u8>(out, before) }
}

/// The same for a WSTRING.
///
/// # Safety
/// As [`staunch_text_clear`].
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_wide_text_clear(out: *mut u8, before: u16) {
    // SAFETY: the caller's promise.
    unsafe { clear::<u16>(out, before) }
}

/// # Safety
/// As [`staunch_text_clear`].
unsafe fn clear<U: Unit>(out: *mut u8, before: u16) {
    // SAFETY: the caller's promise.
    let (len, units) = unsafe { parts::<U>(out, before) };
    units.get_mut(usize::from(*len)..).unwrap_or_default().fill(U::ZERO);
}

macro_rules! shims {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) -> $result:ident [$units:ident] $($extensible:ident)?;)*) => {
        #[allow(non_snake_case, reason = "operands have the standard's names")]
        #[allow(unused_unsafe, reason = "a function of characters alone follows no pointer")]
        pub(crate) fn for_each_symbol(each: &mut dyn FnMut(&'static str, *const u8)) {
            each("staunch_text_copy", staunch_text_copy as *const u8);
            each("staunch_wide_text_copy", staunch_wide_text_copy as *const u8);
            each("staunch_text_append", staunch_text_append as *const u8);
            each("staunch_wide_text_append", staunch_wide_text_append as *const u8);
            each("staunch_text_clear", staunch_text_clear as *const u8);
            each("staunch_wide_text_clear", staunch_wide_text_clear as *const u8);
            $(shims!(@ $units $result each $function ($($arg: $ty),*));)*
        }
    };
    (@ each $result:ident $each:ident $function:ident ($($arg:ident: $ty:ident),*)) => {
        shim!($result u8 "staunch_text_" $each $function ($($arg: $ty),*));
        shim!($result u16 "staunch_wide_text_" $each $function ($($arg: $ty),*));
    };
    (@ one $result:ident $each:ident $function:ident ($($arg:ident: $ty:ident),*)) => {
        shim!($result u8 "staunch_text_" $each $function ($($arg: $ty),*));
    };
}

macro_rules! shim {
    ($result:ident $unit:ident $prefix:literal $each:ident $function:ident ($($arg:ident: $ty:ident),*)) => {
        string_result!($result $unit [$prefix $each $function ($($arg: $ty),*)])
    };
}

/// Which functions write a string, and of which units, and which return a value.
macro_rules! string_result {
    (ANY_STRING $unit:ident $rest:tt) => { shim_of_string!($unit $unit $rest) };
    (STRING $unit:ident $rest:tt) => { shim_of_string!($unit u8 $rest) };
    (WSTRING $unit:ident $rest:tt) => { shim_of_string!($unit u16 $rest) };
    ($result:ident $unit:ident $rest:tt) => { shim_of_value!($unit $result $rest) };
}

macro_rules! shim_of_string {
    ($unit:ident $out:ident [$prefix:literal $each:ident $function:ident ($($arg:ident: $ty:ident),*)]) => {{
        /// # Safety
        /// Operands point to strings, `out` to a string of `capacity` units that is none of them.
        // SAFETY (the symbol): the prefix belongs to this module, and a function has one row.
        #[unsafe(export_name = concat!($prefix, stringify!($function)))]
        unsafe extern "C" fn shim($($arg: operand_type!($ty),)* out: *mut u8, capacity: u16) {
            // SAFETY: the caller's promise.
            unsafe { text::$function($(operand!($ty $unit $arg),)* &mut end::<$out>(out, capacity)) }
        }
        $each(concat!($prefix, stringify!($function)), shim as *const u8);
    }};
}

macro_rules! shim_of_value {
    ($unit:ident $result:ident [$prefix:literal $each:ident $function:ident ($($arg:ident: $ty:ident),*)]) => {{
        /// # Safety
        /// Operands point to strings.
        // SAFETY (the symbol): as for the functions with a string result.
        #[unsafe(export_name = concat!($prefix, stringify!($function)))]
        unsafe extern "C" fn shim($($arg: operand_type!($ty)),*) -> carried!($result) {
            // SAFETY: the caller's promise.
            unsafe { text::$function($(operand!($ty $unit $arg)),*) }
        }
        $each(concat!($prefix, stringify!($function)), shim as *const u8);
    }};
}

macro_rules! operand_type {
    (ANY_STRING) => { *const u8 };
    (STRING) => { *const u8 };
    (WSTRING) => { *const u8 };
    ($ty:ident) => { carried!($ty) };
}

macro_rules! operand {
    (ANY_STRING $unit:ident $arg:ident) => {
        units::<$unit>($arg)
    };
    (STRING $unit:ident $arg:ident) => {
        units::<u8>($arg)
    };
    (WSTRING $unit:ident $arg:ident) => {
        units::<u16>($arg)
    };
    ($ty:ident $unit:ident $arg:ident) => {
        $arg
    };
}

for_each_text_op!(shims);
