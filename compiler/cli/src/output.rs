//! Files, standard output, and standard error, whose readers may leave early.

use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Writes to standard output. A reader that has left, as `head` does, wants no more; the exit code is what it would be.
pub fn print(bytes: &[u8]) -> Result<(), String> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(format!("standard output: {error}")),
    }
}

/// Writes a line to standard error. Where that is closed, nobody is there to be told.
pub fn tell(line: impl Display) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Writes a whole file, or standard output for `-`.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if path == Path::new("-") {
        return print(bytes);
    }
    std::fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
}

/// Whether a file can be written, which is asked before the work that it is for.
pub fn check(path: &Path) -> Result<(), String> {
    if path == Path::new("-") {
        return Ok(());
    }
    let opened = std::fs::OpenOptions::new().append(true).create(true).open(path);
    opened.map(drop).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a file that can be run. One of that name may be running: it keeps its old contents.
pub fn executable(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if path.is_file() {
        let _ = std::fs::remove_file(path);
    }
    write(path, bytes)?;
    // A device, as /dev/null, is left as it is.
    if path.is_file() && path != Path::new("-") { allow_to_run(path) } else { Ok(()) }
}

#[cfg(unix)]
fn allow_to_run(path: &Path) -> Result<(), String> {
    use std::os::unix::fs::PermissionsExt;
    let shown = |error| format!("{}: {error}", path.display());
    let mut permissions = std::fs::metadata(path).map_err(shown)?.permissions();
    // Whoever may read it may run it.
    permissions.set_mode(permissions.mode() | (permissions.mode() & 0o444) >> 2);
    std::fs::set_permissions(path, permissions).map_err(shown)
}

#[cfg(not(unix))]
fn allow_to_run(_path: &Path) -> Result<(), String> {
    Ok(())
}
