//! The counters of the four systems, scan by scan: every table of `tests/vectors/counters.json`.
//!
//! A table runs on its row of `BLOCKS`, through the instance's bytes, so it tests the pins'
//! names, types and places together with the Rust struct that has them.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::HashSet;

use serde_json::{Map, Value as Json};
use staunch_runtime::{BLOCKS, BlockInfo, Context, Direction, Family, Instruction, Repr, Value};

const TABLES: usize = 211;

#[test]
fn every_table_holds() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors/counters.json");
    let text = std::fs::read_to_string(path).unwrap();
    let tables: Vec<Json> = serde_json::from_str(&text).unwrap();
    let mut failures = Vec::new();
    for table in &tables {
        failures.extend(Table::new(table).run());
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert_eq!(tables.len(), TABLES);
}

/// One table being run.
struct Table<'a> {
    json: &'a Json,
    block: &'static BlockInfo,
    instance: Vec<u8>,
    /// The caller's variable at the pin RCV of an R_CTU or R_CTD, and what a restart does to it.
    rcv: Option<Value>,
    rcv_is_retained: bool,
}

impl<'a> Table<'a> {
    fn new(json: &'a Json) -> Self {
        let block = block_of(json);
        let mut table = Self {
            json,
            block,
            instance: start_state(block),
            rcv: block.name.starts_with("R_").then_some(Value::I16(0)),
            rcv_is_retained: json["setup"]["rcv_retain"] != Json::Bool(false),
        };
        table.set_all(object(&json["preload"]));
        table
    }

    /// What went wrong, row by row.
    fn run(&mut self) -> Vec<String> {
        let mut failures = Vec::new();
        let rows = self.json["rows"].as_array().unwrap();
        assert!(!rows.is_empty());
        for (number, row) in rows.iter().enumerate() {
            self.run_row(object(&row["inputs"]));
            for (pin, expected) in object(&row["expect"]) {
                let found = if pin == "RCV" { self.rcv.unwrap() } else { self.get(pin) };
                if found != value(found.repr(), expected) {
                    let id = &self.json["id"];
                    failures.push(format!("{id} row {}: {pin} is {found:?}, not {expected}", number + 1));
                }
            }
        }
        failures
    }

    fn run_row(&mut self, inputs: &Map<String, Json>) {
        if inputs.contains_key("restart") {
            self.restart();
        } else if self.block.family == Family::Logix {
            self.run_logix(inputs);
        } else {
            self.set_all(object(&self.json["const"]));
            self.set_all(inputs);
            self.execute(&self.block.instructions[0], false);
            self.rcv = self.rcv.map(|_| self.get("CV"));
        }
    }

    /// As the compiler lowers a restart of R_CTU and R_CTD.
    fn restart(&mut self) {
        self.instance = start_state(self.block);
        let rcv = self.rcv.expect("only R_CTU and R_CTD have tables with a restart");
        if self.rcv_is_retained {
            self.put("CV", rcv);
        } else {
            self.rcv = Some(Value::I16(0));
        }
    }

    fn run_logix(&mut self, inputs: &Map<String, Json>) {
        self.set_all(object(&self.json["const"]));
        self.set_all(inputs);
        if inputs.contains_key("firstscan") {
            self.prescan("CTUD");
        }
        match inputs.get("prescan").map(|which| which.as_str().unwrap()) {
            Some("U") => return self.prescan("CTU"),
            Some("D") => return self.prescan("CTD"),
            Some(other) => panic!("prescan {other}"),
            None => {}
        }
        for instruction in self.block.instructions {
            match inputs.get(&instruction.name.to_lowercase()) {
                Some(rung) => self.execute(instruction, rung.as_bool().unwrap()),
                None if !instruction.takes_rung => self.execute(instruction, false),
                None => {}
            }
        }
    }

    fn execute(&mut self, instruction: &Instruction, rung: bool) {
        (instruction.run)(&mut self.instance, &Context::at(0), rung);
    }

    fn prescan(&mut self, instruction: &str) {
        let instruction = self.block.instructions.iter().find(|it| it.name == instruction).unwrap();
        (instruction.prescan.unwrap().run)(&mut self.instance);
    }

    /// Sets every pin that is named; the events and rungs of a row are not pins.
    fn set_all(&mut self, pins: &Map<String, Json>) {
        for (name, json) in pins {
            if !["ctu", "ctd", "res", "prescan", "firstscan"].contains(&name.as_str()) {
                let repr = self.block.pin(name).unwrap_or_else(|| panic!("no pin {name}")).repr();
                self.put(name, value(repr, json));
            }
        }
    }

    fn put(&mut self, pin: &str, value: Value) {
        let pin = self.block.pin(pin).unwrap();
        value.write(&mut self.instance[pin.offset..]);
    }

    fn get(&self, pin: &str) -> Value {
        let pin = self.block.pin(pin).unwrap();
        Value::read(pin.repr(), &self.instance[pin.offset..])
    }
}

/// All zero, but for the pins that the compiler starts TRUE.
fn start_state(block: &BlockInfo) -> Vec<u8> {
    let mut bytes = vec![0; block.size];
    for pin in block.pins.iter().filter(|pin| pin.starts_true) {
        Value::Bool(true).write(&mut bytes[pin.offset..]);
    }
    bytes
}

fn block_of(table: &Json) -> &'static BlockInfo {
    let (family, name) = match (table["id"].as_str().unwrap().as_bytes()[0], table["fb"].as_str().unwrap()) {
        (b'A', name) => (Family::Iec, name),
        (b'B', name) => (Family::Cscape, name),
        (b'C', "CTU") if table["setup"]["stop"] == Json::Bool(true) => (Family::Codesys, "CTU_STOP_AT_PV"),
        (b'C', name) => (Family::Codesys, name),
        (b'E', name) => (Family::Openplc, name),
        (b'F', "CTD") if table["setup"]["cd_edge"] == "rising" => (Family::Openplc4, "CTD_RISING"),
        (b'F', "CTUD") if table["setup"]["cd_edge"] == "rising" => (Family::Openplc4, "CTUD_RISING"),
        (b'F', name) => (Family::Openplc4, name),
        (b'G', "CTD") if table["setup"]["ld"] == "edge" => (Family::S7, "CTD_LD_EDGE"),
        (b'G', "CTUD") if table["setup"]["ld"] == "edge" => (Family::S7, "CTUD_LD_EDGE"),
        (b'G', name) => (Family::S7, name),
        (b'D', "CTUD (ST/FBD)") => (Family::Logix, "FBD_COUNTER"),
        (b'D', _) => (Family::Logix, "COUNTER"),
        (other, _) => panic!("no family {other}"),
    };
    BLOCKS.iter().find(|block| block.family == family && block.name == name).unwrap()
}

fn object(json: &Json) -> &Map<String, Json> {
    json.as_object().unwrap()
}

/// Integers above 2^53 are strings.
fn value(repr: Repr, json: &Json) -> Value {
    let number = match json {
        Json::Bool(it) => i128::from(*it),
        Json::Number(it) => i128::from(it.as_i64().unwrap()),
        Json::String(it) => it.parse().unwrap(),
        other => panic!("not a value: {other}"),
    };
    repr.integer(number).unwrap()
}

#[test]
fn pins_lie_as_the_struct_does() {
    for block in BLOCKS {
        let mut end = 0;
        for pin in block.pins {
            assert!(pin.offset >= end, "{block:?}.{} overlaps", pin.name);
            assert_eq!(pin.offset % pin.repr().size() as usize, 0, "{block:?}.{}", pin.name);
            end = pin.offset + pin.repr().size() as usize;
        }
        assert!(end <= block.size, "{block:?}");
        let inputs_come_first = block.pins.iter().map(|pin| pin.direction != Direction::Input).is_sorted();
        assert!(inputs_come_first, "{block:?}");
    }
}

#[test]
fn names_and_symbols_are_unique() {
    let mut names = HashSet::new();
    let mut symbols = HashSet::new();
    for block in BLOCKS {
        assert!(names.insert((block.family, block.name)), "{block:?}");
        for instruction in block.instructions {
            assert!(symbols.insert(instruction.symbol), "{block:?}");
            let prescan = instruction.prescan.map(|it| it.symbol);
            assert!(prescan.is_none_or(|symbol| symbols.insert(symbol)), "{block:?}");
        }
    }
}
