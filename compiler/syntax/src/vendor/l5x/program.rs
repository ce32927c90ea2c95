//! Programs and their routines: the main routine is the program's body, the others are its actions.

use super::super::assembly::{Assembly, Chunk, Says, Trouble};
use super::super::xml::{Broken, Element, Part, Reader};
use super::ladder::{self, Text, Variable};
use super::logic::{self, FIRST_SCAN, Logic, Subroutine};
use super::names::{Names, Scope, free, key};
use super::tag;
use core::ops::Range;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

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
    /// A ladder diagram.
    Rungs(Vec<Text>),
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
    let names_first_scan = routines.iter().any(|it| it.names(file, FIRST_SCAN));
    let logic = Logic {
        file,
        names,
        scope: &scope,
        actions,
        subroutines: subroutines(&routines),
        first_scan: names_first_scan.then(|| free("S_FS", "flag", &scope.tags)),
        main,
    };
    in_words(&mut routines, main, &logic, &element.place, out);
    if let Some(flag) = &logic.first_scan {
        out.write(&format!("VAR {flag}, {flag}_was : BOOL; END_VAR\n"), &element.place);
    }
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
    if let Some(flag) = &logic.first_scan {
        // The prescan takes back what each scan notes.
        out.write(&format!("{flag} := NOT {flag}_was;\n{flag}_was [:=] TRUE;\n"), &element.place);
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

/// What routines take and give that are not text.
pub fn subroutines(routines: &[Routine<'_>]) -> FxHashMap<String, Subroutine> {
    let parameters = |it: &Routine<'_>| match &it.body {
        Body::Rungs(rungs) => Some((key(it.name), ladder::subroutine(rungs))),
        Body::Other(..) => Some((key(it.name), Subroutine::Unknown)),
        Body::Text(_) => None,
    };
    routines.iter().filter_map(parameters).collect()
}

/// Makes statements of rungs, and declares the variables that these need. Those of `main` live for one scan; an action sees only
/// what is kept.
pub fn in_words(routines: &mut [Routine<'_>], main: &str, logic: &Logic<'_>, place: &Range<usize>, out: &mut Assembly) {
    let mut sections: BTreeMap<String, (&str, &str)> = BTreeMap::new();
    for routine in routines {
        let Body::Rungs(rungs) = &routine.body else { continue };
        let ladder = ladder::statements(routine.name, rungs, logic);
        for Variable { name, ty, is_shared } in ladder.variables {
            let is_kept = is_shared || !routine.name.eq_ignore_ascii_case(main);
            sections.insert(name, (if is_kept { "VAR" } else { "VAR_TEMP" }, ty));
        }
        routine.body = Body::Text(ladder.chunks);
    }
    for (name, (section, ty)) in sections {
        out.write(&format!("{section} {name} : {ty}; END_VAR\n"), place);
    }
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
            Part::Open(part) if part.name == "RLLContent" => routine.body = Body::Rungs(rungs(file, reader)?),
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

/// The rungs of a ladder diagram that was opened, to its end.
fn rungs(file: &str, reader: &mut Reader<'_>) -> Result<Vec<Text>, Broken> {
    let mut rungs: Vec<Text> = Vec::new();
    let (mut number, mut comment, mut edit) = (String::new(), String::new(), None);
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) if element.name == "Text" => {
                let text = Text::new(file, number.clone(), reader.content("")?, element.place);
                rungs.push(text.remarked(&comment).edited(edit.take()));
            }
            Some(Part::Open(element)) if element.name == "Comment" => {
                let chunks = reader.content("")?.into_iter().filter(|it| it.says == Says::Itself);
                comment = chunks.map(|it| &file[it.place]).collect();
            }
            Some(Part::Open(element)) if element.name == "Rung" => {
                let own = element.attribute(file, "Number");
                number = own.map_or_else(|| rungs.len().to_string(), str::to_owned);
                comment.clear();
                edit = element.attribute(file, "Type").filter(|it| *it != "N").map(str::to_owned);
                open += 1;
            }
            Some(Part::Open(_)) => reader.skip()?,
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    Ok(rungs)
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
    /// Whether its text names something, which is in capitals.
    fn names(&self, file: &str, name: &str) -> bool {
        let has = |it: &str| it.to_ascii_uppercase().contains(name);
        match &self.body {
            Body::Text(chunks) => chunks.iter().any(|it| has(&file[it.place.clone()])),
            Body::Rungs(rungs) => rungs.iter().any(|it| has(&it.text)),
            Body::Other(..) => false,
        }
    }

    /// Writes the statements.
    pub fn write(&self, owner: &str, logic: &Logic<'_>, out: &mut Assembly) {
        match &self.body {
            Body::Text(chunks) => logic::write(logic, chunks, out),
            Body::Rungs(_) => unreachable!("rungs have been made statements"),
            Body::Other(why, place) => {
                let message = format!("the routine `{}` of `{owner}` is {why}", self.name);
                out.problem(Trouble::OtherLanguage, message, place);
            }
        }
    }
}
