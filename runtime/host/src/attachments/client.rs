//! A Modbus client (a master) around a scan: a thread asks a server for inputs and writes outputs to it, in a period of its own. The scan
//! takes the inputs of the last whole turn, and leaves the outputs of the last whole scan; it waits for nobody.
//!
//! Each server of Modbus TCP has a thread. The units on a serial line share one, as only one request may be on the line.

mod layout;
mod link;
mod plan;
mod rtu;
mod shared;
mod tcp;
mod trouble;
mod wire;
mod worker;

use super::attachment::{Attachment, Ended};
use super::options::AtEnd;
use super::points::{Point, Points};
use crate::map::Map;
use crate::remote::{Remote, Server};
use crate::{Error, Machine};
pub use layout::openplc_layout;
use plan::Plan;
pub use plan::{Mistake, check_remotes};
pub(super) use plan::{input_places, values};
use shared::{Account, Shared};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;
use worker::{Station, Worker};

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

impl Client {
    /// The clients of all servers of a program.
    pub fn start_all(map: &Map, points: &Points, at_end: AtEnd, quiet: bool) -> Result<Vec<Self>, Error> {
        let mut clients = Vec::new();
        for (at, remote) in map.remotes.iter().enumerate() {
            let is_on_line = |other: &&Remote| shares_line(remote, other);
            if map.remotes[..at].iter().any(|it| is_on_line(&it)) {
                continue;
            }
            let further = map.remotes[at + 1..].iter().filter(is_on_line);
            clients.extend(Self::start(std::iter::once(remote).chain(further), map, points, at_end, quiet)?);
        }
        Ok(clients)
    }

    /// Those whose requests are made one after the other, by one thread.
    fn start<'m>(
        remotes: impl Iterator<Item = &'m Remote>,
        map: &Map,
        points: &Points,
        at_end: AtEnd,
        quiet: bool,
    ) -> Result<Vec<Self>, Error> {
        let (mut clients, mut stations) = (Vec::new(), Vec::new());
        for remote in remotes {
            let plan =
                Plan::of(remote, map, points).map_err(|it| Error::Usage(format!("{}: {}", remote.label(), it.text)))?;
            let shared = Arc::new(Shared::new(plan.points.len()));
            let (points, label, (end, ended)) = (plan.points.clone(), remote.label(), channel());
            stations.push(Station::new(remote.clone(), plan, Arc::clone(&shared), end));
            clients.push(Self { points, shared, at_end, turn: 0, ended, patience: Duration::ZERO, label, quiet });
        }
        // Another unit may just be asked.
        let patience = stations.iter().map(Station::patience).sum();
        clients.iter_mut().for_each(|it| it.patience = patience);
        let worker = Worker::new(stations);
        let named = thread::Builder::new().name("modbus server".to_owned()).stack_size(STACK);
        let label = clients.first().map_or_else(String::new, |it| it.label.clone());
        named
            .spawn(move || worker.work())
            .map_err(|error| Error::Usage(format!("{label}: cannot start a thread: {error}")))?;
        Ok(clients)
    }
}

fn shares_line(one: &Remote, other: &Remote) -> bool {
    match (&one.server, &other.server) {
        (Server::Serial(one), Server::Serial(other)) => one.port == other.port,
        (Server::Tcp(_) | Server::Serial(_), _) => false,
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
        let trouble = format!("{} (on-loss = \"fault\")", self.shared.account().trouble);
        Some(Error::Connection { name: self.label.clone(), trouble })
    }

    /// Outputs at their safe values are written as the thread's last act.
    fn end(&mut self, _: Ended) {
        if self.shared.exchange.is_shown() {
            let mut last = vec![0; self.points.len()];
            self.shared.exchange.see_newer(0, |shown| last.clone_from(&shown.values));
            self.shared.exchange.show(self.turn, |at| self.points[at].at_end(self.at_end, last[at]));
        }
        self.shared.is_over.store(true, Ordering::Release);
        let _ = self.ended.recv_timeout(self.patience);
        if !self.quiet {
            let Account { answered, failed, .. } = self.shared.account().clone();
            crate::error::tell(format_args!("note: {}: {answered} requests answered, {failed} not", self.label));
        }
    }
}
