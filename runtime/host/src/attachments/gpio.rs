//! Lines of GPIO chips around a scan: a thread reads the inputs and writes the outputs, each millisecond. The scan takes the inputs that were read
//! last, and leaves its outputs; it waits for nobody.

mod group;
mod lines;
mod worker;

#[cfg(target_os = "linux")]
mod chip;
#[cfg(not(target_os = "linux"))]
#[path = "gpio/no_chip.rs"]
mod chip;

use super::attachment::{Attachment, Ended};
use super::exchange::Exchange;
use super::options::AtEnd;
use super::points::{Point, Points};
use crate::map::Map;
use crate::{Error, Machine};
pub use group::check_pins;
use group::{Planned, plan};
use lines::Chips;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;
use worker::{Shared, Worker};

/// Bytes of the thread, which a run with a priority has locked.
const STACK: usize = 128 << 10;
/// How long the thread may take for its last outputs.
const PATIENCE: Duration = Duration::from_secs(1);

#[derive(Debug)]
pub(super) struct Gpio {
    points: Vec<Point>,
    /// Of each point that is an output, what it is at the end, if that is stated.
    safe: Vec<Option<bool>>,
    /// The values of the last scan.
    last: Vec<u64>,
    shared: Arc<Shared>,
    at_end: AtEnd,
    request: u64,
    /// Closed when the thread has ended.
    ended: Receiver<()>,
}

impl Gpio {
    /// The lines of a program, if it has some.
    pub fn start(map: &Map, points: &Points, at_end: AtEnd) -> Result<Option<Self>, Error> {
        if map.pins.is_empty() { Ok(None) } else { Self::start_at(&chip::Kernel, map, points, at_end).map(Some) }
    }

    fn start_at(chips: &dyn Chips, map: &Map, points: &Points, at_end: AtEnd) -> Result<Self, Error> {
        let planned = plan(&map.pins, map, points).map_err(|(at, text)| refused(&map.pins[at].variable, &text))?;
        let Planned { points, safe, groups } = planned;
        let mut open = Vec::new();
        for group in groups {
            let lines = chips.open(&group).map_err(|text| refused(&group.chip, &text))?;
            let (bits, mask) = group.at_emergency(&safe, at_end);
            if mask != 0 && !lines.guard(bits, mask) {
                return Err(refused(&group.chip, "the outputs have too many different settings"));
            }
            open.push((group, lines));
        }
        let (shared, (end, ended)) = (Arc::new(Shared::new(Exchange::new(points.len()))), channel());
        let worker = Worker::new(open, points.len(), Arc::clone(&shared), end);
        let named = thread::Builder::new().name("gpio".to_owned()).stack_size(STACK);
        named.spawn(move || worker.work()).map_err(|error| refused("threads", &error.to_string()))?;
        let last = vec![0; points.len()];
        Ok(Self { points, safe, last, shared, at_end, request: 0, ended })
    }
}

fn refused(what: &str, text: &str) -> Error {
    Error::Usage(format!("gpio: {what}: {text}"))
}

impl Attachment for Gpio {
    fn before(&mut self, machine: &mut dyn Machine) {
        if let Some(request) = self.shared.exchange.take(&self.points, machine) {
            self.request = request;
        }
    }

    fn after(&mut self, state: &[u8]) {
        let Self { points, last, .. } = self;
        last.iter_mut().zip(points.iter()).for_each(|(last, point)| *last = point.read(state));
        self.shared.exchange.show(self.request, |at| self.last[at]);
    }

    fn lost(&self) -> Option<Error> {
        self.shared.lost()
    }

    /// Outputs at their safe values are written as the thread's last act. Before the first scan, lines have them already.
    fn end(&mut self, _: Ended) {
        if self.shared.exchange.is_shown() {
            self.shared.exchange.show(self.request, |at| match self.safe[at] {
                Some(safe) => u64::from(safe),
                None => self.points[at].at_end(self.at_end, self.last[at]),
            });
        }
        self.shared.end();
        let _ = self.ended.recv_timeout(PATIENCE);
    }
}

#[cfg(test)]
mod tests;
