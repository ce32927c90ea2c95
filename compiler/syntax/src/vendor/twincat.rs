//! TwinCAT 3's files, `.TcPOU`, `.TcGVL`, `.TcDUT` and `.TcIO`: declarations and bodies in CDATA sections; methods,
//! properties and actions are elements next to them, and END_… is left out. A `.TcTTO` is a task, and a `.TcTLEO` an
//! enumeration with a text for each of its values.

use super::assembly::{Assembly, Chunk, Trouble};
use super::unit::{Body, Unit, What};
use super::xml::{Broken, Element, Part, Reader};
use core::ops::Range;

/// Reads what follows the root.
pub fn read<'t>(file: &'t str, mut reader: Reader<'t>) -> Assembly {
    let mut out = Assembly::default();
    if let Err(broken) = units(file, &mut reader, &mut out) {
        let message = format!("this TwinCAT file is not well-formed XML: {}", broken.why);
        out.problem(Trouble::Broken, message, &broken.place);
    }
    out
}

/// The declarations and bodies that are in CDATA sections of one piece; `None` if the file is not well-formed.
pub fn texts(mut reader: Reader<'_>) -> Option<Vec<Range<usize>>> {
    let mut texts = Vec::new();
    while let Some(part) = reader.part().ok()? {
        let Part::Open(element) = part else { continue };
        if matches!(element.name, "Declaration" | "ST")
            && let [one] = reader.content("").ok()?.as_slice()
            && reader.is_cdata(&one.place)
        {
            texts.push(one.place.clone());
        }
    }
    Some(texts)
}

fn units<'t>(file: &'t str, reader: &mut Reader<'t>, out: &mut Assembly) -> Result<(), Broken> {
    let (root, mut is_empty) = (reader.last(), true);
    while let Some(part) = reader.part()? {
        let Part::Open(element) = part else { continue };
        is_empty = false;
        match element.name {
            "POU" | "Itf" | "DUT" | "GVL" | "EnumerationTextList" => {
                let is_list = element.name == "GVL";
                let place = element.place.clone();
                let unit = unit(file, reader, What::Unit, element)?;
                out.write("{dialect 'codesys'}\n", &place);
                if is_list {
                    out.write(&format!("{{gvl '{}'}}\n", unit.name), &place);
                }
                unit.write(file, out);
                if unit.declaration.iter().all(|it| it.place.is_empty()) {
                    out.problem(Trouble::Odd, format!("`{}` has no declaration", unit.name), &place);
                }
            }
            "Task" => task(file, reader, &element, out)?,
            _ => reader.skip()?,
        }
    }
    if is_empty {
        out.problem(Trouble::Odd, "this TwinCAT file is empty".to_owned(), &root);
    }
    Ok(())
}

/// A task that was opened, to its end: a CONFIGURATION with the programs that it calls. Those of libraries, which
/// have a namespace, are the visualisation's and its like.
fn task<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>, out: &mut Assembly) -> Result<(), Broken> {
    let place = &element.place;
    let name: Vec<Chunk> = element.attribute_text(file, "Name").into_iter().collect();
    let (mut interval, mut priority) = (Chunk::words("", place), Chunk::words("PRIORITY := 0", place));
    let (mut programs, mut open) = (Vec::new(), vec!["Task"]);
    while !open.is_empty() {
        match reader.part()? {
            Some(Part::Open(element)) => open.push(element.name),
            Some(Part::Close) => drop(open.pop()),
            Some(Part::Text(chunk)) => {
                let (at, text) = (chunk.place.clone(), file[chunk.place.clone()].trim());
                let is_number = !text.is_empty() && text.bytes().all(|it| it.is_ascii_digit());
                match open.as_slice() {
                    [_, "CycleTime" | "Priority"] if !is_number => {
                        out.problem(Trouble::Odd, format!("`{text}` is not a number"), &at);
                    }
                    [_, "CycleTime"] if text.bytes().all(|it| it == b'0') => {
                        out.problem(
                            Trouble::Odd,
                            format!("`{text}` is not a cycle time: expected microseconds above 0"),
                            &at,
                        );
                    }
                    [_, "CycleTime"] => {
                        // A TIME has whole milliseconds.
                        let prefix = if text.ends_with("000") { "T" } else { "LTIME" };
                        interval = Chunk::words(format!("INTERVAL := {prefix}#{text}us, "), &at);
                    }
                    [_, "Priority"] => priority = Chunk::words(format!("PRIORITY := {text}"), &at),
                    [_, "PouCall", "Name"] if !text.contains('.') && !text.is_empty() => programs.push(chunk),
                    _ => {}
                }
            }
            None => break,
        }
    }
    if programs.is_empty() {
        return Ok(());
    }
    let mut words = vec![Chunk::words("{dialect 'codesys'}\nCONFIGURATION Config\nTASK ", place)];
    words.extend(name.clone());
    words.extend([Chunk::words("(", place), interval, priority, Chunk::words(");\n", place)]);
    out.copy(file, &words);
    for program in programs {
        let at = program.place.clone();
        let mut words = vec![Chunk::words("PROGRAM ", &at), program.clone(), Chunk::words(" WITH ", place)];
        words.extend(name.clone());
        words.extend([Chunk::words(" : ", place), program, Chunk::words(";\n", place)]);
        out.copy(file, &words);
    }
    out.write("END_CONFIGURATION\n", place);
    Ok(())
}

/// A unit that was opened, to its end.
fn unit<'t>(file: &'t str, reader: &mut Reader<'t>, what: What, element: Element<'t>) -> Result<Unit<'t>, Broken> {
    let name = element.attribute(file, "Name").unwrap_or_default();
    let mut unit = Unit::new(what, name, element.place);
    while let Some(part) = reader.part()? {
        let element = match part {
            Part::Open(element) => element,
            Part::Close => break,
            Part::Text(_) => continue,
        };
        let inner = match element.name {
            "Declaration" => {
                unit.declaration = reader.content("")?;
                continue;
            }
            "Implementation" => {
                unit.body = body(reader)?;
                continue;
            }
            "Method" => What::Method,
            "Property" => What::Property,
            "Get" => What::Get,
            "Set" => What::Set,
            "Action" => What::Action,
            _ => {
                reader.skip()?;
                continue;
            }
        };
        unit.parts.push(self::unit(file, reader, inner, element)?);
    }
    unit.end = reader.last();
    Ok(unit)
}

/// The body in an `Implementation`.
fn body(reader: &mut Reader<'_>) -> Result<Body, Broken> {
    let mut body = Body::None;
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if element.name == "ST" => body = Body::Text(reader.content("")?),
            Part::Open(element) => {
                body = Body::Other(language(element.name), element.place);
                reader.skip()?;
            }
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(body)
}

/// What the elements of other languages stand for.
fn language(element: &str) -> &'static str {
    match element {
        "NWL" => "a network of ladder (LD), function blocks (FBD) or instructions (IL)",
        "SFC" => "a sequential function chart (SFC)",
        "CFC" => "a continuous function chart (CFC)",
        "LD" => "a ladder diagram (LD)",
        "FBD" => "a function block diagram (FBD)",
        "IL" => "Instruction List (IL)",
        _ => "in a graphical language",
    }
}
