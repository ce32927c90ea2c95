//! A shim for each instruction and each prescan of the standard blocks.

use staunch_runtime::{Context, codesys, cscape, for_each_block, iec, logix, openplc, openplc4, run_instruction, s7};

macro_rules! shims {
    ($($family:ident $name:literal $block:ty { $($pin:literal => $renamed:literal),* } $([$ty:ident => $retyped:ident])? $(#[$($fact:tt)*])* {
        $($how:ident $instruction:literal $method:ident $symbol:ident
            $(, prescan $prescan:ident $prescan_symbol:ident)?;)*
    })*) => {
        $($(
            /// # Safety
            /// `block` points to an instance that is not used elsewhere during the call, and `cx` to a context.
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $symbol(block: *mut $block, cx: *const Context, rung: bool) {
                // SAFETY: the caller's promise.
                let (block, _cx, _rung) = unsafe { (&mut *block, &*cx, rung) };
                run_instruction!($how block $method _cx, _rung);
            }

            $(
                /// # Safety
                /// `block` points to an instance that is not used elsewhere during the call.
                #[unsafe(no_mangle)]
                unsafe extern "C" fn $prescan_symbol(block: *mut $block) {
                    // SAFETY: the caller's promise.
                    unsafe { (*block).$prescan() }
                }
            )?
        )*)*

        pub(crate) fn for_each_symbol(each: &mut dyn FnMut(&'static str, *const u8)) {
            $($(
                each(stringify!($symbol), $symbol as *const u8);
                $(each(stringify!($prescan_symbol), $prescan_symbol as *const u8);)?
            )*)*
        }
    };
}

for_each_block!(shims);
