//! What a search does with each scan: what of it is new, and when there is nothing more to look for. The order
//! of the scans is `strategy`'s.

use super::look::{Seen, look};
use super::sighting::Sighting;
use super::trace::Trace;
use super::world::World;
use crate::pair::{Pair, Step};
use std::collections::HashMap;

/// Scans in which a difference without events is looked for at least, once there is one with.
const LEAST_WITHOUT_EVENTS: u64 = 20_000;

/// How the search went.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Inputs up to the first difference.
    pub found: Option<Trace>,
    /// And up to one that needs no event, where the first does.
    pub without_event: Option<Trace>,
    /// The shortest sequence that was met for each.
    pub sightings: HashMap<Sighting, Trace>,
    /// Every sequence of this many scans was tried.
    pub depth: usize,
    /// With every combination of inputs that there is; else with those that change few of them.
    pub all_inputs: bool,
    /// Every state that the inputs tried can reach was seen.
    pub complete: bool,
    /// And every state past the first difference.
    pub all_seen: bool,
    pub scans: u64,
    /// The most scans that a search of such states makes, where that is less than was asked for.
    pub limit: Option<u64>,
    /// States from which patterns were tried.
    pub places: usize,
    /// Values of inputs that were drawn by chance, besides those of the alphabet.
    pub more_values: usize,
}

#[derive(Debug)]
pub struct Search<'p> {
    pub pair: &'p mut Pair,
    pub world: &'p World,
    /// Scans that may still be made.
    pub left: u64,
    /// Scans of the pair when the search began.
    before: u64,
    /// Sightings that the two systems allow: when all are known, there is nothing more to find.
    wanted: usize,
    /// The difference that was found needs an event: until so many scans, one that needs none is looked for.
    by_event: Option<u64>,
    /// Past the first difference, for what else there is.
    goes_on: bool,
    ended: bool,
    pub outcome: Outcome,
}

impl<'p> Search<'p> {
    /// A search that may make so many scans.
    pub fn new(pair: &'p mut Pair, world: &'p World, budget: u64, wanted: usize) -> Self {
        let before = pair.scans;
        let outcome = Outcome::default();
        Self { pair, world, left: budget, before, wanted, by_event: None, goes_on: false, ended: false, outcome }
    }

    /// What was found, with the scans that it took.
    pub fn finish(self) -> Outcome {
        Outcome { scans: self.pair.scans - self.before, ..self.outcome }
    }

    /// Goes on past the first difference with so many scans; whether there is anything left to find.
    pub fn go_on(&mut self, scans: u64) -> bool {
        self.by_event = None;
        let goes_on = self.outcome.found.is_some() && self.outcome.sightings.len() < self.wanted;
        if goes_on {
            self.left = self.left.min(scans);
            self.goes_on = true;
        }
        goes_on
    }

    /// Whether there is nothing more to look for.
    pub fn is_done(&self) -> bool {
        self.outcome.found.is_some()
            && self.by_event.is_none_or(|it| it <= self.pair.scans)
            && (!self.goes_on || self.outcome.sightings.len() >= self.wanted)
    }

    /// One scan, and what it shows.
    pub fn scan(&mut self, step: &Step) -> Seen {
        self.left = self.left.saturating_sub(1);
        let faults = self.pair.scan(step);
        let seen = look(self.pair, self.world, step.event, faults);
        self.ended = seen.differs && !self.goes_on || seen.nothing_left || faults.iter().any(Option::is_some);
        seen
    }

    /// Whether nothing follows the last scan: the compared values differ, or a fault ends the run.
    pub fn ended(&self) -> bool {
        self.ended
    }

    /// Whether anything of it would be kept.
    pub fn is_new(&self, seen: &Seen) -> bool {
        let Outcome { found, sightings, .. } = &self.outcome;
        let differs = seen.differs && (found.is_none() || self.by_event.is_some());
        differs || seen.sightings.iter().any(|it| !sightings.contains_key(it))
    }

    /// Whether a trace shows it from the start.
    pub fn is_shown(&mut self, seen: &Seen, trace: &Trace) -> bool {
        let place = self.pair.place();
        self.pair.init();
        let mut last = Seen::default();
        for step in trace.steps() {
            let faults = self.pair.scan(step);
            last = look(self.pair, self.world, step.event, faults);
        }
        self.pair.go_to(&place);
        last.differs == seen.differs && seen.sightings.iter().all(|it| last.sightings.contains(it))
    }

    /// Keeps what is new or shorter.
    pub fn record(&mut self, seen: Seen, trace: impl FnOnce() -> Trace) {
        let Outcome { found, without_event, sightings, .. } = &mut self.outcome;
        let news: Vec<_> = seen.sightings.into_iter().filter(|it| !sightings.contains_key(it)).collect();
        let first = seen.differs && found.is_none();
        let other = seen.differs && self.by_event.is_some();
        if !first && !other && news.is_empty() {
            return;
        }
        let trace = trace();
        let needs_event = trace.steps().any(|it| it.event.is_some());
        if first || other && !needs_event {
            let place = if first { found } else { without_event };
            *place = Some(trace.clone());
            // As long again as the search has taken.
            let more = (self.pair.scans - self.before).max(LEAST_WITHOUT_EVENTS);
            self.by_event = needs_event.then_some(self.pair.scans.saturating_add(more));
        }
        sightings.extend(news.into_iter().map(|it| (it, trace.clone())));
    }
}
