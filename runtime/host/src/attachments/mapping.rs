//! A file in `/dev/shm` as memory that other processes read and write at the same time: each access is of one atomic number.
//!
//! The functions are declared here, and not taken from a crate: the command compiles this one with rustc alone. `shm_open` is not
//! among them, as the C libraries of older systems have it in a library of its own.

use super::points::Width;
use core::ffi::{c_int, c_void};
use std::fs::File;
use std::io::{self, Write as _};
use std::os::fd::AsRawFd;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;
use std::sync::atomic::{AtomicU8, AtomicU16, AtomicU32, AtomicU64, Ordering::Relaxed};

const FOLDER: &str = "/dev/shm";
/// The owner and the group read and write.
const MODE: u32 = 0o660;
/// Does not follow a link.
#[cfg(any(target_arch = "arm", target_arch = "aarch64"))]
const NO_FOLLOW: c_int = 0o100_000;
#[cfg(not(any(target_arch = "arm", target_arch = "aarch64")))]
const NO_FOLLOW: c_int = 0o400_000;
const READ_AND_WRITE: c_int = 1 | 2;
const SHARED: c_int = 1;
const EXCLUSIVE: c_int = 2;
const AT_ONCE: c_int = 4;
/// What `mmap` returns for an error.
const FAILED: usize = usize::MAX;

#[cfg(any(target_pointer_width = "64", target_env = "musl"))]
type Offset = i64;
#[cfg(not(any(target_pointer_width = "64", target_env = "musl")))]
type Offset = core::ffi::c_long;

unsafe extern "C" {
    fn mmap(at: *mut c_void, size: usize, access: c_int, flags: c_int, file: c_int, offset: Offset) -> *mut c_void;
    fn flock(descriptor: c_int, operation: c_int) -> c_int;
}

/// Memory that stays mapped until the process ends: a handler of a signal may use it at any time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mapping {
    base: *mut u8,
    size: usize,
}

// SAFETY: each access is atomic, and the memory stays.
unsafe impl Send for Mapping {}
// SAFETY: as above.
unsafe impl Sync for Mapping {}

impl Mapping {
    /// Opens or makes the file, which this process alone then has locked. A new one is full of zeros.
    pub fn open(name: &str, size: usize) -> io::Result<Self> {
        let path = Path::new(FOLDER).join(name);
        let mut options = File::options();
        let file = options.read(true).write(true).create(true).mode(MODE).custom_flags(NO_FOLLOW).open(path)?;
        let metadata = file.metadata()?;
        if !metadata.is_file() {
            return Err(io::Error::other("it is not a regular file"));
        }
        // SAFETY: it takes any numbers; the descriptor is open.
        if unsafe { flock(file.as_raw_fd(), EXCLUSIVE | AT_ONCE) } != 0 {
            return Err(io::Error::other("another running program has it: end that, or write another name"));
        }
        match usize::try_from(metadata.len()) {
            Ok(0) => fill(&file, size)?,
            Ok(it) if it == size => {}
            _ => {
                return Err(io::Error::other(
                    "it is not a process image of this version: remove it, or write another name",
                ));
            }
        }
        let mapping = Self::of(&file, size)?;
        // The lock is the open file's, and as long as the process's.
        std::mem::forget(file);
        Ok(mapping)
    }

    fn of(file: &File, size: usize) -> io::Result<Self> {
        // SAFETY: it makes a mapping at a place that the system picks; the descriptor is open.
        let base = unsafe { mmap(core::ptr::null_mut(), size, READ_AND_WRITE, SHARED, file.as_raw_fd(), 0) };
        match base as usize {
            FAILED => Err(io::Error::last_os_error()),
            _ => Ok(Self { base: base.cast(), size }),
        }
    }

    /// # Panics
    /// If a number of this size is not within the memory, or is not aligned.
    fn at<T>(self, position: usize) -> *mut T {
        assert!(position % align_of::<T>() == 0 && position + size_of::<T>() <= self.size, "{position}");
        self.base.wrapping_add(position).cast()
    }

    fn byte(self, position: usize) -> &'static AtomicU8 {
        // SAFETY: `at` has checked the place, and the mapping is never removed.
        unsafe { AtomicU8::from_ptr(self.at(position)) }
    }

    fn word(self, position: usize) -> &'static AtomicU16 {
        // SAFETY: as in `byte`; a mapping begins at a page, so what is aligned in it is aligned.
        unsafe { AtomicU16::from_ptr(self.at(position)) }
    }

    pub fn double(self, position: usize) -> &'static AtomicU32 {
        // SAFETY: as in `word`.
        unsafe { AtomicU32::from_ptr(self.at(position)) }
    }

    pub fn long(self, position: usize) -> &'static AtomicU64 {
        // SAFETY: as in `word`.
        unsafe { AtomicU64::from_ptr(self.at(position)) }
    }

    /// The value there. A bit is a byte that is 0 or 1, and any other is read as 1.
    pub fn load(self, width: Width, position: usize) -> u64 {
        match width {
            Width::Bit => u64::from(self.byte(position).load(Relaxed) != 0),
            Width::Byte => self.byte(position).load(Relaxed).into(),
            Width::Word => self.word(position).load(Relaxed).into(),
            Width::Double => self.double(position).load(Relaxed).into(),
            Width::Long => self.long(position).load(Relaxed),
        }
    }

    pub fn store(self, width: Width, position: usize, value: u64) {
        match width {
            Width::Bit | Width::Byte => self.byte(position).store(value as u8, Relaxed),
            Width::Word => self.word(position).store(value as u16, Relaxed),
            Width::Double => self.double(position).store(value as u32, Relaxed),
            Width::Long => self.long(position).store(value, Relaxed),
        }
    }

    /// Stores a value if the present one is `old`; `false` if it is not.
    pub fn replace(self, width: Width, position: usize, old: u64, new: u64) -> bool {
        match width {
            Width::Bit => self.replace_bit(position, old, new),
            Width::Byte => exchanged(self.byte(position).compare_exchange(old as u8, new as u8, Relaxed, Relaxed)),
            Width::Word => exchanged(self.word(position).compare_exchange(old as u16, new as u16, Relaxed, Relaxed)),
            Width::Double => {
                exchanged(self.double(position).compare_exchange(old as u32, new as u32, Relaxed, Relaxed))
            }
            Width::Long => exchanged(self.long(position).compare_exchange(old, new, Relaxed, Relaxed)),
        }
    }

    /// Any byte but 0 is a 1.
    fn replace_bit(self, position: usize, old: u64, new: u64) -> bool {
        let byte = self.byte(position);
        let there = byte.load(Relaxed);
        u64::from(there != 0) == old && exchanged(byte.compare_exchange(there, new as u8, Relaxed, Relaxed))
    }
}

/// Writes zeros, so that a folder without room is an error now, and not the end of the process at the first access.
fn fill(mut file: &File, size: usize) -> io::Result<()> {
    let written = file.write_all(&vec![0; size]);
    if written.is_err() {
        let _ = file.set_len(0);
    }
    written
}

fn exchanged<T>(result: Result<T, T>) -> bool {
    result.is_ok()
}
