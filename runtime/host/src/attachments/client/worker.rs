//! The thread that makes the requests: of one server of Modbus TCP, or of all units of a serial line, in turn.

use super::plan::Plan;
use super::shared::{NAP, Shared};
use super::trouble::Trouble;
use super::wire::Wire;
use crate::remote::{OnLoss, Remote, Server};
use std::fmt::Display;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::Sender;
use std::thread;
use std::time::{Duration, Instant};

/// A server that refuses a connection at once is asked again after this.
const AFTER_REFUSAL: Duration = Duration::from_millis(250);

pub(super) struct Worker {
    /// Those whose run is not over.
    stations: Vec<Station>,
    /// Of all of them.
    wire: Option<Wire>,
}

/// A server, or a unit of a serial line.
pub(super) struct Station {
    remote: Remote,
    plan: Plan,
    shared: Arc<Shared>,
    /// The last scan whose outputs are known, and these.
    scan: u64,
    outputs: Vec<u64>,
    /// When the next turn of requests is made.
    due: Instant,
    /// Since when the server does not answer.
    lost: Option<Instant>,
    _end: Sender<()>,
}

impl Worker {
    pub fn new(stations: Vec<Station>) -> Self {
        Self { stations, wire: None }
    }

    pub fn work(mut self) {
        while let Some(at) = self.next() {
            let station = &mut self.stations[at];
            let is_last = station.shared.is_over();
            match station.turn(&mut self.wire, is_last) {
                Ok(()) => station.found(),
                Err(trouble) => station.missed(&trouble),
            }
            station.plan_next();
            if is_last {
                self.stations.remove(at);
            }
        }
    }

    /// Waits until a station is due, or its run is over. The one that has waited longest comes first, so that each has its turn also
    /// where the line is too slow for the periods.
    fn next(&self) -> Option<usize> {
        loop {
            if let Some(at) = self.stations.iter().position(|it| it.shared.is_over()) {
                return Some(at);
            }
            let (at, due) = self.stations.iter().map(|it| it.due).enumerate().min_by_key(|it| it.1)?;
            let left = due.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Some(at);
            }
            thread::sleep(NAP.min(left));
        }
    }
}

impl Station {
    pub fn new(remote: Remote, plan: Plan, shared: Arc<Shared>, end: Sender<()>) -> Self {
        let outputs = vec![0; plan.points.len()];
        Self { remote, plan, shared, scan: 0, outputs, due: Instant::now(), lost: None, _end: end }
    }

    /// How long its last turn may take.
    pub fn patience(&self) -> Duration {
        3 * self.remote.timeout + 2 * NAP
    }

    fn plan_next(&mut self) {
        let now = Instant::now();
        self.due = (self.due + self.remote.period).max(now);
        if self.lost.is_some() {
            self.due = self.due.max(now + self.rest());
        }
    }

    /// How long a server that does not answer is left alone. On a serial line, its late answer is dropped meanwhile, and the other
    /// units have most of the time.
    fn rest(&self) -> Duration {
        match self.remote.server {
            Server::Tcp(_) => AFTER_REFUSAL,
            Server::Serial(_) => AFTER_REFUSAL.max(2 * self.remote.timeout),
        }
    }

    /// Asks for all inputs, and writes all outputs. The last turn writes only.
    fn turn(&mut self, wire: &mut Option<Wire>, is_last: bool) -> Result<(), Trouble> {
        let mut inputs = Vec::new();
        if !is_last {
            for read in &self.plan.reads {
                self.ask(wire, |wire| wire.read(&self.remote, read, &mut inputs))?;
            }
        }
        // While something is lost, inputs are what that makes of them until a whole turn is answered.
        let was_lost = self.lost.is_some();
        if !was_lost {
            self.shared.exchange.write(&inputs);
        }
        self.shared.exchange.see_newer(self.scan, |shown| {
            self.scan = shown.scan;
            self.outputs.clone_from(&shown.values);
        });
        // Before the first scan, nothing has been decided.
        if self.scan > 0 {
            for write in &self.plan.writes {
                self.ask(wire, |wire| wire.write(&self.remote, write, &self.outputs))?;
            }
        }
        if was_lost {
            self.shared.exchange.write(&inputs);
        }
        Ok(())
    }

    /// One request. On a connection that was idle, or that the server has closed, it is made once more on a new one; and once more where
    /// its answer was damaged.
    fn ask(
        &self,
        line: &mut Option<Wire>,
        mut request: impl FnMut(&mut Wire) -> Result<(), Trouble>,
    ) -> Result<(), Trouble> {
        let mut asked = line.as_mut().map_or(Err(Trouble::Closed), &mut request);
        if matches!(asked, Err(Trouble::Closed)) {
            // The port is free for what opens it anew.
            *line = None;
            asked = request(line.insert(Wire::connect(&self.remote)?));
        }
        if let (Err(Trouble::Damaged(_)), Some(wire)) = (&asked, line.as_mut()) {
            self.shared.account().failed += 1;
            asked = request(wire);
        }
        match &asked {
            Ok(()) => self.shared.account().answered += 1,
            // What else is on its way would be taken for the next answer.
            Err(Trouble::Closed | Trouble::Failed(_)) => *line = None,
            Err(Trouble::Unanswered(_) | Trouble::Damaged(_) | Trouble::Refused(_)) => {}
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
