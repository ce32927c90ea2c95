//! What a search has shown where it found no difference: what was tried, and what was not.

use super::Verdict;
use crate::difference::pitfall;
use crate::inputs::alphabet;
use crate::inputs::choice::Covered;
use crate::pair::{Input, Matched, Pair};
use crate::program::scalar::Instance;
use crate::search::progress::Outcome;
use crate::search::world::World;
use staunch_frontend::Dialect;
use staunch_frontend::rules::{Part, otherwise};
use staunch_host::Event;
use staunch_runtime::{Family, Fault, FaultKind};
use std::fmt::Write;

/// What an exhausted search has shown.
pub fn every_state(pair: &Pair, world: &World, outcome: &Outcome) -> String {
    let compared = world.alphabet.choices.iter().zip(&pair.inputs);
    let compared: Vec<&str> =
        compared.filter(|it| it.0.covered == Some(Covered::Compared)).map(|it| pair.path(it.1.scalars)).collect();
    let mut text = format!("every reachable state was seen ({} scans)", outcome.scans);
    if !pair.idle.is_empty() {
        text.push_str(" of all that decides what is compared");
    }
    if pair.are_settled {
        text.push_str(", with all counts past the values that they are compared with taken as one state");
    }
    match compared.as_slice() {
        [] => {
            text.push_str(", under every value of the inputs");
            // What else is written from outside was not looked at.
            let names = listed(pair.inputs.iter().map(|it| pair.path(it.scalars).to_owned()));
            text += &names.map_or_else(String::new, |it| format!(" ({it})"));
        }
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
    from_outside(&mut text, pair);
    assumed(&mut text, world);
    for limit in [kept(pair), of_one(pair), unlike(pair)].into_iter().flatten() {
        let _ = write!(text, "; {limit}");
    }
    text
}

/// Why two programs need no search.
pub fn same_program(pair: &Pair, world: &World) -> String {
    let mut text =
        "both systems run the same program: no statement, type, block or retention differs in what it does".to_owned();
    let has_subrange = |it: &Input| (0..2).any(|side| range_of(pair, side, it).is_some());
    if pair.inputs.iter().any(has_subrange) {
        text.push_str("; inputs have values of their subranges");
    }
    from_outside(&mut text, pair);
    assumed(&mut text, world);
    if let Some(kept) = kept(pair) {
        let _ = write!(text, "; {kept}");
    }
    text
}

fn range_of(pair: &Pair, side: usize, input: &Input) -> Option<(i128, i128)> {
    pair.sides[side].program.range(pair.scalar(side, input.scalars[side]).ty)
}

fn from_outside(text: &mut String, pair: &Pair) {
    if pair.sides.iter().any(|it| !it.program.structure(it.program.globals).fields.is_empty()) {
        text.push_str("; it is assumed that nothing else is written from outside");
    }
}

/// What has its first value throughout.
fn kept(pair: &Pair) -> Option<String> {
    let names = listed(pair.kept.iter().map(|it| format!("{} ({})", pair.path(it.scalars), pair.shown(it))))?;
    Some(format!(
        "nothing writes {names}, so only the initial value was tried (an assumption about a variable makes it an input)"
    ))
}

/// What is not compared because one program alone has it.
fn of_one(pair: &Pair) -> Option<String> {
    let names = listed(pair.only_one_has(|_| true).into_iter().map(|it| it.1.to_owned()))?;
    Some(format!("not compared, since only one program has it: {names}"))
}

/// What is not compared because it means something else on the other system.
fn unlike(pair: &Pair) -> Option<String> {
    let both = |it: &Matched| {
        let of = |side: usize| format!("{} of {}", pair.scalar(side, it[side]).path, pair.sides[side].dialect.name());
        format!("{} with {}", of(0), of(1))
    };
    let names = listed(pair.unlike.iter().map(both))?;
    Some(format!("not compared, since they mean different things (trap 4): {names}"))
}

/// What may follow from accepted findings, and is not compared once they were seen.
pub fn passed_over(pair: &Pair, world: &World) -> String {
    let cones = || world.tolerance.iter().flat_map(|it| &it.passing.cones);
    let passed = pair.compared.iter().filter(|it| cones().any(|cone| cone.contains(*it)));
    let names = listed(passed.map(|it| pair.path(*it).to_owned()));
    names.map_or_else(String::new, |it| format!("; not compared after an accepted finding: {it}"))
}

/// The names, of many elements of one array the first and the last.
fn listed(names: impl Iterator<Item = String>) -> Option<String> {
    const ELEMENTS: usize = 5;
    let mut runs: Vec<(String, Vec<String>)> = Vec::new();
    for name in names {
        let array = name.split_once('[').map_or_else(|| name.clone(), |it| it.0.to_owned());
        match runs.last_mut().filter(|it| it.0 == array) {
            Some((_, all)) => all.push(name),
            None => runs.push((array, vec![name])),
        }
    }
    let shown = runs.into_iter().map(|(_, all)| match all.as_slice() {
        [first, .., last] if all.len() > ELEMENTS => format!("{first} to {last}"),
        all => all.join(", "),
    });
    shown.reduce(|all, it| format!("{all}, {it}"))
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

/// Counts that never end: a COUNTER wraps where no budget reaches.
fn turning(pair: &Pair) -> Option<String> {
    let uses = pitfall::uses(pair);
    let is_tag = |it: &&Instance| it.block.info().family == Family::Logix;
    let never = (0..uses.len()).filter(|at| uses[*at].is_used && !uses[*at].resets);
    let names = never.filter_map(|at| pair.instances(at).into_iter().find(is_tag).map(|it| format!("`{}`", it.path)));
    let names = listed(names)?;
    Some(format!(
        "the whole count of {names}, which nothing resets: ACC of Logix wraps after 2147483647 to \
         -2147483648, and no budget reaches that; reset it, or stop its rung at a count"
    ))
}

/// What the two systems do after a fault that ends both programs here.
fn after(pair: &Pair, fault: Fault) -> String {
    let part = match fault.kind {
        FaultKind::DivideByZero => Some(Part::DivisionByZero),
        FaultKind::IndexOutOfRange => Some(Part::Index),
        FaultKind::SubrangeViolated => Some(Part::Subrange),
        _ => None,
    };
    let rows = pair.sides.iter().filter_map(|it| otherwise(it.dialect, part?));
    let there: Vec<String> =
        rows.map(|it| format!("; {}: {} ({})", system(it.dialect), it.what, it.evidence)).collect();
    let what =
        format!("what happens after a fault that ends both programs here, {} in line {}", fault.kind, fault.at.line);
    what + &there.concat()
}

fn system(dialect: Dialect) -> String {
    dialect.name().to_ascii_uppercase()
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
    if outcome.more_values > 0 {
        tried.push(format!("{} further values of inputs, drawn by chance", outcome.more_values));
    }
    tried.push(format!("{} scans in all", outcome.scans));
    if !world.assumptions.lines.is_empty() {
        tried.push(format!("assumed: {}", world.assumptions.lines.join("; ")));
    }
    let mut left = Vec::new();
    if !outcome.complete {
        left.push(match outcome.limit {
            None => "longer sequences; a larger --budget tries more of them".to_owned(),
            Some(most) => format!("longer sequences: {most} scans are the most for states of this size"),
        });
    }
    left.extend(turning(pair).filter(|_| !outcome.complete));
    for (choice, input) in alphabet.choices.iter().zip(&pair.inputs).filter(|it| it.0.covered.is_none()) {
        let path = pair.path(input.scalars);
        left.push(format!("values of {path} other than the {} that were tried", choice.values.len()));
    }
    if !alphabet.complete || !outcome.all_inputs {
        let tried = if outcome.all_inputs { alphabet.vectors.len() } else { alphabet.few };
        left.push(format!("combinations of inputs other than the {tried} in which few of them change"));
    }
    let untried = listed(alphabet::untried(pair).into_iter().map(str::to_owned));
    left.extend(
        untried.map(|it| format!("inputs that are references, or have another type on the other system: {it}")),
    );
    let given = listed(alphabet::outputs_given(pair).into_iter().map(str::to_owned));
    left.extend(given.map(|it| format!("values written from outside to outputs of blocks that are inputs: {it}")));
    if !pair.whole {
        left.push("elements of long arrays".to_owned());
    }
    left.extend(world.unfollowed.iter().cloned());
    left.extend(pair.ended.map(|it| after(pair, it)));
    left.extend([kept(pair), of_one(pair), unlike(pair)].into_iter().flatten());
    let beside = world.tolerance.iter().flat_map(|it| it.beside.iter().cloned());
    left.extend(listed(beside).map(|it| format!("the effect of {it}, declared together with an accepted difference")));
    Verdict::NotFound { tried, left }
}
