//! A sequence of inputs once more, with one thing alone as it is on the other system: what then no longer differs, differs
//! because of that.

use super::side::Side;
use super::{Matched, Pair, Row, comparison};
use crate::program::scalar::Instance;
use staunch_host::{Event, Machine};
use staunch_machine::Interpreted;
use staunch_runtime::{Family, PinRole};
use std::ops::Range;

/// Longer sequences are not run again.
const MAX_ROWS: usize = 20_000;

/// What one program has of the other's system.
#[derive(Clone, Debug)]
pub enum Change {
    /// One program has what computes a counter on the other side, by its position among the counters: the first, if the
    /// types of its pins hold that. A COUNTER of Logix shows what the other one has.
    Counter(usize),
    /// So too another block, by its position among those.
    Block(usize),
    /// The program that loses these in an event keeps them, as RETAIN would.
    Kept(Vec<Kept>),
}

/// What an event may leave: a variable, or a block, by its position on each side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    Variable(Matched),
    Block(Matched),
}

/// A sequence of inputs that can be run again.
#[derive(Debug)]
pub struct Again<'a> {
    pair: &'a Pair,
    rows: &'a [Row],
    last: &'a Row,
    /// Whether each program comes to the same state again.
    repeats: [bool; 2],
}

impl<'a> Again<'a> {
    /// `None` where it is too long or ends in a fault.
    pub fn new(pair: &'a Pair, rows: &'a [Row]) -> Option<Self> {
        let faults = rows.iter().any(|it| it.faults.iter().any(Option::is_some));
        let last = rows.last().filter(|_| rows.len() <= MAX_ROWS && !faults)?;
        let repeats = [0, 1].map(|side: usize| {
            // What is between variables is not theirs.
            let is_same = |a: &[u8], b: &[u8]| {
                let mut scalars = pair.sides[side].scalars.all.iter().map(|it| it.offset..it.offset + it.size);
                scalars.all(|it| a[it.clone()] == b[it])
            };
            pair.end(side, None, rows).is_some_and(|it| is_same(&it, &last.states[side]))
        });
        Some(Self { pair, rows, last, repeats })
    }

    /// Whether these agree at the end of the rows, where one program alone has the change.
    pub fn agrees_with(&self, change: &Change, wanted: &[Matched]) -> bool {
        let exchanged = self.pair.exchanged(change);
        if exchanged.is_some_and(|it| it.iter().any(|it| it.block.info().facts.kept.is_some())) {
            return false;
        }
        // Who keeps it in the one event may lose it in another; a count need not fit the other program's type.
        let is_kept = matches!(change, Change::Kept(_));
        let of_logix = exchanged.and_then(|it| it.iter().position(|it| is_of_logix(it)));
        for side in (0..2).filter(|it| self.repeats[*it] && of_logix.is_none_or(|of| of == *it)) {
            let Some(state) = self.pair.end(side, Some(change), self.rows) else { continue };
            let mut states = self.last.states.each_ref().map(Vec::as_slice);
            states[side] = &state;
            let agrees = wanted.iter().all(|it| comparison::equal(&self.pair.sides, *it, states));
            if agrees || !is_kept {
                return agrees;
            }
        }
        false
    }
}

impl Pair {
    /// The block that is computed otherwise, on both sides.
    fn exchanged(&self, change: &Change) -> Option<[&Instance; 2]> {
        let block = |it: &Matched| [0, 1].map(|side: usize| &self.sides[side].scalars.blocks[it[side]]);
        match change {
            Change::Counter(at) => self.counters.get(*at).map(block),
            Change::Block(at) => self.blocks.get(*at).map(block),
            Change::Kept(_) => None,
        }
    }

    /// A program's state at the end of the rows; `None` where it ends before, or its types do not hold what is exchanged.
    fn end(&self, number: usize, change: Option<&Change>, rows: &[Row]) -> Option<Vec<u8>> {
        let side = &self.sides[number];
        let (mut machine, _) = Interpreted::new(&side.program).ok()?;
        let exchanged = change.and_then(|it| self.exchanged(it)).map(|it| [it[number], it[1 - number]]);
        if let Some([own, other]) = exchanged {
            let blocks = [own, other].map(|it| it.block.info());
            let bytes = &self.sides[1 - number].initial[other.offset..other.offset + blocks[1].size];
            // What several instructions make of a structure is not computed by one call of a block.
            match is_of_logix(own) {
                true => machine.interpreter().show_as(own.offset, blocks, bytes),
                false => machine.interpreter().compute_as(own.offset, blocks, bytes),
            }
        }
        let mut drive = side.drive.clone();
        drive.go_to(&side.start);
        for row in rows {
            if let Some(event) = row.event {
                let before = machine.state().to_vec();
                drive.start_again(event, &mut machine);
                if let Some([own, _]) = exchanged {
                    // What an event keeps stays as it is: that is another difference.
                    let is_kept = keeps_count(side, own, event);
                    machine.interpreter().restart_exchanged(&|_| is_kept);
                }
                if let Some(Change::Kept(all)) = change {
                    for it in all.iter().filter(|it| self.keeps(**it, event)[1 - number]) {
                        let bytes = self.bytes(*it, number);
                        machine.interpreter().state_mut()[bytes.clone()].copy_from_slice(&before[bytes]);
                    }
                }
            }
            if let Some([_, other]) = exchanged.filter(|it| is_of_logix(it[0])) {
                let size = other.block.info().size;
                machine.interpreter().give(&row.states[1 - number][other.offset..other.offset + size]);
            }
            for input in &self.inputs {
                let scalar = &side.scalars.all[input.scalars[number]];
                let range = scalar.offset..scalar.offset + scalar.size;
                machine.write(scalar.offset, &row.states[number][range]);
            }
            drive.scan_by(|instance, cx| machine.scan(instance, cx)).ok()?;
        }
        machine.interpreter().exchange_fits().then(|| machine.state().to_vec())
    }

    /// Whether an event keeps anything of it, on each side.
    pub fn keeps(&self, kept: Kept, event: Event) -> [bool; 2] {
        [0, 1].map(|side: usize| self.bytes(kept, side).any(|at| self.sides[side].keeps(event, at)))
    }

    /// Where it is in a side's state.
    pub fn bytes(&self, kept: Kept, side: usize) -> Range<usize> {
        let (offset, size) = match kept {
            Kept::Variable(it) => {
                let scalar = self.scalar(side, it[side]);
                (scalar.offset, scalar.size)
            }
            Kept::Block(it) => {
                let block = &self.sides[side].scalars.blocks[it[side]];
                (block.offset, block.block.info().size)
            }
        };
        offset..offset + size
    }
}

/// Whether an event leaves a counter's value, or of another block what is first in it.
fn keeps_count(side: &Side, block: &Instance, event: Event) -> bool {
    let at = block.block.info().pin_for(PinRole::Count).map_or(0, |it| it.offset);
    side.keeps(event, block.offset + at)
}

pub fn is_of_logix(block: &Instance) -> bool {
    block.block.info().family == Family::Logix
}
