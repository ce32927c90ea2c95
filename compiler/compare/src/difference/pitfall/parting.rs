//! How a counter, or another block, comes to differ in a scan.

use super::classify::{Case, Habits, Kind, Pins, classify};
use super::list::Pitfall;
use super::relevant::Relevant;
use crate::pair::{Matched, Pair, Row};
use crate::program::scalar::Instance;
use staunch_host::Event;
use staunch_runtime::{Family, PinRole};
use std::collections::HashSet;

/// What the last scan has made of a counter: `None` if it does not differ because of it, and within it no
/// pitfall where none explains it.
pub fn seen(pair: &Pair, at: usize, event: Option<Event>, habits: Habits) -> Option<Option<Pitfall>> {
    let parted = pair.outputs[at].iter().any(|it| pair.newly_differs(*it));
    let agreed = pair.outputs[at].iter().all(|it| pair.agreed(*it));
    if !parted || !agreed {
        return None;
    }
    let states = [pair.before(), pair.states()];
    let case = case(pair, at, states, event, habits)?;
    let restarted = case.restarted || pair.is_restarted();
    Some(classify(&Case { first: pair.is_first(), restarted, ..case }))
}

pub fn case(pair: &Pair, at: usize, states: [[&[u8]; 2]; 2], event: Option<Event>, habits: Habits) -> Option<Case> {
    if !habits.is_of_both {
        return None;
    }
    let instances = pair.instances(at);
    let of = |states: [&[u8]; 2]| level([0, 1].map(|side| pins(instances[side], states[side])));
    let only_down = |it: &Instance| it.has(PinRole::Down) && !it.has(PinRole::Up);
    Some(Case {
        kinds: [kind(instances[0])?, kind(instances[1])?],
        before: of(states[0]),
        now: of(states[1]),
        first: false,
        restarted: event.is_some(),
        kept_alike: is_kept_alike(pair, at, event),
        feeds_itself: habits.feeds_itself,
        guards_itself: habits.guards_itself,
        counts_down: instances.into_iter().any(only_down),
        has_down: instances.into_iter().any(block_counts_down),
    })
}

/// Whether it is a block that counts down: a COUNTER of Logix has members for both ways.
pub fn block_counts_down(it: &Instance) -> bool {
    it.block.info().family != Family::Logix && it.has(PinRole::Down)
}

/// Whether both systems keep, or lose, a count in an event; in one that an earlier scan had, in all of them.
fn is_kept_alike(pair: &Pair, at: usize, event: Option<Event>) -> bool {
    let instances = pair.instances(at);
    let keeps = |side: usize, event: Event| {
        let count = instances[side].block.info().pin_for(PinRole::Count);
        count.is_some_and(|it| pair.sides[side].keeps(event, instances[side].offset + it.offset))
    };
    let mut events = Event::ALL.into_iter().filter(|it| event.is_none_or(|only| only == *it));
    events.all(|it| keeps(0, it) == keeps(1, it))
}

pub(super) fn kind(instance: &Instance) -> Option<Kind> {
    let info = instance.block.info();
    let count = info.pin_for(PinRole::Count)?;
    Some(Kind {
        family: info.family,
        repr: count.repr(),
        stops: info.facts.stops,
        falls: info.facts.counts_falls,
        loads_once: info.facts.loads_on_edges,
    })
}

fn pins(instance: &Instance, state: &[u8]) -> Pins {
    let of = |role: PinRole| instance.pin(role, state);
    let is = |role: PinRole| of(role).is_some_and(|it| it != 0);
    Pins {
        up: is(PinRole::Up),
        down: is(PinRole::Down),
        reset: is(PinRole::Reset),
        load: is(PinRole::Load),
        preset: of(PinRole::Preset).unwrap_or(0),
        count: of(PinRole::Count).unwrap_or(0),
        done: is(PinRole::Done),
        empty: is(PinRole::Empty),
    }
}

/// A Logix COUNTER has no pins for its resets: what the other side was given holds for both.
fn level(pins: [Pins; 2]) -> [Pins; 2] {
    let [a, b] = pins;
    pins.map(|it| Pins { reset: a.reset || b.reset, load: a.load || b.load, ..it })
}

/// A counter that starts to differ from its counterpart.
#[derive(Clone, Copy, Debug)]
pub struct Parting {
    pub counter: usize,
    pub row: usize,
    pub pitfall: Pitfall,
    /// Both were given the same.
    pub is_root: bool,
}

/// The first row in which a counter differs because of a pitfall: in its count, if the counts differ at the end.
pub fn parting(pair: &Pair, rows: &[Row], counter: usize, habits: Habits) -> Option<Parting> {
    let ends = rows.len().checked_sub(1).and_then(|it| case_in(pair, rows, it, counter, habits))?;
    let by_count = (!ends.counts_alike()).then(|| parting_in(pair, rows, counter, habits, true)).flatten();
    by_count.or_else(|| parting_in(pair, rows, counter, habits, false))
}

fn parting_in(pair: &Pair, rows: &[Row], counter: usize, habits: Habits, by_count: bool) -> Option<Parting> {
    let outputs = &pair.outputs[counter];
    (0..rows.len()).find_map(|at| {
        let case = case_in(pair, rows, at, counter, habits)?;
        let parts = match by_count {
            true => case.counted_alike() && !case.counts_alike(),
            false => {
                let agreed = outputs.iter().all(|it| agrees(pair, rows, at, *it));
                agreed && outputs.iter().any(|it| !pair.same(*it, &rows[at]))
            }
        };
        let case = parts.then_some(case)?;
        let pitfall = match classify(&case)? {
            Pitfall::START if counts_by_level(pair, rows, counter, habits) => Pitfall::LEVEL,
            pitfall => pitfall,
        };
        Some(Parting { counter, row: at, pitfall, is_root: !case.given_differs() })
    })
}

/// Whether CSCAPE counts an input without an edge, so that at the end the counts differ by more than the one that Logix does not
/// count at the start.
fn counts_by_level(pair: &Pair, rows: &[Row], counter: usize, habits: Habits) -> bool {
    let case = |at: usize| case_in(pair, rows, at, counter, habits);
    let Some(last) = rows.len().checked_sub(1).and_then(case) else { return false };
    let Some(side) = last.kinds.iter().position(|it| it.family == Family::Cscape) else { return false };
    let counts = |it: &Case| {
        let [before, now] = [it.before[side], it.now[side]];
        before.count != now.count && (before.up && now.up || before.down && now.down)
    };
    let [a, b] = last.now;
    a.count.abs_diff(b.count) > 1 && (0..rows.len()).filter_map(case).any(|it| counts(&it))
}

/// A counter that counts the same on both sides, of which the program computes what only Q would show of a block: its path, and
/// the pitfall.
pub fn by_what_it_shows(
    pair: &Pair,
    rows: &[Row],
    habits: &[Habits],
    relevant: &Relevant,
) -> Option<(String, Pitfall)> {
    let last = rows.len().checked_sub(1)?;
    let decides = |counter: &usize| relevant.has(pair.instances(*counter)[0].field, &HashSet::new());
    let at_the_end = |counter: usize| {
        let case = case_in(pair, rows, last, counter, habits[counter])?;
        match () {
            () if case.is_empty_on_one() => Some(Pitfall::BELOW),
            () if case.has_other_preset() => Some(Pitfall::WIDTHS),
            () => None,
        }
    };
    let before = |counter: usize| {
        let mut cases = (0..rows.len()).filter_map(|it| case_in(pair, rows, it, counter, habits[counter]));
        cases.any(|it| it.is_before_first_call()).then_some(Pitfall::BEFORE)
    };
    let all = || (0..habits.len()).filter(decides);
    let found = |of: &dyn Fn(usize) -> Option<Pitfall>| all().find_map(|it| Some((it, of(it)?)));
    let (counter, pitfall) = found(&at_the_end).or_else(|| found(&before))?;
    Some((pair.instances(counter)[0].path.clone(), pitfall))
}

/// A counter in a row.
pub fn case_in(pair: &Pair, rows: &[Row], at: usize, counter: usize, habits: Habits) -> Option<Case> {
    let now = rows[at].states.each_ref().map(Vec::as_slice);
    let start = at.checked_sub(1).map(|it| &rows[it]);
    let before = start.map_or(pair.start(), |it| it.states.each_ref().map(Vec::as_slice));
    case(pair, counter, [before, now], rows[at].event, habits).map(|it| Case { first: at == 0, ..it })
}

/// The row in which an F_TRIG or a timer comes to differ because it is another block on the other system, and its pitfall.
pub fn other_block(pair: &Pair, rows: &[Row], block: usize) -> Option<(usize, Pitfall)> {
    let pitfall = match (pair.is_other_one_shot(block), pair.is_other_timer(block)) {
        (true, _) => Pitfall::FIRST_FALL,
        (false, true) => Pitfall::LATER_CALL,
        (false, false) => return None,
    };
    let outputs = &pair.block_outputs[block];
    let parts = |at: &usize| {
        let states = rows[*at].states.each_ref().map(Vec::as_slice);
        outputs.iter().all(|it| agrees(pair, rows, *at, *it))
            && outputs.iter().any(|it| !pair.same(*it, &rows[*at]))
            && pair.is_given_alike(block, states)
            && (pitfall == Pitfall::FIRST_FALL || pair.is_over_at_once(block, states))
    };
    (0..rows.len()).find(parts).map(|row| (row, pitfall))
}

/// Whether these agreed before a row.
pub fn agrees(pair: &Pair, rows: &[Row], at: usize, matched: Matched) -> bool {
    at.checked_sub(1).is_none_or(|it| pair.same(matched, &rows[it]))
}
