//! A Modbus RTU server around a scan: a thread reads the frames on a serial line, and answers those to its unit from what the last scan has
//! left.

mod unit;

use super::attachment::{Attachment, Ended};
use super::line::Serial;
use super::options::{AtEnd, SerialUnit};
use super::points::Points;
use super::served::Served;
use crate::{Error, Machine};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;
use unit::{Account, Unit};

/// Bytes of the thread, which a run with a priority has locked.
const STACK: usize = 128 << 10;
/// A port that has gone is tried again after this.
const AFTER_ERROR: Duration = Duration::from_millis(250);
/// How long the thread may take to end.
const PATIENCE: Duration = Duration::from_secs(1);

#[derive(Debug)]
pub(super) struct RtuServer {
    served: Arc<Served>,
    account: Arc<Account>,
    at_end: AtEnd,
    /// The last request that a scan has seen.
    request: u64,
    /// Closed when the thread has ended.
    ended: Receiver<()>,
    label: String,
    quiet: bool,
}

impl RtuServer {
    pub fn start(unit: &SerialUnit, points: &Points, at_end: AtEnd, quiet: bool) -> Result<Self, Error> {
        let (label, line) = (format!("modbus-rtu: unit {} on {}", unit.unit, unit.line.port), &unit.line);
        let refused = |error| Error::Usage(format!("cannot serve on {} (--io modbus-rtu): {error}", line.port));
        let port = Serial::open(line).map_err(refused)?;
        if !quiet {
            crate::error::tell(format_args!("note: {label}: {}", line.settings()));
        }
        let (served, account, (end, ended)) = (Arc::new(Served::new(points)), Arc::default(), channel());
        let worker = Worker {
            unit: unit.clone(),
            served: Arc::clone(&served),
            account: Arc::clone(&account),
            label: label.clone(),
            _end: end,
        };
        let named = thread::Builder::new().name("modbus-rtu".to_owned()).stack_size(STACK);
        named.spawn(move || worker.work(port)).map_err(refused)?;
        Ok(Self { served, account, at_end, request: 0, ended, label, quiet })
    }
}

struct Worker {
    unit: SerialUnit,
    served: Arc<Served>,
    account: Arc<Account>,
    label: String,
    _end: Sender<()>,
}

impl Worker {
    /// Serves until the run is over. A port that has gone, as a USB adapter may, is opened again.
    fn work(self, port: Serial) {
        let mut port = Some(port);
        while !self.served.is_over() {
            if let Some(open) = port.take() {
                let mut unit = Unit::new(open, &self.unit, Arc::clone(&self.account));
                if let Err(error) = unit.serve(&self.served) {
                    self.tell(format_args!("the port has gone ({error}); it is opened again when it is back"));
                }
                continue;
            }
            thread::sleep(AFTER_ERROR);
            port = Serial::open(&self.unit.line).ok();
            if port.is_some() {
                self.tell(format_args!("the port is back"));
            }
        }
    }

    fn tell(&self, what: std::fmt::Arguments<'_>) {
        crate::error::tell(format_args!("warning: {}: {what}", self.label));
    }
}

impl Attachment for RtuServer {
    fn before(&mut self, machine: &mut dyn Machine) {
        if let Some(request) = self.served.take(machine) {
            self.request = request;
        }
    }

    fn after(&mut self, state: &[u8]) {
        self.served.show(self.request, state);
    }

    fn end(&mut self, _: Ended) {
        self.served.show_end(self.request, self.at_end);
        self.served.end();
        let _ = self.ended.recv_timeout(PATIENCE);
        if !self.quiet {
            let [answered, others, damaged] = [&self.account.answered, &self.account.others, &self.account.damaged]
                .map(|it| it.load(Ordering::Relaxed));
            crate::error::tell(format_args!(
                "note: {}: {answered} requests answered, {others} frames of other units, {damaged} damaged",
                self.label
            ));
        }
    }
}
