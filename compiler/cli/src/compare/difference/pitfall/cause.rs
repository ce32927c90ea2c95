//! The counter that a difference comes from, and its pitfall.

use super::advice::{Counting, Form, Rules};
use super::classify::{Case, Habits, Kind, Pins, classify, counts_without_edge};
use super::list::Pitfall;
use crate::compare::pair::exchange::{Change, Kept};
use crate::compare::pair::{Matched, Pair, Row};
use crate::compare::program::apart::Declared;
use crate::compare::program::dependency::Dependencies;
use crate::compare::program::scalar::{Instance, Role};
use crate::compare::program::usage;
use crate::compare::program::walked::Name;
use staunch_host::Event;
use staunch_runtime::{Family, PinRole};
use std::collections::HashSet;

/// More that may be the cause are not tried.
const MAX_SUSPECTS: usize = 64;

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

fn case(pair: &Pair, at: usize, states: [[&[u8]; 2]; 2], event: Option<Event>, habits: Habits) -> Option<Case> {
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
    })
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

/// The counter that a difference comes from, if one does; and the pitfall.
#[derive(Clone, Debug, Default)]
pub struct Cause {
    pub counter: Option<String>,
    pub pitfall: Option<Pitfall>,
}

impl Cause {
    /// How the counter counts: which way, of a COUNTER, by the other system's block.
    pub fn counting(&self, pair: &Pair) -> Counting {
        let numbers = 0..pair.counters.len();
        let mut found = numbers.map(|it| pair.instances(it)).filter(|it| Some(&it[0].path) == self.counter.as_ref());
        let Some(instances) = found.next() else {
            return Counting { form: Form::Up, rises: false, rules: None, is_partial: false };
        };
        let rises = instances.iter().any(|it| {
            let info = it.block.info();
            info.family == Family::Openplc4 && !info.facts.counts_falls
        });
        let is_tag = |it: &&Instance| it.block.info().name.eq_ignore_ascii_case("COUNTER");
        let block = instances.into_iter().find(|it| !is_tag(it));
        let form = match block.map(|it| (it.has(PinRole::Up), it.has(PinRole::Down))) {
            Some((false, true)) => Form::Down,
            Some((true, true)) => Form::UpDown,
            Some((_, false)) | None => Form::Up,
        };
        // What CTU and CTD do to one COUNTER is not said.
        let is_both = is_tag(&instances[0]) && form == Form::UpDown;
        let rules = if is_both { None } else { rules(instances[0]) };
        Counting { form, rises, rules, is_partial: is_partial(pair, instances[0]) }
    }
}

/// What it does on its system.
fn rules(instance: &Instance) -> Option<Rules> {
    let kind = kind(instance)?;
    let (least, greatest) = kind.repr.range()?;
    let Kind { family, stops, falls, loads_once, .. } = kind;
    Some(Rules { family, least, greatest, stops, falls, loads_once })
}

fn is_partial(pair: &Pair, instance: &Instance) -> bool {
    let found = usage::of(&pair.sides[0].program);
    let name = instance.field.map(|(owner, field)| Name::Field(owner, field));
    name.and_then(|it| found.get(&it)).is_some_and(|it| !it.given.is_disjoint(&it.left_out))
}

/// Looks at the counters that part in the last row by what is compared of them, then at those that the differences depend
/// on; without one, at restarts and at types.
pub fn cause(pair: &Pair, rows: &[Row], differences: &[Matched], habits: &[Habits]) -> Cause {
    let last = rows.len().saturating_sub(1);
    let direct = parted(pair, rows, last, habits, |it| differences.contains(it));
    if direct.pitfall.is_some() {
        return direct;
    }
    let relevant = Relevant::of(pair, differences);
    if let Some(found) = shown(pair, rows, habits, &relevant) {
        return found;
    }
    let found = roots(pair, rows, habits, &relevant);
    let restarted = rows.iter().position(|row| row.event.is_some() && relevant.differs(pair, row));
    if let Some(found) = found.filter(|it| restarted.is_none_or(|row| it.row <= row)) {
        return Cause { counter: Some(pair.instances(found.counter)[0].path.clone()), pitfall: Some(found.pitfall) };
    }
    let counter = direct.counter;
    if let Some(row) = restarted {
        let kept = || kept_by_one(pair, rows, row, &relevant).first().map(|it| pair.path(*it).to_owned());
        let counter = counter.or_else(kept);
        return Cause { counter, pitfall: Some(Pitfall::RESTART) };
    }
    if let Some(counter) = held_through_reset(pair, rows, habits) {
        return Cause { counter: Some(counter), pitfall: Some(Pitfall::numbered(6)) };
    }
    if let Some((block, pitfall)) = first_other_block(pair, rows, &relevant) {
        return Cause { counter: Some(block), pitfall: Some(pitfall) };
    }
    let widths = differences.iter().any(|[a, b]| {
        let [a, b] = [pair.scalar(0, *a), pair.scalar(1, *b)];
        let counts = a.ty.elementary().is_none_or(|it| !it.is_duration());
        matches!(a.role, Role::Variable) && counts && a.ty.elementary() != b.ty.elementary()
    });
    let pitfall = (counter.is_none() && widths).then_some(Pitfall::WIDTHS);
    Cause { counter, pitfall }
}

/// What may be the cause.
struct Suspect {
    row: usize,
    path: String,
    pitfall: Pitfall,
    change: Change,
}

/// Of those that may be the cause, the first with which nothing of what is looked at differs any more where it alone is as on the
/// other system; else the first of the fewest that do so together, of what is kept.
fn shown(pair: &Pair, rows: &[Row], habits: &[Habits], relevant: &Relevant) -> Option<Cause> {
    if relevant.found.is_empty() {
        return None;
    }
    let mut all = suspects(pair, rows, habits, relevant);
    all.sort_by_key(|it| it.row);
    all.truncate(MAX_SUSPECTS);
    let alone = all.iter().find(|it| pair.agrees_with(&it.change, rows, &relevant.found));
    let found = alone.or_else(|| of_several(pair, rows, relevant, &all))?;
    Some(Cause { counter: Some(found.path.clone()), pitfall: Some(found.pitfall) })
}

/// The first of those that have to be kept together.
fn of_several<'s>(pair: &Pair, rows: &[Row], relevant: &Relevant, all: &'s [Suspect]) -> Option<&'s Suspect> {
    let kept = |it: &&'s Suspect| matches!(it.change, Change::Kept(_));
    let together = |some: &[&Suspect]| {
        let all = some.iter().flat_map(|it| match &it.change {
            Change::Kept(all) => all.as_slice(),
            Change::Counter(_) | Change::Block(_) => &[],
        });
        pair.agrees_with(&Change::Kept(all.copied().collect()), rows, &relevant.found)
    };
    let mut needed: Vec<&Suspect> = all.iter().filter(kept).collect();
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

/// The blocks and variables that one side alone has kept, and the counters and other blocks that part by themselves, of those that
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
fn kept_by_one(pair: &Pair, rows: &[Row], at: usize, relevant: &Relevant) -> Vec<Matched> {
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

/// What the differences at the end depend on.
struct Relevant {
    dependencies: Dependencies,
    differences: HashSet<Declared>,
    found: Vec<Matched>,
}

impl Relevant {
    fn of(pair: &Pair, differences: &[Matched]) -> Self {
        let declared = differences.iter().filter_map(|it| pair.declared(0, *it)).collect();
        Self {
            dependencies: Dependencies::of(&pair.sides[0].program),
            differences: declared,
            found: differences.to_vec(),
        }
    }

    /// Whether a variable decides them, without going through others. A fault may follow from anything.
    fn has(&self, declared: Option<Declared>, others: &HashSet<Declared>) -> bool {
        let decides = |it| !self.dependencies.follow_past(it, others).is_disjoint(&self.differences);
        self.differences.is_empty() || declared.is_none_or(decides)
    }

    /// Whether what decides them differs in a row.
    fn differs(&self, pair: &Pair, row: &Row) -> bool {
        let mut differing = pair.compared.iter().filter(|it| !pair.same(**it, row));
        differing.any(|it| self.has(pair.declared(0, *it), &HashSet::new()))
    }
}

/// A counter that starts to differ from its counterpart.
#[derive(Clone, Copy, Debug)]
struct Parting {
    counter: usize,
    row: usize,
    pitfall: Pitfall,
    /// Both were given the same.
    is_root: bool,
}

/// The counter that the differences come from: the first that parts of those which decide them, by itself and
/// not through another such counter.
fn roots(pair: &Pair, rows: &[Row], habits: &[Habits], relevant: &Relevant) -> Option<Parting> {
    let declared = |counter: usize| pair.instances(counter)[0].field;
    let all = (0..habits.len()).filter(|it| relevant.has(declared(*it), &HashSet::new()));
    let found: Vec<Parting> = all.filter_map(|it| parting(pair, rows, it, habits[it])).collect();
    let roots: Vec<Parting> = found.iter().copied().filter(|it| it.is_root).collect();
    let is_near = |it: &&Parting| {
        let others = roots.iter().map(|it| it.counter).filter(|other| *other != it.counter);
        relevant.has(
            declared(it.counter),
            &others.filter_map(declared).filter(|other| Some(*other) != declared(it.counter)).collect(),
        )
    };
    let first = |found: &mut dyn Iterator<Item = &Parting>| found.min_by_key(|it| it.row).copied();
    first(&mut roots.iter().filter(is_near)).or_else(|| first(&mut roots.iter())).or_else(|| first(&mut found.iter()))
}

/// The first row in which a counter differs because of a pitfall.
fn parting(pair: &Pair, rows: &[Row], counter: usize, habits: Habits) -> Option<Parting> {
    let outputs = &pair.outputs[counter];
    (0..rows.len()).find_map(|at| {
        let agreed = outputs.iter().all(|it| agrees(pair, rows, at, *it));
        let parts = outputs.iter().any(|it| !pair.same(*it, &rows[at]));
        let case = (agreed && parts).then(|| case_in(pair, rows, at, counter, habits)).flatten()?;
        let pitfall = classify(&case)?;
        Some(Parting { counter, row: at, pitfall, is_root: !case.given_differs() })
    })
}

/// A counter in a row.
fn case_in(pair: &Pair, rows: &[Row], at: usize, counter: usize, habits: Habits) -> Option<Case> {
    let now = rows[at].states.each_ref().map(Vec::as_slice);
    let start = at.checked_sub(1).map(|it| &rows[it]);
    let before = start.map_or(pair.start(), |it| it.states.each_ref().map(Vec::as_slice));
    case(pair, counter, [before, now], rows[at].event, habits).map(|it| Case { first: at == 0, ..it })
}

/// The first F_TRIG or timer that comes to differ because it is another block on the other system, of those that decide the
/// differences if there is one.
fn first_other_block(pair: &Pair, rows: &[Row], relevant: &Relevant) -> Option<(String, Pitfall)> {
    let field = |block: usize| pair.sides[0].scalars.blocks[pair.blocks[block][0]].field;
    let (near, far): (Vec<_>, Vec<_>) =
        (0..pair.blocks.len()).partition(|it| relevant.has(field(*it), &HashSet::new()));
    let first = |all: Vec<usize>| {
        let parting = all.into_iter().filter_map(|it| other_block(pair, rows, it).map(|found| (it, found)));
        parting.min_by_key(|(block, (row, pitfall))| (*pitfall, *row, *block))
    };
    let (block, (_, pitfall)) = first(near).or_else(|| first(far))?;
    Some((pair.sides[0].scalars.blocks[pair.blocks[block][0]].path.clone(), pitfall))
}

/// The row in which an F_TRIG or a timer comes to differ because it is another block on the other system, and its pitfall.
fn other_block(pair: &Pair, rows: &[Row], block: usize) -> Option<(usize, Pitfall)> {
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
        let pitfall = case_in(pair, rows, at, number, *own).and_then(|it| classify(&it));
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
