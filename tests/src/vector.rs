//! `vectors/counters.json` as programs: each table becomes Structured Text and a list of scans.

use serde_json::{Map, Value as Json};
use staunch_frontend::{Dialect, Options};
use staunch_runtime::{BLOCKS, BlockInfo, Direction, Family, Retention};
use std::fmt::Write;

/// One table.
#[derive(Clone, Debug)]
pub struct Vector {
    pub id: String,
    pub title: String,
    /// Structured Text.
    pub source: String,
    pub options: Options,
    pub scans: Vec<Scan>,
}

/// One row.
#[derive(Clone, Debug)]
pub struct Scan {
    /// A change from IDLE to RUN, or a restart, just before the scan.
    pub event: Option<&'static str>,
    pub first: bool,
    /// Variables written before the scan, by path.
    pub inputs: Vec<(String, String)>,
    /// Values after it, by path.
    pub expected: Vec<(String, String)>,
}

impl Vector {
    /// A Rust identifier.
    pub fn module(&self) -> String {
        format!("vector_{}", self.id.replace('-', "_").to_lowercase())
    }
}

/// All tables of the text.
pub fn read(text: &str) -> Vec<Vector> {
    let tables: Vec<Json> = serde_json::from_str(text).expect("the vectors are JSON");
    tables.iter().map(|it| Table::new(it).vector()).collect()
}

struct Table<'j> {
    json: &'j Json,
    family: Family,
    block: &'static BlockInfo,
    /// Logix: the instructions that its rows and prescans name.
    instructions: Vec<&'static str>,
    /// Pins that the call passes.
    pins: Vec<&'static str>,
}

/// The rung conditions and the instructions they belong to, in the order of execution.
const RUNGS: [(&str, &str); 3] = [("ctu", "CTU"), ("ctd", "CTD"), ("res", "RES")];

impl<'j> Table<'j> {
    fn new(json: &'j Json) -> Self {
        let (family, name) = family_and_name(json);
        let block = BLOCKS.iter().find(|it| it.family == family && it.name == name).expect("the block exists");
        let mut table = Self { json, family, block, instructions: Vec::new(), pins: Vec::new() };
        table.instructions = RUNGS.iter().map(|it| it.1).filter(|it| table.uses(it)).collect();
        let inputs = block.pins.iter().filter(|it| it.direction == Direction::Input);
        table.pins = inputs.map(|it| it.name).filter(|it| *it != "RCV" && table.names(it)).collect();
        table
    }

    fn vector(&self) -> Vector {
        let id = text(&self.json["id"]);
        let dialect = if self.family == Family::Logix { Dialect::Logix } else { Dialect::Iec };
        let ctu_stop_at_pv = self.json["setup"]["stop"] == Json::Bool(true);
        let openplc4_cd_rises = self.json["setup"]["cd_edge"] == "rising";
        let s7_ld_edge = self.json["setup"]["ld"] == "edge";
        let source = match self.block.name {
            "COUNTER" => self.instructions_source(),
            "FBD_COUNTER" => {
                format!("PROGRAM Main\nVAR c : FBD_COUNTER{}; END_VAR\nCTUD(c);\nEND_PROGRAM\n", self.initial())
            }
            name if name.starts_with("R_") => self.retentive_source(),
            _ => self.call_source(),
        };
        Vector {
            id,
            title: text(&self.json["title"]),
            source,
            options: Options { dialect, ctu_stop_at_pv, openplc4_cd_rises, s7_ld_edge, ..Options::default() },
            scans: self.scans(),
        }
    }

    fn rows(&self) -> impl Iterator<Item = &'j Json> {
        self.json["rows"].as_array().expect("a table has rows").iter()
    }

    /// Whether a row runs this instruction, or prescans it.
    fn uses(&self, instruction: &str) -> bool {
        let rung = RUNGS.iter().find(|it| it.1 == instruction).map_or("", |it| it.0);
        self.rows().any(|row| {
            let inputs = object(&row["inputs"]);
            let prescanned = inputs.get("prescan").map(text).and_then(|it| match it.as_str() {
                "U" => Some("CTU"),
                "D" => Some("CTD"),
                _ => None,
            });
            inputs.contains_key(rung) || prescanned == Some(instruction)
        })
    }

    /// Whether the table gives this pin a value.
    fn names(&self, pin: &str) -> bool {
        object(&self.json["const"]).contains_key(pin) || self.rows().any(|it| object(&it["inputs"]).contains_key(pin))
    }

    /// The instance's initial value: the members that the table presets.
    fn initial(&self) -> String {
        if self.starts_anew() {
            return String::new();
        }
        let preload = object(&self.json["preload"]);
        let members: Vec<_> = preload.iter().map(|(name, value)| format!("{name} := {}", cell(value))).collect();
        if members.is_empty() { String::new() } else { format!(" := ({})", members.join(", ")) }
    }

    fn declarations(&self) -> String {
        let mut text = String::new();
        for pin in &self.pins {
            let info = self.block.pins.iter().find(|it| it.name == *pin).expect("a pin of the block");
            let _ = writeln!(text, "    {pin} : {};", info.ty.name());
        }
        text
    }

    fn call(&self) -> String {
        let arguments: Vec<_> = self.pins.iter().map(|it| format!("{it} := {it}")).collect();
        arguments.join(", ")
    }

    fn ty(&self) -> String {
        format!("{}.{}", self.family.name(), self.block.name)
    }

    fn call_source(&self) -> String {
        format!(
            "PROGRAM Main\nVAR_INPUT\n{}END_VAR\nVAR c : {}{}; END_VAR\nc({});\nEND_PROGRAM\n",
            self.declarations(),
            self.ty(),
            self.initial(),
            self.call()
        )
    }

    /// R_CTU and R_CTD: a row that is a restart calls nothing.
    fn retentive_source(&self) -> String {
        let retained = self.json["setup"]["rcv_retain"] != Json::Bool(false);
        let (global, own) = match retained {
            true => ("", "VAR RETAIN rcv : INT; END_VAR\n"),
            false => ("VAR_GLOBAL rcv : INT; END_VAR\n", "VAR_EXTERNAL rcv : INT; END_VAR\n"),
        };
        format!(
            "{global}PROGRAM Main\nVAR_INPUT\n    execute : BOOL;\n{}END_VAR\n{own}VAR c : {}{}; END_VAR\nIF execute THEN\n    \
             c({}, RCV := rcv);\nEND_IF\nEND_PROGRAM\n",
            self.declarations(),
            self.ty(),
            self.initial(),
            self.call()
        )
    }

    /// Logix: a row names the instructions that run in it, and their rungs.
    fn instructions_source(&self) -> String {
        let mut text = String::from("PROGRAM Main\nVAR_INPUT\n");
        for it in &self.instructions {
            let _ = writeln!(text, "    execute_{it}, rung_{it} : BOOL;");
        }
        let _ = writeln!(text, "END_VAR\nVAR c : COUNTER{}; END_VAR", self.initial());
        for it in &self.instructions {
            let _ = writeln!(text, "IF execute_{it} THEN\n    {it}(Counter := c, RungIn := rung_{it});\nEND_IF");
        }
        text + "END_PROGRAM\n"
    }

    /// Whether initial values of the counts are not used, so that what is preset is written before the first row.
    fn starts_anew(&self) -> bool {
        self.block.retention == Retention::Inputs
    }

    fn scans(&self) -> Vec<Scan> {
        let mut scans: Vec<_> = self.rows().map(|it| self.scan(it)).collect();
        if let Some(first) = scans.first_mut().filter(|_| self.starts_anew()) {
            let preload = object(&self.json["preload"]).iter();
            first.inputs.extend(preload.map(|(name, value)| (format!("c.{name}"), cell(value))));
        }
        scans
    }

    fn scan(&self, row: &Json) -> Scan {
        let inputs = object(&row["inputs"]);
        let event = match (inputs.contains_key("restart"), inputs.contains_key("prescan")) {
            (true, _) => Some("restart"),
            (false, true) => Some("run"),
            (false, false) => None,
        };
        let mut written = Vec::new();
        for pins in [object(&self.json["const"]), inputs] {
            let pins = pins.iter().filter(|(name, _)| self.block.pin(name).is_some() && !is_event(name));
            written.extend(pins.map(|(name, value)| (self.path(name), cell(value))));
        }
        if self.block.name.starts_with("R_") {
            written.push(("execute".to_owned(), cell(&Json::Bool(event.is_none()))));
        }
        for (rung, instruction) in RUNGS.iter().filter(|it| self.instructions.contains(&it.1)) {
            written.push((format!("execute_{instruction}"), cell(&Json::Bool(inputs.contains_key(*rung)))));
            written.push((format!("rung_{instruction}"), cell(inputs.get(*rung).unwrap_or(&Json::Bool(false)))));
        }
        let expected = object(&row["expect"]).iter().map(|(name, value)| {
            let path = if name == "RCV" { "rcv".to_owned() } else { format!("c.{name}") };
            (path, cell(value))
        });
        let first = event.is_some() || inputs.contains_key("firstscan");
        Scan { event, first, inputs: written, expected: expected.collect() }
    }

    /// A table's pin: a variable that the call passes, or else a member.
    fn path(&self, pin: &str) -> String {
        if self.pins.contains(&pin) && self.block.name != "FBD_COUNTER" { pin.to_owned() } else { format!("c.{pin}") }
    }
}

/// What is among a row's inputs without being one. `CTU`, the rung, is distinguished from pins by its
/// small letters.
fn is_event(name: &str) -> bool {
    matches!(name, "ctu" | "ctd" | "res" | "prescan" | "restart" | "firstscan")
}

fn family_and_name(table: &Json) -> (Family, String) {
    let (id, block) = (text(&table["id"]), text(&table["fb"]));
    match (id.as_bytes()[0], block.as_str()) {
        (b'A', name) => (Family::Iec, name.to_owned()),
        (b'B', name) => (Family::Cscape, name.to_owned()),
        (b'C', name) => (Family::Codesys, name.to_owned()),
        (b'E', name) => (Family::Openplc, name.to_owned()),
        (b'F', name) => (Family::Openplc4, name.to_owned()),
        (b'G', name) => (Family::S7, name.to_owned()),
        (b'D', "CTUD (ST/FBD)") => (Family::Logix, "FBD_COUNTER".to_owned()),
        (b'D', _) => (Family::Logix, "COUNTER".to_owned()),
        (other, _) => panic!("no family {other}"),
    }
}

fn object(json: &Json) -> &Map<String, Json> {
    json.as_object().unwrap_or_else(|| panic!("not an object: {json}"))
}

fn text(json: &Json) -> String {
    json.as_str().unwrap_or_else(|| panic!("not a text: {json}")).to_owned()
}

/// A value as Structured Text and traces have it; integers above 2^53 are strings.
fn cell(json: &Json) -> String {
    match json {
        Json::Bool(true) => "TRUE".to_owned(),
        Json::Bool(false) => "FALSE".to_owned(),
        Json::Number(it) => it.to_string(),
        Json::String(it) => it.clone(),
        other => panic!("not a value: {other}"),
    }
}
