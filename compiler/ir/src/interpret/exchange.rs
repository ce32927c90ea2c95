//! One instance that is computed as another block would: what a difference between two blocks comes to in a program.

use staunch_runtime::{BlockInfo, Context, Direction, Pin, Value};

/// The instance, and what computes it.
#[derive(Debug)]
pub(super) struct Exchange {
    offset: usize,
    own: &'static BlockInfo,
    other: &'static BlockInfo,
    initial: Vec<u8>,
    bytes: Vec<u8>,
    /// Every number had its value in the pin that it was given to.
    pub fits: bool,
}

impl Exchange {
    pub fn new(offset: usize, [own, other]: [&'static BlockInfo; 2], bytes: &[u8]) -> Self {
        Self { offset, own, other, initial: bytes.to_vec(), bytes: bytes.to_vec(), fits: true }
    }

    /// After an event, of which `keeps` says what it leaves of the bytes.
    pub fn restart(&mut self, memory: &mut [u8], keeps: &dyn Fn(usize) -> bool) {
        for (at, (byte, initial)) in self.bytes.iter_mut().zip(&self.initial).enumerate() {
            if !keeps(at) {
                *byte = *initial;
            }
        }
        let own = &mut memory[self.offset..self.offset + self.own.size];
        self.fits &= carry([self.other, self.own], Direction::Output, &self.bytes, own);
    }

    /// After a call of the block at an offset of the memory.
    pub fn compute(&mut self, memory: &mut [u8], offset: usize, cx: &Context) {
        if offset != self.offset {
            return;
        }
        let bytes = &mut memory[offset..offset + self.own.size];
        self.fits &= carry([self.own, self.other], Direction::Input, bytes, &mut self.bytes);
        if let Some(instruction) = self.other.instructions.first() {
            (instruction.run)(&mut self.bytes, cx, true);
        }
        self.fits &= carry([self.other, self.own], Direction::Output, &self.bytes, bytes);
    }
}

/// Carries pins from one block to another. Whether every number has its value there, and not only its bits.
fn carry([from, to]: [&BlockInfo; 2], direction: Direction, source: &[u8], target: &mut [u8]) -> bool {
    let mut fits = true;
    let pins = to.pins.iter().filter(|it| it.direction == direction);
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
