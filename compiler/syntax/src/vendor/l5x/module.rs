//! The tags of modules, `Local:1:I`: variables of structures that the modules' own data describes.

use super::super::assembly::{Assembly, Chunk};
use super::super::xml::{Broken, Element, Part, Reader};
use super::data::{self, Value, What, array_of, ty_text};
use super::names::{Names, key, plain};

/// A module that was opened, to its end.
pub fn read<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    element: &Element<'t>,
    names: &mut Names,
    out: &mut Assembly,
) -> Result<(), Broken> {
    let attribute = |it: &str| element.attribute(file, it).unwrap_or_default();
    let mut base = attribute("Name").to_owned();
    let (mut input, mut output) = ("I", "O");
    let mut open = 1_usize;
    while open > 0 {
        let part = match reader.part()? {
            Some(Part::Open(part)) => part,
            Some(Part::Close) => {
                open -= 1;
                continue;
            }
            Some(Part::Text(_)) => continue,
            None => break,
        };
        let suffix = match part.name {
            "Port" => {
                base = address(file, &part, attribute("ParentModule")).unwrap_or(base);
                open += 1;
                continue;
            }
            "Connection" => {
                input = part.attribute(file, "InputTagSuffix").unwrap_or("I");
                output = part.attribute(file, "OutputTagSuffix").unwrap_or("O");
                open += 1;
                continue;
            }
            "InputTag" => input,
            "OutputTag" => output,
            "ConfigTag" => "C",
            _ => {
                open += 1;
                continue;
            }
        };
        if let Some(value) = decorated(file, reader)? {
            declare(file, &format!("{base}:{suffix}"), &value, names, out);
        }
    }
    Ok(())
}

/// In a chassis a module's tags are named by its slot, on a network by the module.
fn address(file: &str, port: &Element<'_>, parent: &str) -> Option<String> {
    const NETWORKS: [&str; 4] = ["Ethernet", "ControlNet", "DeviceNet", "USB"];
    let is_upstream = port.attribute(file, "Upstream") == Some("true");
    let is_network = port.attribute(file, "Type").is_some_and(|it| NETWORKS.contains(&it));
    let slot = port.attribute(file, "Address").filter(|_| is_upstream && !is_network)?;
    Some(format!("{parent}:{slot}"))
}

/// The decorated data of a tag that was opened, to its end.
fn decorated<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Option<Value<'t>>, Broken> {
    let mut value = None;
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if element.attribute(file, "Format") == Some("Decorated") => {
                value = data::within(file, reader)?;
            }
            Part::Open(_) => reader.skip()?,
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(value)
}

fn declare(file: &str, name: &str, value: &Value<'_>, names: &mut Names, out: &mut Assembly) {
    let variable = plain(name);
    let mut chunks = Vec::new();
    types(value, names, &mut chunks);
    chunks.push(Chunk::words(format!("VAR_GLOBAL {variable} : {}", spelled(value)), &value.place));
    if !value.is_zero() {
        chunks.push(Chunk::words(" := ", &value.place));
        value.write(false, &|_, _| false, &mut chunks);
    }
    chunks.push(Chunk::words("; END_VAR\n", &value.place));
    out.copy(file, &chunks);
    names.modules.insert(key(name), variable);
}

/// Declares the structures that a value is of, each once.
fn types(value: &Value<'_>, names: &mut Names, out: &mut Vec<Chunk>) {
    match &value.what {
        What::Number(..) | What::Text(..) | What::Odd => {}
        What::List(elements) => elements.iter().take(1).for_each(|it| types(it, names, out)),
        What::Members(members) => {
            members.iter().for_each(|it| types(&it.2, names, out));
            if !names.module_types.insert(key(value.ty)) {
                return;
            }
            out.push(Chunk::words(format!("TYPE {} :\nSTRUCT\n", plain(value.ty)), &value.place));
            for (name, _, member) in members {
                out.push(name.clone());
                out.push(Chunk::words(format!(" : {};\n", spelled(member)), &member.place));
            }
            out.push(Chunk::words("END_STRUCT;\nEND_TYPE\n", &value.place));
        }
    }
}

fn spelled(value: &Value<'_>) -> String {
    let ty = ty_text(value.ty).unwrap_or_else(|| value.ty.to_owned());
    // Dimensions of data that are none end the reading of it.
    format!("{}{ty}", array_of(value.dimensions).unwrap_or_default())
}
