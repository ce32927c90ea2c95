//! A shim for each conversion from repr to repr.

use staunch_runtime::ops;

macro_rules! shims {
    ($each:ident $function:ident $from:ident: $($to:ident)*) => { $({
        // SAFETY: the prefix belongs to this crate, and a pair of reprs comes once.
        #[unsafe(export_name = concat!("staunch_", stringify!($function), "_", stringify!($from), "_", stringify!($to)))]
        extern "C" fn shim(value: $from) -> $to {
            ops::$function::<$from, $to>(value)
        }
        $each(concat!("staunch_", stringify!($function), "_", stringify!($from), "_", stringify!($to)), shim as *const u8);
    })* };
}

macro_rules! from_each {
    ($each:ident $($from:ident)*) => {
        $(shims!($each convert $from: bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64);)*
    };
}

pub(crate) fn for_each_symbol(each: &mut dyn FnMut(&'static str, *const u8)) {
    from_each!(each bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64);
    shims!(each trunc f32: i8 i16 i32 i64 u8 u16 u32 u64);
    shims!(each trunc f64: i8 i16 i32 i64 u8 u16 u32 u64);
}
