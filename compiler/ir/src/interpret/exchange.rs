//! One instance that is computed as another block would: what a difference between two blocks comes to in a program.

use super::Interpreter;
use staunch_runtime::{BlockInfo, Context, Direction, Pin, Value};

/// The instance, and what computes it.
#[derive(Debug)]
pub(super) struct Exchange {
    offset: usize,
    own: &'static BlockInfo,
    other: &'static BlockInfo,
    bytes: Vec<u8>,
}

impl Interpreter<'_> {
    /// From now on the block at an offset gives what another one does, which begins as `bytes` say. Their pins are matched by
    /// what they are for. Both are function blocks: of an instruction's structure nothing is exchanged.
    pub fn compute_as(&mut self, offset: usize, [own, other]: [&'static BlockInfo; 2], bytes: &[u8]) {
        self.exchange = Some(Exchange { offset, own, other, bytes: bytes.to_vec() });
    }

    /// After a call of a block at an offset.
    pub(super) fn exchanged(&mut self, offset: usize, cx: &Context) {
        let Some(it) = self.exchange.as_mut().filter(|it| it.offset == offset) else { return };
        let bytes = &mut self.memory[offset..offset + it.own.size];
        carry([it.own, it.other], Direction::Input, bytes, &mut it.bytes);
        if let Some(instruction) = it.other.instructions.first() {
            (instruction.run)(&mut it.bytes, cx, true);
        }
        carry([it.other, it.own], Direction::Output, &it.bytes, bytes);
    }
}

/// Carries pins from one block to another.
fn carry([from, to]: [&BlockInfo; 2], direction: Direction, source: &[u8], target: &mut [u8]) {
    let pins = to.pins.iter().filter(|it| it.direction == direction);
    let pair = |pin: &'static Pin| Some((pin, from.pin_for(pin.role?)?));
    for (pin, given) in pins.filter_map(pair) {
        let value = Value::read(given.repr(), &source[given.offset..]);
        let value = match value.as_integer() {
            Some(number) => pin.repr().integer(number).or_else(|| pin.repr().integer(wrapped(pin, number))),
            None => Some(value),
        };
        if let Some(value) = value.filter(|it| it.repr() == pin.repr()) {
            value.write(&mut target[pin.offset..]);
        }
    }
}

/// The number with the same bits.
fn wrapped(pin: &Pin, number: i128) -> i128 {
    let Some((least, greatest)) = pin.repr().range() else { return number };
    (number - least).rem_euclid(greatest - least + 1) + least
}
