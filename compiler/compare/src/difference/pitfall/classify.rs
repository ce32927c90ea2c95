//! Which pitfall a counter's difference shows, by what is known of the counter on both sides.

use super::list::Pitfall;
use staunch_runtime::{Family, Repr};

/// A counter on one side, at the end of a scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pins {
    pub up: bool,
    pub down: bool,
    pub reset: bool,
    pub load: bool,
    pub preset: i128,
    pub count: i128,
    /// Q or DN; QU of an up-down counter.
    pub done: bool,
    /// QD of an up-down counter.
    pub empty: bool,
}

/// A counter's kind on one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    pub family: Family,
    pub repr: Repr,
    /// It counts up only below its preset, and down only above 0.
    pub stops: bool,
    /// It counts down on the falling edge.
    pub falls: bool,
    /// It is loaded when its input rises, and not while that is TRUE.
    pub loads_once: bool,
}

/// How a program uses a counter, as far as it decides which pitfall is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Habits {
    /// Its own output resets it.
    pub feeds_itself: bool,
    /// What it counts depends on its own count.
    pub guards_itself: bool,
    /// Both programs call or write it: what one alone has says nothing of the two systems.
    pub is_of_both: bool,
}

/// All that is known of a counter that differs. The first of two is the system the program comes
/// from.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub kinds: [Kind; 2],
    pub before: [Pins; 2],
    pub now: [Pins; 2],
    /// It is the first scan of all.
    pub first: bool,
    pub restarted: bool,
    /// Both systems keep, or lose, the same of it in that event.
    pub kept_alike: bool,
    /// The counter is reset by its own output.
    pub feeds_itself: bool,
    /// What it counts depends on its own count.
    pub guards_itself: bool,
    pub counts_down: bool,
    /// It counts down as well, if not only.
    pub has_down: bool,
}

impl Case {
    fn has(&self, family: Family) -> bool {
        self.kinds.iter().any(|it| it.family == family)
    }

    /// Whether one side is of this family and the other is not.
    fn parts(&self, family: Family) -> bool {
        self.has(family) && self.kinds[0].family != self.kinds[1].family
    }

    /// Whether one side alone is OpenPLC's, of either library.
    fn parts_openplc(&self) -> bool {
        let [a, b] = self.kinds.map(|it| is_openplc(it.family));
        a != b
    }

    /// CD falls, or rises, where the sides count it on other edges.
    fn other_edge(&self) -> bool {
        let moves = |side: usize| self.before[side].down != self.now[side].down;
        self.kinds[0].falls != self.kinds[1].falls && (moves(0) || moves(1))
    }

    /// Both edges in one call, of which OPENPLC4 counts each by itself.
    fn both_edges(&self) -> bool {
        let side = usize::from(self.kinds[1].family == Family::Openplc4);
        let (before, now) = (self.before[side], self.now[side]);
        let down = before.down != now.down && now.down != self.kinds[side].falls;
        self.parts(Family::Openplc4) && !before.up && now.up && down
    }

    /// One side is loaded in each call with LD TRUE, the other in the first of them.
    fn loads_otherwise(&self) -> bool {
        let side = usize::from(self.kinds[1].loads_once);
        self.kinds[0].loads_once != self.kinds[1].loads_once && self.before[side].load && self.now[side].load
    }

    fn up(&self) -> bool {
        self.now.iter().any(|it| it.up)
    }

    fn down(&self) -> bool {
        self.now.iter().any(|it| it.down)
    }

    /// CU or CD is TRUE now and was before. RES takes that from a COUNTER.
    fn is_held(&self) -> bool {
        let held = |of: fn(&Pins) -> bool| self.before.iter().any(of) && self.now.iter().any(of);
        held(|it| it.up) || held(|it| it.down)
    }

    /// Logix takes an input for one that was TRUE before: in the first scan, or where the prescan has said so and nothing was
    /// executed since.
    fn is_no_edge_to_logix(&self) -> bool {
        let Some(logix) = self.kinds.iter().position(|it| it.family == Family::Logix) else { return false };
        let (own, other) = (self.before[logix], self.before[1 - logix]);
        let is_prescanned = |of: fn(&Pins) -> bool| of(&own) && !of(&other) && of(&self.now[logix]);
        let is_first = self.first && (self.up() || self.down());
        let counts_not = own.count == self.now[logix].count;
        self.parts(Family::Logix)
            && counts_not
            && (is_first || is_prescanned(|it| it.up) || is_prescanned(|it| it.down))
    }

    /// CSCAPE counts what the other does not: an input that stays TRUE, or is in several calls of a scan.
    fn counts_levels(&self) -> bool {
        let Some(side) = self.kinds.iter().position(|it| it.family == Family::Cscape) else { return false };
        let steps = self.now[side].count.abs_diff(self.before[side].count);
        let is_set = self.now.iter().any(|it| it.reset || it.load);
        self.parts(Family::Cscape) && (self.is_held() || steps > 1 && !is_set)
    }

    fn is_wider(&self) -> bool {
        self.kinds[0].repr != self.kinds[1].repr
    }

    /// A count is at a limit of its type, where the other counts further.
    fn at_limit(&self) -> bool {
        (0..2).any(|side| {
            let limits = self.kinds[side].repr.range().unwrap_or((0, 0));
            let own = [self.before[side].count, self.now[side].count];
            own.iter().any(|it| *it == limits.1 || *it == limits.0 && limits.0 < 0)
        })
    }

    /// One side goes below 0, the other stays there, by their rules.
    fn past_zero(&self) -> bool {
        let [a, b] = self.kinds.map(goes_below);
        let (below, stays) = if a { (0, 1) } else { (1, 0) };
        let [lower, upper] = [below, stays].map(|it| self.now[it].count);
        a != b && lower < 0 && upper <= 0 && lower < upper
    }

    /// CD rises on one side alone, where the other has held it since the call before: a guard has made the edge.
    fn makes_an_edge(&self) -> bool {
        (0..2).any(|side| {
            let (rises, held) = (side, 1 - side);
            let rises = !self.before[rises].down && self.now[rises].down;
            rises && self.before[held].down && self.now[held].down
        })
    }

    /// A negative preset is another number on the other side.
    pub(super) fn has_other_preset(&self) -> bool {
        let [a, b] = self.now;
        let same_bits = (a.preset - b.preset).rem_euclid(1 << 16) == 0;
        a.preset != b.preset && same_bits && self.is_wider() && (a.preset < 0 || b.preset < 0)
    }

    /// Q of CSCAPE asks for a count of 0, that of others for one below it, too.
    pub(super) fn is_empty_on_one(&self) -> bool {
        let [a, b] = self.now;
        self.parts(Family::Cscape) && self.counts_down && a.count == b.count && a.count < 0
    }

    /// A block that counts down says nothing yet, where its count is that of one that is empty.
    pub(super) fn is_before_first_call(&self) -> bool {
        let Some(logix) = self.kinds.iter().position(|it| it.family == Family::Logix) else { return false };
        let block = self.before[1 - logix];
        let is_silent = if self.counts_down { !block.done } else { !block.empty };
        self.parts(Family::Logix) && self.has_down && is_silent && block.count == 0 && self.before[logix].count <= 0
    }

    pub(super) fn counts_alike(&self) -> bool {
        self.now[0].count == self.now[1].count
    }

    pub(super) fn counted_alike(&self) -> bool {
        self.before[0].count == self.before[1].count
    }

    /// What the counter is given differs: what is upstream of it has parted.
    pub(super) fn given_differs(&self) -> bool {
        let logix = self.has(Family::Logix);
        let [a, b] = self.now;
        let resets = !logix && (a.reset != b.reset || a.load != b.load);
        a.up != b.up || a.down != b.down || resets
    }
}

/// Which pitfall a counter's difference shows, if one does.
pub fn classify(case: &Case) -> Option<Pitfall> {
    let number = if case.restarted && case.kept_alike {
        // If both keep it, the event makes no difference: Logix evaluates its rungs again.
        match case.parts(Family::Logix) && (case.up() || case.down()) {
            // An edge flag that one side alone keeps gives it another input.
            true => (!case.given_differs()).then_some(5),
            false => of_scan(case),
        }
    } else if case.restarted {
        Some(if case.before.iter().all(|it| it.count == 0) && case.parts(Family::Logix) { 5 } else { 11 })
    } else {
        of_scan(case)
    };
    number.map(Pitfall::numbered)
}

/// Where no event has parted it.
fn of_scan(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    if case.has_other_preset() {
        Some(8)
    } else if a.count != b.count {
        counts(case)
    } else {
        outputs(case)
    }
}

fn counts(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    if case.loads_otherwise() && !case.given_differs() {
        return Some(20);
    }
    if case.at_limit() {
        // What stops one side's count, or turns it round, is its width where the other's is wider.
        return Some(if case.is_wider() { 8 } else { 7 });
    }
    // A load is an assignment in Logix, which no edge forgets.
    let was_reset = case.before.iter().any(|it| it.reset || it.load && !case.has(Family::Logix));
    let is_reset = case.now.iter().any(|it| it.reset || it.load);
    if case.is_no_edge_to_logix() && !case.given_differs() {
        return Some(5);
    }
    if case.guards_itself && case.makes_an_edge() {
        return Some(14);
    }
    if case.both_edges() && case.kinds[0].falls == case.kinds[1].falls {
        return Some(18);
    }
    if case.other_edge() && !case.given_differs() && !case.past_zero() {
        return Some(17);
    }
    let counts_again = case.parts(Family::Logix) || case.parts(Family::Cscape);
    if counts_again && was_reset && !is_reset && case.is_held() && !case.past_zero() {
        // Its own pattern loses nothing where an edge is what Q rises on.
        return Some(if case.feeds_itself && case.parts(Family::Cscape) { 12 } else { 6 });
    }
    if counts_without_edge(case) {
        return Some(6);
    }
    if case.feeds_itself && is_reset && a.preset == b.preset {
        return Some(12);
    }
    if case.parts(Family::Logix) && a.preset == b.preset && case.now.iter().any(|it| it.load) {
        return Some(4);
    }
    if case.past_zero() {
        return Some(if case.parts_openplc() { 15 } else { 3 });
    }
    beyond_preset(case).or_else(|| (case.counts_levels() && !case.given_differs()).then_some(1)).or_else(|| {
        let same_bits = (a.count - b.count).rem_euclid(1 << 16) == 0;
        (case.is_wider() && same_bits).then_some(8)
    })
}

/// Logix has counted although the rung was TRUE before: a reset has made it forget.
pub(super) fn counts_without_edge(case: &Case) -> bool {
    let Some(side) = case.kinds.iter().position(|it| it.family == Family::Logix) else { return false };
    let other = 1 - side;
    let held = case.before[other].up && case.now[other].up;
    case.parts(Family::Logix) && held && case.now[side].count > case.before[side].count
}

/// One side stops at the preset, the other goes past it.
fn beyond_preset(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    let stops = case.kinds[0].stops != case.kinds[1].stops;
    let number = if case.parts_openplc() { 15 } else { 2 };
    (stops && case.up() && a.count.min(b.count) >= a.preset.min(b.preset)).then_some(number)
}

/// The counts agree, the outputs do not.
fn outputs(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    if (a.done, a.empty) == (b.done, b.empty) || a.preset != b.preset && !case.is_wider() {
        return None;
    }
    if case.is_empty_on_one() {
        return Some(21);
    }
    if case.parts(Family::Logix) {
        return Some(if case.counts_down { 4 } else { 13 });
    }
    if case.is_wider() && (a.preset < 0 || a.count < 0) {
        return Some(8);
    }
    case.parts(Family::Cscape).then_some(10)
}

/// OpenPLC before v4.1, or from then on.
pub(super) fn is_openplc(family: Family) -> bool {
    matches!(family, Family::Openplc | Family::Openplc4)
}

/// Whether a count of this kind can be negative.
pub(super) fn goes_below(kind: Kind) -> bool {
    matches!(kind.family, Family::Iec | Family::Logix | Family::S7) && kind.repr.is_signed()
}

#[cfg(test)]
mod tests;
