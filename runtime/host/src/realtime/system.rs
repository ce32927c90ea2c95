//! What a run in real time asks of the operating system: a clock with absolute deadlines, a priority, memory that stays, a
//! processor. On Linux; elsewhere there is only the clock.
//!
//! The functions are declared here, and not taken from a crate: the command compiles this one with rustc alone.

/// Bytes of stack that are touched before the first scan, so that no scan waits for a page.
const STACK: usize = 256 << 10;
const PAGE: usize = 4096;

/// Touches the stack below.
#[inline(never)]
pub(super) fn touch_stack() {
    let mut stack = [0_u8; STACK];
    for at in (0..STACK).step_by(PAGE) {
        stack[at] = 1;
        std::hint::black_box(&mut stack);
    }
}

#[cfg(target_os = "linux")]
pub(super) use linux::{lock_memory, pin, sleep_until, take_priority, time, wake_on_time};
#[cfg(not(target_os = "linux"))]
pub(super) use other::{lock_memory, pin, sleep_until, take_priority, time, wake_on_time};

#[cfg(target_os = "linux")]
mod linux {
    use core::ffi::{c_int, c_long, c_ulong, c_void};
    use std::io;
    use std::time::Duration;

    const MONOTONIC: c_int = 1;
    const ABSOLUTE: c_int = 1;
    const FIFO: c_int = 1;
    const CURRENT_AND_FUTURE: c_int = 1 | 2;
    const WHEN_TOUCHED: c_int = 4;
    /// Of a process with more pages than these, as the compiler's own, most are never touched.
    const MOST_PAGES: u64 = 65_536;
    const TIMER_SLACK: c_int = 29;
    /// Processors that a set holds.
    const MOST_PROCESSORS: usize = 1024;
    const WORD: usize = c_ulong::BITS as usize;

    #[repr(C)]
    struct Timespec {
        seconds: c_long,
        nanoseconds: c_long,
    }

    #[repr(C)]
    struct Parameters {
        priority: c_int,
    }

    unsafe extern "C" {
        fn clock_gettime(clock: c_int, time: *mut Timespec) -> c_int;
        fn clock_nanosleep(clock: c_int, flags: c_int, until: *const Timespec, left: *mut Timespec) -> c_int;
        fn sched_setscheduler(process: c_int, policy: c_int, parameters: *const Parameters) -> c_int;
        fn sched_setaffinity(process: c_int, size: usize, set: *const c_void) -> c_int;
        fn mlockall(flags: c_int) -> c_int;
        fn prctl(option: c_int, ...) -> c_int;
    }

    /// The monotonic clock.
    pub fn time() -> Duration {
        let mut now = Timespec { seconds: 0, nanoseconds: 0 };
        // SAFETY: it fills the structure, and there is always a monotonic clock.
        unsafe { clock_gettime(MONOTONIC, &mut now) };
        Duration::new(u64::try_from(now.seconds).unwrap_or(0), u32::try_from(now.nanoseconds).unwrap_or(0))
    }

    /// Sleeps until the clock shows `deadline`, or a signal arrives.
    pub fn sleep_until(deadline: Duration) {
        let seconds = c_long::try_from(deadline.as_secs()).unwrap_or(c_long::MAX);
        let until = Timespec { seconds, nanoseconds: deadline.subsec_nanos() as c_long };
        // SAFETY: it reads the structure; with an absolute time nothing is written.
        unsafe { clock_nanosleep(MONOTONIC, ABSOLUTE, &until, core::ptr::null_mut()) };
    }

    /// The calling thread wakes at its time, and not up to 50 µs later together with others.
    pub fn wake_on_time() {
        let (nanoseconds, nothing): (c_ulong, c_ulong) = (1, 0);
        // SAFETY: it takes any numbers.
        unsafe { prctl(TIMER_SLACK, nanoseconds, nothing, nothing, nothing) };
    }

    /// The calling thread runs before all of a lower priority.
    pub fn take_priority(priority: u8) -> io::Result<()> {
        let parameters = Parameters { priority: priority.into() };
        // SAFETY: it reads the structure.
        checked(unsafe { sched_setscheduler(0, FIFO, &parameters) })
    }

    /// All memory of the process is brought into memory and stays there, also what comes later.
    pub fn lock_memory() -> io::Result<()> {
        let statistics = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
        let pages = statistics.split(' ').next().and_then(|it| it.parse::<u64>().ok());
        let when = if pages.is_some_and(|it| it > MOST_PAGES) { WHEN_TOUCHED } else { 0 };
        // SAFETY: it takes any number.
        checked(unsafe { mlockall(CURRENT_AND_FUTURE | when) })
    }

    /// The calling thread runs on that processor.
    pub fn pin(processor: usize) -> io::Result<()> {
        let mut set = [0 as c_ulong; MOST_PROCESSORS / WORD];
        let word = set.get_mut(processor / WORD).ok_or(io::ErrorKind::InvalidInput)?;
        *word |= 1 << (processor % WORD);
        // SAFETY: it reads the set, which is of that many bytes.
        checked(unsafe { sched_setaffinity(0, size_of_val(&set), set.as_ptr().cast()) })
    }

    fn checked(result: c_int) -> io::Result<()> {
        if result == 0 { Ok(()) } else { Err(io::Error::last_os_error()) }
    }
}

#[cfg(not(target_os = "linux"))]
mod other {
    use std::io;
    use std::sync::LazyLock;
    use std::time::Duration;
    use std::time::Instant;

    static START: LazyLock<Instant> = LazyLock::new(Instant::now);

    /// The monotonic clock.
    pub fn time() -> Duration {
        START.elapsed()
    }

    /// Sleeps until the clock shows `deadline`.
    pub fn sleep_until(deadline: Duration) {
        std::thread::sleep(deadline.saturating_sub(time()));
    }

    pub fn wake_on_time() {}

    pub fn take_priority(_: u8) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }

    pub fn lock_memory() -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }

    pub fn pin(_: usize) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }
}
