//! What the kernel has in `linux/gpio.h`, version 2 of its interface to lines (from Linux 5.10 on).

/// Bytes of a name.
pub const NAME: usize = 32;
pub const LINES: usize = 64;
pub const ATTRIBUTES: usize = 10;

pub const CHIP_INFO: u32 = 0x8044_B401;
pub const LINE_INFO: u32 = 0xC100_B405;
pub const REQUEST: u32 = 0xC250_B407;
pub const GET_VALUES: u32 = 0xC010_B40E;
pub const SET_VALUES: u32 = 0xC010_B40F;

pub const USED: u64 = 1;
pub const ACTIVE_LOW: u64 = 1 << 1;
pub const INPUT: u64 = 1 << 2;
pub const OUTPUT: u64 = 1 << 3;
pub const PULL_UP: u64 = 1 << 8;
pub const PULL_DOWN: u64 = 1 << 9;
pub const NO_BIAS: u64 = 1 << 10;

pub const OUTPUT_VALUES: u32 = 2;
pub const DEBOUNCE: u32 = 3;

/// `gpiochip_info`
#[repr(C)]
pub struct ChipInfo {
    pub name: [u8; NAME],
    pub label: [u8; NAME],
    pub lines: u32,
}

/// `gpio_v2_line_attribute`. Its value is 64 bits, or the 32 of a time in microseconds, which are those at the same place.
#[repr(C, align(8))]
#[derive(Clone, Copy, Default)]
pub struct Attribute {
    pub id: u32,
    pub padding: u32,
    pub value: [u32; 2],
}

/// `gpio_v2_line_config_attribute`
#[repr(C, align(8))]
#[derive(Clone, Copy, Default)]
pub struct ConfigAttribute {
    pub attribute: Attribute,
    pub mask: u64,
}

/// `gpio_v2_line_config`
#[repr(C, align(8))]
#[derive(Clone, Copy, Default)]
pub struct Config {
    pub flags: u64,
    pub attributes: u32,
    pub padding: [u32; 5],
    pub all: [ConfigAttribute; ATTRIBUTES],
}

/// `gpio_v2_line_request`
#[repr(C, align(8))]
pub struct Request {
    pub offsets: [u32; LINES],
    pub consumer: [u8; NAME],
    pub config: Config,
    pub lines: u32,
    pub buffer: u32,
    pub padding: [u32; 5],
    pub descriptor: i32,
}

/// `gpio_v2_line_info`
#[repr(C, align(8))]
#[derive(Clone, Copy)]
pub struct LineInfo {
    pub name: [u8; NAME],
    pub consumer: [u8; NAME],
    pub offset: u32,
    pub attributes: u32,
    pub flags: u64,
    pub all: [Attribute; ATTRIBUTES],
    pub padding: [u32; 4],
}

/// `gpio_v2_line_values`
#[repr(C, align(8))]
#[derive(Clone, Copy, Default)]
pub struct Values {
    pub bits: u64,
    pub mask: u64,
}

impl Attribute {
    /// Of 64 bits, in the order of the machine.
    pub fn of_bits(id: u32, bits: u64) -> Self {
        let [low, high] = [bits as u32, (bits >> 32) as u32];
        Self { id, padding: 0, value: if cfg!(target_endian = "big") { [high, low] } else { [low, high] } }
    }

    pub fn of_time(id: u32, microseconds: u32) -> Self {
        Self { id, padding: 0, value: [microseconds, 0] }
    }
}
