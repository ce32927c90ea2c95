//! One process at a time writes a file of retained variables. The lock is a file of its own next to it, as the
//! file itself is replaced; the file is locked as well, for it may have other names. The system lets go of both when the
//! process ends, in whatever way.

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::path::Path;

/// The lock of a file, as long as it is held. `None` where the folder does not exist or takes no new file: saving reports that.
pub(super) fn take(path: &Path) -> io::Result<Option<File>> {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".lock");
    let opened = File::options().create(true).truncate(false).write(true).open(path.with_file_name(name));
    match opened {
        Ok(file) => hold(&file).map(|()| Some(file)),
        Err(_) => Ok(None),
    }
}

#[cfg(any(unix, windows))]
const TAKEN_BY_OTHERS: &str =
    "another process keeps its retained variables there: end it, or give this one its own file";

/// Locks a file until it is closed.
#[cfg(unix)]
pub(super) fn hold(file: &File) -> io::Result<()> {
    use std::os::fd::AsRawFd;
    const EXCLUSIVE: i32 = 2;
    const AT_ONCE: i32 = 4;
    unsafe extern "C" {
        fn flock(descriptor: i32, operation: i32) -> i32;
    }
    // SAFETY: it takes any numbers; the descriptor is open.
    let locked = unsafe { flock(file.as_raw_fd(), EXCLUSIVE | AT_ONCE) };
    match (locked, io::Error::last_os_error()) {
        (0, _) => Ok(()),
        (_, error) if error.kind() == io::ErrorKind::WouldBlock => Err(io::Error::other(TAKEN_BY_OTHERS)),
        // Some network file systems have no locks.
        _ => Ok(()),
    }
}

/// Locks a file until it is closed.
#[cfg(windows)]
pub(super) fn hold(file: &File) -> io::Result<()> {
    use core::ffi::c_void;
    use std::os::windows::io::AsRawHandle;
    const AT_ONCE: u32 = 1;
    const EXCLUSIVE: u32 = 2;
    const TAKEN: i32 = 33;
    /// Windows' OVERLAPPED.
    #[repr(C)]
    struct Place {
        internal: [usize; 2],
        offset: [u32; 2],
        event: *mut c_void,
    }
    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn LockFileEx(file: *mut c_void, flags: u32, _: u32, low: u32, high: u32, place: *mut Place) -> i32;
    }
    // Nobody may read or write what is locked: a byte where no file has one.
    let mut place = Place { internal: [0; 2], offset: [0, 0x7FFF_FFFF], event: core::ptr::null_mut() };
    // SAFETY: the handle is open, and the place is as Windows has it, and there until the call returns.
    let locked = unsafe { LockFileEx(file.as_raw_handle(), EXCLUSIVE | AT_ONCE, 0, 1, 0, &raw mut place) };
    match (locked, io::Error::last_os_error().raw_os_error()) {
        (0, Some(TAKEN)) => Err(io::Error::other(TAKEN_BY_OTHERS)),
        // Some network file systems have no locks.
        _ => Ok(()),
    }
}

#[cfg(not(any(unix, windows)))]
pub(super) fn hold(_: &File) -> io::Result<()> {
    Ok(())
}
