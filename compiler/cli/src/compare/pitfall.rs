//! The pitfalls of a move between systems, which of them a difference shows, and which cannot happen.

use super::pair::{Matched, Pair, Row};
use super::scalar::{Instance, Role};
use staunch_host::Event;
use staunch_runtime::{Family, PinRole, Repr};

/// One of the pitfalls of `docs/compare.md`, by its number less one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Pitfall(usize);

struct Text {
    sentence: &'static str,
    advice: &'static str,
}

const PITFALLS: [Text; 15] = [
    Text {
        sentence: "CU held TRUE counts once everywhere except CSCAPE, where it counts every call.",
        advice: "Feed the counter from an R_TRIG: `e(CLK := sensor); c(CU := e.Q, …)`.",
    },
    Text {
        sentence: "Past PV: CSCAPE holds; `IF c.CV > PV` never fires there, `CV = PV` fires for long.",
        advice: "Let PV be 32767, which no INT passes, and compare the count yourself: `c.CV >= 50`, `c.CV > 60`.",
    },
    Text {
        sentence: "CTD at 0: IEC and Logix go negative; CSCAPE and CODESYS stay.",
        advice: "Where the count has to stay at 0, put the edge first: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.",
    },
    Text {
        sentence: "Logix CTD: DN is TRUE while ACC >= PRE, so it drops when done; there is no load input.",
        advice: "Ask for `c.ACC <= 0` instead of DN, and load after the CTD: `IF load THEN c.ACC := c.PRE; END_IF`.",
    },
    Text {
        sentence: "Input already TRUE at start-up: Logix does not count it, the others do.",
        advice: "To count it on Logix, find the edge yourself: `edge := sensor AND NOT before; before := sensor; \
                 c.CU := FALSE; CTU(c, edge);`.",
    },
    Text {
        sentence: "Input still TRUE after a reset: Logix counts one when the reset goes, CSCAPE goes on counting, IEC and CODESYS do not count.",
        advice: "Feed the counter from an R_TRIG, on Logix from `edge := sensor AND NOT before; before := sensor;`.",
    },
    Text {
        sentence: "Limits: IEC, CODESYS saturate; Logix wraps with OV/UN.",
        advice: "Stop the count before its limit: `e(CLK := pulse); c(CU := e.Q AND c.CV < 32767, …)`.",
    },
    Text {
        sentence: "Widths: INT, WORD, DINT. `CV < 0` is never TRUE in CODESYS; -1 written to a WORD preset is 65535.",
        advice: "Keep the count within 0..32767 by `e(CLK := pulse); c(CU := e.Q AND c.CV < 32767, …)`, and a preset by `MAX(preset, 0)`.",
    },
    Text {
        sentence: "Pin names R/LD against RESET/LOAD: positional calls survive a move, named ones do not.",
        advice: "Rename the pins as the lints say, or give the inputs by position.",
    },
    Text {
        sentence: "PV lowered under CV: Q drops on CSCAPE, holds elsewhere.",
        advice: "Let PV be 32767, which no INT passes, and compare the count with the preset yourself: `c.CV >= preset`.",
    },
    Text {
        sentence: "Restart: Logix keeps all, and so does CODESYS over STOP -> RUN; else IEC and CODESYS restart at 0 unless the instance is RETAIN; CSCAPE needs R_CTU/R_CTD and a RETAIN RCV.",
        advice: "Declare RETAIN what Logix keeps, and what CODESYS keeps over STOP -> RUN (IEC, CODESYS), or use R_CTU/R_CTD with a \
                 RETAIN RCV (CSCAPE). IEC and CSCAPE have no variable that only STOP -> RUN keeps.",
    },
    Text {
        sentence: "`c(R := done); done := c.Q;` loses a call on CSCAPE, an edge of a CTUD's other input, and an edge when PV moves.",
        advice: "Give R := FALSE in the call that counts, and after the statements that read Q reset in a second call with all \
                 inputs: `IF c.Q THEN c(CU := sensor, R := TRUE, PV := n); END_IF`; on CSCAPE feed CU from an R_TRIG.",
    },
    Text {
        sentence: "DN of Logix is evaluated only while the rung is TRUE; Q of the others in every call.",
        advice: "Ask for `c.ACC >= c.PRE` instead of DN.",
    },
    Text {
        sentence: "The guard `CD := pulse AND c.CV > 0` makes an edge of its own when CV leaves 0.",
        advice: "Put the edge first: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.",
    },
    Text {
        sentence: "OPENPLC stops at PV and at 0: `CV > PV` never holds, as on CSCAPE, and no count goes below 0.",
        advice: "Let PV be 32767, which no INT passes, and compare the count yourself; count below 0 in a variable of your own.",
    },
];

impl Pitfall {
    pub const RESTART: Self = Self::numbered(11);
    const WIDTHS: Self = Self::numbered(8);

    /// Its number, from 1.
    pub const fn number(self) -> usize {
        self.0 + 1
    }

    pub const fn numbered(number: usize) -> Self {
        assert!(number >= 1 && number <= PITFALLS.len(), "pitfalls count from 1");
        Self(number - 1)
    }

    pub fn all() -> impl Iterator<Item = Self> {
        (0..PITFALLS.len()).map(Self)
    }

    pub fn sentence(self) -> &'static str {
        PITFALLS[self.0].sentence
    }

    pub fn advice(self) -> &'static str {
        PITFALLS[self.0].advice
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
    pub repr: Repr,
    /// It counts up only below its preset, and down only above 0.
    pub stops: bool,
}

/// How a program uses a counter, as far as it decides which pitfall is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Habits {
    /// Its own output resets it.
    pub feeds_itself: bool,
    /// What it counts depends on its own count.
    pub guards_itself: bool,
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
    /// The counter is reset by its own output.
    pub feeds_itself: bool,
    /// What it counts depends on its own count.
    pub guards_itself: bool,
    pub counts_down: bool,
}

impl Case {
    fn has(&self, family: Family) -> bool {
        self.kinds.iter().any(|it| it.family == family)
    }

    /// Whether one side is of this family and the other is not.
    fn parts(&self, family: Family) -> bool {
        self.has(family) && self.kinds[0].family != self.kinds[1].family
    }

    fn up(&self) -> bool {
        self.now.iter().any(|it| it.up)
    }

    fn down(&self) -> bool {
        self.now.iter().any(|it| it.down)
    }

    fn is_wider(&self) -> bool {
        self.kinds[0].repr != self.kinds[1].repr
    }

    /// A count at a limit of its type is where the other goes on.
    fn at_limit(&self) -> bool {
        (0..2).any(|side| {
            let limits = self.kinds[side].repr.range().unwrap_or((0, 0));
            let own = [self.before[side].count, self.now[side].count];
            own.iter().any(|it| *it == limits.1 || *it == limits.0 && limits.0 < 0)
        })
    }

    /// One side is below 0, the other stays at it, by their rules.
    fn past_zero(&self) -> bool {
        let [a, b] = self.now;
        goes_below(self.kinds[0]) != goes_below(self.kinds[1])
            && a.count.min(b.count) < 0
            && a.count.max(b.count) == 0
            && self.down()
    }

    /// What the counter is given differs: what is upstream of it has parted.
    fn given_differs(&self) -> bool {
        let logix = self.has(Family::Logix);
        let [a, b] = self.now;
        let resets = !logix && (a.reset != b.reset || a.load != b.load);
        a.up != b.up || a.down != b.down || resets
    }
}

/// Which pitfall a counter's difference shows, if one does.
pub fn classify(case: &Case) -> Option<Pitfall> {
    let [a, b] = case.now;
    let number = if case.restarted {
        Some(if case.before.iter().all(|it| it.count == 0) && case.parts(Family::Logix) { 5 } else { 11 })
    } else if a.preset != b.preset && case.is_wider() && (a.preset < 0 || b.preset < 0) {
        Some(8)
    } else if a.count != b.count {
        counts(case)
    } else {
        outputs(case)
    };
    number.map(Pitfall::numbered)
}

fn counts(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    if case.at_limit() {
        // What stops one side's count, or turns it round, is its width where the other's is wider.
        return Some(if case.is_wider() { 8 } else { 7 });
    }
    let was_reset = case.before.iter().any(|it| it.reset || it.load);
    let is_reset = case.now.iter().any(|it| it.reset || it.load);
    if case.first && case.parts(Family::Logix) && (case.up() || case.down()) {
        return Some(5);
    }
    if case.guards_itself && (case.before[0].down != case.before[1].down || a.down != b.down) {
        return Some(14);
    }
    let counts_again = case.parts(Family::Logix) || case.parts(Family::Cscape);
    if counts_again && was_reset && !is_reset && (case.up() || case.down()) && !case.past_zero() {
        return Some(if case.feeds_itself { 12 } else { 6 });
    }
    if counts_without_edge(case) {
        return Some(6);
    }
    if case.feeds_itself && is_reset {
        return Some(12);
    }
    if case.parts(Family::Logix) && case.now.iter().any(|it| it.load) {
        return Some(4);
    }
    if case.past_zero() {
        return Some(if case.parts(Family::Openplc) { 15 } else { 3 });
    }
    beyond_preset(case).or_else(|| (case.parts(Family::Cscape) && !case.given_differs()).then_some(1)).or_else(|| {
        let same_bits = (a.count - b.count).rem_euclid(1 << 16) == 0;
        (case.is_wider() && same_bits).then_some(8)
    })
}

/// Logix has counted although the rung was TRUE before: a reset has made it forget.
fn counts_without_edge(case: &Case) -> bool {
    let Some(side) = case.kinds.iter().position(|it| it.family == Family::Logix) else { return false };
    let other = 1 - side;
    let held = case.before[other].up && case.now[other].up;
    case.parts(Family::Logix) && held && case.now[side].count > case.before[side].count
}

/// One side stops at the preset, the other goes past it.
fn beyond_preset(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    let stops = case.kinds[0].stops != case.kinds[1].stops;
    let number = if case.parts(Family::Openplc) { 15 } else { 2 };
    (stops && case.up() && a.count.min(b.count) >= a.preset.min(b.preset)).then_some(number)
}

/// The counts agree, the outputs do not.
fn outputs(case: &Case) -> Option<usize> {
    let [a, b] = case.now;
    if (a.done, a.empty) == (b.done, b.empty) || a.preset != b.preset && !case.is_wider() {
        return None;
    }
    if case.parts(Family::Logix) {
        return Some(if case.counts_down { 4 } else { 13 });
    }
    if case.parts(Family::Cscape) && a.count < 0 && case.counts_down {
        return Some(3);
    }
    if case.is_wider() && (a.preset < 0 || a.count < 0) {
        return Some(8);
    }
    case.parts(Family::Cscape).then_some(10)
}

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

pub fn kind(instance: &Instance) -> Option<Kind> {
    let info = instance.block.info();
    let count = info.pin_for(PinRole::Count)?;
    Some(Kind { family: info.family, repr: count.repr(), stops: info.facts.stops })
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
    let widths = differences.iter().any(|[a, b]| {
        let [a, b] = [pair.scalar(0, *a), pair.scalar(1, *b)];
        matches!(a.role, Role::Variable) && a.ty.elementary() != b.ty.elementary()
    });
    let pitfall = (counter.is_none() && widths).then_some(Pitfall::WIDTHS);
    Cause { counter, pitfall }
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

/// What the programs' texts say of a counter.
#[derive(Clone, Copy, Debug, Default)]
pub struct Use {
    /// Its preset is the same constant in every call on both sides.
    pub constant_preset: bool,
    pub habits: Habits,
    /// Something resets or loads it.
    pub resets: bool,
    /// What resets it depends on its own outputs in some way.
    pub reset_depends: bool,
    /// Both systems keep, or lose, the same of it.
    pub kept_alike: bool,
}

/// Why a pitfall cannot happen to a counter, by the two systems' rules and the program's text alone.
pub fn impossible(pitfall: Pitfall, instances: [&Instance; 2], usage: Use) -> Option<&'static str> {
    let kinds = instances.map(kind);
    let [Some(a), Some(b)] = kinds else { return Some("it is no counter") };
    let parts = |family: Family| (a.family == family) != (b.family == family);
    let has = |role: PinRole| instances.iter().any(|it| it.has(role));
    let same_kind = a == b;
    let no_cscape = (!parts(Family::Cscape)).then_some("CSCAPE is neither, or both, of the two systems");
    let no_logix = (!parts(Family::Logix)).then_some("Logix is neither, or both, of the two systems");
    let no_down = (!has(PinRole::Down)).then_some("it does not count down");
    let no_up = (!has(PinRole::Up)).then_some("it does not count up");
    match pitfall.number() {
        1 => no_cscape,
        2 | 3 if parts(Family::Openplc) => Some("what OPENPLC does is trap 15"),
        2 => (a.stops == b.stops).then_some("both systems stop at PV, or neither does").or(no_up),
        3 => no_down.or_else(|| (goes_below(a) == goes_below(b)).then_some("both systems do the same at 0")),
        4 => no_logix.or((!has(PinRole::Down) || has(PinRole::Up)).then_some("it is no CTD")),
        5 | 13 => no_logix,
        6 => no_logix.and(no_cscape).or((!usage.resets).then_some("nothing resets or loads it")),
        7 => (a.repr != b.repr || same_kind || !parts(Family::Logix))
            .then_some("both systems do the same at a limit, or have other limits"),
        8 => (a.repr == b.repr).then_some("both systems count in the same type"),
        9 => Some("its pins have the same names, or are given by position"),
        10 => no_cscape.or(usage.constant_preset.then_some("its preset is one constant")),
        11 => usage.kept_alike.then_some("both systems keep, or lose, the same of it"),
        12 => (!usage.reset_depends).then_some("what resets it does not depend on its own output"),
        14 => no_down.or((!usage.habits.guards_itself).then_some("no input of it depends on its own count")),
        _ if !parts(Family::Openplc) => Some("OPENPLC is neither, or both, of the two systems"),
        _ => (a.stops == b.stops && goes_below(a) == goes_below(b)).then_some("the other system stops as OPENPLC does"),
    }
}

/// Whether a count of this kind can be negative.
fn goes_below(kind: Kind) -> bool {
    matches!(kind.family, Family::Iec | Family::Logix) && kind.repr.is_signed()
}

#[cfg(test)]
mod tests;
