//! What a move can change other than counters: timers, one-shots and latches, values computed in other types,
//! what an event keeps on one system alone, and faults.

use super::kind::Kind;
use crate::pair::{Matched, Pair};
use crate::program::apart::{self, Declared, Why};
use crate::program::dependency::Dependencies;
use crate::program::scalar::Role;
use staunch_host::Event;
use staunch_ir::{Location, Program};
use std::collections::HashSet;

/// A variable that may come to differ, and where the text says so.
#[derive(Clone, Debug)]
pub struct Candidate {
    pub variable: Matched,
    pub kind: Kind,
    pub at: Location,
    /// Counters that decide it, by their positions among those of the pair.
    pub counters: Vec<usize>,
}

/// The variables that an event leaves as they are on one side alone, one of each declaration.
pub fn kept_by_one(pair: &Pair) -> Vec<Candidate> {
    let mut seen = HashSet::new();
    let mut found = Vec::new();
    let events = || Event::ALL.into_iter().filter(|it| !pair.never.contains(it));
    for [a, b] in pair.matched(|it| it.role == Role::Variable) {
        let scalars = [pair.scalar(0, a), pair.scalar(1, b)];
        let keeps = |side: usize, event| pair.sides[side].keeps(event, scalars[side].offset);
        let Some(declared) = scalars[0].field else { continue };
        if events().any(|it| keeps(0, it) != keeps(1, it)) && seen.insert(declared) {
            let at = location(&pair.sides[0].program, declared);
            found.push(Candidate { variable: [a, b], kind: Kind::Retention, at, counters: Vec::new() });
        }
    }
    found
}

pub fn location(program: &Program, (owner, field): Declared) -> Location {
    program.structure(owner).fields[field.index()].location
}

/// The variables that are assigned values which the two systems compute in other types, or from bits at other places, or under such a condition.
pub fn computed_apart(pair: &Pair) -> Vec<Candidate> {
    let targets = apart::targets(pair.sides.each_ref().map(|it| &it.program));
    let variables = pair.matched(|it| it.role == Role::Variable).into_iter();
    let of = |variable: Matched| {
        let declared = [0, 1].map(|side: usize| pair.scalar(side, variable[side]).field);
        let found = (0..2).find_map(|side| Some((side, targets[side].get(&declared[side]?)?)));
        let (side, found) = found?;
        // A value of one type is stored in the same way, except for the bits around it.
        let reprs = [0, 1].map(|side| pair.sides[side].program.repr(pair.scalar(side, variable[side]).ty));
        let is_located = |(owner, field): Declared| {
            pair.sides[side].program.structure(owner).fields[field.index()].address.is_some()
        };
        let by_address = found.why == Why::Address || declared[side].is_some_and(is_located);
        let kind = if by_address && reprs[0] == reprs[1] { Kind::Address } else { Kind::Width };
        Some(Candidate { variable, kind, at: found.at, counters: Vec::new() })
    };
    variables.filter_map(of).collect()
}

/// Names the counters that decide each.
pub fn note_counters(pair: &Pair, candidates: &mut [Candidate]) {
    let dependencies = Dependencies::of(&pair.sides[0].program);
    for counter in 0..pair.counters.len() {
        let decided = pair.instances(counter)[0].field.map(|it| dependencies.follow(it)).unwrap_or_default();
        let is_decided = |it: &&mut Candidate| pair.declared(0, it.variable).is_some_and(|it| decided.contains(&it));
        candidates.iter_mut().filter(is_decided).for_each(|it| it.counters.push(counter));
    }
}

/// The variables that the two systems hold in strings of other lengths, one of each declaration.
pub fn held_apart(pair: &Pair) -> Vec<Candidate> {
    let mut seen = HashSet::new();
    let capacity = |side: usize, at: usize| pair.scalar(side, at).ty.string_type();
    let apart =
        pair.matched(|it| it.role == Role::Variable).into_iter().filter(|[a, b]| capacity(0, *a) != capacity(1, *b));
    let of = |variable: Matched| {
        let declared = pair.scalar(0, variable[0]).field?;
        let at = || location(&pair.sides[0].program, declared);
        seen.insert(declared).then(|| Candidate { variable, kind: Kind::Width, at: at(), counters: Vec::new() })
    };
    apart.filter_map(of).collect()
}
