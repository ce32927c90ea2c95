//! One instance that is computed as another block would: what a difference between two blocks comes to in a program.

use staunch_runtime::{BlockInfo, Context, Direction, Pin, PinRole, Value};

/// The instance, and what computes it.
#[derive(Debug)]
pub(super) struct Exchange {
    offset: usize,
    own: &'static BlockInfo,
    other: &'static BlockInfo,
    initial: Vec<u8>,
    bytes: Vec<u8>,
    /// The other one is not run: it has been, and its state is given before each scan.
    is_given: bool,
    /// Every number had its value in the pin that it was given to.
    pub fits: bool,
}

impl Exchange {
    pub fn new(offset: usize, [own, other]: [&'static BlockInfo; 2], bytes: &[u8], is_given: bool) -> Self {
        Self { offset, own, other, initial: bytes.to_vec(), bytes: bytes.to_vec(), is_given, fits: true }
    }

    /// What the other one has at the end of the scan that comes.
    pub fn give(&mut self, bytes: &[u8]) {
        self.bytes.copy_from_slice(bytes);
    }

    /// After an event, of which `keeps` says what it leaves of the bytes.
    pub fn restart(&mut self, memory: &mut [u8], keeps: &dyn Fn(usize) -> bool) {
        for (at, (byte, initial)) in self.bytes.iter_mut().zip(&self.initial).enumerate() {
            if !keeps(at) {
                *byte = *initial;
            }
        }
        let own = &mut memory[self.offset..self.offset + self.own.size];
        self.fits &= carry([self.other, self.own], is_output, &self.bytes, own);
    }

    /// After a call of the block at an offset of the memory.
    pub fn compute(&mut self, memory: &mut [u8], offset: usize, cx: &Context) {
        if offset != self.offset {
            return;
        }
        let bytes = &mut memory[offset..offset + self.own.size];
        if self.is_given {
            self.fits &= carry([self.other, self.own], shows, &self.bytes, bytes);
            return;
        }
        self.fits &= carry([self.own, self.other], is_input, bytes, &mut self.bytes);
        if let Some(instruction) = self.other.instructions.first() {
            (instruction.run)(&mut self.bytes, cx, true);
        }
        self.fits &= carry([self.other, self.own], is_output, &self.bytes, bytes);
    }
}

fn is_input(pin: &Pin) -> bool {
    pin.direction == Direction::Input
}

fn is_output(pin: &Pin) -> bool {
    pin.direction == Direction::Output
}

/// Whether it is what a counter shows: the members of a structure are not outputs.
fn shows(pin: &Pin) -> bool {
    matches!(pin.role, Some(PinRole::Count | PinRole::Done | PinRole::Empty))
}

/// Carries pins from one block to another. Whether every number has its value there, and not only its bits.
fn carry([from, to]: [&BlockInfo; 2], which: fn(&Pin) -> bool, source: &[u8], target: &mut [u8]) -> bool {
    let mut fits = true;
    let pins = to.pins.iter().filter(|it| which(it));
    let of_role = |pin: &Pin| from.pin_for(pin.role?);
    let pair = |pin: &'static Pin| Some((pin, of_role(pin).or_else(|| from.pin(pin.name))?));
    for (pin, given) in pins.filter_map(pair) {
        let value = Value::read(given.repr(), &source[given.offset..]);
        let value = match value.as_integer() {
            Some(number) => pin.repr().integer(number).or_else(|| {
                fits = false;
                pin.repr().integer(wrapped(pin, number))
            }),
            None => Some(value),
        };
        if let Some(value) = value.filter(|it| it.repr() == pin.repr()) {
            value.write(&mut target[pin.offset..]);
        }
    }
    fits
}

/// The number with the same bits.
fn wrapped(pin: &Pin, number: i128) -> i128 {
    let Some((least, greatest)) = pin.repr().range() else { return number };
    (number - least).rem_euclid(greatest - least + 1) + least
}
