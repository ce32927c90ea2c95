//! A Modbus TCP client (a master) around a scan: a thread asks a server for inputs and writes outputs to it, in a period of its own. The scan
//! takes the inputs of the last whole turn, and leaves the outputs of the last whole scan; it waits for nobody.

mod plan;
mod wire;

use super::attachment::{Attachment, Ended};
use super::exchange::Exchange;
use super::options::AtEnd;
use super::points::{Point, Points};
use crate::map::Map;
use crate::remote::{OnLoss, Remote};
use crate::{Error, Machine};
use plan::Plan;
pub use plan::{Mistake, check_remotes};
use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use wire::{Trouble, Wire};

/// How often a thread that waits looks whether the run is over.
const NAP: Duration = Duration::from_millis(50);
/// A server that refuses a connection at once is asked again after this.
const AFTER_REFUSAL: Duration = Duration::from_millis(250);
/// Bytes of the thread, which a run with a priority has locked.
const STACK: usize = 128 << 10;

#[derive(Debug)]
pub(super) struct Client {
    points: Vec<Point>,
    shared: Arc<Shared>,
    at_end: AtEnd,
    /// The last turn that a scan has seen.
    turn: u64,
    /// Closed when the thread has ended.
    ended: Receiver<()>,
    /// How long that may take.
    patience: Duration,
    label: String,
    quiet: bool,
}

#[derive(Debug)]
struct Shared {
    exchange: Exchange,
    is_over: AtomicBool,
    /// The server does not answer, and that ends the run.
    is_fatal: AtomicBool,
    account: Mutex<Account>,
}

/// What became of the requests.
#[derive(Clone, Debug, Default)]
struct Account {
    answered: u64,
    failed: u64,
    /// Why the last one was not answered.
    trouble: String,
}

impl Client {
    pub fn start(remote: &Remote, map: &Map, points: &Points, at_end: AtEnd, quiet: bool) -> Result<Self, Error> {
        let plan =
            Plan::of(remote, map, points).map_err(|it| Error::Usage(format!("{}: {}", remote.label(), it.text)))?;
        let shared = Arc::new(Shared {
            exchange: Exchange::new(plan.points.len()),
            is_over: AtomicBool::new(false),
            is_fatal: AtomicBool::new(false),
            account: Mutex::new(Account::default()),
        });
        let (points, patience) = (plan.points.clone(), 3 * remote.timeout + 2 * NAP);
        let (end, ended) = channel();
        let worker =
            Worker { remote: remote.clone(), plan, shared: Arc::clone(&shared), wire: None, lost: None, _end: end };
        let named = thread::Builder::new().name("modbus server".to_owned()).stack_size(STACK);
        named
            .spawn(move || worker.work())
            .map_err(|error| Error::Usage(format!("{}: cannot start a thread: {error}", remote.label())))?;
        Ok(Self { points, shared, at_end, turn: 0, ended, patience, label: remote.label(), quiet })
    }
}

impl Attachment for Client {
    fn before(&mut self, machine: &mut dyn Machine) {
        if let Some(turn) = self.shared.exchange.take(&self.points, machine) {
            self.turn = turn;
        }
    }

    fn after(&mut self, state: &[u8]) {
        self.shared.exchange.show(self.turn, |at| self.points[at].read(state));
    }

    fn lost(&self) -> Option<Error> {
        if !self.shared.is_fatal.load(Ordering::Relaxed) {
            return None;
        }
        let trouble = self.shared.account().trouble.clone();
        Some(Error::Connection { name: self.label.clone(), trouble })
    }

    /// Outputs at their safe values are written as the thread's last act.
    fn end(&mut self, _: Ended) {
        if self.at_end == AtEnd::Zero && self.shared.exchange.is_shown() {
            self.shared.exchange.show(self.turn, |_| 0);
        }
        self.shared.is_over.store(true, Ordering::Release);
        let _ = self.ended.recv_timeout(self.patience);
        if !self.quiet {
            let Account { answered, failed, .. } = self.shared.account().clone();
            crate::error::tell(format_args!("note: {}: {answered} requests answered, {failed} not", self.label));
        }
    }
}

impl Shared {
    fn account(&self) -> std::sync::MutexGuard<'_, Account> {
        self.account.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Acquire)
    }
}

/// The thread's own.
struct Worker {
    remote: Remote,
    plan: Plan,
    shared: Arc<Shared>,
    wire: Option<Wire>,
    /// Since when the server does not answer.
    lost: Option<Instant>,
    _end: Sender<()>,
}

impl Worker {
    fn work(mut self) {
        let mut outputs = vec![0; self.plan.points.len()];
        let (mut scan, mut due) = (0, Instant::now());
        loop {
            let is_last = self.shared.is_over();
            match self.turn(&mut scan, &mut outputs, is_last) {
                Ok(()) => self.found(),
                Err(trouble) => self.missed(&trouble),
            }
            if is_last {
                return;
            }
            due = (due + self.remote.period).max(Instant::now());
            if self.lost.is_some() {
                due = due.max(Instant::now() + AFTER_REFUSAL);
            }
            while !self.shared.is_over() && Instant::now() < due {
                thread::sleep(NAP.min(due.saturating_duration_since(Instant::now())));
            }
        }
    }

    /// Asks for all inputs, and writes all outputs. The last turn writes only.
    fn turn(&mut self, scan: &mut u64, outputs: &mut Vec<u64>, is_last: bool) -> Result<(), Trouble> {
        let mut inputs = Vec::new();
        if !is_last {
            for at in 0..self.plan.reads.len() {
                self.ask(|wire, plan, unit| wire.read(unit, &plan.reads[at], &mut inputs))?;
            }
        }
        // While something is lost, inputs are what that makes of them until a whole turn is answered.
        let was_lost = self.lost.is_some();
        if !was_lost {
            self.shared.exchange.write(&inputs);
        }
        self.shared.exchange.see_newer(*scan, |shown| {
            *scan = shown.scan;
            outputs.clone_from(&shown.values);
        });
        // Before the first scan, nothing has been decided.
        if *scan > 0 {
            for at in 0..self.plan.writes.len() {
                self.ask(|wire, plan, unit| wire.write(unit, &plan.writes[at], outputs))?;
            }
        }
        if was_lost {
            self.shared.exchange.write(&inputs);
        }
        Ok(())
    }

    /// One request. On a connection that was idle, or that the server has closed, it is made once more on a new one.
    fn ask(&mut self, mut request: impl FnMut(&mut Wire, &Plan, u8) -> Result<(), Trouble>) -> Result<(), Trouble> {
        let unit = self.remote.unit;
        let mut asked = Err(Trouble::Closed);
        if let Some(wire) = &mut self.wire {
            asked = request(wire, &self.plan, unit);
        }
        if matches!(asked, Err(Trouble::Closed)) {
            self.wire = None;
            let wire = self.wire.insert(Wire::connect(&self.remote.server, self.remote.timeout)?);
            asked = request(wire, &self.plan, unit);
        }
        match &asked {
            Ok(()) => self.shared.account().answered += 1,
            // What else is on its way would be taken for the next answer.
            Err(Trouble::Closed | Trouble::Failed(_)) => self.wire = None,
            Err(Trouble::Refused(_)) => {}
        }
        asked
    }

    fn found(&mut self) {
        if let Some(lost) = self.lost.take() {
            self.tell(format_args!("it answers again, after {}", crate::spoken::rounded(lost.elapsed())));
        }
    }

    fn missed(&mut self, trouble: &Trouble) {
        let mut account = self.shared.account();
        account.failed += 1;
        if self.lost.is_some() {
            return;
        }
        account.trouble = trouble.to_string();
        drop(account);
        self.lost = Some(Instant::now());
        let what = match self.remote.on_loss {
            OnLoss::Hold => "inputs stay as they are",
            OnLoss::Safe => {
                let inputs = self.plan.inputs.iter().map(|at| (*at, 0, u64::MAX));
                self.shared.exchange.write(&inputs.collect::<Vec<_>>());
                "inputs are 0 and FALSE"
            }
            OnLoss::Fault => {
                self.shared.is_fatal.store(true, Ordering::Relaxed);
                return;
            }
        };
        self.tell(format_args!("{trouble}; {what}"));
    }

    fn tell(&self, what: impl Display) {
        crate::error::tell(format_args!("warning: {}: {what}", self.remote.label()));
    }
}
