//! The safe outputs of a program whose scan does not end: a watchdog, or a signal that has waited for it, ends the process from another
//! thread. It calls this first, which only stores to memory and sets lines.

use super::image::{Image, State};
use super::options::{AtEnd, Connection};
use super::points::Point;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// An image, and what its outputs are at the end.
type Kept = (Image, AtEnd, &'static [Point]);
static IMAGES: [OnceLock<Kept>; Connection::MOST] = [const { OnceLock::new() }; Connection::MOST];
/// Groups of lines with the same settings.
const MOST_LINES: usize = 64;
static LINES: [OnceLock<Guarded>; MOST_LINES] = [const { OnceLock::new() }; MOST_LINES];
static LINE_COUNT: AtomicUsize = AtomicUsize::new(0);

/// Lines of a GPIO chip, and the bits that they take.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "only Linux has lines"))]
pub(super) struct Guarded {
    /// It only makes one system call.
    pub set: fn(descriptor: i32, bits: u64, mask: u64),
    pub descriptor: i32,
    pub bits: u64,
    pub mask: u64,
}

/// From now on, these lines are cared for; `false` where there are too many.
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "only Linux has lines"))]
pub(super) fn add_lines(lines: Guarded) -> bool {
    LINES.get(LINE_COUNT.fetch_add(1, Ordering::Relaxed)).is_some_and(|it| it.set(lines).is_ok())
}

static COUNT: AtomicUsize = AtomicUsize::new(0);

/// From now on, this image is cared for.
pub(super) fn add(image: Image, at_end: AtEnd, safe: &'static [Point]) {
    let place = IMAGES.get(COUNT.fetch_add(1, Ordering::Relaxed));
    place.map(|it| it.set((image, at_end, safe)));
}

/// The process is about to end in the middle of a scan.
pub(crate) fn stop() {
    for (image, at_end, safe) in IMAGES.iter().filter_map(OnceLock::get) {
        image.end_outputs(*at_end, safe);
        image.tell(State::Faulted);
    }
    for Guarded { set, descriptor, bits, mask } in LINES.iter().filter_map(OnceLock::get) {
        set(*descriptor, *bits, *mask);
    }
}
