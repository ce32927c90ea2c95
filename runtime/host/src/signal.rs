//! Ends a run in real time when the user or the system asks for it.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// TRUE once SIGINT or SIGTERM has arrived.
pub(crate) fn asked_to_stop() -> bool {
    ASKED.load(Ordering::Relaxed)
}

#[cfg(unix)]
mod unix {
    use super::{ASKED, Ordering};

    const INTERRUPT: i32 = 2;
    const TERMINATE: i32 = 15;
    const DEFAULT: usize = 0;

    unsafe extern "C" {
        fn signal(number: i32, handler: usize) -> usize;
    }

    extern "C" fn stop(number: i32) {
        ASKED.store(true, Ordering::Relaxed);
        // SAFETY: `signal` may be called in a handler. A second signal ends the process at once.
        unsafe { signal(number, DEFAULT) };
    }

    pub fn listen() {
        let handler = stop as extern "C" fn(i32);
        for number in [INTERRUPT, TERMINATE] {
            // SAFETY: the handler only stores to an atomic and calls `signal`, which POSIX allows.
            unsafe { signal(number, handler as usize) };
        }
    }
}

/// From now on, SIGINT and SIGTERM ask for an end instead of making one.
pub(crate) fn listen() {
    #[cfg(unix)]
    unix::listen();
}
