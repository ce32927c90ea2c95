//! Counts past all that they are compared with are alike, so that an input that pulses for ever leads to few states.
//!
//! Two states that differ in such counts alone behave alike: no comparison tells them apart, and each counts on in its way
//! until a reset or a load, whose result does not depend on the count. Where the count itself is compared between the systems, that holds
//! while both have the same one, of the same type: if only one of them counts on, the two differ, and the search ends there.

use super::side::Side;
use super::{Matched, Pair};
use crate::compare::program::bounds::{self, Bounds};
use crate::compare::program::scalar::Instance;
use crate::compare::program::walked::Name;
use staunch_ir::Value;
use staunch_runtime::{Family, PinRole, Repr};
use std::collections::HashMap;

/// The counts of both systems that have bounds.
#[derive(Debug, Default)]
pub struct Settled {
    counts: Vec<Count>,
    /// What is to be written into both states.
    found: Vec<(usize, usize, Value)>,
}

#[derive(Debug)]
struct Count {
    /// Its position among the counters that both sides have.
    counter: Option<usize>,
    /// Where it lies on each side.
    places: [Option<(usize, Repr)>; 2],
    bounds: Bounds,
    is_compared: bool,
    /// The two counts cannot stop, or turn round, at different limits.
    is_alike: bool,
}

impl Count {
    fn of(pair: &Pair, found: [&HashMap<Name, Bounds>; 2], blocks: [Option<usize>; 2]) -> Option<Self> {
        let instance = |side: usize| blocks[side].map(|it| &pair.sides[side].scalars.blocks[it]);
        let instances = [instance(0), instance(1)];
        let mut bounds: Option<Bounds> = None;
        for (side, it) in instances.iter().enumerate() {
            let Some(it) = it else { continue };
            let own = own(&pair.sides[side], it, found[side])?;
            bounds = Some(bounds.map_or(Some(own), |other| joined(own, other))?);
        }
        let place =
            |it: &Instance| it.block.info().pin_for(PinRole::Count).map(|pin| (it.offset + pin.offset, pin.repr()));
        let places = instances.map(|it| it.and_then(place));
        let is_compared = pair.compared.iter().any(|it| {
            (0..2).all(|side| places[side].is_some_and(|place| pair.scalar(side, it[side]).offset == place.0))
        });
        let kind = |it: Option<&Instance>| {
            let info = it?.block.info();
            Some((info.pin_for(PinRole::Count)?.repr(), info.family == Family::Logix))
        };
        let is_alike = kind(instances[0]) == kind(instances[1]);
        let both = [blocks[0], blocks[1]];
        let counter = pair.counters.iter().position(|it| it.map(Some) == both);
        Some(Self { counter, places, bounds: bounds?, is_compared, is_alike })
    }

    /// The count past all that it is compared with, in place of a greater or lesser one.
    fn past(&self, count: i128) -> Option<i128> {
        match self.bounds {
            Bounds { greatest, rises: true, .. } if count > greatest => Some(greatest + 1),
            Bounds { least, falls: true, .. } if count < least => Some(least - 1),
            _ => None,
        }
    }

    /// What takes the counts' places; and whether something is not told apart by it that a trap may depend on.
    fn settle(&self, states: [&[u8]; 2]) -> ([Option<i128>; 2], bool) {
        let counts = [0, 1].map(|side: usize| self.places[side].and_then(|it| read(states[side], it)));
        let past = counts.map(|it| it.and_then(|it| self.past(it)));
        let is_same = counts[0] == counts[1] && self.is_alike;
        if self.is_compared && !is_same {
            return ([None, None], false);
        }
        (past, !is_same && past.iter().any(Option::is_some))
    }
}

fn read(state: &[u8], (offset, repr): (usize, Repr)) -> Option<i128> {
    Value::read(repr, &state[offset..]).as_integer()
}

/// The bounds of a counter, with the preset that it starts with.
fn own(side: &Side, instance: &Instance, found: &HashMap<Name, Bounds>) -> Option<Bounds> {
    let (owner, field) = instance.field?;
    let mut bounds = *found.get(&Name::Field(owner, field))?;
    bounds.add(instance.pin(PinRole::Preset, &side.initial)?);
    let is_under = instance.block.info().pin("UN").is_some_and(|it| side.initial[instance.offset + it.offset] != 0);
    (!is_under).then_some(bounds)
}

fn joined(a: Bounds, b: Bounds) -> Option<Bounds> {
    let mut all = a;
    all.add(b.least);
    all.add(b.greatest);
    ((a.rises, a.falls) == (b.rises, b.falls)).then_some(all)
}

impl Settled {
    /// Of what is compared now.
    pub fn of(pair: &Pair) -> Self {
        let found = [0, 1].map(|side: usize| bounds::of(&pair.sides[side].program));
        let both = pair.counters.iter().map(|[a, b]| [Some(*a), Some(*b)]);
        let counts = |side: usize| {
            let all = pair.sides[side].scalars.blocks.iter().enumerate().filter(|it| it.1.counts());
            all.map(|it| it.0).filter(move |at| !pair.counters.iter().any(|it: &Matched| it[side] == *at))
        };
        let firsts = counts(0).map(|it| [Some(it), None]);
        let seconds = counts(1).map(|it| [None, Some(it)]);
        let all = both.chain(firsts).chain(seconds);
        let counts = all.filter_map(|it| Count::of(pair, found.each_ref(), it)).collect();
        Self { counts, found: Vec::new() }
    }

    /// Finds what is past all that it is compared with, and notes of which counters that leaves traps open.
    pub fn look(&mut self, states: [&[u8]; 2], open: &mut [bool]) -> bool {
        self.found.clear();
        for count in &self.counts {
            let (past, leaves_open) = count.settle(states);
            for (side, past) in past.into_iter().enumerate() {
                let place = count.places[side].zip(past);
                let value = place.and_then(|((offset, repr), it)| Some((side, offset, repr.integer(it)?)));
                self.found.extend(value);
            }
            if let Some(counter) = count.counter.filter(|_| leaves_open) {
                open[counter] = true;
            }
        }
        !self.found.is_empty()
    }

    pub fn clear(&mut self) {
        self.found.clear();
    }

    /// Writes what was found into one side's state.
    pub fn write(&self, side: usize, state: &mut [u8]) {
        let own = self.found.iter().filter(|it| it.0 == side);
        own.for_each(|(_, offset, value)| value.write(&mut state[*offset..]));
    }
}
