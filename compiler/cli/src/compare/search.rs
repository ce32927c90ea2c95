//! What a search does with each scan: what it shows, what of that is new, and when there is nothing more to
//! look for. The order of the scans is `strategy`'s.

use super::alphabet::Alphabet;
use super::assume::Assumptions;
use super::beyond::Candidate;
use super::pair::{Faults, Matched, Pair, Step};
use super::pitfall::{self, Habits, Pitfall};
use super::sighting::{Sighting, Subject};
use super::tolerance::Tolerance;
use super::trace::Trace;
use staunch_host::Event;
use staunch_ir::Value;
use staunch_runtime::Fault;
use std::collections::{BTreeSet, HashMap};

/// Scans in which a difference without events is looked for at least, once there is one with.
const LEAST_WITHOUT_EVENTS: u64 = 20_000;

/// What the search knows of the world around the programs.
#[derive(Debug)]
pub struct World {
    pub alphabet: Alphabet,
    pub assumptions: Assumptions,
    /// The inputs before anything sets them.
    pub initial: Vec<Value>,
    /// Every sequence of more scans is left to patterns.
    pub depth: Option<usize>,
    /// Every constant of the programs.
    pub constants: BTreeSet<i128>,
    /// Scans that the longest wait in the programs takes.
    pub longest: usize,
    /// Whether a program assigns its own inputs, so that a stimulus has to write them in each scan.
    pub inputs_written: bool,
    /// How the programs use each counter.
    pub habits: Vec<Habits>,
    /// Variables that the two systems compute in other types.
    pub computed: Vec<Candidate>,
    /// What is accepted, where the search goes on past it.
    pub tolerance: Option<Tolerance>,
}

/// What one scan showed.
#[derive(Debug, Default)]
pub struct Seen {
    /// The compared values differ.
    pub differs: bool,
    /// All that is compared follows from what is accepted.
    pub nothing_left: bool,
    pub sightings: Vec<Sighting>,
}

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
    /// Every state that the inputs tried can reach was seen.
    pub complete: bool,
    /// And every state past the first difference.
    pub all_seen: bool,
    pub scans: u64,
    /// States from which patterns were tried.
    pub places: usize,
    /// Values of inputs that were drawn by chance, besides those of the alphabet.
    pub more_values: usize,
}

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

/// What the last scan has made differ that did not before.
pub fn look(pair: &mut Pair, world: &World, event: Option<Event>, faults: Faults) -> Seen {
    let mut sightings = sightings(pair, world, event, faults);
    let Some(tolerance) = &world.tolerance else {
        return Seen { differs: pair.differs(faults), nothing_left: false, sightings };
    };
    let passed = tolerance.passed(pair, event, &sightings);
    sightings.extend(tolerance.parted(pair));
    let (differs, nothing_left) = pair.differs_beyond(&tolerance.passing, &passed, faults);
    Seen { differs, nothing_left, sightings }
}

fn sightings(pair: &Pair, world: &World, event: Option<Event>, faults: Faults) -> Vec<Sighting> {
    let differs = pair.differs(faults);
    let mut sightings = Vec::new();
    if !pair.counters_agree() {
        for at in 0..pair.counters.len() {
            if let Some(pitfall) = pitfall::seen(pair, at, event, world.habits[at]) {
                sightings.push((Subject::Counter(at), pitfall));
            }
        }
    }
    if !pair.blocks_agree() {
        sightings.extend(blocks_seen(pair, event));
    }
    if event.is_none() && differs {
        sightings.extend(computed_seen(pair, world));
    }
    if pair.faults_differ(faults) {
        let of = |(side, fault): (usize, Option<Fault>)| Some((Subject::Fault(side, fault?.at), None));
        sightings.extend(faults.into_iter().enumerate().filter_map(of));
    }
    if event.is_some() && differs {
        let restarted = pair.newly_different();
        sightings.extend(restarted.into_iter().map(|it| (Subject::Variable(it), Some(Pitfall::RESTART))));
    }
    sightings
}

/// The blocks that have parted in the last scan, by an event or by what they are given.
fn blocks_seen(pair: &Pair, event: Option<Event>) -> Vec<Sighting> {
    let restarted = (event.is_some() || pair.is_restarted()).then_some(Pitfall::RESTART);
    let pitfall = |at: usize| if pair.is_other_one_shot(at) { Some(Pitfall::FIRST_FALL) } else { restarted };
    let parted = |outputs: &[Matched]| {
        outputs.iter().any(|it| pair.newly_differs(*it)) && outputs.iter().all(|it| pair.agreed(*it))
    };
    let blocks = (0..pair.blocks.len()).filter(|at| parted(&pair.block_outputs[*at]));
    blocks.map(|at| (Subject::Block(at), pitfall(at))).collect()
}

/// The variables that have parted by how they are computed: all that they are made of was the same.
fn computed_seen(pair: &Pair, world: &World) -> Vec<Sighting> {
    let agree = |counter: &usize| pair.outputs[*counter].iter().all(|it| !pair.differs_now(*it));
    let parted = world.computed.iter().enumerate().filter(|it| pair.newly_differs(it.1.variable));
    let parted = parted.filter(|it| pair.counters_agree() || it.1.counters.iter().all(agree));
    let mut parted = parted.map(|(at, _)| (Subject::Computed(at), None)).peekable();
    if parted.peek().is_some() && pair.agreed_in_all() { parted.collect() } else { Vec::new() }
}
