//! A bounded ring from one thread to another. Neither waits for the other: what finds no room is refused.

use staunch_runtime::Time;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Bytes of states that a ring holds, and the slots that it has whatever their size.
const BYTES: usize = 4 << 20;
const SLOTS: std::ops::RangeInclusive<usize> = 16..=1024;

#[derive(Debug)]
pub(super) struct Ring {
    /// The one thread has those from `taken` to `given`, the other the rest: no lock is ever waited for.
    slots: Box<[Mutex<Slot>]>,
    given: AtomicU64,
    taken: AtomicU64,
}

/// A state after a scan, or as much of it as is copied.
#[derive(Clone, Debug)]
pub(super) struct Slot {
    pub scan: u64,
    pub time: Time,
    /// A row of the trace.
    pub is_row: bool,
    pub state: Vec<u8>,
}

impl Slot {
    pub fn fill(&mut self, (scan, time): (u64, Time), is_row: bool, state: &[u8], parts: &[Range<usize>]) {
        (self.scan, self.time, self.is_row) = (scan, time, is_row);
        for part in parts {
            self.state[part.clone()].copy_from_slice(&state[part.clone()]);
        }
    }
}

impl Ring {
    /// All memory is written to here, so that no scan waits for a page.
    pub fn new(state: &[u8]) -> Self {
        let count = (BYTES / state.len().max(1)).clamp(*SLOTS.start(), *SLOTS.end());
        let slot = || Mutex::new(Slot { scan: 0, time: 0, is_row: false, state: state.to_vec() });
        Self { slots: (0..count).map(|_| slot()).collect(), given: AtomicU64::new(0), taken: AtomicU64::new(0) }
    }

    /// Fills a slot and hands it over, if there is room.
    pub fn give(&self, fill: impl FnOnce(&mut Slot)) -> bool {
        let given = self.given.load(Ordering::Relaxed);
        if given - self.taken.load(Ordering::Acquire) >= self.len() {
            return false;
        }
        let Ok(mut slot) = self.slot(given).try_lock() else { return false };
        fill(&mut slot);
        drop(slot);
        self.given.store(given + 1, Ordering::Release);
        true
    }

    /// Takes the oldest, if there is one.
    pub fn take(&self, take: impl FnOnce(&Slot)) -> bool {
        let taken = self.taken.load(Ordering::Relaxed);
        if taken == self.given.load(Ordering::Acquire) {
            return false;
        }
        take(&self.slot(taken).lock().unwrap_or_else(PoisonError::into_inner));
        self.taken.store(taken + 1, Ordering::Release);
        true
    }

    pub fn is_empty(&self) -> bool {
        self.taken.load(Ordering::Acquire) == self.given.load(Ordering::Acquire)
    }

    fn slot(&self, number: u64) -> &Mutex<Slot> {
        &self.slots[usize::try_from(number % self.len()).unwrap_or(0)]
    }

    fn len(&self) -> u64 {
        u64::try_from(self.slots.len()).unwrap_or(u64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_finds_no_room_is_refused_and_the_rest_arrives_in_order() {
        // So large that there are the fewest slots.
        let state = vec![7; BYTES];
        let ring = Ring::new(&state);
        let parts = [2..3, 3..4];
        let give = |scan: u64| ring.give(|it| it.fill((scan, 10), true, &vec![9; BYTES], &parts));
        assert!((1..=16).all(give) && !give(17));
        let mut scans = Vec::new();
        while ring.take(|it| {
            assert_eq!(it.state[..5], [7, 7, 9, 9, 7]);
            scans.push(it.scan);
        }) {}
        assert!(ring.is_empty() && scans.into_iter().eq(1..=16));
        assert!(give(18) && ring.take(|it| assert_eq!(it.scan, 18)));
    }

    #[test]
    fn two_threads_lose_nothing_that_was_taken_in() {
        let ring = Ring::new(&[0; 8]);
        let (most, mut refused, mut sum) = (if cfg!(miri) { 300 } else { 100_000 }, 0, 0);
        std::thread::scope(|scope| {
            let taker = scope.spawn(|| {
                let (mut last, mut sum) = (0, 0);
                while last < most {
                    let _ = ring.take(|it| {
                        assert!(it.scan > last && it.state == it.scan.to_le_bytes());
                        (last, sum) = (it.scan, sum + it.scan);
                    });
                }
                sum
            });
            for scan in 1..=most {
                let give = || ring.give(|it| it.fill((scan, 0), true, &scan.to_le_bytes(), &[0..4, 4..8]));
                // The last one must arrive.
                while !give() {
                    if scan < most {
                        refused += scan;
                        break;
                    }
                    std::thread::yield_now();
                }
            }
            sum = taker.join().unwrap();
        });
        assert_eq!(sum + refused, most * (most + 1) / 2);
    }
}
