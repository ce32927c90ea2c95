//! Files, standard output, and standard error, whose readers may leave early.

use crate::args::MessageFormat;
use staunch_host::{Replacement, json_text};
use std::fmt::Display;
use std::fs::File;
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

/// Writes a line to standard error. If that is closed, nobody reads it.
pub fn tell(line: impl Display) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Says what went wrong where the format's readers look.
pub fn problem(format: MessageFormat, message: &str) {
    match format {
        MessageFormat::Json => {
            let object = format!("{{\"reason\":\"error\",\"message\":{}}}\n", json_text(message));
            // A reader that has gone away wants no more.
            let _ = std::io::stdout().write_all(object.as_bytes());
        }
        MessageFormat::Human | MessageFormat::Short => tell(format_args!("error: {message}")),
    }
}

/// Writes a whole file, or standard output for `-`.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if path == Path::new("-") {
        return print(bytes);
    }
    put(path, bytes, false).map_err(|error| format!("{}: {error}", path.display()))
}

/// What had the name stays until the new file is whole; it may be running.
fn put(path: &Path, bytes: &[u8], runs: bool) -> std::io::Result<()> {
    let (replacement, mut file) = Replacement::create(path)?;
    file.write_all(bytes)?;
    // A device, as /dev/null, is left as it is.
    if runs && file.metadata()?.is_file() {
        allow_to_run(&file)?;
    }
    replacement.keep()
}

/// Whether a file can be written, which is asked before the work that it is for.
pub fn check(path: &Path) -> Result<(), String> {
    if path == Path::new("-") {
        return Ok(());
    }
    // Opening a pipe would wait for its reader, and end what it reads.
    if std::fs::metadata(path).is_ok_and(|it| !it.is_file() && !it.is_dir()) {
        return Ok(());
    }
    Replacement::create(path).map(drop).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a file that can be run.
pub fn executable(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if path == Path::new("-") {
        return print(bytes);
    }
    put(path, bytes, true).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(unix)]
fn allow_to_run(file: &File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    let mut permissions = file.metadata()?.permissions();
    // Whoever may read it may run it.
    permissions.set_mode(permissions.mode() | (permissions.mode() & 0o444) >> 2);
    file.set_permissions(permissions)
}

#[cfg(not(unix))]
fn allow_to_run(_: &File) -> std::io::Result<()> {
    Ok(())
}
