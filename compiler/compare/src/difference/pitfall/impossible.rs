//! Which pitfalls cannot happen to a counter.

use super::classify::{Habits, goes_below, is_openplc};
use super::list::Pitfall;
use super::parting::{block_counts_down, kind};
use crate::pair::Pair;
use crate::program::scalar::Instance;
use crate::program::usage::{self, Usage};
use crate::program::walked::Name;
use staunch_host::Event;
use staunch_runtime::{Family, PinRole};

/// What the programs' texts say of a counter.
#[derive(Clone, Copy, Debug, Default)]
pub struct Use {
    /// Something calls or writes it on one side at least.
    pub is_used: bool,
    /// And on one side nothing does.
    pub is_of_one: bool,
    /// Its preset is the same constant in every call on both sides.
    pub constant_preset: bool,
    pub habits: Habits,
    /// Something resets or loads it.
    pub resets: bool,
    /// What resets it depends on its own outputs in some way.
    pub reset_depends: bool,
    /// Both systems keep, or lose, the same of it.
    pub kept_alike: bool,
    /// DN of Logix is read, or compared.
    pub shows_done: bool,
}

/// How both programs use each counter.
pub fn uses(pair: &Pair) -> Vec<Use> {
    let found = [0, 1].map(|side: usize| usage::of(&pair.sides[side].program));
    let each = |at: usize| {
        let instances = pair.instances(at);
        let of = |side: usize| -> Usage {
            let name = instances[side].field.map(|(owner, field)| Name::Field(owner, field));
            name.and_then(|it| found[side].get(&it)).cloned().unwrap_or_default()
        };
        let [a, b] = [of(0), of(1)];
        let presets: Vec<_> = a.presets.union(&b.presets).collect();
        let kept = |side: usize| {
            let count = instances[side].block.info().pin_for(PinRole::Count);
            let keeps =
                |event| count.is_some_and(|it| pair.sides[side].keeps(event, instances[side].offset + it.offset));
            Event::ALL.map(|it| !pair.never.contains(&it) && keeps(it))
        };
        Use {
            is_used: a.is_used || b.is_used,
            is_of_one: a.is_used != b.is_used,
            constant_preset: presets.len() == 1 && presets[0].is_some(),
            habits: Habits {
                feeds_itself: a.feeds_itself || b.feeds_itself,
                guards_itself: a.count_depends || b.count_depends,
                is_of_both: a.is_used && b.is_used,
            },
            resets: a.resets || b.resets,
            reset_depends: a.reset_depends || b.reset_depends,
            kept_alike: kept(0) == kept(1),
            shows_done: pair.shows_done(at),
        }
    };
    (0..pair.counters.len()).map(each).collect()
}

/// How the reason ends where a pitfall is of another system.
pub const OF_OTHERS: &str = "of the two systems";

/// Why a pitfall cannot happen to a counter, by the two systems' rules and the program's text alone.
pub fn impossible(pitfall: Pitfall, instances: [&Instance; 2], usage: Use) -> Option<&'static str> {
    let kinds = instances.map(kind);
    let [Some(a), Some(b)] = kinds else { return Some("it is not a counter") };
    let parts = |family: Family| (a.family == family) != (b.family == family);
    let parts_openplc = is_openplc(a.family) != is_openplc(b.family);
    let has = |role: PinRole| instances.iter().any(|it| it.has(role));
    let same_kind = a == b;
    let no_cscape = (!parts(Family::Cscape)).then_some("CSCAPE is neither, or both, of the two systems");
    let no_logix = (!parts(Family::Logix)).then_some("Logix is neither, or both, of the two systems");
    let no_down = (!has(PinRole::Down)).then_some("it does not count down");
    let no_up = (!has(PinRole::Up)).then_some("it does not count up");
    match pitfall.number() {
        _ if !usage.is_used => Some("it is never called"),
        _ if usage.is_of_one => Some("one of the two programs never calls it"),
        1 => no_cscape,
        2 | 3 if parts_openplc => Some("the behaviour of OPENPLC is trap 15"),
        2 => (a.stops == b.stops).then_some("both systems stop at PV, or neither does").or(no_up),
        3 => no_down.or_else(|| (goes_below(a) == goes_below(b)).then_some("both systems do the same at 0")),
        4 => no_logix
            .or((!instances.iter().any(|it| it.has(PinRole::Down) && !it.has(PinRole::Up))).then_some("it is no CTD"))
            .or((!usage.shows_done && !usage.resets).then_some("nothing reads its DN or loads it")),
        5 => no_logix,
        13 => no_logix.or((!usage.shows_done).then_some("nothing reads its DN")),
        6 => no_logix.and(no_cscape).or((!usage.resets).then_some("nothing resets or loads it")),
        7 => (a.repr != b.repr || same_kind || !parts(Family::Logix))
            .then_some("both systems do the same at a limit, or have different limits"),
        8 => (a.repr == b.repr).then_some("both systems count in the same type"),
        9 => Some("its pins have the same names, or are given by position"),
        10 => no_cscape.or(usage.constant_preset.then_some("its preset is one constant")),
        11 => usage.kept_alike.then_some("both systems keep, or lose, the same part of it"),
        12 => (!usage.reset_depends).then_some("its reset does not depend on its own output"),
        14 => no_down.or((!usage.habits.guards_itself).then_some("none of its inputs depends on its own count")),
        17 | 18 if !parts(Family::Openplc4) => Some("OPENPLC4 is neither, or both, of the two systems"),
        17 => no_down.or_else(|| (a.falls == b.falls).then_some("both systems count CD on the same edge")),
        18 => no_down.or(no_up),
        20 if !parts(Family::S7) => Some("S7 is neither, or both, of the two systems"),
        20 if !has(PinRole::Load) => Some("it has no LD"),
        20 => (a.loads_once == b.loads_once).then_some("LD loads in the same way on both systems"),
        21 => no_cscape
            .or(no_down)
            .or((a.repr.is_signed() != b.repr.is_signed()).then_some("one of the two has no negative count")),
        22 if !instances.into_iter().any(block_counts_down) => no_logix.or(Some("no block of it counts down")),
        22 => no_logix,
        _ if !parts_openplc => Some("OPENPLC is neither, or both, of the two systems"),
        _ => (a.stops == b.stops && goes_below(a) == goes_below(b)).then_some("the other system stops as OPENPLC does"),
    }
}
