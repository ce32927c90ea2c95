//! PLCopen XML (TC6), as CODESYS, TwinCAT, Beremiz and OpenPLC's editor write it: declarations are elements, bodies are
//! escaped text. CODESYS adds declarations as text, and methods, properties and lists, to the standard's elements.

mod declaration;
mod tasks;

use super::assembly::{Assembly, Chunk, Trouble};
use super::unit::{Body, Unit, What};
use super::xml::{Broken, Element, Part, Reader};
use core::ops::Range;
use declaration::interface;

/// Whether the root `project` is PLCopen's: by its namespace, or by what is in it, as CODESYS 3.3 wrote it without one.
pub fn is_project(file: &str, root: &Range<usize>) -> bool {
    let tag = &file[root.clone()];
    tag.contains("www.plcopen.org")
        || !tag.contains("xmlns") && file[root.end..].trim_start().starts_with("<fileHeader")
}

/// Reads what follows the root.
pub fn read<'t>(file: &'t str, mut reader: Reader<'t>) -> Assembly {
    let mut out = Assembly::default();
    // Who adds these is CODESYS, or a system that is made of it.
    let codesys = file.contains("3s-software.com") || file.contains("productName=\"CoDeSys\"");
    if codesys {
        out.write("{dialect 'codesys'}\n", &reader.last());
    }
    let mut tasks = Vec::new();
    if let Err(broken) = project(file, &mut reader, codesys, &mut tasks, &mut out) {
        let message = format!("this PLCopen XML is not well-formed: {}", broken.why);
        out.problem(Trouble::Broken, message, &broken.place);
    }
    out.copy(file, &tasks);
    out
}

fn project<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    codesys: bool,
    tasks: &mut Vec<Chunk>,
    out: &mut Assembly,
) -> Result<(), Broken> {
    while let Some(part) = reader.part()? {
        let Part::Open(element) = part else { continue };
        match element.name {
            "dataType" => {
                let chunks = declaration::data_type(file, reader, &element)?;
                out.copy(file, &chunks);
            }
            "pou" => unit(file, reader, What::Unit, element)?.write(file, out),
            "Interface" => unit(file, reader, What::Unit, element)?.write(file, out),
            "globalVars" => {
                if let (true, Some(name)) = (codesys, element.attribute(file, "name")) {
                    out.write(&format!("{{gvl '{name}'}}\n"), &element.place);
                }
                let chunks = declaration::globals(file, reader, &element)?;
                out.copy(file, &chunks);
            }
            "task" => tasks::task(file, reader, &element, tasks)?,
            "pouInstance" => {
                tasks::instance(file, &element, None, tasks);
                reader.skip()?;
            }
            "fileHeader" | "contentHeader" | "documentation" => reader.skip()?,
            // The others hold some of these.
            _ => {}
        }
    }
    tasks::close(tasks, &reader.last());
    Ok(())
}

/// A POU, a method or an accessor that was opened, to its end.
fn unit<'t>(file: &'t str, reader: &mut Reader<'t>, what: What, element: Element<'t>) -> Result<Unit<'t>, Broken> {
    let name = element.attribute(file, "name").unwrap_or_default();
    let head = declaration::head(file, what, &element);
    let mut unit = Unit::new(what, name, element.place.clone());
    unit.declaration = head.clone();
    while let Some(part) = reader.part()? {
        let element = match part {
            Part::Open(element) => element,
            Part::Close => break,
            Part::Text(_) => continue,
        };
        let inner = match element.name {
            "interface" => {
                unit.declaration = interface(file, reader, what, head.clone())?;
                continue;
            }
            "InterfaceAsPlainText" => {
                unit.declaration = reader.content("xhtml")?;
                continue;
            }
            "body" => {
                let body = body(reader)?;
                unit.take_body(body, element.place);
                continue;
            }
            "action" | "Action" => What::Action,
            "Method" => What::Method,
            "Property" => What::Property,
            "GetAccessor" => What::Get,
            "SetAccessor" => What::Set,
            "actions" | "Actions" | "Methods" | "Properties" | "addData" | "data" => {
                parts(file, reader, &mut unit)?;
                continue;
            }
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

/// What lies deeper in a unit, between elements that only hold others.
fn parts<'t>(file: &'t str, reader: &mut Reader<'t>, unit: &mut Unit<'t>) -> Result<(), Broken> {
    let mut open = 1_usize;
    while open > 0 {
        let element = match reader.part()? {
            Some(Part::Open(element)) => element,
            Some(Part::Close) => {
                open -= 1;
                continue;
            }
            Some(Part::Text(_)) => continue,
            None => break,
        };
        let what = match element.name {
            "action" | "Action" => What::Action,
            "Method" => What::Method,
            "Property" => What::Property,
            "GetAccessor" => What::Get,
            "SetAccessor" => What::Set,
            "InterfaceAsPlainText" => {
                unit.declaration = reader.content("xhtml")?;
                continue;
            }
            _ => {
                open += 1;
                continue;
            }
        };
        unit.parts.push(self::unit(file, reader, what, element)?);
    }
    Ok(())
}

fn body(reader: &mut Reader<'_>) -> Result<Body, Broken> {
    let mut body = Body::None;
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => match language(element.name) {
                None if element.name == "ST" => body = Body::Text(text(reader)?),
                None => reader.skip()?,
                Some(language) => {
                    body = Body::Other(language, element.place);
                    reader.skip()?;
                }
            },
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(body)
}

/// The text of an element, in XHTML's elements or not.
fn text(reader: &mut Reader<'_>) -> Result<Vec<Chunk>, Broken> {
    let mut chunks = Vec::new();
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(_)) => open += 1,
            Some(Part::Close) => open -= 1,
            Some(Part::Text(chunk)) => chunks.push(chunk),
            None => break,
        }
    }
    Ok(chunks)
}

fn language(element: &str) -> Option<&'static str> {
    match element {
        "LD" => Some("a ladder diagram (LD)"),
        "FBD" => Some("a function block diagram (FBD)"),
        "SFC" => Some("a sequential function chart (SFC)"),
        "CFC" => Some("a continuous function chart (CFC)"),
        "IL" => Some("Instruction List (IL)"),
        _ => None,
    }
}
