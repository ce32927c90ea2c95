//! Which mutant is on, and which code has been asked that.
extern crate std;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

const NOT_READ: u32 = u32::MAX;
const NONE: u32 = u32::MAX - 1;
static ON: AtomicU32 = AtomicU32::new(NOT_READ);
static REACHED: [AtomicBool; 1 << 15] = [const { AtomicBool::new(false) }; 1 << 15];

/// Whether this mutant is on: the one that was turned on, before that the one of `STAUNCH_MUTANT`.
#[inline(never)]
pub fn on(number: u32) -> bool {
    REACHED[number as usize].store(true, Relaxed);
    let on = ON.load(Relaxed);
    if on == NOT_READ { read() == number } else { on == number }
}

#[cold]
fn read() -> u32 {
    let on = std::env::var("STAUNCH_MUTANT").ok().and_then(|it| it.parse().ok()).unwrap_or(NONE);
    turn_on(on);
    on
}

pub fn turn_on(number: u32) {
    ON.store(number, Relaxed);
}

/// Those that were asked for since the last call.
pub fn reached() -> std::vec::Vec<u32> {
    (0u32..).zip(&REACHED).filter(|(_, it)| it.swap(false, Relaxed)).map(|(number, _)| number).collect()
}
