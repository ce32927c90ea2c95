//! The counter that a difference comes from, and its pitfall.

use super::classify::{Case, Habits, Kind, Pins, classify, counts_without_edge};
use super::list::Pitfall;
use crate::compare::pair::{Matched, Pair, Row};
use crate::compare::program::scalar::{Instance, Role};
use staunch_host::Event;
use staunch_runtime::PinRole;

/// What the last scan has made of a counter: `None` where it has not parted by it, and within it no
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

fn case(pair: &Pair, at: usize, states: [[&[u8]; 2]; 2], event: Option<Event>, habits: Habits) -> Option<Case> {
    let instances = pair.instances(at);
    let of = |states: [&[u8]; 2]| level([0, 1].map(|side| pins(instances[side], states[side])));
    let only_down = |it: &Instance| it.has(PinRole::Down) && !it.has(PinRole::Up);
    Some(Case {
        kinds: [kind(instances[0])?, kind(instances[1])?],
        before: of(states[0]),
        now: of(states[1]),
        first: false,
        restarted: event.is_some(),
        feeds_itself: habits.feeds_itself,
        guards_itself: habits.guards_itself,
        counts_down: instances.into_iter().any(only_down),
    })
}

pub(super) fn kind(instance: &Instance) -> Option<Kind> {
    let info = instance.block.info();
    let count = info.pin_for(PinRole::Count)?;
    Some(Kind { family: info.family, repr: count.repr(), stops: info.facts.stops, falls: info.facts.counts_falls })
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

/// The counter that a difference comes from, if one does; and the pitfall.
#[derive(Clone, Debug, Default)]
pub struct Cause {
    pub counter: Option<String>,
    pub pitfall: Option<Pitfall>,
}

/// Looks at the counters that part in the last row by what is compared of them, then for the first scan
/// in which any counter parted; without one, at restarts and at types.
pub fn cause(pair: &Pair, rows: &[Row], differences: &[Matched], habits: &[Habits]) -> Cause {
    let last = rows.len().saturating_sub(1);
    let direct = parted(pair, rows, last, habits, |it| differences.contains(it));
    if direct.pitfall.is_some() {
        return direct;
    }
    let mut counter = direct.counter;
    for (at, row) in rows.iter().enumerate() {
        let all = |number: usize, rows: &[Row]| pair.outputs[number].iter().all(|it| agrees(pair, rows, at, *it));
        let found = parted(pair, rows, at, habits, |it| {
            let owner = pair.outputs.iter().position(|outputs| outputs.contains(it));
            owner.is_some_and(|number| all(number, rows))
        });
        if found.pitfall.is_some() {
            return found;
        }
        counter = counter.or(found.counter);
        let restarted = row.event.is_some() && pair.compared.iter().any(|it| !pair.same(*it, row));
        if restarted {
            return Cause { counter, pitfall: Some(Pitfall::RESTART) };
        }
    }
    if let Some(counter) = held_through_reset(pair, rows, habits) {
        return Cause { counter: Some(counter), pitfall: Some(Pitfall::numbered(6)) };
    }
    if let Some(block) = first_fall(pair, rows) {
        return Cause { counter: Some(block), pitfall: Some(Pitfall::FIRST_FALL) };
    }
    if let Some(block) = later_call(pair, rows) {
        return Cause { counter: Some(block), pitfall: Some(Pitfall::LATER_CALL) };
    }
    let widths = differences.iter().any(|[a, b]| {
        let [a, b] = [pair.scalar(0, *a), pair.scalar(1, *b)];
        matches!(a.role, Role::Variable) && a.ty.elementary() != b.ty.elementary()
    });
    let pitfall = (counter.is_none() && widths).then_some(Pitfall::WIDTHS);
    Cause { counter, pitfall }
}

/// The first F_TRIG that comes to differ because it is another block on the other system.
fn first_fall(pair: &Pair, rows: &[Row]) -> Option<String> {
    first_other(pair, rows, |it| pair.is_other_one_shot(it))
}

/// The first timer that does.
fn later_call(pair: &Pair, rows: &[Row]) -> Option<String> {
    first_other(pair, rows, |it| pair.is_other_timer(it))
}

fn first_other(pair: &Pair, rows: &[Row], is_other: impl Fn(usize) -> bool) -> Option<String> {
    let parts = |at: usize, block: usize| {
        let outputs = &pair.block_outputs[block];
        outputs.iter().all(|it| agrees(pair, rows, at, *it)) && outputs.iter().any(|it| !pair.same(*it, &rows[at]))
    };
    let others: Vec<_> = (0..pair.blocks.len()).filter(|it| is_other(*it)).collect();
    let first = (0..rows.len()).find_map(|at| others.iter().copied().find(|it| parts(at, *it)))?;
    Some(pair.sides[0].scalars.blocks[pair.blocks[first][0]].path.clone())
}

/// Whether these agreed before a row.
fn agrees(pair: &Pair, rows: &[Row], at: usize, matched: Matched) -> bool {
    at.checked_sub(1).is_none_or(|it| pair.same(matched, &rows[it]))
}

/// The first counter of which an output that is `wanted` comes to differ in a row, and why.
fn parted(pair: &Pair, rows: &[Row], at: usize, habits: &[Habits], wanted: impl Fn(&Matched) -> bool) -> Cause {
    let mut cause = Cause::default();
    let Some(row) = rows.get(at) else { return cause };
    for (number, own) in habits.iter().enumerate() {
        let news = |it: &&Matched| wanted(it) && !pair.same(**it, row) && agrees(pair, rows, at, **it);
        if !pair.outputs[number].iter().any(|it| news(&it)) {
            continue;
        }
        let now = row.states.each_ref().map(Vec::as_slice);
        let start = at.checked_sub(1).map(|it| &rows[it]);
        let before = start.map_or(pair.start(), |it| it.states.each_ref().map(Vec::as_slice));
        let found = case(pair, number, [before, now], row.event, *own);
        let pitfall = found.and_then(|it| classify(&Case { first: at == 0, ..it }));
        let path = pair.instances(number)[0].path.clone();
        if pitfall.is_some() {
            return Cause { counter: Some(path), pitfall };
        }
        cause.counter.get_or_insert(path);
    }
    cause
}

/// A counter that Logix lets count without an edge, whether it agreed before or not.
fn held_through_reset(pair: &Pair, rows: &[Row], habits: &[Habits]) -> Option<String> {
    let states = |row: &Row| -> [Vec<u8>; 2] { row.states.clone() };
    (0..pair.counters.len()).find_map(|number| {
        let counts = |two: &[Row]| {
            let (before, now) = (states(&two[0]), states(&two[1]));
            let all = [before.each_ref().map(Vec::as_slice), now.each_ref().map(Vec::as_slice)];
            case(pair, number, all, two[1].event, habits[number]).is_some_and(|it| counts_without_edge(&it))
        };
        rows.windows(2).any(counts).then(|| pair.instances(number)[0].path.clone())
    })
}
