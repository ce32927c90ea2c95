//! A sequence of inputs once more, with one counter computed as on the other system.

use super::{Matched, Pair, Row, comparison};
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_runtime::{BlockInfo, Family};

/// Longer sequences are not run again.
const MAX_ROWS: usize = 20_000;

impl Pair {
    /// Whether these agree at the end of the rows, where the first program's counter alone is computed as the second's.
    pub fn agrees_with(&self, counter: usize, rows: &[Row], wanted: &[Matched]) -> bool {
        let instances = self.instances(counter);
        let blocks = instances.map(|it| it.block.info());
        let events = rows.iter().any(|it| it.event.is_some() || it.faults.iter().any(Option::is_some));
        if events || rows.len() > MAX_ROWS || !blocks.iter().all(|it| is_plain(it)) {
            return false;
        }
        let agrees = |state: &[u8], side: usize| {
            let last = rows.last().map_or(state, |it| it.states[side].as_slice());
            let states = [state, rows.last().map_or(state, |it| it.states[1].as_slice())];
            match side {
                // What runs here again is what has run.
                0 => state == last,
                _ => wanted.iter().all(|it| comparison::equal(&self.sides, *it, states)),
            }
        };
        let start = instances[1].offset;
        let bytes = &self.sides[1].initial[start..start + blocks[1].size];
        let mut same = Interpreter::new(&self.sides[0].program);
        let mut other = Interpreter::new(&self.sides[0].program);
        other.compute_as(instances[0].offset, blocks, bytes);
        self.run(&mut same, rows) && agrees(same.state(), 0) && self.run(&mut other, rows) && agrees(other.state(), 1)
    }

    /// Whether the rows' inputs lead to their end.
    fn run(&self, interpreter: &mut Interpreter<'_>, rows: &[Row]) -> bool {
        let side = &self.sides[0];
        let mut drive = side.drive.clone();
        drive.go_to(&side.start);
        rows.iter().all(|row| {
            for input in &self.inputs {
                let scalar = &side.scalars.all[input.scalars[0]];
                let range = scalar.offset..scalar.offset + scalar.size;
                interpreter.state_mut()[range.clone()].copy_from_slice(&row.states[0][range]);
            }
            let scan = drive.scan_by(|instance, cx| match interpreter.scan(instance, cx) {
                Err(Stop::Fault(fault)) => Err(fault),
                Ok(()) | Err(Stop::OutOfSteps) => Ok(()),
            });
            scan.is_ok()
        })
    }
}

/// Whether it is a function block, all of whose memory is its own.
fn is_plain(block: &BlockInfo) -> bool {
    block.family != Family::Logix && block.facts.kept.is_none()
}
