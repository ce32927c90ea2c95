//! Lines of Linux, by the character devices of its GPIO chips.
//!
//! The functions are declared here, and not taken from a crate: the command compiles this one with rustc alone.

mod abi;

use super::group::Group;
use super::lines::{Chips, Lines};
use crate::attachments::emergency::{self, Guarded};
use crate::pin::{Bias, PinLine};
use abi::{Attribute, ChipInfo, Config, ConfigAttribute, LineInfo, Request, Values};
use core::ffi::{c_int, c_ulong};
use std::fs::File;
use std::io::{self, ErrorKind};
use std::os::fd::{AsRawFd as _, FromRawFd as _};
use std::path::Path;

#[cfg(target_env = "musl")]
type Operation = c_int;
#[cfg(not(target_env = "musl"))]
type Operation = c_ulong;

unsafe extern "C" {
    fn ioctl(descriptor: c_int, operation: Operation, ...) -> c_int;
}

const FOLDER: &str = "/dev";
/// Who has a line, as the kernel shows it.
const CONSUMER: &[u8] = b"staunch";

pub(super) struct Kernel;

/// Lines that this process has until it is closed.
struct Requested(File);

impl Chips for Kernel {
    fn open(&self, group: &Group) -> Result<Box<dyn Lines>, String> {
        let path = Path::new(FOLDER).join(&group.chip);
        let chip = File::options().read(true).write(true).open(&path).map_err(|it| not_opened(&it))?;
        let mut info = ChipInfo { name: [0; abi::NAME], label: [0; abi::NAME], lines: 0 };
        // SAFETY: the operation fills a structure of this size, which it has in its number.
        unsafe { call(&chip, abi::CHIP_INFO, &raw mut info) }.map_err(|_| "it is not a GPIO chip".to_owned())?;
        let offsets: Result<Vec<u32>, String> =
            group.lines.iter().map(|it| offset(&chip, info.lines, &it.line)).collect();
        let offsets = offsets?;
        let mut request = request(group, &offsets);
        // SAFETY: as above; it reads the structure, too.
        let requested = unsafe { call(&chip, abi::REQUEST, &raw mut request) };
        requested.map_err(|it| not_requested(&chip, &offsets, &it))?;
        // SAFETY: the kernel has opened it for this call, and nobody else has it.
        Ok(Box::new(Requested(unsafe { File::from_raw_fd(request.descriptor) })))
    }
}

impl Lines for Requested {
    fn read(&mut self) -> io::Result<u64> {
        let mut values = Values { bits: 0, mask: u64::MAX };
        // SAFETY: the operation reads and fills a structure of this size, which it has in its number.
        unsafe { call(&self.0, abi::GET_VALUES, &raw mut values) }.map(|()| values.bits)
    }

    fn write(&mut self, bits: u64) -> io::Result<()> {
        let mut values = Values { bits, mask: u64::MAX };
        // SAFETY: the operation reads a structure of this size, which it has in its number.
        unsafe { call(&self.0, abi::SET_VALUES, &raw mut values) }
    }

    fn guard(&self, bits: u64, mask: u64) -> bool {
        emergency::add_lines(Guarded { set, descriptor: self.0.as_raw_fd(), bits, mask })
    }
}

/// Sets lines once, whatever comes of it: a handler of a signal may call it.
fn set(descriptor: c_int, bits: u64, mask: u64) {
    let mut values = Values { bits, mask };
    // SAFETY: the operation reads a structure of this size; with a descriptor that is closed, it does nothing.
    unsafe { ioctl(descriptor, abi::SET_VALUES as Operation, &raw mut values) };
}

/// # Safety
/// The operation has the size of what it reads and fills in its number, which is to be that of the structure.
unsafe fn call<T>(file: &File, operation: u32, structure: *mut T) -> io::Result<()> {
    loop {
        // SAFETY: as the caller promises; the descriptor is open.
        if unsafe { ioctl(file.as_raw_fd(), operation as Operation, structure) } >= 0 {
            return Ok(());
        }
        let error = io::Error::last_os_error();
        if error.kind() != ErrorKind::Interrupted {
            return Err(error);
        }
    }
}

fn request(group: &Group, offsets: &[u32]) -> Request {
    let mut request = Request {
        offsets: [0; abi::LINES],
        consumer: [0; abi::NAME],
        config: config(group),
        lines: offsets.len() as u32,
        buffer: 0,
        padding: [0; 5],
        descriptor: -1,
    };
    request.offsets[..offsets.len()].copy_from_slice(offsets);
    request.consumer[..CONSUMER.len()].copy_from_slice(CONSUMER);
    request
}

fn config(group: &Group) -> Config {
    let direction = if group.is_output { abi::OUTPUT } else { abi::INPUT };
    let level = if group.active_low { abi::ACTIVE_LOW } else { 0 };
    let bias = match group.bias {
        Bias::AsIs => 0,
        Bias::PullUp => abi::PULL_UP,
        Bias::PullDown => abi::PULL_DOWN,
        Bias::Disabled => abi::NO_BIAS,
    };
    let mut config = Config { flags: direction | level | bias, ..Config::default() };
    let mut add = |attribute| {
        let mask = u64::MAX >> (abi::LINES - group.lines.len());
        config.all[config.attributes as usize] = ConfigAttribute { attribute, mask };
        config.attributes += 1;
    };
    if group.is_output {
        let initial = group.lines.iter().enumerate().fold(0, |bits, (at, it)| bits | u64::from(it.initial) << at);
        add(Attribute::of_bits(abi::OUTPUT_VALUES, initial));
    }
    if let Some(time) = group.debounce {
        add(Attribute::of_time(abi::DEBOUNCE, time.as_micros().try_into().unwrap_or(u32::MAX)));
    }
    config
}

fn info(chip: &File, offset: u32) -> io::Result<LineInfo> {
    let mut info = LineInfo {
        name: [0; abi::NAME],
        consumer: [0; abi::NAME],
        offset,
        attributes: 0,
        flags: 0,
        all: [Attribute::default(); abi::ATTRIBUTES],
        padding: [0; 4],
    };
    // SAFETY: the operation reads and fills a structure of this size, which it has in its number.
    unsafe { call(chip, abi::LINE_INFO, &raw mut info) }.map(|()| info)
}

/// The number of a line on its chip.
fn offset(chip: &File, count: u32, line: &PinLine) -> Result<u32, String> {
    let name = match line {
        PinLine::Number(number) if *number < count => return Ok(*number),
        PinLine::Number(number) => {
            return Err(format!("it has {count} lines, from 0 on, and none with number {number}"));
        }
        PinLine::Name(name) => name,
    };
    let is_it = |at: &u32| info(chip, *at).is_ok_and(|it| text(&it.name) == *name);
    (0..count).find(is_it).ok_or_else(|| format!("no line of it is named \"{name}\": `gpioinfo` shows their names"))
}

/// Up to its zero.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|it| *it == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

fn not_opened(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => {
            let found = chips();
            let found = if found.is_empty() {
                "this machine has none".to_owned()
            } else {
                format!("there are {}", found.join(", "))
            };
            format!("no such chip: {found}")
        }
        ErrorKind::PermissionDenied => {
            "this user may not open it: add the user to its group, which is often `gpio`: sudo usermod -aG gpio USER"
                .to_owned()
        }
        _ => format!("it cannot be opened: {error}"),
    }
}

fn chips() -> Vec<String> {
    let all = std::fs::read_dir(FOLDER).into_iter().flatten().flatten();
    let names = all.filter_map(|it| it.file_name().into_string().ok()).filter(|it| it.starts_with("gpiochip"));
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

fn not_requested(chip: &File, offsets: &[u32], error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::ResourceBusy => {
            let used = |at: &u32| info(chip, *at).ok().filter(|it| it.flags & abi::USED != 0);
            match offsets.iter().find_map(used) {
                Some(it) => {
                    format!("line {} is used by \"{}\": end that, or use another line", it.offset, text(&it.consumer))
                }
                None => "a line is used by another program or a driver: `gpioinfo` shows by which".to_owned(),
            }
        }
        ErrorKind::InvalidInput => {
            "the kernel refuses the settings: the chip's driver may lack `bias`, or drive a line in one direction only"
                .to_owned()
        }
        // The interface is older than version 2.
        _ if error.raw_os_error() == Some(NO_SUCH_OPERATION) => "it needs Linux 5.10 or later".to_owned(),
        _ => format!("its lines cannot be requested: {error}"),
    }
}

/// `ENOTTY`
const NO_SUCH_OPERATION: i32 = 25;

#[cfg(test)]
mod tests;
