//! What the scan's thread and the threads of a server share: the values of the last scan, and what clients have written.
//!
//! The values are in two boxes. One client's request at a time is answered, and that holds one box at most, while it copies: the
//! other is free for the scan, which thus never waits. Written values go into a list under a lock that is held while one request's
//! values are added; a scan that finds it taken leaves the list to the next scan. A request's values are together in one scan.

use super::points::Point;
use crate::Machine;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

#[derive(Debug)]
pub(super) struct Exchange {
    boxes: [Mutex<Shown>; 2],
    written: Mutex<Written>,
    /// Whether something is in `written`.
    is_written: AtomicBool,
    /// Scans shown so far.
    shown: AtomicU64,
}

/// The values of a scan.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    /// Its number; 0 before the first one.
    pub scan: u64,
    /// Of the last request that it has seen.
    pub request: u64,
    pub values: Vec<u64>,
}

/// What clients have written since the last scan.
#[derive(Debug)]
struct Written {
    request: u64,
    /// For each point, the bits that are written, and which these are.
    values: Vec<(u64, u64)>,
    /// The points of which some are.
    points: Vec<usize>,
}

impl Exchange {
    pub fn new(points: usize) -> Self {
        let shown = Shown { scan: 0, request: 0, values: vec![0; points] };
        let written = Written { request: 0, values: vec![(0, 0); points], points: Vec::with_capacity(points) };
        Self {
            boxes: [shown.clone(), shown].map(Mutex::new),
            written: Mutex::new(written),
            is_written: AtomicBool::new(false),
            shown: AtomicU64::new(0),
        }
    }

    /// The scan's side: writes into the state what was written, and returns the last request that it has seen.
    pub fn take(&self, points: &[Point], machine: &mut dyn Machine) -> Option<u64> {
        if !self.is_written.load(Ordering::Acquire) {
            return None;
        }
        let mut written = free(&self.written)?;
        self.is_written.store(false, Ordering::Relaxed);
        let Written { request, values, points: changed } = &mut *written;
        for at in changed.drain(..) {
            let (value, mask) = std::mem::take(&mut values[at]);
            points[at].write(machine, value, mask);
        }
        Some(*request)
    }

    /// The scan's side: shows the values of a scan that has seen this request.
    pub fn show(&self, request: u64, mut value: impl FnMut(usize) -> u64) {
        let scan = self.shown.load(Ordering::Relaxed) + 1;
        // Who holds a box holds one, and waits for nothing: one of a few tries succeeds.
        let mut shown = loop {
            if let Some(free) = self.boxes.iter().find_map(free) {
                break free;
            }
        };
        (shown.scan, shown.request) = (scan, request);
        shown.values.iter_mut().enumerate().for_each(|(at, it)| *it = value(at));
        drop(shown);
        self.shown.store(scan, Ordering::Release);
    }

    /// Whether a scan has been shown.
    pub fn is_shown(&self) -> bool {
        self.shown.load(Ordering::Acquire) > 0
    }

    /// A client's side: has the newest values seen, if they are newer than those of `scan`. One thread at a time may do so.
    pub fn see_newer(&self, scan: u64, mut see: impl FnMut(&Shown)) {
        let mut newest = scan;
        for shown in &self.boxes {
            let shown = shown.lock().unwrap_or_else(PoisonError::into_inner);
            if shown.scan > newest {
                newest = shown.scan;
                see(&shown);
            }
        }
    }

    /// A client's side: adds what a request writes, each a point, bits and which these are. Returns the request's number.
    pub fn write(&self, all: &[(usize, u64, u64)]) -> u64 {
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        written.request += 1;
        for (at, value, mask) in all {
            let (old, before) = written.values[*at];
            written.values[*at] = (old & !mask | value & mask, before | mask);
            if before == 0 {
                written.points.push(*at);
            }
        }
        self.is_written.store(true, Ordering::Release);
        written.request
    }
}

fn free<T>(locked: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    match locked.try_lock() {
        Ok(it) => Some(it),
        // Numbers are numbers, whoever panicked while they were copied.
        Err(TryLockError::Poisoned(it)) => Some(it.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}
