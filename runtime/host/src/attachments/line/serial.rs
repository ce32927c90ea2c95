//! A serial port of Linux: bytes as they are, at a rate, a parity and stop bits.
//!
//! The functions are declared here, and not taken from a crate: the command compiles this one with rustc alone. The kernel's own
//! structure (`termios2`) has any rate as a number; that of the C library has only some.

use super::port::Port;
use crate::remote::{Line, Parity};
use core::ffi::{c_int, c_short, c_ulong};
use std::fs::File;
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::os::fd::AsRawFd as _;
use std::os::unix::fs::OpenOptionsExt as _;
use std::thread;
use std::time::Instant;

/// The terminal of the process stays what it is.
const NO_TERMINAL: c_int = 0o400;
/// Opening does not wait for a modem, nor reading for bytes.
const NO_WAITING: c_int = 0o4000;
const EXCLUSIVE: c_int = 2;
const AT_ONCE: c_int = 4;

const GET_SETTINGS: u32 = 0x802C_542A;
const SET_SETTINGS: u32 = 0x402C_542B;
const DROP: u32 = 0x540B;
const RECEIVED: c_int = 0;

/// A break is not a byte.
const IGNORE_BREAK: u32 = 1;
/// A byte with a wrong parity is read as 0; the CRC is then wrong.
const CHECK_PARITY: u32 = 0o20;
const EIGHT_BITS: u32 = 0o60;
const TWO_STOP_BITS: u32 = 0o100;
const RECEIVE: u32 = 0o200;
const WITH_PARITY: u32 = 0o400;
const ODD: u32 = 0o1000;
/// No modem has to be there.
const LOCAL: u32 = 0o4000;
/// The rate is the number.
const ANY_RATE: u32 = 0o10000;
/// The place of the least count of bytes that a read returns.
const LEAST: usize = 6;

const READABLE: c_short = 1;
const WRITABLE: c_short = 4;

#[cfg(target_env = "musl")]
type Operation = c_int;
#[cfg(not(target_env = "musl"))]
type Operation = c_ulong;

/// `termios2`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
struct Settings {
    input: u32,
    output: u32,
    control: u32,
    local: u32,
    discipline: u8,
    characters: [u8; 19],
    input_rate: u32,
    output_rate: u32,
}

/// `pollfd`.
#[repr(C)]
struct Awaited {
    descriptor: c_int,
    events: c_short,
    found: c_short,
}

unsafe extern "C" {
    fn ioctl(descriptor: c_int, operation: Operation, ...) -> c_int;
    fn flock(descriptor: c_int, operation: c_int) -> c_int;
    fn poll(all: *mut Awaited, count: c_ulong, milliseconds: c_int) -> c_int;
}

#[derive(Debug)]
pub(crate) struct Serial(File);

impl Serial {
    /// Opens the port, which this process alone then has locked.
    pub fn open(line: &Line) -> io::Result<Self> {
        let mut options = File::options();
        let file = options.read(true).write(true).custom_flags(NO_TERMINAL | NO_WAITING).open(&line.port);
        let file = file.map_err(|it| explained(&it))?;
        // SAFETY: it takes any numbers; the descriptor is open.
        if unsafe { flock(file.as_raw_fd(), EXCLUSIVE | AT_ONCE) } != 0 {
            return Err(io::Error::other("another running program has the port"));
        }
        let mut settings = Settings::default();
        // SAFETY: the operation fills a structure of this size, which it has in its number.
        let is_serial = unsafe { ioctl(file.as_raw_fd(), GET_SETTINGS as Operation, &raw mut settings) } == 0;
        if !is_serial {
            return Err(io::Error::other("it is not a serial port"));
        }
        let settings = Settings::of(line, settings.discipline);
        // SAFETY: the operation reads a structure of this size, which it has in its number.
        if unsafe { ioctl(file.as_raw_fd(), SET_SETTINGS as Operation, &raw const settings) } != 0 {
            let error = io::Error::last_os_error();
            return Err(io::Error::other(format!("the port does not take {}: {error}", line.settings())));
        }
        // SAFETY: it takes any numbers.
        unsafe { ioctl(file.as_raw_fd(), DROP as Operation, RECEIVED) };
        Ok(Self(file))
    }

    /// Waits until the port can be read or written, or then. A port that has gone can be: the call then has its error.
    fn wait(&self, events: c_short, until: Instant) -> io::Result<bool> {
        let left = until.saturating_duration_since(Instant::now());
        let milliseconds = left.as_millis().try_into().unwrap_or(c_int::MAX);
        let mut awaited = Awaited { descriptor: self.0.as_raw_fd(), events, found: 0 };
        // SAFETY: one structure, as the count says, which lives until the call is over.
        match unsafe { poll(&raw mut awaited, 1, milliseconds) } {
            0 if left.is_zero() => Ok(false),
            0 => {
                // Between frames, a millisecond is long: the rest of one is slept.
                thread::sleep(until.saturating_duration_since(Instant::now()));
                self.wait(events, until)
            }
            1 => Ok(true),
            _ => match io::Error::last_os_error() {
                error if error.kind() == ErrorKind::Interrupted => Ok(true),
                error => Err(error),
            },
        }
    }
}

impl Settings {
    fn of(line: &Line, discipline: u8) -> Self {
        let parity = match line.parity {
            Parity::None => 0,
            Parity::Even => WITH_PARITY,
            Parity::Odd => WITH_PARITY | ODD,
        };
        let stop_bits = if line.stop_bits == 2 { TWO_STOP_BITS } else { 0 };
        let mut characters = [0; 19];
        characters[LEAST] = 1;
        Self {
            input: IGNORE_BREAK | if parity == 0 { 0 } else { CHECK_PARITY },
            control: EIGHT_BITS | RECEIVE | LOCAL | ANY_RATE | parity | stop_bits,
            discipline,
            characters,
            input_rate: line.baud_rate,
            output_rate: line.baud_rate,
            ..Self::default()
        }
    }
}

fn is_for_later(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

impl Port for Serial {
    fn send(&mut self, bytes: &[u8], until: Instant) -> io::Result<()> {
        let mut sent = 0;
        while sent < bytes.len() {
            match self.0.write(&bytes[sent..]) {
                Ok(count) => sent += count,
                Err(error) if is_for_later(&error) => {
                    if !self.wait(WRITABLE, until)? {
                        return Err(ErrorKind::TimedOut.into());
                    }
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<usize> {
        loop {
            match self.0.read(buffer) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(count) => return Ok(count),
                Err(error) if is_for_later(&error) => {
                    if !self.wait(READABLE, until)? {
                        return Ok(0);
                    }
                }
                Err(error) => return Err(error),
            }
        }
    }
}

fn explained(error: &io::Error) -> io::Error {
    match error.kind() {
        ErrorKind::NotFound => io::Error::other("no such port"),
        ErrorKind::PermissionDenied => {
            io::Error::other("this user may not open the port: add the user to its group, which is often `dialout`")
        }
        _ => io::Error::other(format!("the port cannot be opened: {error}")),
    }
}
