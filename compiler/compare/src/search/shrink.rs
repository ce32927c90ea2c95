//! A sequence of inputs without what its difference does not need.

use super::look;
use super::sighting::Sighting;
use super::trace::Trace;
use super::world::World;
use crate::pair::{Pair, Step};

/// Scans that making the sequence to the first difference shorter may take.
const BUDGET: u64 = 4_000_000;
/// And one that shows another finding, of which there may be many.
const SMALL_BUDGET: u64 = 40_000;
/// A sequence of at most this many scans is tried without each of them.
const MAX_STEPS: usize = 300;
/// More parts than this are not tried one by one.
const MAX_GROUPS: usize = 200;

/// What a sequence is to show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// The compared values differ.
    Differ,
    Sees(Sighting),
}

/// Leaves out runs of scans, events, and changes of inputs.
pub fn shrink(pair: &mut Pair, world: &World, goal: Goal, trace: Trace) -> Trace {
    let left = match goal {
        Goal::Differ => BUDGET,
        Goal::Sees(_) => SMALL_BUDGET,
    };
    let mut shrink = Shrink { pair, world, goal, left };
    let Some(mut best) = shrink.tried(trace.clone()) else { return trace };
    loop {
        let calm = shrink.shortest(best);
        let calm = shrink.calmer(calm);
        // With inputs that keep their values, a scan may be one too many.
        best = shrink.shorter(calm.clone());
        if best.scans() == calm.scans() {
            return calm;
        }
    }
}

struct Shrink<'p> {
    pair: &'p mut Pair,
    world: &'p World,
    goal: Goal,
    left: u64,
}

impl Shrink<'_> {
    /// Shorter and shorter: what is left may repeat in another way.
    fn shortest(&mut self, mut best: Trace) -> Trace {
        loop {
            let before = best.scans();
            best = self.shorter(best);
            if best.scans() == before || self.left == 0 {
                return best;
            }
            best = Trace::of(best.steps().cloned().collect());
        }
    }

    fn shorter(&mut self, best: Trace) -> Trace {
        let best = self.groups(best);
        let best = self.bodies(best);
        if best.scans() <= MAX_STEPS { self.steps(best) } else { best }
    }

    fn shows_after(&mut self, trace: &Trace) -> Option<usize> {
        self.pair.init();
        let mut ages = self.world.assumptions.ages();
        let mut before = &self.world.initial;
        for (step, number) in trace.steps().zip(1..) {
            if self.left == 0 || number == 1 && step.event.is_some() {
                return None;
            }
            self.left -= 1;
            ages = self.world.assumptions.age(&ages, before, &step.inputs)?;
            // What the inputs hold before they are given is not what the plant does.
            if (number == 1 || before != &step.inputs) && !self.world.assumptions.allow(&step.inputs) {
                return None;
            }
            before = &step.inputs;
            let faults = self.pair.scan(step);
            let seen = look::look(self.pair, self.world, step.event, faults);
            let shown = match self.goal {
                Goal::Differ => seen.differs,
                Goal::Sees(sighting) => seen.sightings.contains(&sighting),
            };
            if shown {
                return Some(number);
            }
            if faults.iter().any(Option::is_some) {
                return None;
            }
        }
        None
    }

    /// The sequence up to what is looked for, if it shows that.
    fn tried(&mut self, trace: Trace) -> Option<Trace> {
        let scans = self.shows_after(&trace)?;
        Some(if scans == trace.scans() { trace } else { trace.first(scans) })
    }

    /// Each group as few times as will do.
    fn groups(&mut self, mut best: Trace) -> Trace {
        let mut at = 0;
        while at < best.groups.len().min(MAX_GROUPS) {
            let times = best.groups[at].times;
            best = self.fewest(best, times, |trace, times| trace.groups[at].times = times);
            at += 1;
        }
        best.groups.retain(|it| it.times > 0);
        best
    }

    /// Each run of a group as few scans as will do.
    fn bodies(&mut self, mut best: Trace) -> Trace {
        for group in 0..best.groups.len().min(MAX_GROUPS) {
            let mut at = 0;
            while best.groups.get(group).is_some_and(|it| at < it.body.len()) {
                let scans = best.groups[group].body[at].1;
                best = self.fewest(best, scans, |trace, scans| trace.groups[group].body[at].1 = scans);
                at += 1;
            }
        }
        best.groups.iter_mut().for_each(|it| it.body.retain(|run| run.1 > 0));
        best.groups.retain(|it| !it.body.is_empty());
        best
    }

    /// Looks for the least number with which it still does, by halves.
    fn fewest(&mut self, best: Trace, mut enough: usize, set: impl Fn(&mut Trace, usize)) -> Trace {
        let mut found = best;
        let mut too_few = None;
        while let Some(middle) = between(too_few, enough) {
            let mut fewer = found.clone();
            set(&mut fewer, middle);
            match self.shows_after(&fewer) {
                Some(scans) if scans <= found.scans() => {
                    (found, enough) = (fewer, middle);
                }
                Some(_) | None => too_few = Some(middle),
            }
        }
        found
    }

    /// Without each part of the sequence, halves first.
    fn steps(&mut self, best: Trace) -> Trace {
        let mut steps: Vec<Step> = best.steps().cloned().collect();
        let mut size = steps.len() / 2;
        while size > 0 && self.left > 0 {
            let mut at = 0;
            while at < steps.len() {
                let mut fewer = steps.clone();
                fewer.drain(at..(at + size).min(steps.len()));
                match self.shows_after(&Trace::of(fewer.clone())) {
                    Some(length) => {
                        fewer.truncate(length);
                        steps = fewer;
                    }
                    None => at += size,
                }
            }
            size /= 2;
        }
        Trace::of(steps)
    }

    /// Inputs that keep their value, or the one they start with; events that are not needed.
    fn calmer(&mut self, best: Trace) -> Trace {
        let mut best = self.tried(best.clone()).unwrap_or(best);
        let scans = best.scans();
        let mut before = self.world.initial.clone();
        for group in 0..best.groups.len().min(MAX_GROUPS) {
            for run in 0..best.groups[group].body.len() {
                for (input, kept) in before.iter().enumerate() {
                    for simpler in [self.world.initial[input], *kept] {
                        let mut calmer = best.clone();
                        calmer.groups[group].body[run].0.inputs[input] = simpler;
                        if calmer != best && self.shows_after(&calmer) == Some(scans) {
                            best = calmer;
                            break;
                        }
                    }
                }
                before.clone_from(&best.groups[group].body[run].0.inputs);
            }
        }
        best
    }
}

/// The count to try: none at all first.
fn between(too_few: Option<usize>, enough: usize) -> Option<usize> {
    match too_few {
        None if enough == 0 => None,
        None => Some(0),
        Some(few) if few + 1 >= enough => None,
        Some(few) => Some(few + (enough - few) / 2),
    }
}
