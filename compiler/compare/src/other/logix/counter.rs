//! A counter block, and what stands for it in Logix.

use staunch_frontend::Dialect;
use staunch_runtime::{BlockInfo, Direction as PinDirection, Elementary, PinRole};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Up,
    Down,
    Both,
}

/// A counter, as the program declares it.
#[derive(Clone, Copy, Debug)]
pub struct Counter {
    pub block: &'static BlockInfo,
    /// The structure that its instructions work on.
    pub tag: &'static BlockInfo,
    pub direction: Direction,
    /// What its count is converted with: Logix counts in DINT.
    pub narrow: Option<&'static str>,
}

/// The types of counts that a COUNTER can hold, and what makes one of its count.
const NARROWED: [(Elementary, Option<&str>); 4] = [
    (Elementary::Dint, None),
    (Elementary::Int, Some("DINT_TO_INT")),
    (Elementary::Sint, Some("DINT_TO_SINT")),
    (Elementary::Word, Some("DINT_TO_WORD")),
];

impl Counter {
    pub fn named(name: &str, from: Dialect) -> Option<Self> {
        let block = from.block(name)?;
        let count = block.pin_for(PinRole::Count).filter(|it| it.direction == PinDirection::Output)?;
        let direction = match (block.pin_for(PinRole::Up), block.pin_for(PinRole::Down)) {
            (Some(_), None) => Direction::Up,
            (None, Some(_)) => Direction::Down,
            (Some(_), Some(_)) => Direction::Both,
            (None, None) => return None,
        };
        // What is wider than a COUNTER, or unsigned, is not the same thing.
        let (_, narrow) = NARROWED.into_iter().find(|it| it.0 == count.ty)?;
        let tag = Dialect::Logix.block(if direction == Direction::Both { "FBD_COUNTER" } else { "COUNTER" })?;
        Some(Self { block, tag, direction, narrow })
    }

    /// The member of the COUNTER or FBD_COUNTER that stands for a pin, if one does.
    pub fn member(self, pin: &str) -> Option<&'static str> {
        self.tag.pin_for(self.block.pin(pin)?.role?).map(|it| it.name)
    }

    /// Whether an output says that nothing is left, `CV <= 0`: QD, and Q of a CTD. No flag of Logix is that; DN of its
    /// CTD is TRUE while ACC >= PRE.
    pub fn is_empty(self, pin: &str) -> bool {
        match self.block.pin(pin).and_then(|it| it.role) {
            Some(PinRole::Empty) => true,
            Some(PinRole::Done) => self.direction == Direction::Down,
            _ => false,
        }
    }

    /// Whether an output says that the preset is reached: QU, and Q of a CTU.
    pub fn is_done(self, pin: &str) -> bool {
        self.direction != Direction::Down && self.block.pin(pin).is_some_and(|it| it.role == Some(PinRole::Done))
    }

    /// What an argument at this position is for; after the inputs, the variable that keeps the count.
    pub fn input_at(self, at: usize) -> Option<Input> {
        match self.block.inputs().nth(at) {
            Some(pin) => pin.role.map(Input::Pin),
            None => self.block.facts.kept.filter(|_| at == self.block.inputs().count()).map(|_| Input::Kept),
        }
    }

    pub fn input_named(self, name: &str) -> Option<Input> {
        let kept = self.block.facts.kept.filter(|it| it.pin.eq_ignore_ascii_case(name));
        kept.map(|_| Input::Kept).or_else(|| PinRole::named(name).map(Input::Pin))
    }
}

/// What is given in a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    Pin(PinRole),
    /// The variable that keeps the count.
    Kept,
}
