//! How wide the terminal is.

/// Characters in a line without a terminal, or with one that does not give its width.
const DEFAULT: usize = 100;
/// A table does not fit fewer.
const LEAST: usize = 40;

/// Characters in a line of standard output, from `COLUMNS` or the terminal.
pub(crate) fn width() -> usize {
    let said = std::env::var("COLUMNS").ok().and_then(|it| it.trim().parse().ok());
    said.or_else(of_terminal).unwrap_or(DEFAULT).max(LEAST)
}

#[cfg(any(target_os = "linux", target_os = "macos"))]
fn of_terminal() -> Option<usize> {
    const STANDARD_OUTPUT: i32 = 1;
    #[cfg(target_os = "linux")]
    const GET_SIZE: core::ffi::c_ulong = 0x5413;
    #[cfg(target_os = "macos")]
    const GET_SIZE: core::ffi::c_ulong = 0x4008_7468;

    unsafe extern "C" {
        fn ioctl(file: i32, request: core::ffi::c_ulong, ...) -> i32;
    }

    // Rows, columns, and both in pixels.
    let mut size = [0_u16; 4];
    // SAFETY: the request fills a `struct winsize`, which is four of these. On another file it fails.
    let done = unsafe { ioctl(STANDARD_OUTPUT, GET_SIZE, size.as_mut_ptr()) };
    (done == 0 && size[1] > 0).then(|| usize::from(size[1]))
}

#[cfg(windows)]
fn of_terminal() -> Option<usize> {
    use core::ffi::c_void;
    const STANDARD_OUTPUT: u32 = 11_u32.wrapping_neg();
    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn GetStdHandle(which: u32) -> *mut c_void;
        fn GetConsoleScreenBufferInfo(console: *mut c_void, info: *mut [i16; 11]) -> i32;
    }
    // Sizes, places and colours; of the window's edges the left one is at 5, and the right one at 7.
    let mut info = [0_i16; 11];
    // SAFETY: the call fills a CONSOLE_SCREEN_BUFFER_INFO, which is eleven of these. On anything else it fails.
    let done = unsafe { GetConsoleScreenBufferInfo(GetStdHandle(STANDARD_OUTPUT), &raw mut info) };
    let columns = i32::from(info[7]) - i32::from(info[5]) + 1;
    usize::try_from(columns).ok().filter(|it| done != 0 && *it > 1)
}

#[cfg(not(any(target_os = "linux", target_os = "macos", windows)))]
fn of_terminal() -> Option<usize> {
    None
}
