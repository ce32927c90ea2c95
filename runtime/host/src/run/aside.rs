//! The output of a run in real time, its trace and the program's messages, by a thread of its own: the scan's thread copies values into a bounded
//! ring, and neither writes, waits nor allocates. Rows without room there are counted, and lost.

use super::options::Options;
use super::ring::{Ring, Slot};
use crate::Error;
use crate::error::tell;
use crate::messages::Messages;
use crate::trace::{Row, Subject, Trace};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// The scan's side.
pub(super) struct Aside {
    shared: Arc<Shared>,
    /// How many rows it has lost.
    thread: JoinHandle<u64>,
    /// Of the state, what the columns show, and where messages are.
    parts: Vec<Range<usize>>,
    messages: Vec<Range<usize>>,
    /// How many messages the program had when they were last handed over, as bytes.
    count: Vec<u8>,
    has_trace: bool,
    /// Rows without room.
    dropped: u64,
}

struct Shared {
    ring: Ring,
    /// The thread sleeps until it is woken up.
    idle: AtomicBool,
    ends: AtomicBool,
}

impl Aside {
    /// `None` where there is nothing to write.
    pub fn start(subject: &Subject<'_>, options: &Options, state: &[u8]) -> Result<Option<Self>, Error> {
        let has_trace = options.trace.is_some();
        let messages = if options.quiet && !options.json { Vec::new() } else { Messages::places(subject.map) };
        if !has_trace && messages.is_empty() {
            return Ok(None);
        }
        let place = |at: usize, ty| at..at + subject.map.size_of(ty);
        let parts = subject.columns.iter().map(|it| place(it.place.offset, it.place.ty));
        let parts = if has_trace { neighbours(parts) } else { Vec::new() };
        let shared =
            Arc::new(Shared { ring: Ring::new(state), idle: AtomicBool::new(false), ends: AtomicBool::new(false) });
        let count = messages.first().map_or_else(Vec::new, |it| state[it.clone()].to_vec());
        let desk = Desk::new(subject, options, Arc::clone(&shared), !messages.is_empty());
        let map = subject.map.clone();
        let (columns, overlays) = (subject.columns.clone(), subject.overlays.clone());
        let (title, cycle) = (subject.title.clone(), subject.cycle);
        let work = move || desk.work(&Subject { map: &map, columns, overlays, title, cycle });
        let thread = thread::Builder::new().name("trace".to_owned()).spawn(work);
        let thread = thread.map_err(|it| Error::Usage(format!("no thread: {it}")))?;
        Ok(Some(Self { shared, thread, parts, messages, count, has_trace, dropped: 0 }))
    }

    /// Hands a row of the trace over.
    pub fn row(&mut self, row: Row<'_>) {
        if !self.has_trace {
            return;
        }
        let (when, state) = ((row.scan, row.time), row.state);
        let given = self.shared.ring.give(|it| it.fill(when, true, state, &self.parts));
        self.dropped += u64::from(!given);
        self.wake();
    }

    /// Hands new messages over. What finds no room is handed over with the next one.
    pub fn messages(&mut self, scan: u64, state: &[u8]) {
        let Some(count) = self.messages.first().map(|it| &state[it.clone()]) else { return };
        if count == self.count {
            return;
        }
        if self.shared.ring.give(|it| it.fill((scan, 0), false, state, &self.messages)) {
            self.count.copy_from_slice(count);
            self.wake();
        }
    }

    fn wake(&self) {
        if self.shared.idle.swap(false, Ordering::AcqRel) {
            self.thread.thread().unpark();
        }
    }

    /// Waits until all is written; the number of rows that are lost.
    pub fn finish(self) -> u64 {
        self.shared.ends.store(true, Ordering::Release);
        self.thread.thread().unpark();
        self.dropped + self.thread.join().unwrap_or(0)
    }
}

/// Ranges that follow one another are one.
fn neighbours(parts: impl Iterator<Item = Range<usize>>) -> Vec<Range<usize>> {
    let mut joined: Vec<Range<usize>> = Vec::new();
    for part in parts {
        match joined.last_mut().filter(|it| it.end == part.start) {
            Some(last) => last.end = part.end,
            None => joined.push(part),
        }
    }
    joined
}

/// The thread's side.
struct Desk {
    shared: Arc<Shared>,
    options: Options,
    messages: Option<Messages>,
    lost: u64,
    /// Rows that may not have been written yet.
    pending: u64,
}

impl Desk {
    fn new(subject: &Subject<'_>, options: &Options, shared: Arc<Shared>, has_messages: bool) -> Self {
        let messages = has_messages.then(|| Messages::of(subject.map));
        Self { shared, options: options.clone(), messages, lost: 0, pending: 0 }
    }

    fn work(mut self, subject: &Subject<'_>) -> u64 {
        let trace = self.options.trace.as_deref().map(|it| Trace::create(it, subject, true)).transpose();
        let mut trace = self.needed(trace).flatten();
        let shared = Arc::clone(&self.shared);
        loop {
            let ends = shared.ends.load(Ordering::Acquire);
            let mut has_more = false;
            while shared.ring.take(|it| self.tell(it, subject, &mut trace)) {
                has_more = true;
            }
            if has_more {
                self.written(&mut trace, |it| it.flush());
                self.pending = if trace.as_ref().is_some_and(Trace::is_picture) { self.pending } else { 0 };
            }
            if ends {
                break;
            }
            shared.idle.store(true, Ordering::Release);
            if shared.ring.is_empty() && !shared.ends.load(Ordering::Acquire) {
                thread::park_timeout(Duration::from_secs(1));
            }
        }
        self.written(&mut trace, |it| it.finish(subject));
        self.lost
    }

    fn tell(&mut self, slot: &Slot, subject: &Subject<'_>, trace: &mut Option<Trace>) {
        let Slot { scan, time, is_row, state } = slot;
        if !is_row {
            for it in self.messages.iter_mut().flat_map(|it| it.take(subject.map, state)) {
                // Whoever does not read objects gets a warning at the end.
                let _ = it.tell(*scan, &self.options);
            }
            return;
        }
        if trace.is_none() {
            self.lost += 1;
            return;
        }
        self.pending += 1;
        self.written(trace, |it| it.row(subject, Row { scan: *scan, time: *time, state }));
    }

    /// Without a trace that cannot be written the program continues: what it lacks is counted.
    fn written(&mut self, trace: &mut Option<Trace>, write: impl FnOnce(&mut Trace) -> Result<(), Error>) {
        let Some(written) = trace.as_mut().map(write) else { return };
        if self.needed(written).is_none() {
            self.lost += std::mem::take(&mut self.pending);
            *trace = None;
        }
    }

    fn needed<T>(&self, written: Result<T, Error>) -> Option<T> {
        written.map_err(|error| tell(format_args!("warning: {error}; the program continues without it"))).ok()
    }
}
