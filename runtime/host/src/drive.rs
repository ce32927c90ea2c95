//! A program scan by scan, without stimulus and trace, that can go back to where it was: what a
//! search drives. Times, tasks and restarts are those of [`run`](crate::run()).

use crate::map::Map;
use crate::retain::Retained;
use crate::schedule::Schedule;
use crate::{Compiled, Machine};
use staunch_runtime::{Context, Fault, Time};

/// When the programs of one map run, and what a restart leaves of them.
#[derive(Clone, Debug)]
pub struct Drive {
    schedule: Schedule,
    retained: Retained,
    /// Instances that have not run since the start.
    fresh: Vec<bool>,
}

/// A place in time that a [`Drive`] can go back to.
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
        Self { schedule, retained: Retained::of(map), fresh: vec![true; map.instances.len()] }
    }

    /// When the next scan is due.
    pub fn next(&self) -> Time {
        self.schedule.next()
    }

    /// The least time from scan to scan of a program.
    pub fn shortest_period(&self) -> Time {
        self.schedule.shortest_period()
    }

    /// A power cycle: what is not retained starts anew. Inputs are to be written again.
    pub fn restart(&mut self, machine: &mut dyn Machine) {
        let kept = self.retained.snapshot(machine.state());
        machine.init();
        self.retained.restore(&kept, machine);
        self.fresh.fill(true);
    }

    /// Whether a restart keeps anything, so that it is more than a new start.
    pub fn retains(&self) -> bool {
        !self.retained.is_empty()
    }

    /// Whether a restart keeps the byte at this offset.
    pub fn keeps(&self, offset: usize) -> bool {
        self.retained.holds(offset)
    }

    /// The programs that are due.
    pub fn scan(&mut self, machine: &mut Compiled) -> Result<(), Fault> {
        let now = self.schedule.next();
        for instance in self.schedule.advance(now, false) {
            let cx = Context::new(now, std::mem::take(&mut self.fresh[*instance]));
            machine.scan(*instance, &cx)?;
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

    /// What decides of the time to come, but for when it is: for each program how long until it is
    /// due, and whether it has not run since the start.
    pub fn phases(&self) -> impl Iterator<Item = (Time, bool)> {
        let now = self.schedule.next();
        self.schedule.times().map(move |it| it - now).zip(self.fresh.iter().copied())
    }
}
