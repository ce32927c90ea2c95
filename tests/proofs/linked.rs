//! Programs linked without `std`, without an allocator, and with a panic handler that does not exist: that succeeds only where no panic is
//! reachable, and nothing allocates.
#![no_std]
#![no_main]

mod entries;

use core::sync::atomic::{AtomicUsize, Ordering};
use staunch_runtime::Context;

pub struct Entry {
    pub init: unsafe extern "C" fn(state: *mut u8),
    pub scan: unsafe extern "C" fn(state: *mut u8, cx: *const Context, instance: u32) -> u64,
}

/// What else is called, to see that the link can fail.
mod more;

static KEPT: AtomicUsize = AtomicUsize::new(0);

#[unsafe(no_mangle)]
extern "C" fn main(count: i32, arguments: *const usize) -> i32 {
    for it in entries::ENTRIES {
        KEPT.fetch_add(it.init as usize ^ it.scan as usize, Ordering::Relaxed);
    }
    more::called(count as usize, arguments)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn a_panic_is_reachable() -> !;
    }
    // SAFETY: it is never linked.
    unsafe { a_panic_is_reachable() }
}

#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}
