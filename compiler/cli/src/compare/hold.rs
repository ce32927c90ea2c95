//! Inputs that stay TRUE for long, as a switch or a light barrier does: what a timer waits for, and
//! what a counter that counts calls counts.

use super::duration;
use super::pair::{Pair, Step};
use super::search::LONG;
use staunch_ir::{Lane, Value};
use std::collections::BTreeSet;

/// Scans that an input is held at least: at 10 ms, more than three minutes.
const HELD: usize = 20_000;
/// Scans of TRUE and of FALSE in a wave, besides those that the program's constants ask for.
const FIXED: [usize; 3] = [10, 100, 1_000];
/// Constants of the program that a wave is made for.
const MAX_WAVES: usize = 8;
/// TRUE and FALSE in a wave, together.
const HALVES: usize = 24;
/// More inputs than this pulse only by themselves before they are held.
const MAX_PAIRED: usize = 8;

/// One step, again and again.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    pub step: Step,
    pub scans: usize,
}

/// Every BOOL TRUE, the others as they are.
pub fn raised(inputs: &[Value]) -> Vec<Value> {
    inputs.iter().map(|it| if it.lane() == Lane::Bool { Value::Bool(true) } else { *it }).collect()
}

/// The sequences to try, the simplest first: each input held, all of them, each of these vectors of
/// inputs, each input after a pulse, and each in long waves.
pub fn sequences(pair: &Pair, vectors: &[Step]) -> Vec<Vec<Run>> {
    let still = pair.initial();
    let bools: Vec<usize> = (0..still.len()).filter(|at| still[*at].lane() == Lane::Bool).collect();
    if bools.is_empty() {
        return Vec::new();
    }
    let constants = duration::scans(&pair.sides[0].program, pair.cycle);
    let longest = constants.iter().copied().filter(|it| *it < LONG).max().unwrap_or(0);
    let with = |at: usize, value: bool| {
        let mut inputs = still.clone();
        inputs[at] = Value::Bool(value);
        inputs
    };
    let run = |inputs: Vec<Value>, scans: usize| Run { step: Step { restart: false, inputs }, scans };
    let all = raised(&still);
    let held_for = |long: usize| {
        let each = bools.iter().map(move |at| with(*at, true));
        let together = (bools.len() > 1).then(|| all.clone());
        each.chain(together).map(move |it| vec![run(it, long)]).collect::<Vec<_>>()
    };
    let mut found = held_for(HELD);
    let short = constants.range(..HELD).next_back().map_or(0, |it| it + 100).max(FIXED[2]);
    let plain = vectors.iter().filter(|it| !it.restart);
    found.extend(plain.map(|it| vec![run(it.inputs.clone(), short)]));
    for held in &bools {
        let pulses = bools.iter().filter(|it| *it == held || bools.len() <= MAX_PAIRED);
        for pulse in pulses {
            found.push(vec![run(with(*pulse, true), 1), run(with(*pulse, false), 1), run(with(*held, true), HELD)]);
        }
    }
    // A preset is reached, and passed by a few.
    found.extend(Some(longest + 100).filter(|it| *it > HELD).into_iter().flat_map(held_for));
    for half in waves(&constants) {
        for at in &bools {
            let wave = [run(with(*at, true), half), run(with(*at, false), half)];
            found.push(wave.into_iter().cycle().take(HALVES).collect());
        }
    }
    found
}

/// Scans of each half of the waves to try, the shortest first.
fn waves(constants: &BTreeSet<usize>) -> BTreeSet<usize> {
    // A timer that starts in one scan is done some scans after the time has passed.
    let asked = constants.iter().map(|it| it + 2).filter(|it| it * 2 <= LONG);
    FIXED.into_iter().chain(asked.take(MAX_WAVES)).collect()
}
