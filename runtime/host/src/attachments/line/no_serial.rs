//! Systems other than Linux: no serial port can be opened.

use super::port::Port;
use crate::remote::Line;
use std::io;
use std::time::Instant;

/// One that there is none of.
#[derive(Debug)]
pub(crate) enum Serial {}

impl Serial {
    pub fn open(_: &Line) -> io::Result<Self> {
        Err(io::Error::new(io::ErrorKind::Unsupported, "only on Linux are serial ports read and written"))
    }
}

impl Port for Serial {
    fn send(&mut self, _: &[u8], _: Instant) -> io::Result<()> {
        match *self {}
    }

    fn receive(&mut self, _: &mut [u8], _: Instant) -> io::Result<usize> {
        match *self {}
    }
}
