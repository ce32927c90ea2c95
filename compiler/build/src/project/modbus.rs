//! `[[modbus]]` of a project file: servers that a run in real time reads inputs from, and writes outputs to.

use super::{choice, nearest, number, text};

/// One server, as written in the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Modbus {
    pub name: Option<String>,
    /// `192.168.0.20:502`
    pub server: Option<String>,
    /// A serial line, in place of a server: `/dev/ttyUSB0`.
    pub port: Option<String>,
    pub baud_rate: Option<u64>,
    /// none, even or odd.
    pub parity: Option<String>,
    pub data_bits: Option<u64>,
    pub stop_bits: Option<u64>,
    pub unit: Option<u64>,
    pub period: Option<String>,
    pub timeout: Option<String>,
    /// hold, safe or fault.
    pub on_loss: Option<String>,
    /// high-first or low-first.
    pub word_order: Option<String>,
    /// openplc: each input and output has the place that OpenPLC gives its address.
    pub layout: Option<String>,
    /// Variables or addresses, and their places at the server.
    pub map: Vec<(String, String)>,
}

const KEYS: [&str; 14] = [
    "name",
    "server",
    "port",
    "baud-rate",
    "parity",
    "data-bits",
    "stop-bits",
    "unit",
    "period",
    "timeout",
    "on-loss",
    "word-order",
    "layout",
    "map",
];

pub fn read(value: &toml::Value) -> Result<Vec<Modbus>, String> {
    let wrong = || "`modbus` must be tables: write `[[modbus]]` above each".to_owned();
    let tables = value.as_array().ok_or_else(wrong)?;
    tables.iter().map(|it| one(it.as_table().ok_or_else(wrong)?)).collect()
}

fn one(table: &toml::Table) -> Result<Modbus, String> {
    let mut modbus = Modbus::default();
    for (key, value) in table {
        match key.as_str() {
            "name" => modbus.name = Some(text(key, value)?),
            "server" => modbus.server = Some(text(key, value)?),
            "port" => modbus.port = Some(text(key, value)?),
            "baud-rate" => modbus.baud_rate = Some(number(key, value)?),
            "parity" => modbus.parity = Some(choice(key, value, &["none", "even", "odd"])?),
            "data-bits" => modbus.data_bits = Some(number(key, value)?),
            "stop-bits" => modbus.stop_bits = Some(number(key, value)?),
            "unit" => modbus.unit = Some(number(key, value)?),
            "period" => modbus.period = Some(text(key, value)?),
            "timeout" => modbus.timeout = Some(text(key, value)?),
            "on-loss" => modbus.on_loss = Some(choice(key, value, &["hold", "safe", "fault"])?),
            "word-order" => modbus.word_order = Some(choice(key, value, &["high-first", "low-first"])?),
            "layout" => modbus.layout = Some(choice(key, value, &["openplc"])?),
            "map" => modbus.map = map(value)?,
            _ => {
                return Err(match nearest(key, KEYS.into_iter()) {
                    Some(near) => format!("`[[modbus]]` has no setting `{key}`; did you mean `{near}`?"),
                    None => format!("`[[modbus]]` has no setting `{key}`; its settings are {}", KEYS.join(", ")),
                });
            }
        }
    }
    match (&modbus.server, &modbus.port) {
        (None, None) => Err(
            "`[[modbus]]` needs a server: server = \"192.168.0.20:502\", or port = \"/dev/ttyUSB0\" for a serial line"
                .to_owned(),
        ),
        (Some(_), _) | (None, Some(_)) => Ok(modbus),
    }
}

fn map(value: &toml::Value) -> Result<Vec<(String, String)>, String> {
    let wrong = || "`map` must be a table: write `[modbus.map]`, and below it level = \"input-register 3\"".to_owned();
    let table = value.as_table().ok_or_else(wrong)?;
    table.iter().map(|(name, place)| Ok((name.clone(), place.as_str().ok_or_else(wrong)?.to_owned()))).collect()
}
