//! Counts past all values that they are compared with are equivalent, so that an input that pulses for ever leads to few states.
//!
//! The programs ask no more of such a count than whether it is past a constant or a preset, which it stays until a reset or a
//! load whose result does not depend on it. So two states that differ in these counts alone go the same way.
//!
//! Where the two systems' counts of one counter are compared with one another, that is not all that is asked of them. As long as
//! they are the same, of one type, the search continues with both just past: what makes them differ further on makes them differ
//! there, since both stop at the same limit. The other way round does not hold where they have come to that limit, so that a
//! difference which is found past there is shown once more from the start.

use super::idle::Idle;
use super::scan::{Input, Matched};
use super::side::Side;
use crate::program::bounds::{self, Bounds};
use crate::program::flow::Range;
use crate::program::scalar::{Instance, Role};
use crate::program::walked::Name;
use staunch_ir::Value;
use staunch_runtime::{PinRole, Repr};
use std::collections::{HashMap, HashSet};

/// What is known of both systems before they run.
#[derive(Clone, Copy)]
pub struct Known<'p> {
    pub sides: &'p [Side; 2],
    pub inputs: &'p [Input],
    /// What is compared now.
    pub compared: &'p [Matched],
    /// Counters that both sides have.
    pub counters: &'p [Matched],
    /// What decides nothing of what is compared.
    pub idle: &'p Idle,
}

impl Known<'_> {
    fn offset(&self, side: usize, scalar: usize) -> usize {
        self.sides[side].scalars.all[scalar].offset
    }
}

/// The counts of both systems that have bounds.
#[derive(Debug, Default)]
pub struct Settled {
    counts: Vec<Count>,
    /// What a state is known by in place of its own counts: the side, the offset and the count.
    found: Vec<(usize, usize, Value)>,
    /// Of these, the ones that the search continues with.
    moved: Vec<(usize, usize, Value)>,
}

#[derive(Debug)]
struct Count {
    /// Its position among the counters that both sides have.
    counter: Option<usize>,
    /// Where it is on each side.
    places: [Option<(usize, Repr)>; 2],
    bounds: Bounds,
    is_compared: bool,
}

impl Count {
    /// Of a block on each side, by its position; `None` where it has no bounds.
    fn of(known: Known<'_>, found: [&HashMap<Name, Bounds>; 2], blocks: [Option<usize>; 2]) -> Option<Self> {
        let instances = [0, 1].map(|side: usize| blocks[side].map(|it| &known.sides[side].scalars.blocks[it]));
        let mut bounds: Option<Bounds> = None;
        for (side, it) in instances.iter().enumerate() {
            let Some(it) = it else { continue };
            let own = own(&known.sides[side], it, found[side]).filter(|_| !is_given(known, side, it))?;
            bounds = Some(bounds.map_or(Some(own), |other| joined(own, other))?);
        }
        let place =
            |it: &Instance| it.block.info().pin_for(PinRole::Count).map(|pin| (it.offset + pin.offset, pin.repr()));
        let places = instances.map(|it| it.and_then(place));
        let lies_at = |side: usize, it: &Matched| places[side].is_some_and(|at| known.offset(side, it[side]) == at.0);
        let is_compared = known.compared.iter().any(|it| lies_at(0, it) || lies_at(1, it));
        let counter = known.counters.iter().position(|it| it.map(Some) == blocks);
        Some(Self { counter, places, bounds: bounds?, is_compared })
    }

    /// Just past the bounds, in place of what is further past them.
    fn past(&self, count: i128) -> Option<i128> {
        match self.bounds {
            Bounds { greatest, rises: true, .. } if count > greatest => Some(greatest + 1),
            Bounds { least, falls: true, .. } if count < least => Some(least - 1),
            Bounds { .. } => None,
        }
    }

    /// The counts, and those just past the bounds for each that is past them; and whether both sides have the same count, of one type.
    fn settle(&self, states: [&[u8]; 2]) -> ([Option<i128>; 2], bool) {
        let counts = [0, 1].map(|side: usize| self.places[side].and_then(|it| read(states[side], it)));
        let is_same = match self.places {
            [Some(a), Some(b)] => a.1 == b.1 && counts[0] == counts[1],
            [Some(_), None] | [None, Some(_)] | [None, None] => false,
        };
        let past = counts.map(|it| it.and_then(|it| self.past(it)));
        if self.is_compared && !is_same { ([None, None], is_same) } else { (past, is_same) }
    }
}

fn read(state: &[u8], (offset, repr): (usize, Repr)) -> Option<i128> {
    Value::read(repr, &state[offset..]).as_integer()
}

/// The values at the start of the variables that the program alone writes, and of the inputs that have a range all that they may
/// be given: of a member of several instances, from the least on to the greatest.
pub fn starts(known: Known<'_>, side: usize) -> HashMap<Name, Range> {
    let own = &known.sides[side];
    let mut found: HashMap<Name, Range> = HashMap::new();
    let mut outside = HashSet::new();
    for (at, scalar) in own.scalars.all.iter().enumerate() {
        let Some((owner, field)) = scalar.field else { continue };
        let name = Name::Field(owner, field);
        let value = own.program.repr(scalar.ty).and_then(|it| read(&own.initial, (scalar.offset, it)));
        let input = known.inputs.iter().find(|it| it.scalars[side] == at);
        let is_given = (scalar.role == Role::Input || input.is_some()) && input.is_none_or(|it| it.range.is_none());
        let is_located = own.program.structure(owner).fields[field.index()].address.is_some();
        match value.filter(|_| !is_given && !is_located && !scalar.is_shared) {
            Some(value) => {
                let (least, greatest) = input.and_then(|it| it.range).unwrap_or((value, value));
                let range = found.entry(name).or_insert((value, value));
                *range = (range.0.min(value).min(least), range.1.max(value).max(greatest));
            }
            None => _ = outside.insert(name),
        }
    }
    found.retain(|name, _| !outside.contains(name) && !own.scalars.truncated);
    found
}

/// Whether the world outside writes a pin of it.
fn is_given(known: Known<'_>, side: usize, instance: &Instance) -> bool {
    let all = instance.offset..instance.offset + instance.block.info().size;
    known.inputs.iter().any(|it| all.contains(&known.offset(side, it.scalars[side])))
}

/// The bounds of a counter, with the preset that it starts with.
fn own(side: &Side, instance: &Instance, found: &HashMap<Name, Bounds>) -> Option<Bounds> {
    let (owner, field) = instance.field?;
    let mut bounds = *found.get(&Name::Field(owner, field))?;
    bounds.add(instance.pin(PinRole::Preset, &side.initial)?);
    Some(bounds)
}

fn joined(a: Bounds, b: Bounds) -> Option<Bounds> {
    let mut all = a;
    all.add(b.least);
    all.add(b.greatest);
    ((a.rises, a.falls) == (b.rises, b.falls)).then_some(all)
}

impl Settled {
    pub fn of(known: Known<'_>) -> Self {
        let found = [0, 1]
            .map(|side: usize| bounds::of(&known.sides[side].program, &starts(known, side), &known.idle.fields[side]));
        let both = known.counters.iter().map(|[a, b]| [Some(*a), Some(*b)]);
        let counts = |side: usize| {
            let all = known.sides[side].scalars.blocks.iter().enumerate().filter(|it| it.1.counts());
            all.map(|it| it.0).filter(move |at| !known.counters.iter().any(|it: &Matched| it[side] == *at))
        };
        let firsts = counts(0).map(|it| [Some(it), None]);
        let seconds = counts(1).map(|it| [None, Some(it)]);
        let all = both.chain(firsts).chain(seconds);
        let counts = all.filter_map(|it| Count::of(known, found.each_ref(), it)).collect();
        Self { counts, ..Self::default() }
    }

    /// Finds what is past all that it is compared with, and notes of which counters that leaves traps open.
    pub fn look(&mut self, states: [&[u8]; 2], open: &mut [bool]) -> bool {
        self.clear();
        for count in &self.counts {
            let (past, is_same) = count.settle(states);
            let before = self.found.len();
            for (side, past) in past.into_iter().enumerate() {
                let place = count.places[side].zip(past).filter(|(at, past)| read(states[side], *at) != Some(*past));
                let value = place.and_then(|((offset, repr), it)| Some((side, offset, repr.integer(it)?)));
                self.found.extend(value);
            }
            let new = &self.found[before..];
            match count.counter.filter(|_| !is_same && !new.is_empty()) {
                Some(counter) => open[counter] = true,
                None if is_same => self.moved.extend_from_slice(new),
                None => {}
            }
        }
        !self.found.is_empty()
    }

    pub fn clear(&mut self) {
        self.found.clear();
        self.moved.clear();
    }

    /// Writes what was found into one side's state.
    pub fn write(&self, side: usize, state: &mut [u8]) {
        let own = self.found.iter().filter(|it| it.0 == side);
        own.for_each(|(_, offset, value)| value.write(&mut state[*offset..]));
    }

    /// What the search continues with in place of what the last look saw: the side, the offset and the count.
    pub fn moved(&self) -> &[(usize, usize, Value)] {
        &self.moved
    }
}
