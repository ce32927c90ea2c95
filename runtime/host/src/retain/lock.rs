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
        (_, error) if error.kind() == io::ErrorKind::WouldBlock => Err(io::Error::other(
            "another process keeps its retained variables there: end it, or give this one its own file",
        )),
        // Some network file systems have no locks.
        _ => Ok(()),
    }
}

#[cfg(not(unix))]
pub(super) fn hold(_: &File) -> io::Result<()> {
    Ok(())
}
