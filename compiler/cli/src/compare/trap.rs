//! The twelve traps of a move between systems, and which of them a difference shows.

use super::leaf::{Instance, Role};
use super::pair::{Matched, Pair, Row};
use staunch_runtime::{Family, Lane, PinRole};

/// One of the traps of `docs/compare.md`, by its number less one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trap(usize);

struct Text {
    sentence: &'static str,
    advice: &'static str,
}

const TRAPS: [Text; 12] = [
    Text {
        sentence: "CU held TRUE counts once everywhere except CSCAPE, where it counts every call.",
        advice: "Put an R_TRIG before the counter's input on CSCAPE; elsewhere, call the counter with pulses.",
    },
    Text {
        sentence: "Past PV: CSCAPE holds; `IF c.CV > PV` never fires there, `CV = PV` fires for long.",
        advice: "Ask for `c.Q` or `c.CV >= PV`, never for `>` or `=`, and count the surplus in a variable if you need it.",
    },
    Text {
        sentence: "CTD at 0: IEC and Logix go negative; CSCAPE and CODESYS stay.",
        advice: "Call the counter with `CD := pulse AND c.CV > 0`, which stops at 0 everywhere.",
    },
    Text {
        sentence: "Logix CTD: DN is TRUE while ACC >= PRE, so it drops when done; there is no load input.",
        advice: "Ask for `c.ACC <= 0` instead of DN, and load with `IF load THEN c.ACC := c.PRE; END_IF`.",
    },
    Text {
        sentence: "Input already TRUE at start-up: Logix does not count it, the others do.",
        advice: "Decide which is meant: keep the input FALSE in the first scan, or add the first part to the count.",
    },
    Text {
        sentence: "Input still TRUE after a reset: Logix counts one when the reset goes, CSCAPE goes on counting, IEC and CODESYS do not count.",
        advice: "Feed the counter from an R_TRIG, so that it sees one pulse for each part on every system.",
    },
    Text {
        sentence: "Limits: IEC, CODESYS saturate; Logix wraps with OV/UN.",
        advice: "Reset the counter before its limit, or count in a wider type (CTU_DINT, LCTU).",
    },
    Text {
        sentence: "Widths: INT, WORD, DINT. `CV < 0` is never TRUE in CODESYS; -1 written to a WORD preset is 65535.",
        advice: "Keep presets and counts within 0..32767, and convert explicitly where the type changes.",
    },
    Text {
        sentence: "Pin names R/LD against RESET/LOAD: positional calls survive a move, named ones do not.",
        advice: "Rename the pins as the lints say, or give the inputs by position.",
    },
    Text {
        sentence: "PV lowered under CV: Q drops on CSCAPE, holds elsewhere.",
        advice: "Ask for `c.CV >= PV` instead of Q, or reset the counter when the preset changes.",
    },
    Text {
        sentence: "Restart: Logix keeps all; IEC and CODESYS restart at 0 unless the instance is RETAIN; CSCAPE needs R_CTU/R_CTD and a RETAIN RCV.",
        advice: "Declare the instance RETAIN (IEC, CODESYS), use R_CTU/R_CTD with a RETAIN RCV (CSCAPE), or reset it in the first scan (Logix).",
    },
    Text {
        sentence: "`c(R := done); done := c.Q;` loses an edge that arrives in the reset scan, on IEC and CODESYS.",
        advice: "Reset in the scan that completes the count: `IF c.Q THEN c(R := TRUE); END_IF` after the call.",
    },
];

impl Trap {
    /// The trap with this number, from 1.
    pub const fn number(self) -> usize {
        self.0 + 1
    }

    pub const fn numbered(number: usize) -> Self {
        assert!(number >= 1 && number <= TRAPS.len(), "traps count from 1 to 12");
        Self(number - 1)
    }

    pub fn sentence(self) -> &'static str {
        TRAPS[self.0].sentence
    }

    pub fn advice(self) -> &'static str {
        TRAPS[self.0].advice
    }
}

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
    pub lane: Lane,
}

/// All that is known of a counter that differs. The first of two is the system the program comes
/// from.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub kinds: [Kind; 2],
    /// Before the scan; `None` in the first.
    pub before: Option<[Pins; 2]>,
    pub now: [Pins; 2],
    /// The scan follows a restart.
    pub restarted: bool,
    /// The counter is reset by its own output.
    pub feeds_itself: bool,
    /// The counter only counts down.
    pub counts_down: bool,
}

impl Case {
    /// Pins of the side of `family`.
    fn on(&self, family: Family) -> Option<(Option<Pins>, Pins)> {
        let side = self.kinds.iter().position(|it| it.family == family)?;
        Some((self.before.map(|it| it[side]), self.now[side]))
    }

    fn involves(&self, family: Family) -> bool {
        self.kinds.iter().any(|it| it.family == family) && self.kinds[0].family != self.kinds[1].family
    }

    fn at_limit(&self) -> bool {
        let Some(before) = self.before else { return false };
        (0..2).any(|side| {
            let limits = self.kinds[side].lane.range().unwrap_or((0, 0));
            let own = [before[side].count, self.now[side].count];
            before[0].count == before[1].count
                && own.iter().any(|it| *it == limits.1 || *it == limits.0 && limits.0 < 0)
        })
    }
}

/// Which trap the difference of a counter shows.
pub fn classify(case: &Case) -> Option<Trap> {
    let [a, b] = case.now;
    let number = if case.restarted && case.before.is_some() {
        restarted(case)
    } else if a.preset != b.preset {
        Some(8)
    } else if a.count != b.count {
        counts(case)
    } else {
        outputs(case)
    };
    number.map(Trap::numbered)
}

fn restarted(case: &Case) -> Option<usize> {
    let kept_nothing = case.before.is_some_and(|it| it.iter().all(|pins| pins.count == 0));
    Some(if kept_nothing && case.involves(Family::Logix) { 5 } else { 11 })
}

fn counts(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    let wider = case.kinds[0].lane != case.kinds[1].lane;
    if case.at_limit() {
        // What stops one side's count, or turns it round, is its width where the other's is wider.
        return Some(if wider { 8 } else { 7 });
    }
    let before = case.before;
    let was_reset = before.is_some_and(|it| it.iter().any(|pins| pins.reset || pins.load));
    let now_reset = a.reset || a.load || b.reset || b.load;
    let (up, down) = (a.up || b.up, a.down || b.down);
    if was_reset && !now_reset && (up || down) && !past_zero(case) {
        return Some(if case.feeds_itself { 12 } else { 6 });
    }
    if let Some((_, logix)) = case.on(Family::Logix).filter(|_| case.involves(Family::Logix)) {
        if before.is_none() && (up || down) {
            return Some(5);
        }
        if a.load || b.load || logix.load {
            return Some(4);
        }
    }
    if past_zero(case) {
        return Some(3);
    }
    if let Some((_, cscape)) = case.on(Family::Cscape).filter(|_| case.involves(Family::Cscape)) {
        let other = a.count.max(b.count);
        if up && cscape.count >= cscape.preset && other > cscape.count {
            return Some(2);
        }
        return Some(1);
    }
    let same_bits = (a.count - b.count).rem_euclid(1 << 16) == 0;
    if wider && same_bits {
        return Some(8);
    }
    // OpenPLC stops at the preset, and one document of CODESYS says so of its CTU.
    let stops = case.kinds[0].family == case.kinds[1].family
        || case.involves(Family::Openplc)
        || case.involves(Family::Codesys);
    (stops && up && a.count.min(b.count) >= a.preset).then_some(2)
}

/// One side goes below 0, the other stays at it.
fn past_zero(case: &Case) -> bool {
    let [a, b] = case.now;
    let (low, high) = (a.count.min(b.count), a.count.max(b.count));
    low < 0 && high == 0 && (a.down || b.down)
}

/// The counts agree, the outputs do not.
fn outputs(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    if (a.done, a.empty) == (b.done, b.empty) {
        return None;
    }
    if case.involves(Family::Logix) && case.counts_down {
        return Some(4);
    }
    let preset_moved = case.before.is_some_and(|it| it[0].preset != a.preset);
    if case.involves(Family::Logix) && !preset_moved {
        // DN waits for a rung that is TRUE; no trap says so.
        return None;
    }
    if case.involves(Family::Cscape) && a.count < 0 && case.counts_down {
        return Some(3);
    }
    if case.kinds[0].lane != case.kinds[1].lane && (a.preset < 0 || a.count < 0) {
        return Some(8);
    }
    Some(10)
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

/// The counter that differs, if one does; and the trap.
pub struct Cause {
    pub counter: Option<String>,
    pub trap: Option<Trap>,
}

/// Looks at the counters whose outputs differ, also where they are not compared; without any, at
/// the types.
pub fn cause(pair: &Pair, rows: &[Row], differences: &[Matched], feeding: &[String]) -> Cause {
    let Some(last) = rows.last() else { return Cause { counter: None, trap: None } };
    let of_counters = counters(pair, rows, differences, feeding);
    if of_counters.trap.is_some() {
        return of_counters;
    }
    let outputs = pair.outputs();
    let parted = rows.iter().position(|row| outputs.iter().any(|it| !pair.same(*it, row)));
    if let Some(at) = parted.filter(|at| *at + 1 < rows.len()) {
        let differing: Vec<Matched> = outputs.into_iter().filter(|it| !pair.same(*it, &rows[at])).collect();
        let earlier = counters(pair, &rows[..=at], &differing, feeding);
        if earlier.trap.is_some() {
            return earlier;
        }
    }
    let counter = of_counters.counter;
    let kept = last.restart.then_some(Trap::numbered(11));
    let widths = differences.iter().any(|[a, _]| {
        let leaf = &pair.sides[0].leaves.all[*a];
        let counts = leaf.ty.elementary().and_then(|it| it.lane().range()).is_some();
        matches!(leaf.role, Role::Variable(_)) && counts
    });
    let trap = kept.or((counter.is_none() && widths).then_some(Trap::numbered(8)));
    Cause { counter, trap }
}

/// The first counter in the last row that shows a trap, or else that differs.
fn counters(pair: &Pair, rows: &[Row], differences: &[Matched], feeding: &[String]) -> Cause {
    let Some(last) = rows.last() else { return Cause { counter: None, trap: None } };
    let mut counter = None;
    for [a, b] in differences {
        let roles = [pair.sides[0].leaves.all[*a].role, pair.sides[1].leaves.all[*b].role];
        let (Role::Output(a), Role::Output(b)) = (roles[0], roles[1]) else { continue };
        let instances = [&pair.sides[0].leaves.blocks[a], &pair.sides[1].leaves.blocks[b]];
        counter.get_or_insert_with(|| instances[0].path.clone());
        let before = rows.len().checked_sub(2).map(|at| &rows[at]);
        let case = case(instances, before, last, feeding);
        if let Some(trap) = case.as_ref().and_then(classify) {
            return Cause { counter: Some(instances[0].path.clone()), trap: Some(trap) };
        }
    }
    Cause { counter, trap: None }
}

fn case(instances: [&Instance; 2], before: Option<&Row>, last: &Row, feeding: &[String]) -> Option<Case> {
    let kind = |it: &Instance| {
        let info = it.block.info();
        let count = info.pin_for(PinRole::Count)?;
        Some(Kind { family: info.family, lane: count.lane() })
    };
    let of = |row: &Row| [0, 1].map(|side| pins(instances[side], &row.states[side]));
    let name = instances[0].key.rsplit(['.', ']']).next().unwrap_or_default();
    let info = [instances[0].block.info(), instances[1].block.info()];
    let only_down =
        |it: &&staunch_runtime::BlockInfo| it.pin_for(PinRole::Down).is_some() && it.pin_for(PinRole::Up).is_none();
    let (now, before) = (level(of(last)), before.map(|it| level(of(it))));
    Some(Case {
        kinds: [kind(instances[0])?, kind(instances[1])?],
        before,
        now,
        restarted: last.restart,
        feeds_itself: feeding.iter().any(|it| it.eq_ignore_ascii_case(name)),
        counts_down: info.iter().any(only_down),
    })
}

/// A Logix COUNTER has no pins for its inputs: what the other side was given holds for both.
fn level(pins: [Pins; 2]) -> [Pins; 2] {
    let [a, b] = pins;
    pins.map(|it| Pins { reset: a.reset || b.reset, load: a.load || b.load, ..it })
}

#[cfg(test)]
mod tests;
