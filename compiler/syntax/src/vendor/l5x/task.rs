//! Tasks and the programs that they run, as a CONFIGURATION with one RESOURCE.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::super::xml::{Broken, Element, Part, Reader};
use super::names::{Names, key};
use core::ops::Range;

/// A task that was opened, to its end. One that is inhibited runs nothing.
pub fn read<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    element: &Element<'t>,
    names: &Names,
    tasks: &mut Vec<Chunk>,
    out: &mut Assembly,
) -> Result<(), Broken> {
    let place = &element.place;
    let name: Vec<Chunk> = element.attribute_text(file, "Name").into_iter().collect();
    let programs = programs(file, reader, names, out)?;
    if element.attribute(file, "InhibitTask") == Some("true") || programs.is_empty() {
        return Ok(());
    }
    let kind = element.attribute(file, "Type").unwrap_or_default();
    if kind == "EVENT" {
        let message = format!("the task `{}` waits for an event", element.attribute(file, "Name").unwrap_or_default());
        out.problem(Trouble::NotSupported, message, place);
    }
    if tasks.is_empty() {
        tasks.push(Chunk::words("CONFIGURATION Config\nRESOURCE Res ON PLC\n", place));
    }
    tasks.push(Chunk::words("TASK ", place));
    tasks.extend(name.clone());
    tasks.push(Chunk::words("(", place));
    if let Some(rate) = element.attribute(file, "Rate").filter(|_| kind == "PERIODIC") {
        tasks.push(Chunk::words(format!("INTERVAL := T#{rate}ms, "), place));
    }
    let priority = element.attribute(file, "Priority").unwrap_or("10");
    tasks.push(Chunk::words(format!("PRIORITY := {priority});\n"), place));
    for program in programs {
        let (at, ty) = program;
        tasks.extend([Chunk::words("PROGRAM ", &at), Chunk::verbatim(at.clone()), Chunk::words(" WITH ", place)]);
        tasks.extend(name.clone());
        tasks.extend([Chunk::words(" : ", place), Chunk::words(ty, &at), Chunk::words(";\n", place)]);
    }
    Ok(())
}

/// The programs of a task that was opened, to its end: where each is named, and its type.
fn programs<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    names: &Names,
    out: &mut Assembly,
) -> Result<Vec<(Range<usize>, String)>, Broken> {
    let mut programs = Vec::new();
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) => {
                open += 1;
                if element.name == "ScheduledProgram"
                    && let Some(at) = element.attribute_place(file, "Name")
                {
                    let name = key(&file[at.clone()]);
                    match names.programs.get(&name) {
                        Some(ty) => programs.push((at, ty.clone())),
                        None if names.disabled_programs.contains(&name) => {}
                        None => {
                            let message = format!("there is no program `{}`", &file[at.clone()]);
                            out.problem(Trouble::Odd, message, &at);
                        }
                    }
                }
            }
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    Ok(programs)
}

pub fn close(tasks: &mut Vec<Chunk>, place: &Range<usize>) {
    if !tasks.is_empty() {
        tasks.push(Chunk::words("END_RESOURCE\nEND_CONFIGURATION\n", place));
    }
}
