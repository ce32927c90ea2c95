//! A shim for each string function.
//!
//! A result is cut at the capacity it is given; the bytes past its length become zero.

use core::slice;

use staunch_runtime::{carried, for_each_text_op, text};

/// Offset of the first byte of a string from its header.
const BYTES: usize = size_of::<u16>();

/// The bytes of the string at `header`.
///
/// # Safety
/// `header` points to a string, aligned for its length, that nobody writes to during `'a`.
unsafe fn bytes<'a>(header: *const u8) -> &'a [u8] {
    // SAFETY: a string starts with its length, and has that many bytes after it.
    unsafe { slice::from_raw_parts(header.add(BYTES), usize::from(header.cast::<u16>().read())) }
}

/// The string at `header` as a destination, emptied.
///
/// # Safety
/// `header` points to a string of `capacity` bytes, aligned for its length, that nobody else
/// reads or writes during `'a`.
unsafe fn destination<'a>(header: *mut u8, capacity: u16) -> text::Destination<'a> {
    // SAFETY: the length and the bytes do not overlap; the rest is the caller's promise.
    unsafe {
        text::Destination::new(
            &mut *header.cast::<u16>(),
            slice::from_raw_parts_mut(header.add(BYTES), usize::from(capacity)),
        )
    }
}

/// Assigns a string, cut at the capacity of the target; both may be the same variable.
///
/// # Safety
/// Both point to strings, aligned for their lengths; `out` has `capacity` bytes, and the strings
/// are one or do not overlap.
#[unsafe(no_mangle)]
unsafe extern "C" fn staunch_text_copy(from: *const u8, out: *mut u8, capacity: u16) {
    if !core::ptr::eq(from, out) {
        // SAFETY: the caller's promise, and they are not one.
        unsafe { destination(out, capacity).write(bytes(from)) };
    }
}

macro_rules! shims {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) -> $result:ident $($extensible:ident)?;)*) => {
        #[allow(non_snake_case, reason = "operands have the standard's names")]
        pub(crate) fn for_each_symbol(each: &mut dyn FnMut(&'static str, *const u8)) {
            each("staunch_text_copy", staunch_text_copy as *const u8);
            $(shim!($result each $function ($($arg: $ty),*));)*
        }
    };
}

macro_rules! shim {
    (STRING $each:ident $function:ident ($($arg:ident: $ty:ident),*)) => {{
        /// # Safety
        /// Operands point to strings, `out` to a string of `capacity` bytes that is none of them.
        // SAFETY (the symbol): the prefix belongs to this module, and a function has one row.
        #[unsafe(export_name = concat!("staunch_text_", stringify!($function)))]
        unsafe extern "C" fn shim($($arg: operand_type!($ty),)* out: *mut u8, capacity: u16) {
            // SAFETY: the caller's promise.
            unsafe { text::$function($(operand!($ty $arg),)* &mut destination(out, capacity)) }
        }
        $each(concat!("staunch_text_", stringify!($function)), shim as *const u8);
    }};
    ($result:ident $each:ident $function:ident ($($arg:ident: $ty:ident),*)) => {{
        /// # Safety
        /// Operands point to strings.
        // SAFETY (the symbol): as for the functions with a string result.
        #[unsafe(export_name = concat!("staunch_text_", stringify!($function)))]
        unsafe extern "C" fn shim($($arg: operand_type!($ty)),*) -> carried!($result) {
            // SAFETY: the caller's promise.
            unsafe { text::$function($(operand!($ty $arg)),*) }
        }
        $each(concat!("staunch_text_", stringify!($function)), shim as *const u8);
    }};
}

macro_rules! operand_type {
    (STRING) => { *const u8 };
    ($ty:ident) => { carried!($ty) };
}

macro_rules! operand {
    (STRING $arg:ident) => {
        bytes($arg)
    };
    ($ty:ident $arg:ident) => {
        $arg
    };
}

for_each_text_op!(shims);
