//! Ends a run in real time when the user or the system requests it: after its scan, or in the middle of a
//! scan that takes too long.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
static FIGURES: AtomicBool = AtomicBool::new(false);

/// TRUE once after SIGUSR1 has arrived.
pub(crate) fn asked_for_figures() -> bool {
    FIGURES.load(Ordering::Relaxed) && FIGURES.swap(false, Ordering::Relaxed)
}

/// As if SIGUSR1 had arrived.
pub(crate) fn ask_for_figures_again() {
    FIGURES.store(true, Ordering::Relaxed);
}

/// TRUE once SIGINT, SIGTERM or SIGHUP has arrived, on Windows Ctrl-C or the end of the console: the run now ends by itself, however long that takes.
pub(crate) fn asked_to_stop() -> bool {
    let asked = ASKED.load(Ordering::Relaxed);
    if asked {
        #[cfg(unix)]
        unix::patience(0);
        #[cfg(windows)]
        windows::hear();
    }
    asked
}

#[cfg(unix)]
mod unix {
    use super::{ASKED, FIGURES, Ordering};

    const HANG_UP: i32 = 1;
    const INTERRUPT: i32 = 2;
    #[cfg(target_os = "linux")]
    const USER_1: i32 = 10;
    #[cfg(not(target_os = "linux"))]
    const USER_1: i32 = 30;
    const ALARM: i32 = 14;
    const TERMINATE: i32 = 15;
    const DEFAULT: usize = 0;
    const IGNORE: usize = 1;
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
            signal(number, at_once as extern "C" fn(i32) as usize);
            alarm(PATIENCE);
        }
    }

    extern "C" fn figures(_: i32) {
        FIGURES.store(true, Ordering::Relaxed);
    }

    /// Nothing is waited for.
    extern "C" fn at_once(number: i32) {
        crate::attachments::emergency::stop();
        // SAFETY: POSIX allows both in a handler.
        unsafe {
            signal(number, DEFAULT);
            raise(number);
        }
    }

    /// The scan does not end: the process ends as one that ignores the signal would.
    extern "C" fn give_up(_: i32) {
        at_once(INTERRUPT);
    }

    /// Gives up after so many seconds; never with 0.
    pub fn patience(seconds: u32) {
        // SAFETY: it takes any number.
        unsafe { alarm(seconds) };
    }

    pub fn ignore_closed_pipes() {
        const PIPE: i32 = 13;
        // SAFETY: to ignore a signal calls nothing.
        unsafe { signal(PIPE, IGNORE) };
    }

    pub fn listen() {
        let handler = stop as extern "C" fn(i32);
        for number in [HANG_UP, INTERRUPT, TERMINATE] {
            // SAFETY: the handler only stores to an atomic and makes calls that POSIX allows there.
            let before = unsafe { signal(number, handler as usize) };
            // `nohup` has asked that the program continues when the terminal closes.
            if number == HANG_UP && before == IGNORE {
                // SAFETY: to ignore a signal calls nothing.
                unsafe { signal(number, IGNORE) };
            }
        }
        for (number, handler) in [(ALARM, give_up as extern "C" fn(i32)), (USER_1, figures)] {
            // SAFETY: as above.
            unsafe { signal(number, handler as usize) };
        }
    }
}

#[cfg(windows)]
mod windows {
    use super::{ASKED, AtomicBool, Ordering};
    use std::thread::sleep;
    use std::time::Duration;

    static HEARD: AtomicBool = AtomicBool::new(false);

    const INTERRUPTS: [u32; 2] = [0, 1];
    /// Naps of 10 ms that a scan may still take.
    const PATIENCE: u32 = 200;
    const NAP: Duration = Duration::from_millis(10);
    /// The next handler, which ends the process, is called.
    const PASS: i32 = 0;
    const HANDLED: i32 = 1;

    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn SetConsoleCtrlHandler(handler: extern "system" fn(u32) -> i32, add: i32) -> i32;
    }

    /// Runs in a thread of its own. A second Ctrl-C ends the process at once.
    extern "system" fn stop(event: u32) -> i32 {
        if ASKED.swap(true, Ordering::Relaxed) {
            return PASS;
        }
        let is_heard = (0..PATIENCE).any(|_| {
            sleep(NAP);
            HEARD.load(Ordering::Relaxed)
        });
        if !is_heard {
            return PASS;
        }
        // When the console is closed, the process ends as soon as this returns: the run is to end before.
        while !INTERRUPTS.contains(&event) {
            sleep(NAP);
        }
        HANDLED
    }

    /// The run ends by itself.
    pub fn hear() {
        HEARD.store(true, Ordering::Relaxed);
    }

    pub fn listen() {
        // SAFETY: the handler makes safe calls alone, in its own thread.
        unsafe { SetConsoleCtrlHandler(stop, 1) };
    }
}

/// An output whose reader has gone is an error to be handled, and no end of the process: Rust's own `main` makes
/// it so, and C's does not.
pub(crate) fn ignore_closed_pipes() {
    #[cfg(unix)]
    unix::ignore_closed_pipes();
}

/// From now on, SIGINT, SIGTERM and SIGHUP, on Windows Ctrl-C and the end of the console, ask for an end instead of making one, and SIGUSR1
/// asks for figures.
pub(crate) fn listen() {
    #[cfg(unix)]
    unix::listen();
    #[cfg(windows)]
    windows::listen();
}
