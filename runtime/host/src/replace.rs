//! Files that are written. A file appears under its name only when it is complete: it is written under a temporary name next
//! to it and renamed, so that a crash or a full disk leaves the old file intact. A pipe or a device is written
//! directly.

use std::ffi::OsString;
use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// A new file that replaces the file with its name once it is [kept](Self::keep); if it is dropped before, it is deleted.
#[derive(Debug)]
pub struct Replacement {
    target: PathBuf,
    /// Empty where the name itself is written.
    aside: PathBuf,
}

impl Replacement {
    /// The file to write to, for `path`. A symbolic link stays: what it leads to is replaced.
    pub fn create(path: &Path) -> io::Result<(Self, File)> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let target = followed(path)?;
        let old = fs::metadata(&target).ok();
        if is_straight(path) || old.as_ref().is_some_and(|it| !it.is_file()) {
            return straight(path, target);
        }
        let mut name = OsString::from(".");
        name.push(target.file_name().unwrap_or_default());
        name.push(format!(".{}.{}.new", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
        let aside = target.with_file_name(name);
        let file = match File::create_new(&aside) {
            // A file may be writable in a folder that is not: it is better written than refused.
            Err(error) if error.kind() == io::ErrorKind::PermissionDenied && old.is_some() => {
                return straight(path, target);
            }
            made => made?,
        };
        let replacement = Self { target, aside };
        if let Some(old) = old {
            if old.permissions().readonly() {
                // It was made so on purpose, and a rename does not ask.
                return Err(io::ErrorKind::PermissionDenied.into());
            }
            file.set_permissions(old.permissions())?;
        }
        Ok((replacement, file))
    }

    /// The file has its name from now on.
    pub fn keep(mut self) -> io::Result<()> {
        if !self.aside.as_os_str().is_empty() {
            fs::rename(&self.aside, &self.target)?;
            self.aside = PathBuf::new();
        }
        Ok(())
    }
}

impl Drop for Replacement {
    fn drop(&mut self) {
        if !self.aside.as_os_str().is_empty() {
            let _ = fs::remove_file(&self.aside);
        }
    }
}

/// Names of a process's open files lead to these, and not to a file with that name.
#[cfg(not(windows))]
fn is_straight(path: &Path) -> bool {
    path.starts_with("/dev") || path.starts_with("/proc")
}

/// Names of devices, which have them in every folder.
#[cfg(windows)]
fn is_straight(path: &Path) -> bool {
    use std::path::{Component, Prefix};
    let is_device = |name: &str| ["NUL", "CON", "CONOUT$", "PRN"].iter().any(|it| name.eq_ignore_ascii_case(it));
    let of_devices = |it| matches!(it, Component::Prefix(prefix) if matches!(prefix.kind(), Prefix::DeviceNS(_)));
    path.file_name().and_then(|it| it.to_str()).is_some_and(is_device) || path.components().any(of_devices)
}

fn straight(path: &Path, target: PathBuf) -> io::Result<(Replacement, File)> {
    Ok((Replacement { target, aside: PathBuf::new() }, open(path)?))
}

/// A pipe without a reader blocks its writer, so a message is shown first.
fn open(path: &Path) -> io::Result<File> {
    if fs::metadata(path).is_ok_and(|it| is_pipe(&it)) && !is_straight(path) {
        crate::error::tell(format_args!("note: {} is a pipe: waiting until it is read", path.display()));
    }
    // A device of Windows has nothing to empty.
    if cfg!(windows) && is_straight(path) { File::options().write(true).open(path) } else { File::create(path) }
}

/// For what must not wait: a file as it is, and a pipe only where it is read.
pub fn open_at_once(path: &Path) -> io::Result<File> {
    if !fs::metadata(path).is_ok_and(|it| is_pipe(&it)) || is_straight(path) {
        return File::create(path);
    }
    open_pipe(path)
}

#[cfg(any(target_os = "linux", target_os = "android"))]
fn open_pipe(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    const NONBLOCK: i32 = 0o4000;
    let opened = File::options().write(true).custom_flags(NONBLOCK).open(path);
    opened.map_err(|error| match error.raw_os_error() {
        Some(6) => io::Error::other("it is a pipe that nobody reads"),
        _ => error,
    })
}

#[cfg(not(any(target_os = "linux", target_os = "android")))]
fn open_pipe(_: &Path) -> io::Result<File> {
    Err(io::Error::other("it is a pipe, which could block the program"))
}

/// Opens a file for reading. A pipe without a writer blocks its reader, so a message is shown first.
pub fn open_to_read(path: &Path) -> io::Result<File> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(io::Error::other("it is a folder"));
    }
    if is_endless(path, &metadata) {
        return Err(io::Error::other("it is a device, which has no end"));
    }
    if is_pipe(&metadata) && !is_straight(path) {
        crate::error::tell(format_args!("note: {} is a pipe: waiting until it is written", path.display()));
    }
    File::open(path)
}

/// Devices that a shell hands over have an end.
fn is_endless(path: &Path, metadata: &Metadata) -> bool {
    const ENDING: [&str; 3] = ["/dev/null", "/dev/stdin", "/dev/full"];
    let ends =
        ENDING.iter().any(|it| path == Path::new(it)) || path.starts_with("/dev/fd") || path.starts_with("/proc");
    is_device(metadata) && (!ends || path == Path::new("/dev/full"))
}

#[cfg(unix)]
pub(crate) fn is_pipe(metadata: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    metadata.file_type().is_fifo()
}

#[cfg(unix)]
fn is_device(metadata: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    metadata.file_type().is_char_device() || metadata.file_type().is_block_device()
}

#[cfg(not(unix))]
pub(crate) fn is_pipe(_: &Metadata) -> bool {
    false
}

#[cfg(not(unix))]
fn is_device(_: &Metadata) -> bool {
    false
}

/// Links that lead to one another are as many as systems follow.
const LINKS: usize = 40;

/// What a name leads to through symbolic links, also where the last one leads to nothing yet.
pub fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        let Ok(next) = fs::read_link(&path) else { return Ok(path) };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(io::Error::other("its symbolic links form a loop"))
}

/// What identifies a file, by whatever name it is reached. A file that does not exist yet is its
/// folder and its name. `None` for devices and pipes that the process has open, which several may read and write.
#[cfg(unix)]
fn identity(path: &Path) -> Option<(u64, u64, OsString)> {
    use std::os::unix::fs::MetadataExt;
    if path == Path::new("-") {
        return None;
    }
    match fs::metadata(path) {
        // Standard input may be a file.
        Ok(it) if is_device(&it) || is_straight(path) && !it.is_file() => None,
        Err(_) if is_straight(path) => None,
        Ok(it) => Some((it.dev(), it.ino(), OsString::new())),
        Err(_) => {
            let target = followed(path).ok()?;
            let folder = target.parent().filter(|it| !it.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let folder = fs::metadata(folder).ok()?;
            Some((folder.dev(), folder.ino(), target.file_name()?.to_owned()))
        }
    }
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<PathBuf> {
    if path == Path::new("-") || is_straight(path) {
        return None;
    }
    let folder = path.parent().filter(|it| !it.as_os_str().is_empty()).unwrap_or(Path::new("."));
    path.canonicalize().or_else(|_| folder.canonicalize().map(|it| it.join(path.file_name().unwrap_or_default()))).ok()
}

/// A file that a call names, and its role in it: `the source`, `--trace`.
pub type Role<'a> = (&'a str, &'a Path);

/// Checks that no output replaces an input or another output.
pub fn keep_apart(inputs: &[Role<'_>], outputs: &[Role<'_>]) -> Result<(), String> {
    for (number, (what, path)) in outputs.iter().enumerate() {
        let Some(own) = identity(path) else { continue };
        let same = |it: &&Role<'_>| identity(it.1).as_ref() == Some(&own);
        if let Some((other, name)) = inputs.iter().find(same) {
            return Err(format!(
                "{what} {} would replace {other} {}; write to another file",
                path.display(),
                name.display()
            ));
        }
        if let Some((other, name)) = outputs[..number].iter().find(same) {
            return Err(format!(
                "{what} {} and {other} {} are the same file; write to two files",
                path.display(),
                name.display()
            ));
        }
    }
    Ok(())
}
