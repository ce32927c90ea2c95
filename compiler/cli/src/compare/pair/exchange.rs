//! A sequence of inputs once more, with one thing alone as it is on the other system: what then no longer differs, differs
//! because of that.

use super::{Matched, Pair, Row, comparison};
use crate::compare::program::scalar::Instance;
use crate::machine::Interpreted;
use staunch_host::{Event, Machine};
use staunch_runtime::{BlockInfo, Family};

/// Longer sequences are not run again.
const MAX_ROWS: usize = 20_000;

/// What the first program has of the second's system.
#[derive(Clone, Debug)]
pub enum Change {
    /// What computes a counter, by its position among the counters.
    Counter(usize),
    /// What computes another block, by its position among those.
    Block(usize),
    /// What events leave of these.
    Kept(Vec<Matched>),
    /// What events leave of a block, by its position on each side.
    KeptBlock(Matched),
}

impl Pair {
    /// Whether these agree at the end of the rows, where the first program alone has the change.
    pub fn agrees_with(&self, change: &Change, rows: &[Row], wanted: &[Matched]) -> bool {
        let faults = rows.iter().any(|it| it.faults.iter().any(Option::is_some));
        let Some(last) = rows.last().filter(|_| rows.len() <= MAX_ROWS && !faults) else { return false };
        if self.exchanged(change).is_some_and(|it| !it.iter().all(|it| is_plain(it.block.info()))) {
            return false;
        }
        // What runs here again is what has run.
        let is_same = self.end(None, rows).is_some_and(|it| it == last.states[0]);
        let agrees = |state: &[u8]| {
            wanted.iter().all(|it| comparison::equal(&self.sides, *it, [state, last.states[1].as_slice()]))
        };
        is_same && self.end(Some(change), rows).is_some_and(|it| agrees(&it))
    }

    /// The block that is computed otherwise, on both sides.
    fn exchanged(&self, change: &Change) -> Option<[&Instance; 2]> {
        let block = |it: &Matched| [0, 1].map(|side: usize| &self.sides[side].scalars.blocks[it[side]]);
        match change {
            Change::Counter(at) => self.counters.get(*at).map(block),
            Change::Block(at) => self.blocks.get(*at).map(block),
            Change::Kept(_) | Change::KeptBlock(_) => None,
        }
    }

    /// The first program's state at the end of the rows.
    fn end(&self, change: Option<&Change>, rows: &[Row]) -> Option<Vec<u8>> {
        let side = &self.sides[0];
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
                match change {
                    Some(Change::Kept(all)) => {
                        all.iter().for_each(|it| self.keep_as_other(*it, event, &before, &mut machine));
                    }
                    Some(Change::KeptBlock(it)) => self.keep_block_as_other(*it, event, &before, &mut machine),
                    Some(Change::Counter(_) | Change::Block(_)) | None => {}
                }
            }
            for input in &self.inputs {
                let scalar = &side.scalars.all[input.scalars[0]];
                let range = scalar.offset..scalar.offset + scalar.size;
                machine.write(scalar.offset, &row.states[0][range]);
            }
            drive.scan_by(|instance, cx| machine.scan(instance, cx)).ok()?;
        }
        Some(machine.state().to_vec())
    }

    /// Leaves of a variable what the event leaves of it on the other system.
    fn keep_as_other(&self, matched: Matched, event: Event, before: &[u8], machine: &mut Interpreted<'_>) {
        let [own, other] = [self.scalar(0, matched[0]), self.scalar(1, matched[1])];
        let is_kept = self.sides[1].keeps(event, other.offset);
        let source = if is_kept { before } else { self.sides[0].initial.as_slice() };
        machine.write(own.offset, &source[own.offset..own.offset + own.size]);
    }
}

impl Pair {
    /// Whether an event keeps anything of a block, on each side.
    pub fn keeps_block(&self, matched: Matched, event: Event) -> [bool; 2] {
        [0, 1].map(|side: usize| {
            let block = &self.sides[side].scalars.blocks[matched[side]];
            (0..block.block.info().size).any(|at| self.sides[side].keeps(event, block.offset + at))
        })
    }

    fn keep_block_as_other(&self, matched: Matched, event: Event, before: &[u8], machine: &mut Interpreted<'_>) {
        let own = &self.sides[0].scalars.blocks[matched[0]];
        let is_kept = self.keeps_block(matched, event)[1];
        let source = if is_kept { before } else { self.sides[0].initial.as_slice() };
        let range = own.offset..own.offset + own.block.info().size;
        machine.interpreter().state_mut()[range.clone()].copy_from_slice(&source[range]);
    }
}

/// Whether it is a function block, all of whose memory is its own.
fn is_plain(block: &BlockInfo) -> bool {
    block.family != Family::Logix && block.facts.kept.is_none()
}
