//! Runs a program scan by scan, without stimulus and trace, and can return to an earlier point, as a
//! search needs. Times, tasks and restarts are those of [`run`](crate::run()).

use crate::map::Map;
use crate::schedule::{Due, Schedule};
use crate::start::{Event, Start};
use crate::{Compiled, Machine};
use staunch_runtime::{Context, Fault, Time};

/// When the programs of one map run, and what a restart leaves of them.
#[derive(Clone, Debug)]
pub struct Drive {
    schedule: Schedule,
    start: Start,
    /// Instances that have not run since the start.
    fresh: Vec<bool>,
}

/// A point in time to which a [`Drive`] can return.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bookmark {
    /// For each program, when it is due.
    next: Vec<Time>,
    fresh: Vec<bool>,
}

impl Drive {
    /// All instances of the map, at time 0.
    pub fn new(map: &Map, cycle: Option<Time>) -> Self {
        let running: Vec<usize> = (0..map.instances.len()).collect();
        let schedule = Schedule::new(map, &running, cycle);
        Self { schedule, start: Start::of(map), fresh: vec![true; map.instances.len()] }
    }

    /// When the next scan is due.
    pub fn next(&self) -> Time {
        self.schedule.next()
    }

    /// The shortest time between two scans of a program.
    pub fn shortest_period(&self) -> Time {
        self.schedule.shortest_period()
    }

    /// Variables that the event does not keep are initialised again. Inputs must be written again.
    pub fn start_again(&mut self, event: Event, machine: &mut dyn Machine) {
        self.start.again(event, machine);
        self.fresh.fill(true);
    }

    /// Whether an event keeps anything, so that it differs from a new start.
    pub fn keeps_anything(&self, event: Event) -> bool {
        !self.start.kept(event).is_empty()
    }

    /// Whether two events keep the same variables.
    pub fn are_alike(&self, a: Event, b: Event) -> bool {
        self.start.kept(a) == self.start.kept(b)
    }

    /// Whether an event keeps the same bytes as in another program.
    pub fn keeps_as(&self, event: Event, other: &Self) -> bool {
        self.start.kept(event) == other.start.kept(event)
    }

    /// Whether an event keeps the byte at this offset.
    pub fn keeps(&self, event: Event, offset: usize) -> bool {
        self.start.kept(event).iter().any(|it| it.contains(&offset))
    }

    /// The programs that are due.
    pub fn scan(&mut self, machine: &mut Compiled) -> Result<(), Fault> {
        self.scan_by(|instance, cx| machine.scan(instance, cx))
    }

    /// Advances to the next scan; the caller runs the programs.
    pub fn scan_by(&mut self, mut run: impl FnMut(usize, &Context) -> Result<(), Fault>) -> Result<(), Fault> {
        let now = self.schedule.next();
        self.schedule.advance(now, false);
        for Due { instance, period } in self.schedule.due() {
            let cx = Context::new(now, std::mem::take(&mut self.fresh[*instance])).with_cycle(*period);
            run(*instance, &cx)?;
        }
        Ok(())
    }

    pub fn bookmark(&self) -> Bookmark {
        Bookmark { next: self.schedule.times().collect(), fresh: self.fresh.clone() }
    }

    pub fn go_to(&mut self, bookmark: &Bookmark) {
        self.schedule.set_times(&bookmark.next);
        self.fresh.copy_from_slice(&bookmark.fresh);
    }

    /// The state of the schedule, independent of the present time: for each program how long until it is
    /// due, and whether it has not run since the start.
    pub fn phases(&self) -> impl Iterator<Item = (Time, bool)> {
        let now = self.schedule.next();
        self.schedule.times().map(move |it| it - now).zip(self.fresh.iter().copied())
    }
}
