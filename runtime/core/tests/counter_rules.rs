//! Each row of the counters' table in `docs/dialects.md` is pinned: a second reading of the counters,
//! whose rules are switches, agrees with every table of vectors, and breaking the rule of a row
//! breaks a vector that the row links. The runtime's blocks agree with it over random calls.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use serde_json::{Map, Value as Json};
use staunch_runtime::{BLOCKS, BlockInfo, BlockOption, Context, Family, PinRole, Value};

/// The rules of a family, as far as the pins of one counter do not show them.
#[derive(Clone, Copy, Debug)]
struct Rules {
    counts_levels: bool,
    first_call_counts: bool,
    reset_consumes_edges: bool,
    reset_beats_counting: bool,
    reset_beats_load: bool,
    reset_is_a_level: bool,
    stops_at_preset: bool,
    stops_at_zero: bool,
    saturates: bool,
    both_edges_cancel: bool,
    /// Up, then down, each judged on the count as it then is.
    each_by_itself: bool,
    down_falls: bool,
    done_when_equal: bool,
    empty_when_below: bool,
    done_under_reset: bool,
    /// A load acts when its input rises; nothing counts while it is TRUE.
    load_is_an_edge: bool,
}

fn rules(family: char) -> Rules {
    let iec = Rules {
        counts_levels: false,
        first_call_counts: true,
        reset_consumes_edges: true,
        reset_beats_counting: true,
        reset_beats_load: true,
        reset_is_a_level: true,
        stops_at_preset: false,
        stops_at_zero: false,
        saturates: true,
        both_edges_cancel: true,
        each_by_itself: false,
        down_falls: false,
        done_when_equal: false,
        empty_when_below: true,
        done_under_reset: true,
        load_is_an_edge: false,
    };
    let cscape = Rules {
        counts_levels: true,
        stops_at_preset: true,
        stops_at_zero: true,
        done_when_equal: true,
        empty_when_below: false,
        ..iec
    };
    match family {
        'A' | 'G' => iec,
        'B' => cscape,
        'C' => Rules { stops_at_zero: true, ..iec },
        'E' => Rules { stops_at_preset: true, stops_at_zero: true, ..iec },
        'F' => Rules { stops_at_preset: true, stops_at_zero: true, each_by_itself: true, down_falls: true, ..iec },
        other => panic!("no family {other}"),
    }
}

/// A row's first words, the families whose rule it is, and its rule broken.
type Broken = (&'static str, &'static str, fn(&mut Rules));

const ROWS: [Broken; 18] = [
    ("counts on", "ABCEFG", |it| it.counts_levels ^= true),
    ("counts on", "F", |it| it.down_falls = false),
    ("input TRUE on the very first call", "ABCEFG", |it| it.first_call_counts = false),
    ("edge under reset or load", "ACEFG", |it| it.reset_consumes_edges = false),
    ("priority", "ABCEFG", |it| it.reset_beats_counting = false),
    ("priority", "ACEFG", |it| it.reset_beats_load = false),
    ("reset and load", "ABCEFG", |it| it.reset_is_a_level = false),
    ("CTU past `PV`", "ABCEFG", |it| it.stops_at_preset ^= true),
    ("CTD below 0", "ABEFG", |it| it.stops_at_zero ^= true),
    ("at the type's limit", "ACG", |it| it.saturates = false),
    ("both edges of a CTUD", "ACEG", |it| it.both_edges_cancel = false),
    ("both edges of a CTUD", "F", |it| it.each_by_itself = false),
    ("CTU `Q`", "ABCEFG", |it| it.done_when_equal ^= true),
    ("CTD `Q`", "ABEFG", |it| it.empty_when_below ^= true),
    ("`Q` is computed", "ABCEFG", |it| it.done_under_reset = false),
    // Of what does not count below 0, that it stays there is what its limit says.
    ("CTD below 0", "C", |it| (it.saturates, it.stops_at_zero) = (false, false)),
    ("at the type's limit", "B", |it| it.stops_at_preset = false),
    ("at the type's limit", "EF", |it| it.stops_at_preset = false),
];

#[derive(Clone, Copy)]
struct Counter {
    rules: Rules,
    limits: (i128, i128),
    called: bool,
    up_before: bool,
    down_before: bool,
    reset_before: bool,
    load_before: bool,
    count: i128,
    done: bool,
    empty: bool,
}

struct Inputs {
    up: bool,
    down: bool,
    reset: bool,
    load: bool,
    preset: i128,
}

impl Counter {
    fn call(&mut self, it: &Inputs) {
        let rules = self.rules;
        let counts = rules.first_call_counts || std::mem::replace(&mut self.called, true);
        let edge = |now: bool, before: bool| now && counts && (rules.counts_levels || !before);
        let falls = !it.down && self.down_before;
        let down = if rules.down_falls && !rules.counts_levels { falls } else { edge(it.down, self.down_before) };
        let up = edge(it.up, self.up_before);
        let level = |now: bool, before: bool| now && (rules.reset_is_a_level || !before);
        let (reset, load) = (level(it.reset, self.reset_before), level(it.load, self.load_before));
        let held = rules.load_is_an_edge && it.load;
        let load = load && !(held && self.load_before);
        let (up, down) = (up && !held, down && !held);
        (self.reset_before, self.load_before) = (it.reset, it.load);
        if rules.reset_consumes_edges || !(reset || load) {
            (self.up_before, self.down_before) = (it.up, it.down);
        }
        let counts = up || down;
        self.count = match () {
            () if counts && !rules.reset_beats_counting => self.counted(up, down, it.preset),
            () if reset && (rules.reset_beats_load || !load) => 0,
            () if load => it.preset,
            () => self.counted(up, down, it.preset),
        };
        if rules.done_under_reset || !(reset || load) {
            self.done = if rules.done_when_equal { self.count == it.preset } else { self.count >= it.preset };
            self.empty = if rules.empty_when_below { self.count <= 0 } else { self.count == 0 };
        }
    }

    fn counted(&self, up: bool, down: bool, preset: i128) -> i128 {
        let rules = self.rules;
        if rules.each_by_itself && up && down {
            let raised = Self { count: self.counted(true, false, preset), ..*self };
            return raised.counted(false, true, preset);
        }
        let (up, down) = if up && down { (!rules.both_edges_cancel, false) } else { (up, down) };
        let up = up && !(rules.stops_at_preset && self.count >= preset);
        let down = down && !(rules.stops_at_zero && self.count <= 0);
        let count = self.count + i128::from(up) - i128::from(down);
        let (low, high) = self.limits;
        if rules.saturates { count.clamp(low, high) } else { (count - low).rem_euclid(high - low + 1) + low }
    }
}

fn tables() -> Vec<Json> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors/counters.json");
    let tables: Vec<Json> = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let of_counters = |it: &Json| !id(it).starts_with('D') && !it["fb"].as_str().unwrap().starts_with("R_");
    tables.into_iter().filter(of_counters).collect()
}

fn id(table: &Json) -> &str {
    table["id"].as_str().unwrap()
}

fn family(table: &Json) -> char {
    id(table).chars().next().unwrap()
}

/// The first row that the rules do not give, by its number from 1.
fn failure(table: &Json, rules: Rules) -> Option<usize> {
    let rules = match table["setup"]["stop"] {
        Json::Bool(true) => Rules { stops_at_preset: true, ..rules },
        _ => rules,
    };
    let rules = Rules { load_is_an_edge: table["setup"]["ld"] == "edge", ..rules };
    let rules = Rules { down_falls: rules.down_falls && table["setup"]["cd_edge"] != "rising", ..rules };
    let mut pins = Map::new();
    let mut counter = Counter {
        rules,
        limits: limits(table),
        called: false,
        up_before: false,
        down_before: false,
        reset_before: false,
        load_before: false,
        count: number(table["preload"].get("CV")),
        done: false,
        empty: false,
    };
    let down_only = table["fb"].as_str().unwrap().starts_with("CTD");
    let rows = table["rows"].as_array().unwrap();
    let fails = |row: &Json| {
        for given in [&table["const"], &row["inputs"]] {
            pins.extend(given.as_object().unwrap().clone());
        }
        let get = |names: [&str; 2]| number(names.iter().find_map(|it| pins.get(*it)));
        counter.call(&Inputs {
            up: get(["CU", "CU"]) != 0,
            down: get(["CD", "CD"]) != 0,
            reset: get(["R", "RESET"]) != 0,
            load: get(["LD", "LOAD"]) != 0,
            preset: get(["PV", "PV"]),
        });
        row["expect"].as_object().unwrap().iter().any(|(pin, expected)| {
            let found = match pin.as_str() {
                "CV" => counter.count,
                "QD" => counter.empty.into(),
                "Q" if down_only => counter.empty.into(),
                "Q" | "QU" => counter.done.into(),
                other => panic!("no pin {other}"),
            };
            found != number(Some(expected))
        })
    };
    rows.iter().position(fails).map(|it| it + 1)
}

fn limits(table: &Json) -> (i128, i128) {
    match table["type"].as_str() {
        Some("SINT") => (i8::MIN.into(), i8::MAX.into()),
        Some("USINT") => (0, u8::MAX.into()),
        Some("UINT") => (0, u16::MAX.into()),
        Some("DINT") => (i32::MIN.into(), i32::MAX.into()),
        Some("LINT") => (i64::MIN.into(), i64::MAX.into()),
        Some("UDINT") => (0, u32::MAX.into()),
        Some("ULINT") => (0, u64::MAX.into()),
        _ if family(table) == 'C' => (0, u16::MAX.into()),
        _ => (i16::MIN.into(), i16::MAX.into()),
    }
}

fn number(json: Option<&Json>) -> i128 {
    match json {
        None => 0,
        Some(Json::Bool(it)) => i128::from(*it),
        Some(Json::Number(it)) => i128::from(it.as_i64().unwrap()),
        Some(Json::String(it)) => it.parse().unwrap(),
        Some(other) => panic!("not a value: {other}"),
    }
}

#[test]
fn the_rules_give_every_table() {
    for table in tables() {
        assert_eq!(failure(&table, rules(family(&table))), None, "{}", id(&table));
    }
}

#[test]
fn a_broken_rule_breaks_what_its_row_links() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/dialects.md")).unwrap();
    let tables = tables();
    let mut missing = Vec::new();
    for (row, families, breaks) in ROWS {
        let start = format!("| {row}");
        let line = page.lines().find(|it| it.starts_with(&start)).unwrap_or_else(|| panic!("no row `{row}`"));
        for it in families.chars() {
            let mut broken = rules(it);
            breaks(&mut broken);
            let of_family = tables.iter().filter(|table| family(table) == it);
            let kills = |table: &&Json| failure(table, broken).is_some();
            let killers: Vec<&str> = of_family.filter(kills).map(id).collect();
            if !killers.iter().any(|id| line.contains(&format!("[{id}]"))) {
                missing.push(format!("{it}, `{row}`: could be pinned by {killers:?}"));
            }
        }
    }
    assert!(missing.is_empty(), "no link fails for:\n{}", missing.join("\n"));
}

/// Blocks and the rules of their families, pin by pin over random calls from random counts.
#[test]
fn the_blocks_follow_the_rules() {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    let mut dice = move |sides: u64| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        seed % sides
    };
    let letters = [
        (Family::Iec, 'A'),
        (Family::Cscape, 'B'),
        (Family::Codesys, 'C'),
        (Family::Openplc, 'E'),
        (Family::Openplc4, 'F'),
        (Family::S7, 'G'),
    ];
    for block in BLOCKS.iter().filter(|it| it.is_counter()) {
        let Some((_, letter)) = letters.iter().find(|it| it.0 == block.family) else { continue };
        let stops = block.facts.option.is_some_and(|it| it.option == BlockOption::CtuStopAtPv);
        let down_falls = block.facts.counts_falls;
        let stops_at_preset = stops || rules(*letter).stops_at_preset;
        let load_is_an_edge = block.facts.loads_on_edges;
        let rules = Rules { stops_at_preset, down_falls, load_is_an_edge, ..rules(*letter) };
        for _ in 0..300 {
            random_calls(block, rules, &mut dice);
        }
    }
}

fn random_calls(block: &BlockInfo, rules: Rules, dice: &mut dyn FnMut(u64) -> u64) {
    let count = block.pin_for(PinRole::Count).unwrap();
    let limits = count.repr().range().unwrap();
    let near = |dice: &mut dyn FnMut(u64) -> u64| {
        let around = [limits.0, 0, limits.1][dice(3) as usize];
        (around + i128::from(dice(7)) - 3).clamp(limits.0, limits.1)
    };
    let mut instance = vec![0; block.size];
    let start = near(dice);
    count.repr().integer(start).unwrap().write(&mut instance[count.offset..]);
    let mut counter = Counter {
        rules,
        limits,
        called: false,
        up_before: false,
        down_before: false,
        reset_before: false,
        load_before: false,
        count: start,
        done: false,
        empty: false,
    };
    let mut preset = near(dice);
    for _ in 0..40 {
        if dice(8) == 0 {
            preset = near(dice);
        }
        let mut bit = |role, sides| block.pin_for(role).is_some() && dice(sides) == 0;
        let (up, down) = (bit(PinRole::Up, 2), bit(PinRole::Down, 2));
        let (reset, load) = (bit(PinRole::Reset, 12), bit(PinRole::Load, 12));
        for (role, value) in [(PinRole::Up, up), (PinRole::Down, down), (PinRole::Reset, reset), (PinRole::Load, load)]
        {
            if let Some(pin) = block.pin_for(role) {
                Value::Bool(value).write(&mut instance[pin.offset..]);
            }
        }
        let pin = block.pin_for(PinRole::Preset).unwrap();
        pin.repr().integer(preset).unwrap().write(&mut instance[pin.offset..]);
        (block.instructions[0].run)(&mut instance, &Context::at(0), false);
        counter.call(&Inputs { up, down, reset, load, preset });
        let both = block.pin_for(PinRole::Empty).is_some();
        let only_down = !both && block.pin_for(PinRole::Down).is_some();
        let done = if only_down { counter.empty } else { counter.done };
        let expected =
            [(PinRole::Count, counter.count), (PinRole::Done, done.into()), (PinRole::Empty, counter.empty.into())];
        for (role, expected) in expected {
            if let Some(pin) = block.pin_for(role) {
                let found = Value::read(pin.repr(), &instance[pin.offset..]);
                let found = found.as_integer().unwrap_or_else(|| i128::from(found == Value::Bool(true)));
                assert_eq!(found, expected, "{block:?}.{}", pin.name);
            }
        }
    }
}
