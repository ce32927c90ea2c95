//! Sequences in which inputs hold, pulse and change, now and then all at once: for what neither
//! order nor novelty leads to.

use super::guided::Guided;
use super::pair::Step;
use super::search::Search;
use super::trace::Trace;

/// Scans of one sequence.
const EPISODE: usize = 300;

/// Until nothing of the budget is left.
pub fn walk(search: &mut Search<'_>, guided: &Guided) {
    let mut dice = Dice(0x5EED);
    let events = search.pair.events();
    let vectors = search.world.alphabet.vectors.clone();
    while search.left > 0 && !search.is_done() {
        let (before, mut inputs, mut ages) = guided.enter(search, dice.below(guided.places().max(1)));
        let mut steps = Vec::new();
        for _ in 0..EPISODE {
            let mut next = inputs.clone();
            match dice.below(8) {
                0 | 1 => {}
                7 => next.clone_from(dice.pick(&vectors)),
                _ if next.is_empty() => {}
                _ => {
                    let at = dice.below(next.len());
                    next[at] = *dice.pick(&search.world.alphabet.choices[at].values);
                }
            }
            let assumptions = &search.world.assumptions;
            let Some(now) = assumptions.allow(&next).then(|| assumptions.age(&ages, &inputs, &next)).flatten() else {
                continue;
            };
            let event = match events.as_slice() {
                [] => None,
                events if dice.below(16) == 0 => Some(*dice.pick(events)),
                _ => None,
            };
            let started = !steps.is_empty() || !before.is_empty();
            let event = event.filter(|_| started);
            (inputs, ages) = (next, now);
            let step = Step { event, inputs: inputs.clone() };
            let seen = search.scan(&step);
            steps.push(step);
            if !seen.is_empty() {
                search.record(seen, || Trace::of(before.iter().chain(&steps).cloned().collect()));
            }
            if search.ended() || search.left == 0 {
                break;
            }
        }
        if steps.is_empty() {
            // The assumptions let nothing happen from here.
            search.left = search.left.saturating_sub(1);
        }
    }
}

/// SplitMix64.
struct Dice(u64);

impl Dice {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let limit = u64::try_from(limit.max(1)).unwrap_or(1);
        usize::try_from((bits ^ (bits >> 31)) % limit).unwrap_or(0)
    }

    fn pick<'v, T>(&mut self, values: &'v [T]) -> &'v T {
        &values[self.below(values.len())]
    }
}
