//! Each row of Logix's table in `docs/dialects.md` is pinned: a second reading of COUNTER and FBD_COUNTER,
//! whose rules are switches, agrees with every table of vectors, and breaking the rule of a row breaks
//! a vector that the row links. The runtime's structures agree with it over random calls.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use serde_json::Value as Json;
use staunch_runtime::{BLOCKS, BlockInfo, Context, Value};

#[derive(Clone, Copy, Debug)]
struct Rules {
    prescan_marks: bool,
    false_rung_forgets: bool,
    false_rung_leaves_done: bool,
    edges_alone_count: bool,
    past_preset: bool,
    below_zero: bool,
    done_while_true: bool,
    done_at_preset: bool,
    flags_decide_done: bool,
    wraps: bool,
    sets_flags: bool,
    the_way_back_clears: bool,
    reset_keeps_preset: bool,
    reset_clears_memories: bool,
    reset_clears_flags: bool,
    both_count: bool,
    up_comes_first: bool,
    tags_are_kept: bool,
}

const LOGIX: Rules = Rules {
    prescan_marks: true,
    false_rung_forgets: true,
    false_rung_leaves_done: true,
    edges_alone_count: true,
    past_preset: true,
    below_zero: true,
    done_while_true: true,
    done_at_preset: true,
    flags_decide_done: true,
    wraps: true,
    sets_flags: true,
    the_way_back_clears: true,
    reset_keeps_preset: true,
    reset_clears_memories: true,
    reset_clears_flags: true,
    both_count: true,
    up_comes_first: true,
    tags_are_kept: true,
};

/// The first words of a row, or of a paragraph, and its rule broken.
type Broken = (&'static str, fn(&mut Rules));

const FUNCTION_BLOCK: &str = "`CTUD(tag)` works on an `FBD_COUNTER`";

const ROWS: [Broken; 24] = [
    ("| prescan: the first scan", |it| it.prescan_marks = false),
    ("| rung FALSE", |it| it.false_rung_forgets = false),
    ("| rung FALSE", |it| it.edges_alone_count = false),
    ("| rung TRUE and `CU` FALSE", |it| it.edges_alone_count = false),
    ("| rung TRUE and `CU` FALSE", |it| it.reset_keeps_preset = false),
    ("| rung TRUE and `CU` FALSE", |it| it.reset_clears_memories = false),
    ("| rung TRUE and `CU` FALSE", |it| it.reset_clears_flags = false),
    ("| rung TRUE, counting or not", |it| it.false_rung_leaves_done = false),
    ("| rung TRUE, counting or not", |it| it.done_while_true = false),
    ("| rung TRUE, counting or not", |it| it.done_at_preset = false),
    ("| rung TRUE, counting or not", |it| it.below_zero = false),
    ("| limit", |it| it.wraps = false),
    ("| limit", |it| it.sets_flags = false),
    ("| limit", |it| it.the_way_back_clears = false),
    ("| limit", |it| it.flags_decide_done = false),
    ("| limit", |it| it.past_preset = false),
    ("| rung still TRUE after a reset", |it| it.reset_clears_memories = false),
    ("| up and down in one scan", |it| it.both_count = false),
    ("| retention", |it| it.tags_are_kept = false),
    (FUNCTION_BLOCK, |it| it.prescan_marks = false),
    (FUNCTION_BLOCK, |it| it.reset_clears_memories = false),
    (FUNCTION_BLOCK, |it| it.up_comes_first = false),
    (FUNCTION_BLOCK, |it| it.both_count = false),
    (FUNCTION_BLOCK, |it| it.the_way_back_clears = false),
];

/// A COUNTER, or an FBD_COUNTER with the edge memories in `up` and `down`.
#[derive(Clone, Debug)]
struct Counter {
    rules: Rules,
    up: bool,
    down: bool,
    done: bool,
    over: bool,
    under: bool,
    preset: i128,
    count: i128,
}

const LIMITS: (i128, i128) = (i32::MIN as i128, i32::MAX as i128);

impl Counter {
    fn new(rules: Rules) -> Self {
        Self { rules, up: false, down: false, done: false, over: false, under: false, preset: 0, count: 0 }
    }

    fn prescan(&mut self, up: bool, down: bool) {
        if !self.rules.tags_are_kept {
            *self = Self { preset: self.preset, ..Self::new(self.rules) };
        }
        self.up |= up && self.rules.prescan_marks;
        self.down |= down && self.rules.prescan_marks;
    }

    fn one_up(&mut self) {
        if !self.rules.past_preset && self.count >= self.preset {
            return;
        }
        self.count += 1;
        if self.count > LIMITS.1 {
            self.count = if self.rules.wraps { LIMITS.0 } else { LIMITS.1 };
            let undone = self.under && self.rules.the_way_back_clears;
            self.under &= !undone;
            self.over |= self.rules.sets_flags && !undone;
        }
    }

    fn one_down(&mut self) {
        if !self.rules.below_zero && self.count <= 0 {
            return;
        }
        self.count -= 1;
        if self.count < LIMITS.0 {
            self.count = if self.rules.wraps { LIMITS.1 } else { LIMITS.0 };
            let undone = self.over && self.rules.the_way_back_clears;
            self.over &= !undone;
            self.under |= self.rules.sets_flags && !undone;
        }
    }

    fn evaluate(&mut self) {
        let reached = if self.rules.done_at_preset { self.count >= self.preset } else { self.count > self.preset };
        let flags = self.rules.flags_decide_done;
        self.done = flags && self.over || !(flags && self.under) && reached;
    }

    /// One instruction, `CTU` or `CTD`.
    fn rung(&mut self, upward: bool, rung: bool) {
        let before = if upward { self.up } else { self.down };
        let counts = rung && (!before || !self.rules.edges_alone_count);
        let memory = rung || before && !self.rules.false_rung_forgets;
        if upward {
            self.up = memory
        } else {
            self.down = memory
        }
        match (counts, upward) {
            (true, true) => self.one_up(),
            (true, false) => self.one_down(),
            (false, _) => {}
        }
        if rung && (counts || self.rules.done_while_true) || !rung && !self.rules.false_rung_leaves_done {
            self.evaluate();
        }
    }

    fn reset(&mut self) {
        let Self { rules, preset, up, down, over, under, done, .. } = self.clone();
        *self = Self::new(rules);
        self.preset = if rules.reset_keeps_preset { preset } else { 0 };
        if !rules.reset_clears_memories {
            (self.up, self.down) = (up, down);
        }
        if !rules.reset_clears_flags {
            (self.over, self.under, self.done) = (over, under, done);
        }
    }

    /// `CTUD`.
    fn function_block(&mut self, up: bool, down: bool, reset: bool) {
        if reset {
            return self.reset();
        }
        let (rises, falls) = (up && !self.up, down && !self.down);
        (self.up, self.down) = (up, down);
        let falls = falls && (self.rules.both_count || !rises);
        let order = if self.rules.up_comes_first { [true, false] } else { [false, true] };
        for upward in order {
            match upward {
                true if rises => self.one_up(),
                false if falls => self.one_down(),
                _ => {}
            }
        }
        self.evaluate();
    }

    fn shown(&self, member: &str) -> i128 {
        match member {
            "ACC" => self.count,
            "PRE" => self.preset,
            "CU" => self.up.into(),
            "CD" => self.down.into(),
            "DN" => self.done.into(),
            "OV" => self.over.into(),
            "UN" => self.under.into(),
            other => panic!("no member {other}"),
        }
    }

    fn set(&mut self, member: &str, value: &Json) {
        match member {
            "ACC" => self.count = number(value),
            "PRE" => self.preset = number(value),
            "CU" => self.up = number(value) != 0,
            "CD" => self.down = number(value) != 0,
            "DN" => self.done = number(value) != 0,
            "OV" => self.over = number(value) != 0,
            "UN" => self.under = number(value) != 0,
            other => panic!("no member {other}"),
        }
    }
}

fn tables() -> Vec<Json> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors/counters.json");
    let tables: Vec<Json> = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    tables.into_iter().filter(|it| id(it).starts_with('D')).collect()
}

fn id(table: &Json) -> &str {
    table["id"].as_str().unwrap()
}

fn number(json: &Json) -> i128 {
    match json {
        Json::Bool(it) => i128::from(*it),
        other => i128::from(other.as_i64().unwrap()),
    }
}

/// The first row that the rules do not give, by its number from 1.
fn failure(table: &Json, rules: Rules) -> Option<usize> {
    let mut counter = Counter::new(rules);
    for (member, value) in table["preload"].as_object().unwrap().iter().chain(table["const"].as_object().unwrap()) {
        counter.set(member, value);
    }
    let fails = |row: &Json| {
        let inputs = &row["inputs"];
        let rung = |name: &str| inputs.get(name).map(|it| number(it) != 0);
        if let Some(preset) = inputs.get("PRE") {
            counter.set("PRE", preset);
        }
        match inputs.get("prescan").and_then(Json::as_str) {
            Some(which) => counter.prescan(which == "U", which == "D"),
            None if rung("firstscan") == Some(true) => counter.prescan(true, true),
            None => {}
        }
        if table["fb"].as_str().unwrap().starts_with("CTUD") {
            let is = |name| rung(name).unwrap_or(false);
            counter.function_block(is("CUEnable"), is("CDEnable"), is("Reset"));
        } else {
            rung("ctu").into_iter().for_each(|it| counter.rung(true, it));
            // What is broken here is one of two instructions in one scan.
            let both = rung("ctu") == Some(true) && rung("ctd") == Some(true);
            rung("ctd").filter(|_| rules.both_count || !both).into_iter().for_each(|it| counter.rung(false, it));
            rung("res").filter(|it| *it).into_iter().for_each(|_| counter.reset());
        }
        row["expect"].as_object().unwrap().iter().any(|(member, value)| counter.shown(member) != number(value))
    };
    table["rows"].as_array().unwrap().iter().position(fails).map(|it| it + 1)
}

#[test]
fn the_rules_give_every_table() {
    let tables = tables();
    assert!(tables.len() >= 20, "{}", tables.len());
    for table in tables {
        assert_eq!(failure(&table, LOGIX), None, "{}", id(&table));
    }
}

#[test]
fn a_broken_rule_breaks_what_its_row_links() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/dialects.md")).unwrap();
    let page = &page[page.find("\n## Logix\n").unwrap()..];
    let tables = tables();
    let mut missing = Vec::new();
    for (number, (row, breaks)) in ROWS.iter().enumerate() {
        let start = page.find(row).unwrap_or_else(|| panic!("no row `{row}`"));
        // A row is a line; a paragraph ends before an empty one.
        let end = if row.starts_with('|') { "\n" } else { "\n\n" };
        let linked = page[start..].split(end).next().unwrap();
        let mut broken = LOGIX;
        breaks(&mut broken);
        let killers: Vec<&str> = tables.iter().filter(|it| failure(it, broken).is_some()).map(id).collect();
        if !killers.iter().any(|id| linked.contains(&format!("[{id}]"))) {
            missing.push(format!("{number}, `{row}`: could be pinned by {killers:?}"));
        }
    }
    assert!(missing.is_empty(), "no link fails for:\n{}", missing.join("\n"));
}

fn block(name: &str) -> &'static BlockInfo {
    BLOCKS.iter().find(|it| it.name == name).unwrap()
}

fn write(instance: &mut [u8], block: &BlockInfo, member: &str, value: i128) {
    let pin = block.pin(member).unwrap();
    let value = pin.repr().integer(value).unwrap_or(Value::Bool(value != 0));
    value.write(&mut instance[pin.offset..]);
}

fn read(instance: &[u8], block: &BlockInfo, member: &str) -> i128 {
    let pin = block.pin(member).unwrap();
    let value = Value::read(pin.repr(), &instance[pin.offset..]);
    value.as_integer().unwrap_or_else(|| i128::from(value == Value::Bool(true)))
}

fn dice() -> impl FnMut(u64) -> u64 {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    move |sides| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        seed % sides
    }
}

/// Around 0 and the limits.
fn near(dice: &mut dyn FnMut(u64) -> u64) -> i128 {
    let around = [LIMITS.0, 0, LIMITS.1][usize::try_from(dice(3)).unwrap()];
    (around + i128::from(dice(7)) - 3).clamp(LIMITS.0, LIMITS.1)
}

const MEMBERS: [&str; 7] = ["ACC", "PRE", "CU", "CD", "DN", "OV", "UN"];

#[test]
fn the_instructions_follow_the_rules() {
    let (counter, mut dice) = (block("COUNTER"), dice());
    for _ in 0..600 {
        let mut instance = vec![0; counter.size];
        let mut model = Counter::new(LOGIX);
        (model.count, model.preset) = (near(&mut dice), near(&mut dice));
        write(&mut instance, counter, "ACC", model.count);
        write(&mut instance, counter, "PRE", model.preset);
        for _ in 0..40 {
            let (which, rung) = (dice(8), dice(2) == 0);
            let of = |name: &str| counter.instructions.iter().find(|it| it.name == name).unwrap();
            let name = ["CTU", "CTD", "CTU", "CTD", "CTU", "CTD", "RES", "prescan"][usize::try_from(which).unwrap()];
            match name {
                "prescan" => {
                    (of("CTU").prescan.unwrap().run)(&mut instance);
                    model.prescan(true, false);
                }
                _ => {
                    (of(name).run)(&mut instance, &Context::at(0), rung);
                    match name {
                        "CTU" => model.rung(true, rung),
                        "CTD" => model.rung(false, rung),
                        _ if rung => model.reset(),
                        _ => {}
                    }
                }
            }
            for member in MEMBERS {
                assert_eq!(read(&instance, counter, member), model.shown(member), "{name} {rung}: {member}");
            }
        }
    }
}

#[test]
fn the_function_block_follows_the_rules() {
    let (counter, mut dice) = (block("FBD_COUNTER"), dice());
    let instruction = &counter.instructions[0];
    for _ in 0..600 {
        let mut instance = vec![0; counter.size];
        let mut model = Counter::new(LOGIX);
        (model.count, model.preset) = (near(&mut dice), near(&mut dice));
        for (member, value) in [("ACC", model.count), ("PRE", model.preset), ("EnableIn", 1)] {
            write(&mut instance, counter, member, value);
        }
        for _ in 0..40 {
            let (up, down, reset) = (dice(2) == 0, dice(2) == 0, dice(12) == 0);
            if dice(16) == 0 {
                (instruction.prescan.unwrap().run)(&mut instance);
                model.prescan(true, true);
            }
            for (member, value) in [("CUEnable", up), ("CDEnable", down), ("Reset", reset)] {
                write(&mut instance, counter, member, value.into());
            }
            (instruction.run)(&mut instance, &Context::at(0), false);
            model.function_block(up, down, reset);
            for member in MEMBERS {
                assert_eq!(read(&instance, counter, member), model.shown(member), "{up} {down} {reset}: {member}");
            }
        }
    }
}
