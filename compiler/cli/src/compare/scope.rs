//! What a search has shown where it found no difference: what was tried, and what was not.

use super::pair::Pair;
use super::search::{Outcome, World};
use super::{Verdict, alphabet};
use staunch_host::Event;
use std::fmt::Write;

/// What an exhausted search has shown.
pub fn every_state(pair: &Pair, world: &World, outcome: &Outcome) -> String {
    let compared = world.alphabet.choices.iter().zip(&pair.inputs);
    let compared: Vec<&str> = compared
        .filter(|it| it.0.covered == Some(alphabet::Covered::Compared))
        .map(|it| pair.path(it.1.scalars))
        .collect();
    let mut text = format!("every reachable state was seen ({} scans)", outcome.scans);
    match compared.as_slice() {
        [] => text.push_str(", under every value of the inputs"),
        names => {
            let _ = write!(
                text,
                ", under every value of the inputs on every side of the constants that the program compares {} with",
                names.join(", ")
            );
        }
    }
    if let Some(events) = events(pair) {
        let _ = write!(text, ", with {events} at every point");
    }
    assumed(&mut text, world);
    text
}

/// The events that are tried.
fn events(pair: &Pair) -> Option<String> {
    let words = pair.events().into_iter().map(|it| match it {
        Event::Restart => "a restart",
        Event::Run => "STOP -> RUN",
        Event::Reset => "a reset",
    });
    words.map(str::to_owned).reduce(|all, it| format!("{all} and {it}"))
}

fn assumed(text: &mut String, world: &World) {
    if !world.assumptions.lines.is_empty() {
        let _ = write!(text, "; assumed: {}", world.assumptions.lines.join("; "));
    }
}

/// What a search that found nothing has tried, and what it has not.
pub fn not_found(pair: &Pair, world: &World, outcome: &Outcome) -> Verdict {
    let alphabet = &world.alphabet;
    let mut tried = vec![match outcome.complete {
        true => "every state that the values tried can reach".to_owned(),
        false => format!("every sequence of inputs over {} scans", outcome.depth),
    }];
    if outcome.places > 0 {
        tried.push(format!("inputs that hold, pulse and wait, from {} states", outcome.places));
    }
    tried.extend(events(pair).map(|it| format!("{it} at each of them")));
    tried.push(format!("{} scans in all", outcome.scans));
    if !world.assumptions.lines.is_empty() {
        tried.push(format!("assumed: {}", world.assumptions.lines.join("; ")));
    }
    let mut left = Vec::new();
    if !outcome.complete {
        left.push("longer sequences; a larger --budget tries more of them".to_owned());
    }
    for (choice, input) in alphabet.choices.iter().zip(&pair.inputs).filter(|it| it.0.covered.is_none()) {
        let path = pair.path(input.scalars);
        left.push(format!("values of {path} other than the {} that were tried", choice.values.len()));
    }
    if !alphabet.complete {
        left.push(format!("combinations of inputs other than the {} that change few of them", alphabet.vectors.len()));
    }
    if alphabet::has_untried(pair) {
        left.push("inputs that are strings, or of another type on the other system".to_owned());
    }
    if !pair.whole {
        left.push("elements of long arrays".to_owned());
    }
    Verdict::NotFound { tried, left }
}
