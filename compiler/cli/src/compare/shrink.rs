//! A sequence of inputs without what the difference does not need.

use super::hold::Run;
use super::pair::{Pair, Step};

/// Longer sequences are made shorter by what repeats in them, not scan by scan.
const MAX_STEPS: usize = 300;
/// More runs than this are not made shorter by trying.
const MAX_RUNS: usize = 100;

/// Leaves out runs of scans, restarts, changes of inputs.
pub fn shrink(pair: &mut Pair, mut steps: Vec<Step>) -> Vec<Step> {
    if steps.len() > MAX_STEPS {
        steps = by_runs(pair, steps);
    }
    if steps.len() > MAX_STEPS {
        return without_the_first(pair, steps);
    }
    let shorter = shorter(pair, steps);
    calmer(pair, shorter)
}

fn without_the_first(pair: &mut Pair, steps: Vec<Step>) -> Vec<Step> {
    let later = steps[1..].to_vec();
    if pair.differs_after(&later) == Some(later.len()) { later } else { steps }
}

fn runs(steps: &[Step]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for step in steps {
        match runs.last_mut() {
            Some(run) if run.step == *step && !step.restart => run.scans += 1,
            _ => runs.push(Run { step: step.clone(), scans: 1 }),
        }
    }
    runs
}

fn steps(runs: &[Run]) -> Vec<Step> {
    runs.iter().flat_map(|it| std::iter::repeat_n(it.step.clone(), it.scans)).collect()
}

/// Each run at the fewest scans, then with its inputs at their start where that does as well.
fn by_runs(pair: &mut Pair, all: Vec<Step>) -> Vec<Step> {
    let mut shrunk = runs(&all);
    if shrunk.len() > MAX_RUNS {
        return all;
    }
    let mut at = 0;
    while at < shrunk.len() {
        fewest(pair, &mut shrunk, at);
        at += 1;
    }
    shrunk.retain(|it| it.scans > 0);
    let initial = pair.initial();
    for at in 0..shrunk.len() {
        for (input, start) in initial.iter().enumerate() {
            let mut calm = shrunk.clone();
            calm[at].step.inputs[input] = *start;
            let length = calm.iter().map(|it| it.scans).sum();
            if calm != shrunk && pair.differs_after(&steps(&calm)) == Some(length) {
                shrunk = calm;
            }
        }
    }
    steps(&shrunk)
}

/// Looks for the fewest scans of one run with which the two still differ, by halves.
fn fewest(pair: &mut Pair, runs: &mut [Run], at: usize) {
    let (mut too_few, mut enough) = (None, runs[at].scans);
    while let Some(middle) = between(too_few, enough) {
        let before = std::mem::replace(&mut runs[at].scans, middle);
        match pair.differs_after(&steps(runs)) {
            Some(length) => {
                end_after(runs, length);
                enough = runs[at].scans;
            }
            None => {
                runs[at].scans = before;
                too_few = Some(middle);
            }
        }
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

/// Cuts what stands after this many scans.
fn end_after(runs: &mut [Run], mut length: usize) {
    for run in runs {
        run.scans = run.scans.min(length);
        length -= run.scans;
    }
}

fn shorter(pair: &mut Pair, mut steps: Vec<Step>) -> Vec<Step> {
    let mut size = steps.len() / 2;
    while size > 0 {
        let mut at = 0;
        while at < steps.len() {
            let mut shorter = steps.clone();
            shorter.drain(at..(at + size).min(steps.len()));
            match pair.differs_after(&shorter) {
                Some(length) => {
                    shorter.truncate(length);
                    steps = shorter;
                }
                None => at += size,
            }
        }
        size /= 2;
    }
    steps
}

/// Inputs that keep their value, or the one they start with.
fn calmer(pair: &mut Pair, mut steps: Vec<Step>) -> Vec<Step> {
    let initial = pair.initial();
    for at in 0..steps.len() {
        for (input, start) in initial.iter().enumerate() {
            let before = if at == 0 { *start } else { steps[at - 1].inputs[input] };
            for simpler in [*start, before] {
                let mut calmer = steps.clone();
                calmer[at].inputs[input] = simpler;
                if calmer != steps && pair.differs_after(&calmer) == Some(steps.len()) {
                    steps = calmer;
                    break;
                }
            }
        }
    }
    steps
}
