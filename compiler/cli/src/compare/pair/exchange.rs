//! A sequence of inputs once more, with one thing alone as it is on the other system: what then no longer differs, differs
//! because of that.

use super::{Matched, Pair, Row, comparison};
use crate::compare::program::scalar::Instance;
use crate::machine::Interpreted;
use staunch_host::{Event, Machine};
use staunch_runtime::{BlockInfo, Family};
use std::ops::Range;

/// Longer sequences are not run again.
const MAX_ROWS: usize = 20_000;

/// What one program has of the other's system.
#[derive(Clone, Debug)]
pub enum Change {
    /// The first program has what computes a counter, by its position among the counters.
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

impl Pair {
    /// Whether these agree at the end of the rows, where one program alone has the change.
    pub fn agrees_with(&self, change: &Change, rows: &[Row], wanted: &[Matched]) -> bool {
        let faults = rows.iter().any(|it| it.faults.iter().any(Option::is_some));
        let Some(last) = rows.last().filter(|_| rows.len() <= MAX_ROWS && !faults) else { return false };
        if self.exchanged(change).is_some_and(|it| !it.iter().all(|it| is_plain(it.block.info()))) {
            return false;
        }
        // Who keeps it in the one event may lose it in another.
        let sides: &[usize] = if matches!(change, Change::Kept(_)) { &[0, 1] } else { &[0] };
        sides.iter().any(|side| {
            // What runs here again is what has run.
            let is_same = self.end(*side, None, rows).is_some_and(|it| it == last.states[*side]);
            let agrees = |state: &[u8]| {
                let mut states = last.states.each_ref().map(Vec::as_slice);
                states[*side] = state;
                wanted.iter().all(|it| comparison::equal(&self.sides, *it, states))
            };
            is_same && self.end(*side, Some(change), rows).is_some_and(|it| agrees(&it))
        })
    }

    /// The block that is computed otherwise, on both sides.
    fn exchanged(&self, change: &Change) -> Option<[&Instance; 2]> {
        let block = |it: &Matched| [0, 1].map(|side: usize| &self.sides[side].scalars.blocks[it[side]]);
        match change {
            Change::Counter(at) => self.counters.get(*at).map(block),
            Change::Block(at) => self.blocks.get(*at).map(block),
            Change::Kept(_) => None,
        }
    }

    /// A program's state at the end of the rows.
    fn end(&self, number: usize, change: Option<&Change>, rows: &[Row]) -> Option<Vec<u8>> {
        let side = &self.sides[number];
        let (mut machine, _) = Interpreted::new(&side.program).ok()?;
        let exchanged = change.and_then(|it| self.exchanged(it));
        if let Some(instances) = exchanged {
            let blocks = instances.map(|it| it.block.info());
            let bytes = &self.sides[1].initial[instances[1].offset..instances[1].offset + blocks[1].size];
            machine.interpreter().compute_as(instances[0].offset, blocks, bytes);
        }
        let mut drive = side.drive.clone();
        drive.go_to(&side.start);
        for row in rows {
            if let Some(event) = row.event {
                let before = machine.state().to_vec();
                drive.start_again(event, &mut machine);
                if let Some([_, other]) = exchanged {
                    let keeps = |at: usize| self.sides[1].keeps(event, other.offset + at);
                    machine.interpreter().restart_exchanged(&keeps);
                }
                if let Some(Change::Kept(all)) = change {
                    for it in all.iter().filter(|it| self.keeps(**it, event)[1 - number]) {
                        let bytes = self.bytes(*it, number);
                        machine.interpreter().state_mut()[bytes.clone()].copy_from_slice(&before[bytes]);
                    }
                }
            }
            for input in &self.inputs {
                let scalar = &side.scalars.all[input.scalars[number]];
                let range = scalar.offset..scalar.offset + scalar.size;
                machine.write(scalar.offset, &row.states[number][range]);
            }
            drive.scan_by(|instance, cx| machine.scan(instance, cx)).ok()?;
        }
        Some(machine.state().to_vec())
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

/// Whether it is a function block, all of whose memory is its own.
fn is_plain(block: &BlockInfo) -> bool {
    block.family != Family::Logix && block.facts.kept.is_none()
}
