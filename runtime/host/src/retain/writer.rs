//! Saves what a running program retains, from a thread of its own: the scan's thread neither waits for
//! the disk nor allocates. It copies the bytes that changed into a box; the writer takes the newest.

use super::keeper::Keeper;
use super::storage::Storage;
use staunch_runtime::Time;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How long the writer waits after an error before it tries again, at least.
const AFTER_ERROR: Duration = Duration::from_secs(1);

/// How soon a change is on disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pace {
    within: Duration,
}

impl Pace {
    /// Within a time; 0 is as soon as the disk can.
    pub const fn within(within: Duration) -> Self {
        Self { within }
    }

    /// From the start of a write to that of the next, at least. The other half of the time is the disk's.
    fn gap(self) -> Duration {
        self.within / 2
    }

    /// How long to wait with the next write; `None` when it may start.
    fn wait(self, since_last: Option<(Duration, bool)>) -> Option<Duration> {
        let (since, failed) = since_last?;
        let gap = if failed { self.gap().max(AFTER_ERROR) } else { self.gap() };
        gap.checked_sub(since).filter(|it| !it.is_zero())
    }

    fn is_late(self, took: Duration) -> bool {
        !self.within.is_zero() && took > self.within - self.gap()
    }
}

/// The scan's side.
#[derive(Debug)]
pub(super) struct Writer {
    shared: Arc<Shared>,
    thread: JoinHandle<io::Result<()>>,
    /// How often values were handed over.
    generation: u64,
}

/// Two boxes: the writer holds one of them at most, so that the other is free.
#[derive(Debug)]
struct Shared {
    boxes: [Mutex<Parcel>; 2],
    /// The writer sleeps until it is woken up.
    idle: AtomicBool,
    ends: AtomicBool,
}

#[derive(Clone, Debug)]
struct Parcel {
    generation: u64,
    clock: Time,
    values: Vec<u8>,
    /// Why the run ended, or the one before while this one continues.
    fault: String,
}

impl Writer {
    /// `values` are those of the kept file, or that a start without a file has: they need not be written.
    pub fn start<S: Storage + 'static>(
        keeper: Keeper<S>,
        pace: Pace,
        (values, fault): (&[u8], &str),
        tell: impl Fn(&str) + Send + 'static,
    ) -> io::Result<Self> {
        let parcel = || Parcel { generation: 0, clock: 0, values: values.to_owned(), fault: fault.to_owned() };
        let boxes = [parcel(), parcel()].map(Mutex::new);
        let shared = Arc::new(Shared { boxes, idle: AtomicBool::new(false), ends: AtomicBool::new(false) });
        let (taken, desk_shared) = (parcel(), Arc::clone(&shared));
        let mut desk = Desk { shared: desk_shared, keeper, pace, taken, saved: 0, last: None, was_late: false };
        let thread = thread::Builder::new().name("retain".to_owned()).spawn(move || desk.work(&tell))?;
        Ok(Self { shared, thread, generation: 0 })
    }

    /// Hands values over. It takes as long as copying does.
    pub fn offer(&mut self, clock: Time, values: &[u8]) {
        self.generation += 1;
        // Who holds a box lets it go without waiting for anything: one of a few tries succeeds.
        while !self.hand_over(clock, values, None) {}
        if self.shared.idle.swap(false, Ordering::AcqRel) {
            self.thread.thread().unpark();
        }
    }

    fn hand_over(&self, clock: Time, values: &[u8], fault: Option<&str>) -> bool {
        let Some(mut parcel) = self.shared.boxes.iter().find_map(free) else { return false };
        (parcel.generation, parcel.clock) = (self.generation, clock);
        parcel.values.copy_from_slice(values);
        if let Some(fault) = fault {
            fault.clone_into(&mut parcel.fault);
        }
        true
    }

    /// Saves the last values, and the clock also where they are on disk already. Waits for the disk.
    pub fn finish(mut self, clock: Time, values: &[u8], fault: &str) -> io::Result<()> {
        self.generation += 1;
        while !self.hand_over(clock, values, Some(fault)) {}
        self.shared.ends.store(true, Ordering::Release);
        self.thread.thread().unpark();
        self.thread.join().unwrap_or_else(|_| Err(io::Error::other("the writer ended early")))
    }
}

fn free(parcel: &Mutex<Parcel>) -> Option<MutexGuard<'_, Parcel>> {
    match parcel.try_lock() {
        Ok(parcel) => Some(parcel),
        // Bytes are bytes, whoever panicked while they were copied: they are overwritten.
        Err(TryLockError::Poisoned(parcel)) => Some(parcel.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}

/// The writer's side.
struct Desk<S> {
    shared: Arc<Shared>,
    keeper: Keeper<S>,
    pace: Pace,
    /// What was saved last, or is being saved.
    taken: Parcel,
    saved: u64,
    /// When the last write began, and whether it failed.
    last: Option<(Instant, bool)>,
    was_late: bool,
}

impl<S: Storage> Desk<S> {
    fn work(&mut self, tell: &dyn Fn(&str)) -> io::Result<()> {
        loop {
            let ends = self.shared.ends.load(Ordering::Acquire);
            let wait = self.pace.wait(self.last.map(|(began, failed)| (began.elapsed(), failed)));
            if let (Some(time), false) = (wait, ends) {
                thread::park_timeout(time);
                continue;
            }
            // Before the boxes are looked into: what comes after that wakes this thread up.
            self.shared.idle.store(true, Ordering::Release);
            self.take_newest();
            if self.taken.generation != self.saved {
                self.shared.idle.store(false, Ordering::Release);
                let result = self.save(tell);
                if ends {
                    return result;
                }
            } else if ends {
                return Ok(());
            } else {
                thread::park();
            }
        }
    }

    fn take_newest(&mut self) {
        for parcel in &self.shared.boxes {
            let parcel = parcel.lock().unwrap_or_else(PoisonError::into_inner);
            if parcel.generation > self.taken.generation {
                (self.taken.generation, self.taken.clock) = (parcel.generation, parcel.clock);
                self.taken.values.copy_from_slice(&parcel.values);
                self.taken.fault.clone_from(&parcel.fault);
            }
        }
    }

    /// Says what changes: an error when it comes and when it is over, a slow disk once.
    fn save(&mut self, tell: &dyn Fn(&str)) -> io::Result<()> {
        let began = Instant::now();
        let result = self.keeper.save(self.taken.clock, &self.taken.values, &self.taken.fault);
        let took = began.elapsed();
        let failed_before = self.last.replace((began, result.is_err())).is_some_and(|it| it.1);
        match &result {
            Ok(()) => {
                self.saved = self.taken.generation;
                if failed_before {
                    tell("retained variables are saved again");
                }
            }
            Err(error) if !failed_before => {
                tell(&format!("retained variables cannot be saved: {error}; trying again"));
            }
            Err(_) => {}
        }
        if self.pace.is_late(took) && !std::mem::replace(&mut self.was_late, true) {
            let took = took.as_millis();
            tell(&format!(
                "the disk took {took} ms to save retained variables: changes are saved later than requested"
            ));
        }
        result
    }
}

#[cfg(test)]
mod tests;
