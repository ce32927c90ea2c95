//! A shim for each row of the operation table, at each of its reprs.

use staunch_runtime::{carried, for_each_op, ops};

macro_rules! shims {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) -> $result:ident
        [$class:ident as $reprs:ident] $outcome:ident $($extensible:ident)?;)*) => {
        #[allow(non_snake_case, reason = "operands have the standard's names")]
        pub(crate) fn for_each_symbol(each: &mut dyn FnMut(&'static str, *const u8)) {
            $(at_reprs!($reprs each { $outcome $function ($($arg: $ty),*) $result });)*
        }
    };
}

/// One shim for each repr of a class.
macro_rules! at_reprs {
    (any $each:ident $row:tt) => {
        at_reprs!(@ $each $row bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64)
    };
    (number $each:ident $row:tt) => {
        at_reprs!(@ $each $row i8 i16 i32 i64 u8 u16 u32 u64 f32 f64)
    };
    (integer $each:ident $row:tt) => {
        at_reprs!(@ $each $row i8 i16 i32 i64 u8 u16 u32 u64)
    };
    (real $each:ident $row:tt) => {
        at_reprs!(@ $each $row f32 f64)
    };
    (long $each:ident $row:tt) => {
        at_reprs!(@ $each $row i64)
    };
    (bits $each:ident $row:tt) => {
        at_reprs!(@ $each $row bool i8 i16 i32 i64 u8 u16 u32 u64)
    };
    (@ $each:ident $row:tt $($repr:ident)*) => {
        $(shim!($each $repr $row);)*
    };
}

macro_rules! shim {
    ($each:ident $repr:ident { total $function:ident ($($arg:ident: $ty:ident),*) $result:ident }) => {{
        #[allow(dead_code, reason = "some rows have no operand or result of the repr")]
        type T = $repr;

        // SAFETY: the prefix belongs to this crate, and a function and a repr meet in one row.
        #[unsafe(export_name = concat!("staunch_", stringify!($function), "_", stringify!($repr)))]
        extern "C" fn shim($($arg: carried!($ty)),*) -> carried!($result) {
            ops::$function($($arg),*)
        }
        $each(concat!("staunch_", stringify!($function), "_", stringify!($repr)), shim as *const u8);
    }};
    ($each:ident $repr:ident { faults $function:ident ($($arg:ident: $ty:ident),*) $result:ident }) => {{
        type T = $repr;

        /// # Safety
        /// `out` is writable and aligned for the result.
        // SAFETY (the symbol): as for the total rows.
        #[unsafe(export_name = concat!("staunch_", stringify!($function), "_", stringify!($repr)))]
        unsafe extern "C" fn shim($($arg: carried!($ty),)* out: *mut carried!($result)) -> u8 {
            match ops::$function($($arg),*) {
                Ok(result) => {
                    // SAFETY: the caller's promise.
                    unsafe { out.write(result) };
                    0
                }
                Err(kind) => kind as u8,
            }
        }
        $each(concat!("staunch_", stringify!($function), "_", stringify!($repr)), shim as *const u8);
    }};
}

for_each_op!(shims);
