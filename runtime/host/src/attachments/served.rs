//! What a Modbus server of a program answers from, whatever carries the requests.

use super::exchange::Exchange;
use super::options::AtEnd;
use super::pdu;
use super::points::{Point, Points};
use super::registers::{Registers, place};
use crate::Machine;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

#[derive(Debug)]
pub(super) struct Served {
    points: Vec<Point>,
    exchange: Exchange,
    /// One request at a time.
    registers: Mutex<Registers>,
    is_over: AtomicBool,
}

impl Served {
    pub fn new(points: &Points) -> Self {
        let points: Vec<Point> = points.all.iter().filter(|it| place(it).is_some()).copied().collect();
        Self {
            exchange: Exchange::new(points.len()),
            registers: Mutex::new(Registers::new(&points)),
            points,
            is_over: AtomicBool::new(false),
        }
    }

    /// The scan's side: writes into the state what clients have written, and returns the last request that it has seen.
    pub fn take(&self, machine: &mut dyn Machine) -> Option<u64> {
        self.exchange.take(&self.points, machine)
    }

    /// The scan's side: shows the values of a scan that has seen this request.
    pub fn show(&self, request: u64, state: &[u8]) {
        self.exchange.show(request, |at| self.points[at].read(state));
    }

    /// The run is over: outputs are safe, and the rest is as the last scan left it.
    pub fn show_end(&self, request: u64, at_end: AtEnd) {
        let mut last = vec![0; self.points.len()];
        self.exchange.see_newer(0, |shown| last.clone_from(&shown.values));
        self.exchange.show(request, |at| self.points[at].at_end(at_end, last[at]));
    }

    /// The run is over: threads that serve end.
    pub fn end(&self) {
        self.is_over.store(true, Ordering::Relaxed);
    }

    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    /// Whether a scan has been shown.
    pub fn is_shown(&self) -> bool {
        self.exchange.is_shown()
    }

    /// Appends the answer to a request.
    pub fn answer(&self, request: &[u8], answer: &mut Vec<u8>) {
        let mut registers = self.registers.lock().unwrap_or_else(PoisonError::into_inner);
        registers.update(&self.exchange);
        pdu::answer(request, &mut registers, answer);
        registers.hand_over(&self.exchange);
    }
}
