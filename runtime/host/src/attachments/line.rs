//! A serial line: its port, and the frames of Modbus RTU on it.

mod frame;
mod port;

#[cfg(target_os = "linux")]
mod serial;
#[cfg(not(target_os = "linux"))]
#[path = "line/no_serial.rs"]
mod serial;

pub(super) use frame::{LEAST, MOST, PAUSE, Timing, close, first_whole, is_whole};
pub(super) use port::Port;
pub(super) use serial::Serial;
