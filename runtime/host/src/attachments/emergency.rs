//! The safe outputs of a program whose scan does not end: a watchdog, or a signal that has waited for it, ends the process from another
//! thread. It calls this first, which only stores to memory.

use super::image::{Image, State};
use super::options::{AtEnd, Connection};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

static IMAGES: [OnceLock<(Image, AtEnd)>; Connection::MOST] = [const { OnceLock::new() }; Connection::MOST];
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// From now on, this image is cared for.
pub(super) fn add(image: Image, at_end: AtEnd) {
    let place = IMAGES.get(COUNT.fetch_add(1, Ordering::Relaxed));
    place.map(|it| it.set((image, at_end)));
}

/// The process is about to end in the middle of a scan.
pub(crate) fn stop() {
    for (image, at_end) in IMAGES.iter().filter_map(OnceLock::get) {
        if *at_end == AtEnd::Zero {
            image.zero_outputs();
        }
        image.tell(State::Faulted);
    }
}
