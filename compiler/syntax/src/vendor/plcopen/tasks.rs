//! Tasks and the programs that they run, as a CONFIGURATION with one RESOURCE.

use super::super::assembly::Chunk;
use super::super::xml::{Broken, Element, Part, Reader};
use core::ops::Range;

/// A task that was opened, to its end.
pub fn task<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    element: &Element<'t>,
    out: &mut Vec<Chunk>,
) -> Result<(), Broken> {
    let place = &element.place;
    open(out, place);
    let name = element.attribute_text(file, "name");
    out.push(Chunk::words("TASK ", place));
    out.extend(name.clone());
    out.push(Chunk::words("(", place));
    let written = element.attribute(file, "interval").map(|it| (duration(it), place.clone()));
    let (mut added, mut instances, mut depth) = (None, Vec::new(), 1_usize);
    while depth > 0 {
        let Some(part) = reader.part()? else { break };
        match part {
            Part::Open(element) => {
                if element.name == "pouInstance" {
                    instance(file, &element, name.as_ref(), &mut instances);
                    reader.skip()?;
                    continue;
                }
                added = added.or_else(|| Some((settings(file, &element)?, element.place.clone())));
                depth += 1;
            }
            Part::Text(_) => {}
            Part::Close => depth -= 1,
        }
    }
    if let Some((interval, place)) = written.filter(|it| !is_none(&it.0)).or(added) {
        out.push(Chunk::words(format!("INTERVAL := {interval}, "), &place));
    }
    let priority = element.attribute(file, "priority").unwrap_or("0");
    out.push(Chunk::words(format!("PRIORITY := {priority});\n"), place));
    out.append(&mut instances);
    Ok(())
}

/// The interval that CODESYS and TwinCAT add to a task that runs in cycles, `Interval="10000" IntervalUnit="us"` or
/// `Interval="t#20ms"`; TwinCAT leaves that of the standard at `PT0S`.
fn settings(file: &str, element: &Element<'_>) -> Option<String> {
    if element.name != "TaskSettings" || element.attribute(file, "KindOfTask") != Some("Cyclic") {
        return None;
    }
    let interval = element.attribute(file, "Interval")?;
    let unit = element.attribute(file, "IntervalUnit").unwrap_or("ms").replace('µ', "u");
    let is_number = interval.bytes().all(|it| it.is_ascii_digit() || it == b'.') && !interval.is_empty();
    let interval = if is_number { format!("T#{interval}{unit}") } else { interval.to_uppercase().replace('µ', "u") };
    let is_time = ["T#", "LT#", "TIME#"].iter().any(|it| interval.starts_with(it));
    (is_time && !is_none(&interval)).then_some(interval)
}

/// `T#0s`: no interval, as a task without one has it.
fn is_none(interval: &str) -> bool {
    let digits = interval.split_once('#').map_or(interval, |it| it.1);
    digits.bytes().any(|it| it == b'0') && !digits.bytes().any(|it| matches!(it, b'1'..=b'9'))
}

/// A program that runs in a task, or in none.
pub fn instance<'t>(file: &'t str, element: &Element<'t>, task: Option<&Chunk>, out: &mut Vec<Chunk>) {
    let place = &element.place;
    out.push(Chunk::words("PROGRAM ", place));
    out.extend(element.attribute_text(file, "name"));
    if let Some(task) = task {
        out.extend([Chunk::words(" WITH ", place), task.clone()]);
    }
    out.push(Chunk::words(" : ", place));
    // CODESYS's programs are their own instances.
    let named = |it: &&str| element.attribute(file, it).is_some_and(|it| !it.is_empty());
    let ty = ["typeName", "type", "name"].into_iter().find(|it| named(it));
    out.extend(ty.and_then(|it| element.attribute_text(file, it)));
    out.push(Chunk::words(";\n", place));
}

pub fn open(out: &mut Vec<Chunk>, place: &Range<usize>) {
    if out.is_empty() {
        out.push(Chunk::words("CONFIGURATION Config\nRESOURCE Res ON PLC\n", place));
    }
}

pub fn close(out: &mut Vec<Chunk>, place: &Range<usize>) {
    if !out.is_empty() {
        out.push(Chunk::words("END_RESOURCE\nEND_CONFIGURATION\n", place));
    }
}

/// `T#20ms`, ISO 8601's `PT0.02S`, or a time of day of XML, `00:00:00.02`, as Structured Text.
fn duration(text: &str) -> String {
    let is_number = |it: &str| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit() || it == b'.');
    let of_day: Vec<&str> = text.split(':').collect();
    match (text.strip_prefix("PT").and_then(|it| it.strip_suffix('S')), of_day.as_slice()) {
        (Some(seconds), _) if is_number(seconds) => format!("T#{seconds}s"),
        (None, [hours, minutes, seconds]) if of_day.iter().all(|it| is_number(it)) => {
            format!("T#{hours}h{minutes}m{seconds}s")
        }
        _ => text.to_owned(),
    }
}
