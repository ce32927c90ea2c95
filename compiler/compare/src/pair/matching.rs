//! What both sides have, by the names that they share; and what one of them alone has.

use super::scan::{Input, Matched};
use super::side::Side;
use crate::program::scalar::{Instance, Role, Scalar};
use crate::program::usage;
use crate::program::walked::Name;
use staunch_runtime::{Family, PinRole};
use std::collections::{HashMap, HashSet};

/// The scalars that both sides have, by their common names.
pub fn matched(sides: &[Side; 2], wanted: impl Fn(&Scalar) -> bool) -> Vec<Matched> {
    let other = sides[1].scalars.all.iter().enumerate();
    let other: HashMap<&str, usize> = other.map(|(at, scalar)| (scalar.key.as_str(), at)).collect();
    let all = sides[0].scalars.all.iter().enumerate();
    let wanted = all.filter(|(_, scalar)| wanted(scalar));
    wanted.filter_map(|(at, scalar)| Some([at, *other.get(scalar.key.as_str())?])).collect()
}

/// Instances on both sides: those that count, or the others.
pub fn blocks(sides: &[Side; 2], count: bool) -> Vec<Matched> {
    let others = sides[1].scalars.blocks.iter().enumerate().filter(|(_, it)| it.counts() == count);
    let others: HashMap<&str, usize> = others.map(|(at, it)| (it.key.as_str(), at)).collect();
    let counterpart = |it: &Instance| others.get(it.key.as_str()).copied();
    let ours = sides[0].scalars.blocks.iter().enumerate().filter(|(_, it)| it.counts() == count);
    ours.filter_map(|(at, it)| Some([at, counterpart(it)?])).collect()
}

pub fn outputs(sides: &[Side; 2], blocks: &[Matched]) -> Vec<Vec<Matched>> {
    let all = matched(sides, |it| matches!(it.role, Role::Output(_)));
    let of = |[counter, _]: &Matched| {
        let own = |it: &&Matched| sides[0].scalars.all[it[0]].role == Role::Output(*counter);
        all.iter().filter(own).copied().collect()
    };
    blocks.iter().map(of).collect()
}

/// Whether it is Q of a CTD matched with DN of Logix: they mean different things.
pub fn is_done_of_down(sides: &[Side; 2], matched: Matched) -> bool {
    let is_down =
        |it: &Instance| it.has(PinRole::Down) && !it.has(PinRole::Up) && it.block.info().family != Family::Logix;
    let is =
        |own: usize| block_of(sides, own, matched).is_some_and(is_down) && is_done_of_logix(sides, 1 - own, matched);
    is(0) || is(1)
}

/// Whether it is DN of a counter of Logix.
pub fn is_done_of_logix(sides: &[Side; 2], side: usize, matched: Matched) -> bool {
    block_of(sides, side, matched).is_some_and(|tag| {
        let info = tag.block.info();
        let at = sides[side].scalars.all[matched[side]].offset;
        info.family == Family::Logix && info.pin_for(PinRole::Done).is_some_and(|it| at == tag.offset + it.offset)
    })
}

/// The outputs of counters that are DN of Logix, which nothing reads there.
pub fn unread_done(sides: &[Side; 2], outputs: &[Vec<Matched>]) -> HashSet<Matched> {
    let mut unread = HashSet::new();
    for side in 0..2 {
        let done = || outputs.iter().flatten().filter(|it| is_done_of_logix(sides, side, **it));
        if done().next().is_none() {
            continue;
        }
        let found = usage::of(&sides[side].program);
        let is_read = |it: &&Matched| {
            let field = block_of(sides, side, **it).and_then(|it| it.field);
            field.is_none_or(|(owner, field)| found.get(&Name::Field(owner, field)).is_some_and(|it| it.reads_done))
        };
        unread.extend(done().filter(|it| !is_read(it)).copied());
    }
    unread
}

/// The block that an output is of.
fn block_of(sides: &[Side; 2], side: usize, matched: Matched) -> Option<&Instance> {
    match sides[side].scalars.all[matched[side]].role {
        Role::Output(number) => sides[side].scalars.blocks.get(number),
        Role::Input | Role::Variable | Role::Hidden => None,
    }
}

/// Whether a name, as a user writes it, is that of a scalar or of what it is in. It may begin with the one PROGRAM, as it
/// may for a run.
fn is_named(side: &Side, at: usize, name: &str) -> bool {
    let scalar = &side.scalars.all[at];
    let starts = |path: &str, name: &str| {
        let (path, name) = (path.to_ascii_lowercase(), name.to_ascii_lowercase());
        path.strip_prefix(&name).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    let key = scalar.key.strip_prefix("globals.").unwrap_or(&scalar.key);
    let is = |name: &str| starts(key, name) || starts(&scalar.key, name) || starts(&scalar.path, name);
    let program = &side.program;
    // A variable of a list may be named in full.
    let full = scalar.full_name(program);
    let within = name.split_once('.').filter(|(first, _)| match program.instances.as_slice() {
        [one] => [&one.name, &program.class(one.program).name].into_iter().any(|it| it.eq_ignore_ascii_case(first)),
        _ => false,
    });
    is(name) || full.is_some_and(|it| starts(&it, name)) || within.is_some_and(|(_, rest)| is(rest))
}

/// A name that nothing has which is compared; with how many sides have it otherwise.
pub fn unknown_name<'n>(sides: &[Side; 2], only: &'n [String]) -> Option<(&'n str, usize)> {
    let both = matched(sides, |it| it.role != Role::Hidden);
    let known = |name: &str| both.iter().any(|[a, b]| is_named(&sides[0], *a, name) || is_named(&sides[1], *b, name));
    let name = only.iter().find(|it| !known(it))?;
    let has = |side: &usize| (0..sides[*side].scalars.all.len()).any(|at| is_named(&sides[*side], at, name));
    Some((name, [0, 1].iter().filter(|it| has(it)).count()))
}

/// Variables and outputs of blocks that only one side has: its number, and their paths.
pub fn only_one_has(sides: &[Side; 2], wanted: impl Fn(&Scalar) -> bool) -> Vec<(usize, &str)> {
    let keys = [0, 1].map(|side: usize| sides[side].scalars.all.iter().map(|it| it.key.as_str()).collect());
    let keys: [HashSet<&str>; 2] = keys;
    let of = |side: usize| {
        let all = sides[side].scalars.all.iter().filter(|it| it.role != Role::Hidden);
        let (wanted, other) = (&wanted, &keys[1 - side]);
        all.filter(move |it| wanted(it) && !other.contains(it.key.as_str())).map(move |it| (side, it.path.as_str()))
    };
    of(0).chain(of(1)).collect()
}

pub fn compared(sides: &[Side; 2], inputs: &[Input], only: &[String]) -> Vec<Matched> {
    let inputs: Vec<_> = inputs.iter().map(|it| it.scalars[0]).collect();
    let shows = |it: &Scalar| matches!(it.role, Role::Variable | Role::Output(_));
    let mut found = matched(sides, shows);
    found.retain(|[a, b]| {
        let asked = only.is_empty() || only.iter().any(|it| is_named(&sides[0], *a, it) || is_named(&sides[1], *b, it));
        shows(&sides[1].scalars.all[*b]) && !inputs.contains(a) && asked
    });
    found
}
