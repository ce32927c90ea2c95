//! What is new about a state: a value of a BOOL or an enumeration, a number's place among the
//! program's constants, a count against its preset, how the two systems differ.

use crate::pair::Pair;
use crate::program::scalar::Role;
use staunch_ir::{Repr, Value};
use staunch_runtime::PinRole;
use std::cmp::Ordering;
use std::collections::{BTreeSet, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};

/// Respects that are looked at.
const MAX_RESPECTS: usize = 4096;

/// Something about a state that has few values.
#[derive(Clone, Copy, Debug)]
enum Respect {
    /// A scalar on one side.
    Value { side: usize, offset: usize, repr: Repr },
    /// The count against the preset, on one side.
    Preset { side: usize, count: usize, preset: usize, repr: Repr },
    /// A number on one side against that of the other.
    Sides { offsets: [usize; 2], reprs: [Repr; 2] },
}

#[derive(Debug)]
pub struct Novelty {
    respects: Vec<Respect>,
    limits: Vec<i128>,
    /// Values of single respects.
    values: HashSet<(usize, u64)>,
    /// Of all together.
    whole: HashSet<u64>,
    scratch: Vec<u64>,
}

impl Novelty {
    pub fn of(pair: &Pair, constants: &BTreeSet<i128>) -> Self {
        let mut respects = Vec::new();
        for [a, b] in pair.matched(|it| matches!(it.role, Role::Output(_))) {
            let scalars = [pair.scalar(0, a), pair.scalar(1, b)];
            let reprs = [0, 1].map(|side| pair.sides[side].program.repr(scalars[side].ty));
            if let [Some(x), Some(y)] = reprs {
                respects.push(Respect::Sides { offsets: scalars.map(|it| it.offset), reprs: [x, y] });
            }
        }
        for (number, side) in pair.sides.iter().enumerate() {
            for block in &side.scalars.blocks {
                let pin = |role| block.block.info().pin_for(role);
                if let (Some(count), Some(preset)) = (pin(PinRole::Count), pin(PinRole::Preset)) {
                    let (count, preset, repr) =
                        (block.offset + count.offset, block.offset + preset.offset, count.repr());
                    respects.push(Respect::Preset { side: number, count, preset, repr });
                }
            }
            for scalar in &side.scalars.all {
                let repr =
                    side.program.repr(scalar.ty).filter(|_| matches!(scalar.role, Role::Variable | Role::Output(_)));
                respects.extend(repr.map(|repr| Respect::Value { side: number, offset: scalar.offset, repr }));
            }
        }
        respects.truncate(MAX_RESPECTS);
        let limits = constants.iter().copied().collect();
        Self { respects, limits, values: HashSet::new(), whole: HashSet::new(), scratch: Vec::new() }
    }

    /// How much is new about the state that the pair is in: 0 where the systems differ
    /// as never before, 1 for another respect, 2 for a combination; `None` if nothing is.
    pub fn rank(&mut self, pair: &Pair, inputs: &[Value]) -> Option<usize> {
        let states = pair.states();
        self.scratch.clear();
        for respect in &self.respects {
            let value = respect.value(states, &self.limits);
            self.scratch.push(value);
        }
        let mut hasher = DefaultHasher::new();
        self.scratch.hash(&mut hasher);
        for input in inputs {
            let mut bytes = [0; 8];
            input.write(&mut bytes);
            let value = u64::from_ne_bytes(bytes);
            self.scratch.push(value);
            value.hash(&mut hasher);
        }
        if !self.whole.insert(hasher.finish()) {
            return None;
        }
        let mut rank = 2;
        for (at, value) in self.scratch.iter().enumerate() {
            if self.values.insert((at, *value)) {
                let parted = matches!(self.respects.get(at), Some(Respect::Sides { .. })) && *value != SAME;
                rank = rank.min(usize::from(!parted));
            }
        }
        Some(rank)
    }
}

/// The two sides agree.
const SAME: u64 = 1;

impl Respect {
    fn value(self, states: [&[u8]; 2], limits: &[i128]) -> u64 {
        match self {
            Self::Value { side, offset, repr } => class(Value::read(repr, &states[side][offset..]), limits),
            Self::Preset { side, count, preset, repr } => {
                order(Value::read(repr, &states[side][count..]), Value::read(repr, &states[side][preset..]))
            }
            Self::Sides { offsets, reprs } => {
                let [a, b] = [0, 1].map(|side| Value::read(reprs[side], &states[side][offsets[side]..]));
                order(a, b)
            }
        }
    }
}

fn order(a: Value, b: Value) -> u64 {
    let number = |it: Value| match it {
        Value::Bool(it) => Some(i128::from(it)),
        other => other.as_integer(),
    };
    match number(a).cmp(&number(b)) {
        Ordering::Less => 0,
        Ordering::Equal => SAME,
        Ordering::Greater => 2,
    }
}

/// A number's place among the program's constants.
fn class(value: Value, limits: &[i128]) -> u64 {
    let place = match value {
        Value::Bool(it) => return u64::from(it),
        Value::F32(it) => return u64::from(it > 0.0),
        Value::F64(it) => return u64::from(it > 0.0),
        other => limits.binary_search(&other.as_integer().unwrap_or(0)).map_or_else(|at| 2 * at, |at| 2 * at + 1),
    };
    u64::try_from(place).unwrap_or(u64::MAX)
}
