//! A search for inputs that make two systems differ, and for every pitfall that the inputs can reach.
//! The same program gives the same answer.
//!
//! First every sequence, shortest first; then patterns from every state that is new in some respect;
//! then what is left of both, and random sequences from a fixed seed.

use super::exhaustive::Exhaustive;
use super::guided::Guided;
use super::progress::{Outcome, Search};
use super::trace::Trace;
use super::world::World;
use super::{random, shrink};
use crate::pair::Pair;

/// The share of the budget that other values get, where all states that those tried can reach were seen.
const MORE_VALUES: u64 = 16;

/// Bytes of states that all scans together may go through; a small state counts as `SMALL`.
const MAX_BYTES: u64 = 4 << 30;
const SMALL: usize = 512;

pub fn search(pair: &mut Pair, world: &World, budget: u64, wanted: usize) -> Outcome {
    // A large state takes its time to compare and to keep.
    let bytes = u64::try_from(pair.size().max(SMALL)).unwrap_or(u64::MAX);
    let most = (MAX_BYTES / bytes).max(1000);
    let limit = (budget > most).then_some(most);
    let budget = budget.min(most);
    let mut search = Search::new(pair, world, budget, wanted);
    run(&mut search, budget);
    let mut outcome = Outcome { limit, ..search.finish() };
    let mut shortest = |it: Trace| shrink::shrink(pair, world, shrink::Goal::Differ, it);
    outcome.found = outcome.found.map(&mut shortest);
    let calm = outcome.without_event.take().map(&mut shortest);
    outcome.found = match (outcome.found, calm) {
        // An event is rarer in a plant than the inputs' moves.
        (Some(found), Some(calm)) if calm.scans() <= found.scans() + found.scans() / 8 => Some(calm),
        (found, _) => found,
    };
    outcome
}

fn run(search: &mut Search<'_>, budget: u64) {
    (search.outcome.depth, search.outcome.complete) = look(search, budget);
    // What else there is gets its share, and no more; what parted may agree again.
    if search.go_on(budget / 16) {
        search.outcome.all_seen = look(search, search.left).1;
    }
}

/// How many scans of every sequence were tried, and whether that was all of them.
fn look(search: &mut Search<'_>, budget: u64) -> (usize, bool) {
    let alphabet = &search.world.alphabet;
    let (few, all) = (alphabet.few, alphabet.vectors.len());
    search.outcome.all_inputs = few == all;
    let mut exhaustive = Exhaustive::of(search, few);
    exhaustive.run(search, budget / 4 * 3);
    if exhaustive.complete && few < all && !search.is_done() {
        // What is left goes to the combinations that change more inputs.
        search.outcome.all_inputs = true;
        exhaustive = Exhaustive::of(search, all);
        exhaustive.run(search, budget / 4);
    }
    if !exhaustive.complete && !search.is_done() {
        let mut guided = Guided::new(search);
        guided.run(search, budget / 4);
        exhaustive.run(search, budget / 8);
        if !exhaustive.complete {
            guided.run(search, budget / 16);
            random::walk(search, &guided);
        }
        search.outcome.places = guided.places();
    }
    if exhaustive.complete && !search.is_done() && !search.world.alphabet.is_exact() {
        let guided = Guided::new(search);
        search.left = search.left.min(budget / MORE_VALUES);
        search.outcome.more_values = random::walk(search, &guided);
    }
    (exhaustive.depth, exhaustive.complete)
}
