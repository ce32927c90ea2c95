//! What may be the cause of a difference, and what of it takes the difference away where it alone is as on the other system.

use super::classify::Habits;
use super::list::Pitfall;
use super::parting::{Parting, other_block, parting};
use super::relevant::Relevant;
use crate::pair::exchange::{Again, Change, Kept};
use crate::pair::{Matched, Pair, Row};
use crate::program::apart::Declared;
use crate::program::scalar::{Instance, Role};
use std::collections::HashSet;

/// More that may be the cause are not tried.
const MAX_SUSPECTS: usize = 64;

/// What may be the cause.
pub struct Suspect {
    row: usize,
    pub path: String,
    pub pitfall: Pitfall,
    change: Change,
}

/// Of those that may be the cause, the first with which nothing of what is looked at differs any more where it alone is as on the
/// other system; else the first of the fewest that do so together, of what is kept.
pub fn shown(pair: &Pair, rows: &[Row], habits: &[Habits], relevant: &Relevant) -> Option<Suspect> {
    if relevant.found.is_empty() {
        return None;
    }
    let mut all = suspects(pair, rows, habits, relevant);
    all.sort_by_key(|it| it.row);
    all.truncate(MAX_SUSPECTS);
    if all.is_empty() {
        return None;
    }
    let again = Again::new(pair, rows)?;
    let agrees = |it: &Suspect| again.agrees_with(&it.change, &relevant.found);
    let alone = all.iter().position(agrees).map(|it| root_of(pair, relevant, &all, it, &agrees));
    let found = alone.or_else(|| of_several(&again, relevant, &all))?;
    Some(all.swap_remove(found))
}

/// What decides one that takes the difference away, and does so by itself.
fn root_of(
    pair: &Pair,
    relevant: &Relevant,
    all: &[Suspect],
    mut found: usize,
    agrees: &dyn Fn(&Suspect) -> bool,
) -> usize {
    let declared = |it: &Suspect| match &it.change {
        Change::Counter(at) => pair.instances(*at)[0].field,
        Change::Block(at) => pair.sides[0].scalars.blocks[pair.blocks[*at][0]].field,
        Change::Kept(_) => None,
    };
    let decides = |a: &Suspect, b: &Suspect| match (declared(a), declared(b)) {
        (Some(a), Some(b)) => a != b && relevant.dependencies.follow(a).contains(&b),
        (None, _) | (_, None) => false,
    };
    let is_before = |it: &Suspect, found: &Suspect| decides(it, found) && !decides(found, it) && agrees(it);
    while let Some(at) = all.iter().position(|it| is_before(it, &all[found])) {
        found = at;
    }
    found
}

/// The first of those that have to be kept together.
fn of_several(again: &Again, relevant: &Relevant, all: &[Suspect]) -> Option<usize> {
    let together = |some: &[usize]| {
        let all = some.iter().flat_map(|it| match &all[*it].change {
            Change::Kept(all) => all.as_slice(),
            Change::Counter(_) | Change::Block(_) => &[],
        });
        again.agrees_with(&Change::Kept(all.copied().collect()), &relevant.found)
    };
    let is_kept = |it: &usize| matches!(all[*it].change, Change::Kept(_));
    let mut needed: Vec<usize> = (0..all.len()).filter(is_kept).collect();
    if !together(&needed) {
        return None;
    }
    for at in (0..needed.len()).rev() {
        let mut fewer = needed.clone();
        fewer.remove(at);
        if together(&fewer) {
            needed = fewer;
        }
    }
    needed.first().copied()
}

/// The blocks and variables that one side alone has kept, and the counters and other blocks that differ by themselves, of those that
/// decide the differences.
fn suspects(pair: &Pair, rows: &[Row], habits: &[Habits], relevant: &Relevant) -> Vec<Suspect> {
    let events = || (0..rows.len()).filter(|it| rows[*it].event.is_some());
    let mut found: Vec<Suspect> = events().flat_map(|it| kept_blocks(pair, rows, it, relevant)).collect();
    found.extend(parted_blocks(pair, rows, habits, relevant));
    found.extend(events().flat_map(|it| kept_variables(pair, rows, it, relevant)));
    found
}

fn kept_blocks(pair: &Pair, rows: &[Row], row: usize, relevant: &Relevant) -> Vec<Suspect> {
    let all = pair.blocks.iter().chain(&pair.counters).filter(|it| is_kept_by_one(pair, rows, row, **it));
    let suspect = |it: &Matched| {
        let instance = &pair.sides[0].scalars.blocks[it[0]];
        let (path, pitfall, change) = (instance.path.clone(), Pitfall::RESTART, Change::Kept(vec![Kept::Block(*it)]));
        relevant.has(instance.field, &HashSet::new()).then_some(Suspect { row, path, pitfall, change })
    };
    all.filter_map(suspect).collect()
}

fn parted_blocks(pair: &Pair, rows: &[Row], habits: &[Habits], relevant: &Relevant) -> Vec<Suspect> {
    let decides = |it: &Instance| relevant.has(it.field, &HashSet::new());
    let counter = |(number, own): (usize, &Habits)| {
        let instance = pair.instances(number)[0];
        let Parting { row, pitfall, .. } = decides(instance).then(|| parting(pair, rows, number, *own))??;
        Some(Suspect { row, path: instance.path.clone(), pitfall, change: Change::Counter(number) })
    };
    let other = |(number, block): (usize, &Matched)| {
        let instance = &pair.sides[0].scalars.blocks[block[0]];
        let (row, pitfall) = decides(instance).then(|| other_block(pair, rows, number))??;
        Some(Suspect { row, path: instance.path.clone(), pitfall, change: Change::Block(number) })
    };
    let counters = habits.iter().enumerate().filter_map(counter);
    counters.chain(pair.blocks.iter().enumerate().filter_map(other)).collect()
}

/// The elements and members of one variable are one suspect.
fn kept_variables(pair: &Pair, rows: &[Row], row: usize, relevant: &Relevant) -> Vec<Suspect> {
    let mut groups: Vec<(Option<Declared>, Vec<Matched>)> = Vec::new();
    for it in kept_by_one(pair, rows, row, relevant) {
        let declared = pair.declared(0, it);
        match groups.iter_mut().find(|group| group.0 == declared) {
            Some(group) => group.1.push(it),
            None => groups.push((declared, vec![it])),
        }
    }
    let suspect = |group: Vec<Matched>| {
        let path = pair.path(group[0]).to_owned();
        let all = group.into_iter().map(Kept::Variable).collect();
        Suspect { row, path, pitfall: Pitfall::RESTART, change: Change::Kept(all) }
    };
    groups.into_iter().map(|it| suspect(it.1)).collect()
}

/// Whether one side alone keeps anything of a block in the event of a row, and it is not as at the start there.
fn is_kept_by_one(pair: &Pair, rows: &[Row], at: usize, block: Matched) -> bool {
    let Some(event) = rows[at].event else { return false };
    let keeps = pair.keeps(Kept::Block(block), event);
    let side = usize::from(keeps[1]);
    let before = at.checked_sub(1).map_or(pair.start()[side], |it| rows[it].states[side].as_slice());
    let bytes = pair.bytes(Kept::Block(block), side);
    keeps[0] != keeps[1] && before[bytes.clone()] != pair.start()[side][bytes]
}

/// Variables that decide the differences, which one side alone has kept in the event of a row: there they had another value
/// than the other side begins with. Those come first that fewer of the others decide.
pub fn kept_by_one(pair: &Pair, rows: &[Row], at: usize, relevant: &Relevant) -> Vec<Matched> {
    let Some(event) = rows[at].event else { return Vec::new() };
    let before = at.checked_sub(1).map_or(pair.start(), |it| rows[it].states.each_ref().map(Vec::as_slice));
    let is_kept = |it: &Matched| {
        let keeps = [0, 1].map(|side: usize| pair.sides[side].keeps(event, pair.scalar(side, it[side]).offset));
        let side = usize::from(keeps[1]);
        let scalar = pair.scalar(side, it[side]);
        let value = |state: &[u8]| state[scalar.offset..scalar.offset + scalar.size].to_vec();
        keeps[0] != keeps[1] && value(before[side]) != value(pair.start()[side])
    };
    let all = pair.matched(|it| matches!(it.role, Role::Variable)).into_iter();
    let mut decides: Vec<Matched> =
        all.filter(|it| is_kept(it) && relevant.has(pair.declared(0, *it), &HashSet::new())).collect();
    // What another of them decides is made anew in the scan.
    let follows = |decides: &[Matched], it: &Matched| {
        let others = decides.iter().filter(|other| pair.declared(0, **other) != pair.declared(0, *it));
        let decided = |other: &Matched| {
            let found = pair.declared(0, *other).map(|other| relevant.dependencies.follow(other));
            found.zip(pair.declared(0, *it)).is_some_and(|(found, own)| found.contains(&own))
        };
        others.filter(|other| decided(other)).count()
    };
    let before = decides.clone();
    decides.sort_by_cached_key(|it| follows(&before, it));
    decides
}
