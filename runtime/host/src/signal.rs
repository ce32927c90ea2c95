//! Ends a run in real time when the user or the system asks for it: after its scan, or in the midst of a
//! scan that takes too long.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// TRUE once SIGINT or SIGTERM has arrived: the run now ends by itself, however long that takes.
pub(crate) fn asked_to_stop() -> bool {
    let asked = ASKED.load(Ordering::Relaxed);
    #[cfg(unix)]
    if asked {
        unix::patience(0);
    }
    asked
}

#[cfg(unix)]
mod unix {
    use super::{ASKED, Ordering};

    const INTERRUPT: i32 = 2;
    const ALARM: i32 = 14;
    const TERMINATE: i32 = 15;
    const DEFAULT: usize = 0;
    /// Seconds that a scan may still take.
    const PATIENCE: u32 = 2;

    unsafe extern "C" {
        fn signal(number: i32, handler: usize) -> usize;
        fn alarm(seconds: u32) -> u32;
        fn raise(number: i32) -> i32;
    }

    extern "C" fn stop(number: i32) {
        ASKED.store(true, Ordering::Relaxed);
        // SAFETY: POSIX allows both in a handler. A second signal ends the process at once.
        unsafe {
            signal(number, DEFAULT);
            alarm(PATIENCE);
        }
    }

    /// The scan does not end: the process ends as one that ignores the signal would.
    extern "C" fn give_up(_: i32) {
        // SAFETY: POSIX allows both in a handler.
        unsafe {
            signal(INTERRUPT, DEFAULT);
            raise(INTERRUPT);
        }
    }

    /// Gives up after so many seconds; never with 0.
    pub fn patience(seconds: u32) {
        // SAFETY: it takes any number.
        unsafe { alarm(seconds) };
    }

    pub fn ignore_closed_pipes() {
        const PIPE: i32 = 13;
        const IGNORE: usize = 1;
        // SAFETY: to ignore a signal calls nothing.
        unsafe { signal(PIPE, IGNORE) };
    }

    pub fn listen() {
        let handler = stop as extern "C" fn(i32);
        for number in [INTERRUPT, TERMINATE] {
            // SAFETY: the handler only stores to an atomic and makes calls that POSIX allows there.
            unsafe { signal(number, handler as usize) };
        }
        let handler = give_up as extern "C" fn(i32);
        // SAFETY: as above.
        unsafe { signal(ALARM, handler as usize) };
    }
}

/// An output whose reader has gone is an error to be handled, and no end of the process: Rust's own `main` makes
/// it so, and C's does not.
pub(crate) fn ignore_closed_pipes() {
    #[cfg(unix)]
    unix::ignore_closed_pipes();
}

/// From now on, SIGINT and SIGTERM ask for an end instead of making one.
pub(crate) fn listen() {
    #[cfg(unix)]
    unix::listen();
}
