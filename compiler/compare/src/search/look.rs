//! What one scan shows.

use super::sighting::{Sighting, Subject};
use super::world::World;
use crate::difference::pitfall::{self, Pitfall};
use crate::pair::{Faults, Matched, Pair};
use staunch_host::Event;
use staunch_runtime::Fault;

/// What one scan showed.
#[derive(Debug, Default)]
pub struct Seen {
    /// The compared values differ.
    pub differs: bool,
    /// All that is compared follows from what is accepted.
    pub nothing_left: bool,
    pub sightings: Vec<Sighting>,
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
        // A consequence of a difference that the event made is not a separate finding.
        let parted = pair.parted_by_event();
        let is_otherwise = sightings.iter().any(|it| it.1.is_some_and(|it| it != Pitfall::RESTART));
        let restarted = match parted.is_empty() {
            true if is_otherwise => Vec::new(),
            true => pair.newly_different(),
            false => parted,
        };
        sightings.extend(restarted.into_iter().map(|it| (Subject::Variable(it), Some(Pitfall::RESTART))));
    }
    sightings
}

/// The blocks that have parted in the last scan, by an event or by what they are given.
fn blocks_seen(pair: &Pair, event: Option<Event>) -> Vec<Sighting> {
    let restarted = (event.is_some() || pair.is_restarted()).then_some(Pitfall::RESTART);
    let is_late = |at: usize| {
        let states = pair.states();
        pair.is_other_timer(at) && pair.is_given_alike(at, states) && pair.is_over_at_once(at, states)
    };
    let pitfall = |at: usize| match () {
        () if pair.is_other_one_shot(at) && pair.is_given_alike(at, pair.states()) => Some(Pitfall::FIRST_FALL),
        () if restarted.is_none() && is_late(at) => Some(Pitfall::LATER_CALL),
        () => restarted,
    };
    let parted = |outputs: &[Matched]| {
        outputs.iter().any(|it| pair.newly_differs(*it)) && outputs.iter().all(|it| pair.agreed(*it))
    };
    let blocks = (0..pair.blocks.len()).filter(|at| parted(&pair.block_outputs[*at]));
    blocks.map(|at| (Subject::Block(at), pitfall(at))).collect()
}

/// The variables that differ by how they are computed: all their inputs were the same.
fn computed_seen(pair: &Pair, world: &World) -> Vec<Sighting> {
    let agree = |counter: &usize| pair.outputs[*counter].iter().all(|it| !pair.differs_now(*it));
    let parted = world.computed.iter().enumerate().filter(|it| pair.newly_differs(it.1.variable));
    let parted = parted.filter(|it| pair.counters_agree() || it.1.counters.iter().all(agree));
    let mut parted = parted.map(|(at, _)| (Subject::Computed(at), None)).peekable();
    if parted.peek().is_some() && pair.agreed_in_all() { parted.collect() } else { Vec::new() }
}
