//! The servers of a project file that a run in real time reads inputs from and writes outputs to: held against the program's
//! variables, and given to its map.

use staunch_build::{Modbus, Project};
use staunch_host::{Map, OnLoss, Remote, WordOrder, check_remotes, is_address_and_port, parse_duration};
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use std::time::Duration;

/// How often a server is asked where the project does not say, and how long an answer may take.
const PERIOD: Duration = Duration::from_millis(100);
const TIMEOUT: Duration = Duration::from_millis(500);

/// Gives a program the servers of its project. An error is a mistake in the project file, with its place.
pub fn connect(project: &Project, program: &mut Program) -> Result<(), String> {
    if project.modbus.is_empty() {
        return Ok(());
    }
    let read = |(number, it)| remote(it).map_err(|(key, text)| (number, key, text));
    let place =
        |(number, key, text): (usize, String, String)| format!("{}: {text}", project.place_in_modbus(number, &key));
    let remotes: Vec<Remote> = project.modbus.iter().enumerate().map(read).collect::<Result<_, _>>().map_err(place)?;
    let map = staunch_ir::symbols::map_text(program, &Layout::new(program));
    let map = Map::parse(&map).map_err(|it| it.to_string())?;
    check_remotes(&remotes, &map).map_err(|(number, mistake)| match mistake.variable {
        Some(name) => place((number, name.clone(), format!("`{name}`: {}", mistake.text))),
        None => place((number, "server".to_owned(), mistake.text)),
    })?;
    program.remotes = remotes.iter().flat_map(Remote::lines).collect();
    Ok(())
}

/// An error is the setting that is wrong, and why.
fn remote(modbus: &Modbus) -> Result<Remote, (String, String)> {
    let fail = |key: &str, text: String| (key.to_owned(), text);
    let server = &modbus.server;
    if !is_address_and_port(server) {
        let text = format!("`{server}` is not an address and port: write, for example, server = \"192.168.0.20:502\"");
        return Err(fail("server", text));
    }
    let unit = modbus.unit.unwrap_or(1);
    let unit = u8::try_from(unit).map_err(|_| fail("unit", format!("`unit` is a number from 0 to 255, not {unit}")))?;
    let time = |key: &str, written: &Option<String>, other: Duration| match written {
        Some(written) => parse_duration(written)
            .map_err(|it| fail(key, format!("`{key}`: {it}")))
            .map(|it| Duration::from_nanos(it.unsigned_abs())),
        None => Ok(other),
    };
    let name = modbus.name.clone().unwrap_or_else(|| server.clone());
    if name.chars().any(char::is_control) {
        return Err(fail("name", "`name` is one line of text".to_owned()));
    }
    let remote = Remote {
        name,
        server: server.clone(),
        unit,
        period: time("period", &modbus.period, PERIOD)?,
        timeout: time("timeout", &modbus.timeout, TIMEOUT)?,
        on_loss: named(&OnLoss::ALL, modbus.on_loss.as_deref()).unwrap_or(OnLoss::Hold),
        word_order: named(&WordOrder::ALL, modbus.word_order.as_deref()),
        variables: modbus.map.clone(),
    };
    if modbus.map.is_empty() {
        return Err(fail(
            "server",
            "no variable is read or written there: write `[modbus.map]`, and below it level = \"input-register 3\""
                .to_owned(),
        ));
    }
    Ok(remote)
}

/// A word that the project file may have, which has been checked.
fn named<T: Copy>(all: &[(&'static str, T)], word: Option<&str>) -> Option<T> {
    all.iter().find(|it| Some(it.0) == word).map(|it| it.1)
}
