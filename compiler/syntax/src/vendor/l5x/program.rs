//! Programs and their routines: the main routine is the program's body, the others are its actions.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::super::xml::{Broken, Element, Part, Reader};
use super::logic::{self, Logic};
use super::names::{Names, Scope, free, key};
use super::tag;
use core::ops::Range;

/// A routine as the file has it.
#[derive(Debug)]
pub struct Routine<'t> {
    pub name: &'t str,
    pub place: Range<usize>,
    name_chunk: Option<Chunk>,
    pub body: Body,
}

#[derive(Debug)]
pub enum Body {
    Text(Vec<Chunk>),
    /// Why it is not text.
    Other(&'static str, Range<usize>),
}

/// A program that was opened, to its end.
pub fn read<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    element: &Element<'t>,
    names: &mut Names,
    out: &mut Assembly,
) -> Result<(), Broken> {
    let name = element.attribute(file, "Name").unwrap_or_default();
    let main = element.attribute(file, "MainRoutineName").unwrap_or_default();
    let (mut scope, mut sections, mut routines) = (Scope::default(), Vec::new(), Vec::new());
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(part) if part.name == "Tags" => {
                sections.extend(tag::tags(file, reader, "VAR", names, &mut scope)?);
            }
            Part::Open(part) if part.name == "Routines" => routines = self::routines(file, reader)?,
            Part::Open(_) => reader.skip()?,
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    let called = free(name, "program", &names.controller.tags);
    let mut head = vec![Chunk::words("PROGRAM ", &element.place)];
    head.push(match element.attribute_place(file, "Name") {
        Some(place) if called == name => Chunk::verbatim(place),
        Some(place) => Chunk::words(called.clone(), &place),
        None => Chunk::words("", &element.place),
    });
    head.push(Chunk::words("\n", &element.place));
    out.copy(file, &head);
    out.copy(file, &sections);
    let actions = routines.iter().map(|it| (key(it.name), free(it.name, "routine", &scope.tags))).collect();
    let logic = Logic { file, names, scope: &scope, actions, main };
    if !main.is_empty() && !routines.iter().any(|it| it.name.eq_ignore_ascii_case(main)) {
        let place = element.attribute_place(file, "MainRoutineName").unwrap_or_else(|| element.place.clone());
        out.problem(Trouble::Odd, format!("the program `{name}` has no routine `{main}`"), &place);
    }
    for routine in routines.iter().filter(|it| !it.name.eq_ignore_ascii_case(main)) {
        out.write("ACTION ", &routine.place);
        let called = logic.actions.get(&key(routine.name)).filter(|it| *it != routine.name);
        match (&routine.name_chunk, called) {
            (Some(chunk), Some(called)) => out.write(called, &chunk.place),
            (Some(chunk), None) => out.copy(file, core::slice::from_ref(chunk)),
            (None, _) => {}
        }
        out.write("\n", &routine.place);
        routine.write(name, &logic, out);
        out.write("END_ACTION\n", &routine.place);
    }
    if let Some(main) = routines.iter().find(|it| it.name.eq_ignore_ascii_case(main)) {
        main.write(name, &logic, out);
    }
    out.write("END_PROGRAM\n", &reader.last());
    if element.attribute(file, "Disabled") == Some("true") {
        names.disabled_programs.insert(key(name));
    } else {
        names.programs.insert(key(name), called);
    }
    Ok(())
}

/// The routines in an element that was opened, to its end.
pub fn routines<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Vec<Routine<'t>>, Broken> {
    let mut routines = Vec::new();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if matches!(element.name, "Routine" | "EncodedData") => {
                routines.push(routine(file, reader, &element)?);
            }
            Part::Open(_) => reader.skip()?,
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(routines)
}

fn routine<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>) -> Result<Routine<'t>, Broken> {
    let mut routine = Routine {
        name: element.attribute(file, "Name").unwrap_or_default(),
        place: element.place.clone(),
        name_chunk: element.attribute_text(file, "Name"),
        body: Body::Text(Vec::new()),
    };
    if element.name == "EncodedData" {
        routine.body = Body::Other("protected: its source is encrypted", element.place.clone());
        reader.skip()?;
        return Ok(routine);
    }
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(part) if part.name == "STContent" => routine.body = Body::Text(lines(reader)?),
            Part::Open(part) if part.name == "RLLContent" => routine.body = rungs(file, reader, part.place)?,
            Part::Open(part) => {
                if let (Some(language), true) = (language(part.name), holds_any(reader)?) {
                    routine.body = Body::Other(language, part.place);
                }
            }
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(routine)
}

fn language(element: &str) -> Option<&'static str> {
    match element {
        "FBDContent" => Some("a function block diagram (FBD), not Structured Text"),
        "SFCContent" => Some("a sequential function chart (SFC), not Structured Text"),
        "EncodedData" => Some("protected: its source is encrypted"),
        _ => None,
    }
}

/// Passes over the rest of an element that was opened, and says whether anything was in it.
fn holds_any(reader: &mut Reader<'_>) -> Result<bool, Broken> {
    let mut any = false;
    loop {
        match reader.part()? {
            Some(Part::Open(_)) => {
                any = true;
                reader.skip()?;
            }
            Some(Part::Text(_)) => {}
            Some(Part::Close) | None => return Ok(any),
        }
    }
}

/// A ladder diagram that was opened, to its end. Rungs that only call routines, as main routines mostly are, say so in
/// the words of Structured Text.
fn rungs(file: &str, reader: &mut Reader<'_>, place: Range<usize>) -> Result<Body, Broken> {
    let (mut chunks, mut only_calls) = (Vec::new(), true);
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) if element.name == "Text" => {
                for text in reader.content("")? {
                    match calls(&file[text.place.clone()]) {
                        Some(calls) => chunks.extend(calls.into_iter().flat_map(|it| statement(&text.place, it))),
                        None => only_calls = false,
                    }
                }
            }
            Some(Part::Open(element)) if element.name == "Rung" => open += 1,
            Some(Part::Open(_)) => reader.skip()?,
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    Ok(if only_calls { Body::Text(chunks) } else { Body::Other("a ladder diagram (RLL), not Structured Text", place) })
}

/// The calls of a rung that has nothing else, in their order: `JSR(Fill,0)JSR(Drain,0);`, `[JSR(Fill,0) ,JSR(Drain,0) ];`,
/// whose branches run one after the other, `NOP();`.
fn calls(rung: &str) -> Option<Vec<Range<usize>>> {
    let (mut calls, mut at, mut branches) = (Vec::new(), 0, 0_usize);
    while at < rung.len() {
        let rest = &rung[at..];
        at += match rest.as_bytes()[0] {
            b' ' | b'\t' | b'\r' | b'\n' | b';' => 1,
            b'[' => {
                branches += 1;
                1
            }
            b',' if branches > 0 => 1,
            b']' => {
                branches = branches.checked_sub(1)?;
                1
            }
            _ if rest.starts_with("NOP()") => "NOP()".len(),
            _ => {
                let operands = rest.strip_prefix("JSR(")?;
                let end = operands.find(['(', ')']).filter(|it| operands[*it..].starts_with(')'))?;
                let length = "JSR(".len() + end + 1;
                calls.push(at..at + length);
                length
            }
        };
    }
    (branches == 0).then_some(calls)
}

/// A call of a rung as a statement.
fn statement(rung: &Range<usize>, call: Range<usize>) -> [Chunk; 2] {
    let place = rung.start + call.start..rung.start + call.end;
    let end = Chunk::words(";\n", &(place.end..place.end));
    [Chunk::verbatim(place), end]
}

/// The lines of a routine that was opened, to its end.
fn lines(reader: &mut Reader<'_>) -> Result<Vec<Chunk>, Broken> {
    let mut chunks = Vec::new();
    loop {
        match reader.part()? {
            Some(Part::Open(_)) => {
                chunks.extend(reader.content("")?);
                chunks.push(Chunk::words("\n", &reader.last()));
            }
            // Text between the lines is not part of them.
            Some(Part::Text(_)) => {}
            Some(Part::Close) | None => return Ok(chunks),
        }
    }
}

impl Routine<'_> {
    /// Writes the statements.
    pub fn write(&self, owner: &str, logic: &Logic<'_>, out: &mut Assembly) {
        match &self.body {
            Body::Text(chunks) => logic::write(logic, chunks, out),
            Body::Other(why, place) => {
                let message = format!("the routine `{}` of `{owner}` is {why}", self.name);
                out.problem(Trouble::OtherLanguage, message, place);
            }
        }
    }
}
