//! The counter that a difference comes from, and its pitfall.

use super::advice::{Counting, Form, Rules};
use super::classify::{Habits, Kind, classify, counts_without_edge};
use super::list::Pitfall;
use super::parting::{Parting, agrees, by_what_it_shows, case, case_in, kind, other_block, parting};
use super::relevant::Relevant;
use super::suspects::{kept_by_one, shown};
use crate::pair::exchange::is_of_logix;
use crate::pair::{Matched, Pair, Row};
use crate::program::scalar::{Instance, Role};
use crate::program::usage;
use crate::program::walked::Name;
use staunch_runtime::{Family, PinRole};
use std::collections::HashSet;

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
    // A COUNTER of Logix has no pins that show what it was given.
    let is_of_logix = (0..pair.counters.len()).any(|it| pair.instances(it).iter().any(|it| is_of_logix(it)));
    if direct.pitfall.is_some() && !is_of_logix {
        return direct;
    }
    let relevant = Relevant::of(pair, differences);
    if let Some(found) = shown(pair, rows, habits, &relevant) {
        return Cause { counter: Some(found.path), pitfall: Some(found.pitfall) };
    }
    if direct.pitfall.is_some() {
        return direct;
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
    if let Some((counter, pitfall)) = by_what_it_shows(pair, rows, habits, &relevant) {
        return Cause { counter: Some(counter), pitfall: Some(pitfall) };
    }
    let widths = differences.iter().any(|[a, b]| {
        let [a, b] = [pair.scalar(0, *a), pair.scalar(1, *b)];
        let counts = a.ty.elementary().is_none_or(|it| !it.is_duration());
        matches!(a.role, Role::Variable) && counts && a.ty.elementary() != b.ty.elementary()
    });
    let pitfall = (counter.is_none() && widths).then_some(Pitfall::WIDTHS);
    Cause { counter, pitfall }
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
