//! The servers and lines of a project file that a run in real time reads inputs from and writes outputs to: held against the program's
//! variables, and given to its map.

use staunch_build::{Modbus, Project};
use staunch_host::{
    Map, Mistake, OnLoss, Pin, Remote, WordOrder, check_remotes, check_safe, openplc_layout, parse_duration,
};
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use std::time::Duration;

mod gpio;
mod server;

/// How often a server is asked where the project does not say, and how long an answer may take.
const PERIOD: Duration = Duration::from_millis(100);
const TIMEOUT: Duration = Duration::from_millis(500);

/// Gives a program the servers of its project. An error is a mistake in the project file, with its place.
pub fn connect(project: &Project, program: &mut Program) -> Result<(), String> {
    // Declarations alone, as one file of a project, run nowhere.
    if !project.is_connected() || program.instances.is_empty() {
        return Ok(());
    }
    let place = |(number, key, text): (usize, String, String)| {
        format!("{}: {text}", project.place_in_table("modbus", number, &key))
    };
    let read = |(number, it)| remote(it).map_err(|(key, text)| (number, key, text));
    let mut remotes: Vec<Remote> =
        project.modbus.iter().enumerate().map(read).collect::<Result<_, _>>().map_err(place)?;
    server::check_lines(&remotes).map_err(|(number, text)| place((number, "port".to_owned(), text)))?;
    let map = staunch_ir::symbols::map_text(program, &Layout::new(program));
    let map = Map::parse(&map).map_err(|it| it.to_string())?.with_safe(project.safe.clone());
    check_safe(&map).map_err(|(number, text)| {
        let name = &project.safe[number].0;
        format!("{}: `{name}`: {text}", project.place_of_safe(name))
    })?;
    lay_out(project, &map, &mut remotes).map_err(place)?;
    check_remotes(&remotes, &map)
        .map_err(|(number, mistake)| place(mistaken(number, &project.modbus[number], mistake)))?;
    let pins = gpio::pins(project, &remotes, &map)?;
    let safe = project.safe.iter().map(|(name, value)| format!("safe\t{name}\t{value}"));
    program.remotes = remotes.iter().flat_map(Remote::lines).chain(pins.iter().map(Pin::record)).chain(safe).collect();
    Ok(())
}

/// Adds what a layout says to the entries of the servers that have one.
fn lay_out(project: &Project, map: &Map, remotes: &mut [Remote]) -> Result<(), (usize, String, String)> {
    let laid_out = openplc_layout(map, remotes);
    for (number, remote) in remotes.iter_mut().enumerate() {
        if project.modbus[number].layout.is_none() {
            continue;
        }
        if laid_out.is_empty() && remote.variables.is_empty() {
            let text = "no variable has a place there: a layout of OpenPLC has those at %IX, %IW, %QX and %QW";
            return Err((number, "layout".to_owned(), text.to_owned()));
        }
        remote.variables.extend(laid_out.iter().cloned());
    }
    Ok(())
}

/// The setting that a mistake is in, and its text.
fn mistaken(number: usize, modbus: &Modbus, mistake: Mistake) -> (usize, String, String) {
    let server = || if modbus.port.is_some() { "port" } else { "server" }.to_owned();
    match mistake.variable {
        Some(name) => {
            let is_own = modbus.map.iter().any(|it| it.0 == name);
            let key = if is_own { name.clone() } else { "layout".to_owned() };
            (number, key, format!("`{name}`: {}", mistake.text))
        }
        None => (number, server(), mistake.text),
    }
}

/// An error is the setting that is wrong, and why.
fn remote(modbus: &Modbus) -> Result<Remote, (String, String)> {
    let fail = |key: &str, text: String| (key.to_owned(), text);
    let server = server::of(modbus)?;
    let unit = server::unit(modbus, &server)?;
    let time = |key: &str, written: &Option<String>, other: Duration| match written {
        Some(written) => parse_duration(written)
            .map_err(|it| fail(key, format!("`{key}`: {it}")))
            .map(|it| Duration::from_nanos(it.unsigned_abs())),
        None => Ok(other),
    };
    let name = modbus.name.as_ref().or(modbus.server.as_ref()).or(modbus.port.as_ref()).cloned().unwrap_or_default();
    if name.chars().any(char::is_control) {
        return Err(fail("name", "`name` is one line of text".to_owned()));
    }
    let remote = Remote {
        name,
        server,
        unit,
        period: time("period", &modbus.period, PERIOD)?,
        timeout: time("timeout", &modbus.timeout, TIMEOUT)?,
        on_loss: named(&OnLoss::ALL, modbus.on_loss.as_deref()).unwrap_or(OnLoss::Hold),
        word_order: named(&WordOrder::ALL, modbus.word_order.as_deref()),
        variables: modbus.map.clone(),
    };
    if modbus.map.is_empty() && modbus.layout.is_none() {
        return Err(fail(
            if modbus.port.is_some() { "port" } else { "server" },
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
