//! What reads and writes lines: the kernel, or a test.

use super::group::Group;
use std::io;

/// Lines of one chip that were requested together. A bit is a line, the first the lowest; 1 is active.
pub(super) trait Lines: Send {
    fn read(&mut self) -> io::Result<u64>;
    fn write(&mut self, bits: u64) -> io::Result<()>;
    /// From now on, the lines that `mask` has take these bits if the process is ended in the middle of a scan. `false` where too many do.
    fn guard(&self, bits: u64, mask: u64) -> bool;
}

/// What has lines.
pub(super) trait Chips {
    /// An error says what is wrong, and what to do.
    fn open(&self, group: &Group) -> Result<Box<dyn Lines>, String>;
}
