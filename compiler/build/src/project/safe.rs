//! `[safe]` of a project file: what outputs are before the first scan of a run in real time, and at its end.

/// Variables or addresses, with their values as Structured Text has them.
pub fn read(value: &toml::Value) -> Result<Vec<(String, String)>, String> {
    let table = value.as_table().ok_or("`safe` must be a table: write `[safe]`, and below it valve = true")?;
    table.iter().map(|(name, value)| Ok((name.clone(), literal(name, value)?))).collect()
}

fn literal(name: &str, value: &toml::Value) -> Result<String, String> {
    let text = match value {
        toml::Value::Boolean(it) => if *it { "TRUE" } else { "FALSE" }.to_owned(),
        toml::Value::Integer(it) => it.to_string(),
        // A whole number keeps its point.
        toml::Value::Float(it) => format!("{it:?}"),
        toml::Value::String(it) => it.clone(),
        toml::Value::Table(_) => {
            return Err(format!("`{name}`: a name with a point is in quotes: \"{name}.valve\" = true"));
        }
        toml::Value::Array(_) | toml::Value::Datetime(_) => {
            return Err(format!("`{name}` must be true, false, a number, or a value in quotes: \"T#2s\""));
        }
    };
    match text.contains(char::is_control) || name.contains(char::is_control) {
        true => Err("a name and a value of `[safe]` are one line each".to_owned()),
        false => Ok(text),
    }
}
