//! What frames of a serial line are sent by and received from.

use std::io;
use std::time::Instant;

/// A serial line as bytes.
pub(crate) trait Port {
    fn send(&mut self, bytes: &[u8], until: Instant) -> io::Result<()>;
    /// Some bytes, as soon as there are any; 0 if there are none until then. Bytes that came before are returned at once.
    fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<usize>;
}
