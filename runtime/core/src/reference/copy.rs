//! Many bytes through two references: as if each were loaded and stored by itself, and as many at once as can be.

use super::table::Run;
use super::{Memory, Table, View};
use crate::{FaultKind, ops};

/// So many bytes are on their way at most.
const MOST: usize = 64;

/// One byte, as it is seen.
const BYTE: View = View::Number(1);

/// One side of a copy.
struct Side {
    reference: u64,
    /// What the byte is in to which the reference leads, if that is known.
    run: Option<Run>,
}

impl Table<'_> {
    /// Copies `count` bytes one after the other, each from where `from` leads to where `to` does, which both go on by `step`
    /// after it. A fault leaves those copied that were before it.
    pub fn copy(
        &self,
        memory: &(impl Memory + ?Sized),
        to: u64,
        from: u64,
        count: i64,
        step: i64,
    ) -> Result<(), FaultKind> {
        let [mut to, mut from] = [to, from].map(|reference| Side { reference, run: None });
        let mut left = count;
        while left > 0 {
            [&mut from, &mut to].into_iter().for_each(|it| it.find(self, memory));
            let length = usize::try_from(left).map_or(MOST, |it| it.min(MOST));
            let done = match (&to.run, &from.run) {
                (Some(target), Some(source)) if matches!(step, -1 | 1) => {
                    together(memory, target, source, length, step)
                }
                _ => {
                    let mut byte = [0];
                    self.load_bytes(memory, from.reference, 0, BYTE, &mut byte)?;
                    self.store_bytes(memory, to.reference, 0, BYTE, &byte)?;
                    1
                }
            };
            [&mut from, &mut to].into_iter().for_each(|it| it.go(step.wrapping_mul(done as i64)));
            left -= done as i64;
        }
        Ok(())
    }
}

impl Side {
    fn find(&mut self, table: &Table<'_>, memory: &(impl Memory + ?Sized)) {
        if self.run.is_none() && table.check_is_there(memory, self.reference).is_ok() {
            self.run = table.run(self.reference);
        }
    }

    fn go(&mut self, way: i64) {
        self.reference = ops::advance(self.reference, way);
        let moved = self.run.take().map(|it| Run { at: it.at.wrapping_add_signed(way as isize), ..it });
        self.run = moved.filter(|it| it.bytes.contains(&it.at));
    }
}

/// Copies within one variable of each side: how many.
fn together(memory: &(impl Memory + ?Sized), target: &Run, source: &Run, length: usize, step: i64) -> usize {
    let up = step > 0;
    let is_ahead = if up { target.at > source.at } else { target.at < source.at };
    // What is written must be nothing that is read later.
    let apart = if is_ahead { target.at.abs_diff(source.at) } else { MOST };
    let length = length.min(apart).min(target.left(up)).min(source.left(up));
    let back = if up { 0 } else { length - 1 };
    let mut bytes = [0; MOST];
    let bytes = bytes.get_mut(..length).unwrap_or_default();
    if !source.is_gap {
        memory.read(source.at - back, bytes);
    }
    if !target.is_gap {
        memory.write(target.at - back, bytes);
    }
    length
}
