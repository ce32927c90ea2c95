//! `[[gpio]]` of a project file: lines of GPIO chips that a run in real time reads inputs from, and writes outputs to.

use super::{choice, flag, nearest, number, text};

/// One line, as written in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gpio {
    /// A variable or an address.
    pub variable: String,
    /// `gpiochip0`
    pub chip: String,
    pub line: GpioLine,
    pub active_low: bool,
    /// pull-up, pull-down, disabled or as-is.
    pub bias: Option<String>,
    pub debounce: Option<String>,
    pub safe: Option<bool>,
}

/// How a line is named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GpioLine {
    Number(u64),
    Name(String),
}

const KEYS: [&str; 7] = ["variable", "chip", "line", "active-low", "bias", "debounce", "safe"];

pub fn read(value: &toml::Value) -> Result<Vec<Gpio>, String> {
    let wrong = || "`gpio` must be tables: write `[[gpio]]` above each".to_owned();
    let tables = value.as_array().ok_or_else(wrong)?;
    tables.iter().map(|it| one(it.as_table().ok_or_else(wrong)?)).collect()
}

fn one(table: &toml::Table) -> Result<Gpio, String> {
    if let Some(key) = table.keys().find(|it| !KEYS.contains(&it.as_str())) {
        return Err(match nearest(key, KEYS.into_iter()) {
            Some(near) => format!("`[[gpio]]` has no setting `{key}`; did you mean `{near}`?"),
            None => format!("`[[gpio]]` has no setting `{key}`; its settings are {}", KEYS.join(", ")),
        });
    }
    let needed = |key: &str, example: &str| {
        table.get(key).ok_or_else(|| format!("`[[gpio]]` needs a setting `{key}`: write, for example, {example}"))
    };
    let optional = |key: &str| table.get(key);
    Ok(Gpio {
        variable: text("variable", needed("variable", "variable = \"%IX0.0\"")?)?,
        chip: text("chip", needed("chip", "chip = \"gpiochip0\"")?)?,
        line: line(needed("line", "line = 17, or line = \"GPIO17\"")?)?,
        active_low: optional("active-low").map_or(Ok(false), |it| flag("active-low", it))?,
        bias: optional("bias")
            .map(|it| choice("bias", it, &["pull-up", "pull-down", "disabled", "as-is"]))
            .transpose()?,
        debounce: optional("debounce").map(|it| text("debounce", it)).transpose()?,
        safe: optional("safe").map(|it| flag("safe", it)).transpose()?,
    })
}

fn line(value: &toml::Value) -> Result<GpioLine, String> {
    match value.as_str() {
        Some(name) => Ok(GpioLine::Name(name.to_owned())),
        None => number("line", value)
            .map(GpioLine::Number)
            .map_err(|_| "`line` must be the number of a line, from 0 on, or its name in quotes".to_owned()),
    }
}
