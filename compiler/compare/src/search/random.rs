//! Sequences in which inputs hold, pulse and change, now and then all at once: for what neither
//! order nor novelty leads to. A number that the program computes with has more values than can be tried; some are drawn by
//! chance for each sequence, so that they come again in it.

use super::guided::Guided;
use super::progress::Search;
use super::trace::Trace;
use crate::inputs::choice::Choice;
use crate::pair::Step;
use staunch_ir::{Repr, Value};

/// Scans of one sequence.
const EPISODE: usize = 300;

/// Values of one input that are drawn for a sequence.
const DRAWN: usize = 3;

/// Until nothing of the budget is left; how many values were drawn.
pub fn walk(search: &mut Search<'_>, guided: &Guided) -> usize {
    let mut dice = Dice(0x5EED);
    let constants: Vec<i128> = search.world.constants.iter().copied().collect();
    let mut count = 0;
    let events = search.pair.events();
    let alphabet = &search.world.alphabet;
    let vectors: Vec<Vec<Value>> = alphabet.vectors.iter().take(alphabet.few).cloned().collect();
    while search.left > 0 && !search.is_done() {
        let (before, mut inputs, mut ages) = guided.enter(search, dice.below(guided.places().max(1)));
        let mut steps = Vec::new();
        let choices = &search.world.alphabet.choices;
        let palette: Vec<Vec<Value>> = choices.iter().map(|it| drawn(&mut dice, it, &constants)).collect();
        count += palette.iter().map(Vec::len).sum::<usize>();
        for _ in 0..EPISODE {
            let mut next = inputs.clone();
            match dice.below(8) {
                0 | 1 => {}
                7 => next.clone_from(dice.pick(&vectors)),
                _ if next.is_empty() => {}
                _ => {
                    let at = dice.below(next.len());
                    let few = &palette[at];
                    let takes_drawn = !few.is_empty() && dice.below(2) == 0;
                    next[at] = *dice.pick(if takes_drawn { few } else { &search.world.alphabet.choices[at].values });
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
    count
}

/// Values of an input that others than those tried may differ from: near what the program's constants make together, of few
/// bits, or any.
fn drawn(dice: &mut Dice, choice: &Choice, constants: &[i128]) -> Vec<Value> {
    let (Some(first), None) = (choice.values.first(), choice.covered) else { return Vec::new() };
    let repr = first.repr();
    let one = |dice: &mut Dice| match choice.range {
        Some(range) => {
            let number = whole(dice, range, constants)?;
            repr.integer(number - number.rem_euclid(choice.step)).filter(|_| number >= range.0)
        }
        None => real(dice, repr, constants),
    };
    (0..DRAWN).filter_map(|_| one(dice)).collect()
}

fn whole(dice: &mut Dice, (low, high): (i128, i128), constants: &[i128]) -> Option<i128> {
    let constant = |dice: &mut Dice| if constants.is_empty() { 1 } else { *dice.pick(constants) };
    let number = match dice.below(4) {
        0 => low.checked_add(dice.number().checked_rem(high.checked_sub(low)?.checked_add(1)?)?)?,
        1 => constant(dice).checked_add(dice.number() % 5 - 2)?,
        2 => {
            // A remainder and a multiple of a divisor, or a product and a sum.
            let shift = u32::try_from(dice.below(16)).ok()?;
            let times = dice.number() % (1 << shift) + 1;
            constant(dice).checked_mul(times)?.checked_add(constant(dice))?
        }
        _ => (0..=dice.below(3)).fold(0, |bits, _| bits | 1 << dice.below(64)) & high.max(0),
    };
    (low..=high).contains(&number).then_some(number)
}

fn real(dice: &mut Dice, repr: Repr, constants: &[i128]) -> Option<Value> {
    let near = if constants.is_empty() { 1 } else { *dice.pick(constants) };
    // A thousandth to twice of a constant.
    let number = format!("{near}e-3").parse::<f64>().ok()? * f64::from(u32::try_from(dice.below(2000)).ok()?);
    match repr {
        Repr::F32 => crate::inputs::alphabet::narrowed(number).map(Value::F32),
        Repr::F64 => Some(Value::F64(number)),
        _ => None,
    }
}

/// SplitMix64.
struct Dice(u64);

impl Dice {
    fn number(&mut self) -> i128 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        i128::from(bits ^ (bits >> 31))
    }

    fn below(&mut self, limit: usize) -> usize {
        let limit = i128::try_from(limit.max(1)).unwrap_or(1);
        usize::try_from(self.number() % limit).unwrap_or(0)
    }

    fn pick<'v, T>(&mut self, values: &'v [T]) -> &'v T {
        &values[self.below(values.len())]
    }
}
