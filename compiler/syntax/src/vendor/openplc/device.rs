//! The files of a project about its device: its board, its pins, and other devices with points of Modbus.

use super::super::assembly::{Assembly, Trouble};
use super::super::device::{Device, Pin, normal};
use super::super::json::{Kind, Member, Value};
use super::global::has_lists;
use super::object::{Object, is_name, shown};

/// What a `project.json` shows of the editor that has written it.
pub fn of_project(file: &str, value: &Value) -> Device {
    let Kind::Object(members) = &value.kind else { return Device::default() };
    let whole = Object { file, place: &value.place, members };
    let data = whole.object("data", &mut Assembly::default());
    let is_strucpp = data.is_some_and(|it| it.get("libraries").is_some() || has_lists(&it));
    Device { is_strucpp, ..Device::default() }
}

/// `devices/configuration.json`
pub fn configuration(file: &str, value: &Value, out: &mut Assembly) {
    let Some(object) = Object::required(file, value, "a configuration", out) else { return };
    let board = object.text("deviceBoard", out).map(|it| it.text(file));
    let is_strucpp = ["vendorScreenData", "selectedPlatformOptions"].iter().any(|it| object.get(it).is_some());
    out.device = Some(Device { is_strucpp, board, pins: Vec::new() });
}

/// `devices/pin-mapping.json`: a list, or from v4.2 on one for each board.
pub fn pins(file: &str, value: &Value, out: &mut Assembly) {
    let mut device = Device::default();
    match &value.kind {
        Kind::List(pins) => device.pins = board(file, None, pins, out),
        Kind::Object(boards) => {
            device.is_strucpp = true;
            let all = boards.iter().flat_map(|it| of_board(file, it, out)).collect();
            device.pins = all;
        }
        Kind::Null | Kind::Truth | Kind::Number | Kind::Text => {
            let message = format!("{} is not a pin mapping of OpenPLC Editor", value.what());
            out.problem(Trouble::Odd, message, &value.place);
        }
    }
    out.device = Some(device);
}

fn of_board(file: &str, member: &Member, out: &mut Assembly) -> Vec<Pin> {
    let name = member.name.text(file);
    if let Kind::List(pins) = &member.value.kind {
        return board(file, Some(&name), pins, out);
    }
    let message = format!("the pins of `{}` are {}, not a list", shown(&name), member.value.what());
    out.problem(Trouble::Odd, message, &member.name.place);
    Vec::new()
}

/// The pins of one board. Two with one address, or one alias, contradict each other.
fn board(file: &str, board: Option<&str>, values: &[Value], out: &mut Assembly) -> Vec<Pin> {
    let mut pins: Vec<Pin> = Vec::new();
    for value in values {
        let Some(object) = Object::required(file, value, "a pin", out) else { continue };
        let Some(pin) = pin(&object, board, out) else { continue };
        let has_address = |it: &&Pin| normal(&it.address) == normal(&pin.address);
        let has_alias = |it: &&Pin| pin.alias.is_some() && it.alias == pin.alias;
        if let Some(other) = pins.iter().find(has_address) {
            contradiction(&object, "address", [other, &pin], out);
        } else if let Some(other) = pins.iter().find(has_alias) {
            let member = if object.get("alias").is_some() { "alias" } else { "name" };
            contradiction(&object, member, [other, &pin], out);
        }
        pins.push(pin);
    }
    pins
}

fn pin(object: &Object<'_>, board: Option<&str>, out: &mut Assembly) -> Option<Pin> {
    let file = object.file;
    let address = object.text("address", out)?;
    if !address.raw(file).starts_with('%') {
        out.problem(Trouble::Odd, format!("`{}` is not an address", shown(&address.text(file))), &address.place);
        return None;
    }
    let area = object.word("pinType", out).and_then(area);
    if area.is_some_and(|it| !normal(address.raw(file)).starts_with(it)) {
        let message = format!("`{}` is not an address of this kind of pin, `{}…`", address.raw(file), area?);
        out.problem(Trouble::Odd, message, &address.place);
    }
    let alias = match object.text("alias", out) {
        Some(alias) => Some(alias),
        None => object.text("name", out),
    };
    Some(Pin {
        board: board.map(str::to_owned),
        pin: object.text("pin", out).map(|it| it.text(file)),
        alias: alias.filter(|it| is_name(file, it, out)).map(|it| it.text(file)),
        address: address.text(file),
    })
}

/// How the addresses of a kind of pins begin.
fn area(kind: &str) -> Option<&'static str> {
    match kind {
        "digitalInput" => Some("%IX"),
        "digitalOutput" => Some("%QX"),
        "analogInput" => Some("%IW"),
        "analogOutput" => Some("%QW"),
        _ => None,
    }
}

fn contradiction(object: &Object<'_>, member: &str, pins: [&Pin; 2], out: &mut Assembly) {
    let [first, second] = pins.map(|it| it.pin.as_deref().unwrap_or(&it.address));
    let value = object.get(member);
    let place = value.map_or(object.start(), |it| it.place.clone());
    let text = value.map(|it| shown(&it.text(object.file))).unwrap_or_default();
    let what = if member == "address" { "address" } else { "alias" };
    out.problem(Trouble::Odd, format!("`{text}` is the {what} of two pins, `{first}` and `{second}`"), &place);
}

/// A device of `devices/remote`: points of Modbus have addresses and aliases.
pub fn remote(file: &str, value: &Value, out: &mut Assembly) {
    let Some(object) = Object::required(file, value, "a remote device", out) else { return };
    let groups = object.object("modbusTcpConfig", out).map_or(&[][..], |it| it.list("ioGroups", out));
    let mut pins = Vec::new();
    for group in groups {
        let Some(group) = Object::required(file, group, "a group of points", out) else { continue };
        for point in group.list("ioPoints", out) {
            let Some(point) = Object::required(file, point, "a point", out) else { continue };
            let (address, alias) = (point.text("iecLocation", out), point.text("alias", out));
            let (Some(address), Some(alias)) = (address, alias) else { continue };
            pins.push(Pin { board: None, pin: None, alias: Some(alias.text(file)), address: address.text(file) });
        }
    }
    out.device = Some(Device { pins, ..Device::default() });
}
