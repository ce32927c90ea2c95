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
    /// Copies `count` bytes one after the other, each from where `from` leads to where `to` does, which both advance by `step`
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::{ORIGIN, Reference, encode};
    use core::array::from_fn;
    use core::cell::Cell;

    const SIZE: usize = 200;

    /// One object: 100 numbers, a BOOL, three bytes of no variable, and 96 numbers.
    const WORDS: [u32; 30] = [
        1,
        8,
        30, // one object; its node is the state's; so many words
        0,
        200,
        0,
        0,
        8, // from where, how large, not plain, always there
        encode::STRUCTURE,
        200,
        1,
        3,
        0,
        18,
        100,
        22,
        104,
        26, // the members
        encode::NUMBERS,
        100,
        0,
        0,
        encode::TRUTHS,
        1,
        0,
        0,
        encode::NUMBERS,
        96,
        0,
        0,
    ];

    fn one_by_one(
        table: &Table<'_>,
        memory: &[Cell<u8>],
        way: [u64; 2],
        count: i64,
        step: i64,
    ) -> Result<(), FaultKind> {
        let [mut to, mut from] = way;
        for _ in 0..count {
            let mut byte = [0];
            table.load_bytes(memory, from, 0, BYTE, &mut byte)?;
            table.store_bytes(memory, to, 0, BYTE, &byte)?;
            (to, from) = (ops::advance(to, step), ops::advance(from, step));
        }
        Ok(())
    }

    #[test]
    fn bytes_go_as_if_one_by_one() {
        let table = Table::new(&WORDS);
        let at = |position: u32| Reference { object: 1, address: ORIGIN + position }.bits();
        let places = [0, 1, 2, 60, 98, 99, 100, 101, 103, 104, 107, 150, 199, 200];
        for way in places.iter().flat_map(|to| places.map(|from| [at(*to), at(from)])) {
            for (count, step) in
                [0, 1, 3, 40, 90, 200].into_iter().flat_map(|count| [-2, -1, 0, 1, 2].map(|it| (count, it)))
            {
                let [all, each]: [[Cell<u8>; SIZE]; 2] = from_fn(|_| from_fn(|at| Cell::new(at as u8)));
                let [whole, ends] = [
                    table.copy(all.as_slice(), way[0], way[1], count, step),
                    one_by_one(&table, &each, way, count, step),
                ];
                assert_eq!((whole, &all), (ends, &each), "{way:x?} {count} {step}");
            }
        }
        assert_eq!(table.copy([].as_slice(), 0, at(0), 1, 1), Err(FaultKind::NullReference));
    }
}
