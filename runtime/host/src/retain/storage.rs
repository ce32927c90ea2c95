//! Where the bytes of retained variables go: a file, and a new one next to it that can replace it.

use super::lock;
use crate::replace::followed;
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

/// Which of the two files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Which {
    /// The one that the next start reads.
    Kept,
    /// The one that is being made.
    New,
}

/// A place that keeps bytes over a power cut: what was written is safe once `sync` has returned without an
/// error. Until then any part of it may be there or not.
pub(super) trait Storage: Send {
    /// Makes the new file, empty.
    fn create(&mut self) -> io::Result<()>;
    /// Writes bytes at an offset, as many as go at once, and returns how many; see [`write_all`].
    fn write(&mut self, which: Which, offset: usize, bytes: &[u8]) -> io::Result<usize>;
    fn sync(&mut self, which: Which) -> io::Result<()>;
    /// The new file takes the kept one's place, in one step.
    fn publish(&mut self) -> io::Result<()>;
    /// Makes sure of that: until it has returned without an error, the next start may find the old file.
    fn sync_name(&mut self) -> io::Result<()>;
    /// Forgets the new file.
    fn discard(&mut self);
}

/// Writes all bytes, piece by piece if need be.
pub(super) fn write_all(
    storage: &mut (impl Storage + ?Sized),
    which: Which,
    mut offset: usize,
    mut bytes: &[u8],
) -> io::Result<()> {
    while !bytes.is_empty() {
        match storage.write(which, offset, bytes) {
            Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
            Ok(count) => (offset, bytes) = (offset + count, &bytes[count..]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// A file of the operating system.
#[derive(Debug)]
pub(super) struct Disk {
    path: PathBuf,
    aside: PathBuf,
    kept: Option<File>,
    new: Option<File>,
    /// Held as long as the file may be written.
    _lock: Option<File>,
}

impl Disk {
    /// The disk, and the first `limit` bytes of the file if there is one. The file that is read is also the one that is written
    /// later, whatever happens to the name.
    ///
    /// A symbolic link stays: what it leads to is read and written.
    pub fn open(path: &Path, limit: u64) -> io::Result<(Self, Option<Vec<u8>>)> {
        let path = &followed(path)?;
        if std::fs::metadata(path).is_ok_and(|it| !it.is_file()) {
            return Err(io::Error::other("retained variables need a file, but this is something else"));
        }
        let lock = lock::take(path)?;
        let mut name: OsString = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.new", std::process::id()));
        let mut disk =
            Self { path: path.to_owned(), aside: path.with_file_name(name), kept: None, new: None, _lock: lock };
        let both = File::options().read(true).write(true).open(path);
        // A file that may only be read can still be replaced.
        let file = both.or_else(|_| File::open(path));
        let file = match file {
            Ok(file) => disk.kept.insert(file),
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok((disk, None)),
            Err(error) => return Err(error),
        };
        lock::hold(file)?;
        let mut bytes = Vec::new();
        file.take(limit).read_to_end(&mut bytes)?;
        Ok((disk, Some(bytes)))
    }

    fn file(&mut self, which: Which) -> io::Result<&mut File> {
        let file = match which {
            Which::Kept => &mut self.kept,
            Which::New => &mut self.new,
        };
        file.as_mut().ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

impl Storage for Disk {
    fn create(&mut self) -> io::Result<()> {
        // Nobody else has it yet; the lock stays with it under the name that it is given, and under others.
        lock::hold(self.new.insert(File::create(&self.aside)?))
    }

    fn write(&mut self, which: Which, offset: usize, bytes: &[u8]) -> io::Result<usize> {
        let file = self.file(which)?;
        file.seek(SeekFrom::Start(offset as u64))?;
        file.write(bytes)
    }

    fn sync(&mut self, which: Which) -> io::Result<()> {
        let file = self.file(which)?;
        // Of a file that only changes inside, the time of the last change need not be on disk.
        match which {
            Which::Kept => file.sync_data(),
            Which::New => file.sync_all(),
        }
    }

    fn publish(&mut self) -> io::Result<()> {
        std::fs::rename(&self.aside, &self.path)?;
        self.kept = self.new.take();
        Ok(())
    }

    /// A file's name is on disk only when its folder is. Some systems cannot open or sync a folder.
    fn sync_name(&mut self) -> io::Result<()> {
        let folder = self.path.parent().filter(|it| !it.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let Ok(folder) = File::open(folder) else { return Ok(()) };
        match folder.sync_all() {
            Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
            result => result,
        }
    }

    fn discard(&mut self) {
        self.new = None;
        let _ = std::fs::remove_file(&self.aside);
    }
}
