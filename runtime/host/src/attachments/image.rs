//! A process image in shared memory, version 1: a header with two counters, and the areas, whose layout is [`Place`]'s.
//!
//! A counter is odd while the values that it stands for are being written (a seqlock): nobody waits for anybody. Who reads them looks at
//! the counter before and after, and reads again if it was odd or has changed. The program counts for outputs and memory, the world
//! outside for what it writes. The scan's thread tries a few times and else keeps the inputs that it has: a writer that was interrupted in
//! the middle delays nothing.

use super::mapping::Mapping;
use super::options::AtEnd;
use super::points::{Area, Point};
use staunch_runtime::firmware::Place;
use std::io;
use std::sync::atomic::{Ordering, fence};

const MAGIC: u64 = u64::from_ne_bytes(*b"STAUNCH\0");
const VERSION: u32 = 1;

const VERSION_AT: usize = 8;
const SIZE_AT: usize = 12;
const INPUTS_AT: usize = 16;
const OUTPUTS_AT: usize = 20;
const SCANS_AT: usize = 24;
const STATE_AT: usize = 32;
const PROCESS_AT: usize = 36;
const HEADER: usize = 64;

const AREA: usize = Place::AREA_SIZE;
const SIZE: usize = HEADER + 3 * AREA;

/// How often inputs that change while they are read are read again.
const TRIES: usize = 3;

/// What the header says of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// It has not run yet.
    Starts = 0,
    Runs = 1,
    Ended = 2,
    Faulted = 3,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Image(Mapping);

/// Where a value is.
pub(super) fn place(point: &Point) -> usize {
    let area = match point.area {
        Area::Input => 0,
        Area::Output => 1,
        Area::Memory => 2,
    };
    HEADER + area * AREA + Place::new(point.area, point.width, point.number).at()
}

impl Image {
    /// Opens the image with this name, or makes it. Its inputs keep their values.
    pub fn open(name: &str) -> io::Result<Self> {
        let mapping = Mapping::open(name, SIZE)?;
        let (magic, version) = (mapping.long(0), mapping.double(VERSION_AT));
        let known = [(0, 0), (MAGIC, VERSION)];
        if !known.contains(&(magic.load(Ordering::Relaxed), version.load(Ordering::Relaxed))) {
            let text = "it is not a process image of this version: remove it, or write another name";
            return Err(io::Error::other(text));
        }
        version.store(VERSION, Ordering::Relaxed);
        mapping.double(SIZE_AT).store(SIZE as u32, Ordering::Relaxed);
        mapping.double(PROCESS_AT).store(std::process::id(), Ordering::Relaxed);
        mapping.long(SCANS_AT).store(0, Ordering::Relaxed);
        let image = Self(mapping);
        image.tell(State::Starts);
        // A program before may have ended in the middle.
        let outputs = mapping.double(OUTPUTS_AT);
        outputs.store(outputs.load(Ordering::Relaxed) & !1, Ordering::Relaxed);
        magic.store(MAGIC, Ordering::Release);
        Ok(image)
    }

    pub fn tell(self, state: State) {
        self.0.double(STATE_AT).store(state as u32, Ordering::Release);
    }

    pub fn load(self, point: &Point) -> u64 {
        self.0.load(point.width, place(point))
    }

    pub fn store(self, point: &Point, value: u64) {
        self.0.store(point.width, place(point), value);
    }

    pub fn replace(self, point: &Point, old: u64, new: u64) -> bool {
        self.0.replace(point.width, place(point), old, new)
    }

    /// Reads what the world outside writes; `false` where that is in the middle of it, and what was read is of no use.
    pub fn read_inputs(self, mut read: impl FnMut()) -> bool {
        let counter = self.0.double(INPUTS_AT);
        (0..TRIES).any(|_| {
            let before = counter.load(Ordering::Acquire);
            read();
            fence(Ordering::Acquire);
            before % 2 == 0 && counter.load(Ordering::Relaxed) == before
        })
    }

    /// Writes what the program shows, as one.
    pub fn publish(self, write: impl FnOnce()) {
        let counter = self.0.double(OUTPUTS_AT);
        let before = counter.load(Ordering::Relaxed);
        counter.store(before.wrapping_add(1) | 1, Ordering::Relaxed);
        fence(Ordering::Release);
        write();
        counter.store((before | 1).wrapping_add(1), Ordering::Release);
    }

    /// One more scan is in the image.
    pub fn count_scan(self) {
        let scans = self.0.long(SCANS_AT);
        scans.store(scans.load(Ordering::Relaxed) + 1, Ordering::Relaxed);
    }

    /// Outputs are as at the end of a run; with [`AtEnd::Zero`] also those of no variable are 0. Nothing but atomic stores: a handler of a
    /// signal may call it.
    pub fn end_outputs(self, at_end: AtEnd, safe: &[Point]) {
        const FIRST: usize = HEADER + AREA;
        if at_end == AtEnd::Hold && safe.is_empty() {
            return;
        }
        self.publish(|| {
            if at_end == AtEnd::Zero {
                (FIRST..FIRST + AREA).step_by(8).for_each(|at| self.0.long(at).store(0, Ordering::Relaxed));
            }
            safe.iter().for_each(|it| self.store(it, it.safe.unwrap_or(0)));
        });
    }
}
