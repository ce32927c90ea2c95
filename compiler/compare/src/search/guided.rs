//! Patterns from every state that is new in some respect: inputs that hold, pulse, or wait until the
//! program has settled, for as long as anything changes by it.
//!
//! A state is new where a variable, a count against the program's constants, or the difference of the two
//! systems is as it was not before. States in which counters have parted come first: the
//! compared values may follow.

use super::novelty::Novelty;
use super::progress::Search;
use super::trace::{Paths, ROOT, Trace, Way};
use crate::pair::{Place, Step};
use staunch_ir::Value;
use std::collections::VecDeque;
use std::rc::Rc;

/// Scans of a pattern before others have their turn; then for longer; then past the limit of a WORD.
const TURNS: [usize; 3] = [300, 12_000, 140_000];
/// States that are kept.
const MAX_PLACES: usize = 20_000;
/// Bytes of states that are kept.
const MAX_BYTES: usize = 256 << 20;

/// A state from which patterns are tried.
#[derive(Debug)]
struct Waypoint {
    place: Place,
    inputs: Vec<Value>,
    ages: Vec<u8>,
    path: usize,
    is_start: bool,
}

/// A pattern that has not come to its end.
#[derive(Debug)]
struct Pattern {
    from: usize,
    steps: Rc<[Step]>,
    /// Goes on to the next step when the program has settled, not in each scan.
    waits: bool,
    /// How far it went.
    place: Place,
    ages: Vec<u8>,
    scans: usize,
    halves: Vec<usize>,
    turn: usize,
}

/// What is to be done next, in an order of its own for each kind.
#[derive(Debug)]
struct Queue<T> {
    items: VecDeque<T>,
    /// Scans that went into it.
    spent: u64,
}

impl<T> Default for Queue<T> {
    fn default() -> Self {
        Self { items: VecDeque::new(), spent: 0 }
    }
}

/// Kinds of states: counters have parted; something is new; a combination is new.
const RANKS: usize = 3;
/// How much of the scans each kind of state, and each length of pattern, gets.
const WEIGHTS: [u64; RANKS + 2] = [4, 4, 2, 3, 3];

#[derive(Debug)]
pub struct Guided {
    novelty: Novelty,
    paths: Paths,
    waypoints: Vec<Waypoint>,
    fresh: [Queue<usize>; RANKS],
    cut: [Queue<Pattern>; 2],
}

impl Guided {
    pub fn new(search: &mut Search<'_>) -> Self {
        let novelty = Novelty::of(search.pair, &search.world.constants);
        search.pair.init();
        let start = Waypoint {
            place: search.pair.place(),
            inputs: search.world.initial.clone(),
            ages: search.world.assumptions.ages(),
            path: ROOT,
            is_start: true,
        };
        let mut guided = Self {
            novelty,
            paths: Paths::default(),
            waypoints: vec![start],
            fresh: Default::default(),
            cut: Default::default(),
        };
        guided.fresh[1].items.push_back(0);
        guided
    }

    pub fn places(&self) -> usize {
        self.waypoints.len()
    }

    /// Goes to a state; with the steps that lead to it.
    pub fn enter(&self, search: &mut Search<'_>, at: usize) -> (Vec<Step>, Vec<Value>, Vec<u8>) {
        let it = &self.waypoints[at];
        search.pair.go_to(&it.place);
        let none = Way::Cycle(Rc::from([]), 0);
        (self.paths.steps(it.path, &none), it.inputs.clone(), it.ages.clone())
    }

    pub fn run(&mut self, search: &mut Search<'_>, reserve: u64) {
        while search.left > reserve && !search.is_done() {
            let spent = |at: usize, spent: u64| spent / WEIGHTS[at];
            let fresh = self.fresh.iter().enumerate().filter(|it| !it.1.items.is_empty());
            let fresh = fresh.map(|(at, it)| (spent(at, it.spent), at));
            let cut = self.cut.iter().enumerate().filter(|it| !it.1.items.is_empty());
            let cut = cut.map(|(at, it)| (spent(RANKS + at, it.spent), RANKS + at));
            let Some((_, next)) = fresh.chain(cut).min() else { return };
            let before = search.left;
            match next.checked_sub(RANKS) {
                None => {
                    let Some(at) = self.fresh[next].items.pop_front() else { return };
                    self.expand(search, at, reserve);
                    self.fresh[next].spent += before - search.left;
                }
                Some(turn) => {
                    let Some(pattern) = self.cut[turn].items.pop_front() else { return };
                    self.follow(search, pattern, reserve);
                    self.cut[turn].spent += before - search.left;
                }
            }
        }
    }

    /// Every pattern from a state.
    fn expand(&mut self, search: &mut Search<'_>, from: usize, reserve: u64) {
        let inputs = self.waypoints[from].inputs.clone();
        let allowed = |it: &Vec<Value>| search.world.assumptions.allow(it);
        let mut others: Vec<Vec<Value>> = Vec::new();
        for (at, choice) in search.world.alphabet.choices.iter().enumerate() {
            let with = |value: &Value| {
                let mut inputs = inputs.clone();
                inputs[at] = *value;
                inputs
            };
            others.extend(choice.values.iter().filter(|it| **it != inputs[at]).map(with).filter(allowed));
        }
        if !allowed(&inputs) {
            // The start, as the assumptions see it: any combination may come first.
            others.extend(search.world.alphabet.vectors.iter().take(64).cloned());
        }
        let events = if self.waypoints[from].is_start { Vec::new() } else { search.pair.events() };
        let waits = search.pair.has_timers() || !search.world.assumptions.ages().is_empty();
        let same = allowed(&inputs).then(|| inputs.clone());
        let mut patterns: Vec<(Vec<Step>, bool)> = Vec::new();
        for event in events {
            let restart = |it: &Vec<Value>| (vec![Step { event: Some(event), inputs: it.clone() }], false);
            patterns.extend(same.iter().chain(&others).map(restart));
        }
        patterns.extend(same.iter().map(|it| (vec![Step::of(it.clone())], false)));
        for other in &others {
            patterns.push((vec![Step::of(other.clone())], false));
            if let Some(same) = &same {
                let pulse = vec![Step::of(other.clone()), Step::of(same.clone())];
                patterns.push((pulse.clone(), false));
                patterns.extend(waits.then_some((pulse, true)));
            }
        }
        for (steps, waits) in patterns {
            if search.left <= reserve || search.is_done() {
                return;
            }
            let Waypoint { place, ages, .. } = &self.waypoints[from];
            let (place, ages) = (place.clone(), ages.clone());
            let steps = Rc::from(steps);
            self.follow(
                search,
                Pattern { from, steps, waits, place, ages, scans: 0, halves: Vec::new(), turn: 0 },
                reserve,
            );
        }
    }

    /// Follows a pattern until the two differ, it repeats itself, or others have their turn.
    fn follow(&mut self, search: &mut Search<'_>, mut pattern: Pattern, reserve: u64) {
        search.pair.go_to(&pattern.place);
        let mut known = Known::default();
        let once = pattern.steps.iter().any(|it| it.event.is_some());
        let limit = if once { 1 } else { TURNS[pattern.turn] };
        let mut before = match pattern.last() {
            Some(step) => step.inputs.clone(),
            None => self.waypoints[pattern.from].inputs.clone(),
        };
        while pattern.scans < limit && search.left > reserve {
            let step = pattern.steps[pattern.position()].clone();
            let Some(ages) = search.world.assumptions.age(&pattern.ages, &before, &step.inputs) else {
                // It has to stay longer: wait with what was before.
                if !pattern.stay() {
                    return;
                }
                continue;
            };
            pattern.ages = ages;
            let seen = search.scan(&step);
            pattern.count();
            if !seen.is_empty() {
                let way = pattern.way();
                let path = self.waypoints[pattern.from].path;
                search.record(seen, || Trace::of(self.paths.steps(path, &way)));
            }
            if search.ended() || search.is_done() {
                return;
            }
            self.note(search, &pattern, &step);
            let key = search.pair.key(&pattern.ages);
            let settled = known.last == Some(key);
            known.last = Some(key);
            if pattern.waits {
                let waited = pattern.halves.last().copied().unwrap_or(0);
                if settled || waited > search.world.longest + 2 {
                    pattern.halves.push(0);
                }
            }
            if known.repeats(key, pattern.position()) {
                return;
            }
            before = step.inputs;
        }
        if !once && pattern.turn + 1 < TURNS.len() && self.waypoints.len() < MAX_PLACES {
            pattern.place = search.pair.place();
            pattern.turn += 1;
            self.cut[pattern.turn - 1].items.push_back(pattern);
        }
    }

    /// Keeps a state that is new in some respect.
    fn note(&mut self, search: &Search<'_>, pattern: &Pattern, step: &Step) {
        let Some(rank) = self.novelty.rank(search.pair, &step.inputs) else { return };
        let room = self.waypoints.len() < MAX_PLACES && self.waypoints.len() * (search.pair.size() + 512) < MAX_BYTES;
        if !room {
            return;
        }
        let path = self.paths.add(self.waypoints[pattern.from].path, pattern.way());
        self.waypoints.push(Waypoint {
            place: search.pair.place(),
            inputs: step.inputs.clone(),
            ages: pattern.ages.clone(),
            path,
            is_start: false,
        });
        self.fresh[rank].items.push_back(self.waypoints.len() - 1);
    }
}

impl Pattern {
    /// The step that comes next.
    fn position(&self) -> usize {
        let turns = if self.waits { self.halves.len().saturating_sub(1) } else { self.scans };
        turns % self.steps.len()
    }

    fn last(&self) -> Option<&Step> {
        let turns = if self.waits { self.halves.len() } else { self.scans };
        let before = match self.halves.last() {
            Some(0) => turns.checked_sub(2),
            _ => turns.checked_sub(1),
        };
        before.map(|it| &self.steps[it % self.steps.len()])
    }

    fn count(&mut self) {
        self.scans += 1;
        match self.halves.last_mut() {
            Some(last) => *last += 1,
            None if self.waits => self.halves.push(1),
            None => {}
        }
    }

    /// Goes on with the step before, where the pattern can wait.
    fn stay(&mut self) -> bool {
        self.halves.len() > 1 && self.halves.pop_if(|it| *it == 0).is_some()
    }

    fn way(&self) -> Way {
        match self.waits {
            true => Way::Wave(Rc::clone(&self.steps), self.halves.clone()),
            false => Way::Cycle(Rc::clone(&self.steps), self.scans),
        }
    }
}

/// Brent's way to see that states repeat: one of them is kept, for longer and longer.
#[derive(Debug, Default)]
struct Known {
    last: Option<u128>,
    kept: Option<(u128, usize)>,
    since: usize,
    power: usize,
}

impl Known {
    fn repeats(&mut self, key: u128, position: usize) -> bool {
        if self.kept == Some((key, position)) {
            return true;
        }
        self.since += 1;
        if self.since >= self.power {
            (self.kept, self.since, self.power) = (Some((key, position)), 0, (self.power * 2).max(1));
        }
        false
    }
}
