//! The thread that reads and writes lines.

use super::group::Group;
use super::lines::Lines;
use crate::Error;
use crate::attachments::exchange::Exchange;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;

/// From one reading to the next.
const PERIOD: Duration = Duration::from_millis(1);

/// What the scan's thread and this one share.
#[derive(Debug)]
pub(super) struct Shared {
    pub exchange: Exchange,
    is_over: AtomicBool,
    /// Why lines cannot be read or written any more: the chip, and the error.
    trouble: OnceLock<(String, String)>,
}

pub(super) struct Worker {
    inputs: Vec<Open>,
    outputs: Vec<Open>,
    /// The last scan whose outputs are known, and these.
    scan: u64,
    values: Vec<u64>,
    shared: Arc<Shared>,
    _end: Sender<()>,
}

struct Open {
    group: Group,
    lines: Box<dyn Lines>,
    /// What was last read or written.
    bits: Option<u64>,
}

impl Shared {
    pub fn new(exchange: Exchange) -> Self {
        Self { exchange, is_over: AtomicBool::new(false), trouble: OnceLock::new() }
    }

    pub fn end(&self) {
        self.is_over.store(true, Ordering::Release);
    }

    pub fn lost(&self) -> Option<Error> {
        let (chip, trouble) = self.trouble.get()?;
        Some(Error::Connection { name: format!("gpio {chip}"), trouble: trouble.clone() })
    }
}

impl Worker {
    pub fn new(all: Vec<(Group, Box<dyn Lines>)>, points: usize, shared: Arc<Shared>, end: Sender<()>) -> Self {
        let open = |(group, lines)| Open { group, lines, bits: None };
        let (outputs, inputs) = all.into_iter().map(open).partition(|it| it.group.is_output);
        Self { inputs, outputs, scan: 0, values: vec![0; points], shared, _end: end }
    }

    /// Until the run is over, or a line fails: then the run ends.
    pub fn work(mut self) {
        loop {
            let is_last = self.shared.is_over.load(Ordering::Acquire);
            if let Err(trouble) = self.turn() {
                let _ = self.shared.trouble.set(trouble);
                // The other outputs still become safe.
                if is_last {
                    return;
                }
            }
            if is_last {
                return;
            }
            thread::sleep(PERIOD);
        }
    }

    /// The first error, after all lines had their turn.
    fn turn(&mut self) -> Result<(), (String, String)> {
        let mut trouble = Ok(());
        let mut note = |group: &Group, done: io::Result<()>| {
            if let (Ok(()), Err(error)) = (&trouble, done) {
                trouble = Err((group.chip.clone(), error.to_string()));
            }
        };
        let mut changed = Vec::new();
        for it in &mut self.inputs {
            let read = it.read(&mut changed);
            note(&it.group, read);
        }
        if !changed.is_empty() {
            self.shared.exchange.write(&changed);
        }
        self.shared.exchange.see_newer(self.scan, |shown| {
            self.scan = shown.scan;
            self.values.clone_from(&shown.values);
        });
        // Before the first scan, nothing has been decided.
        if self.scan > 0 {
            for it in &mut self.outputs {
                let written = it.write(&self.values);
                note(&it.group, written);
            }
        }
        trouble
    }
}

impl Open {
    fn read(&mut self, changed: &mut Vec<(usize, u64, u64)>) -> io::Result<()> {
        let bits = self.lines.read()?;
        let before = self.bits.replace(bits).unwrap_or(!bits);
        let points = self.group.lines.iter().enumerate();
        changed.extend(
            points.filter(|(at, _)| (before ^ bits) >> at & 1 == 1).map(|(at, it)| (it.point, bits >> at & 1, 1)),
        );
        Ok(())
    }

    fn write(&mut self, values: &[u64]) -> io::Result<()> {
        let bits = self.group.lines.iter().enumerate().fold(0, |bits, (at, it)| bits | (values[it.point] & 1) << at);
        if self.bits != Some(bits) {
            self.lines.write(bits)?;
            self.bits = Some(bits);
        }
        Ok(())
    }
}
