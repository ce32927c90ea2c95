//! PLCopen XML (TC6), as CODESYS, TwinCAT, Beremiz and OpenPLC's editor write it: declarations are elements, bodies are
//! escaped text or diagrams. CODESYS adds declarations as text, and methods, properties and lists, to the standard's elements.

mod chart;
mod declaration;
mod declared;
mod drawn;
mod tasks;

use super::assembly::{Assembly, Chunk, Says, Trouble};
use super::diagram::{self, Context, Declared, Names, Refusal, Rules, Written};
use super::unit::{Body, Unit, What};
use super::xml::{Broken, Element, Part, Reader};
use core::ops::Range;
use declaration::interface;
use rustc_hash::{FxHashMap, FxHashSet};

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
    let has_diagrams = ["<LD", "<FBD", "<SFC"].iter().any(|it| file.contains(it));
    let declared = if has_diagrams { declared::declared(file) } else { Declared::default() };
    if let Err(broken) = project(file, &mut reader, &declared, codesys, &mut tasks, &mut out) {
        let message = format!("this PLCopen XML is not well-formed: {}", broken.why);
        out.problem(Trouble::Broken, message, &broken.place);
    }
    out.copy(file, &tasks);
    out
}

fn project<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    declared: &Declared,
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
            "pou" | "Interface" => {
                let name = element.attribute(file, "name").unwrap_or_default();
                let rules = if codesys { Rules::Codesys } else { Rules::Beremiz };
                let context = Context { declared, pou: name, action: "", rules };
                let mut diagrams = Diagrams {
                    context,
                    action: String::new(),
                    names: Names::default(),
                    variables: Vec::new(),
                    transitions: FxHashMap::default(),
                };
                unit(file, reader, What::Unit, element, &mut diagrams)?.write(file, out);
            }
            "globalVars" => {
                if let (true, Some(name)) = (codesys, element.attribute(file, "name")) {
                    out.write(&format!("{{gvl '{name}'}}\n"), &element.place);
                }
                let chunks = declaration::globals(file, reader, &element)?;
                out.copy(file, &chunks);
            }
            "task" => tasks::task(file, reader, &element, tasks)?,
            "pouInstance" => {
                tasks::open(tasks, &element.place);
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

/// What the diagrams of a POU are in, and what they need of it.
struct Diagrams<'s> {
    context: Context<'s>,
    /// The action that is read.
    action: String,
    names: Names,
    /// Variables of the POU that its actions' diagrams have added.
    variables: Vec<(String, String)>,
    /// The conditions that a chart names, by their names in capitals.
    transitions: FxHashMap<String, chart::Transition>,
}

impl Diagrams<'_> {
    /// What a unit's diagrams need is its own, but for an action's. What the outer one needs is kept meanwhile.
    fn enter(&mut self, what: What, name: &str) -> Vec<(String, String)> {
        if what == What::Action {
            name.clone_into(&mut self.action);
            return Vec::new();
        }
        std::mem::take(&mut self.variables)
    }

    fn leave(&mut self, what: What, outer: Vec<(String, String)>) {
        self.action.clear();
        if what != What::Action {
            self.variables = outer;
        }
    }
}

/// The sections of what diagrams need. An instance keeps what it has seen, in a method too.
fn sections(what: What, variables: &[(String, String)]) -> String {
    let is_instance = |it: &(String, String)| it.1.ends_with("_TRIG") && what == What::Method;
    // An instance that is drawn twice has one ENO.
    let mut seen = FxHashSet::default();
    let variables: Vec<_> = variables.iter().filter(|it| seen.insert(&it.0)).collect();
    let section = |keyword: &str, of: &dyn Fn(&(String, String)) -> bool| {
        let lines: String =
            variables.iter().filter(|it| of(it)).map(|(name, ty)| format!("{name} : {ty};\n")).collect();
        if lines.is_empty() { lines } else { format!("\n{keyword}\n{lines}END_VAR\n") }
    };
    section("VAR", &|it| !is_instance(it)) + &section("VAR_INST", &is_instance)
}

/// A POU, a method or an accessor that was opened, to its end.
fn unit<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    what: What,
    element: Element<'t>,
    diagrams: &mut Diagrams<'_>,
) -> Result<Unit<'t>, Broken> {
    let name = element.attribute(file, "name").unwrap_or_default();
    let outer = diagrams.enter(what, name);
    let unit = whole_unit(file, reader, what, element, diagrams);
    diagrams.leave(what, outer);
    unit
}

fn whole_unit<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    what: What,
    element: Element<'t>,
    diagrams: &mut Diagrams<'_>,
) -> Result<Unit<'t>, Broken> {
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
                let body = body(file, reader, &mut unit, diagrams)?;
                unit.take_body(body, element.place);
                continue;
            }
            "transitions" => {
                transitions(file, reader, diagrams)?;
                continue;
            }
            "action" | "Action" => What::Action,
            "Method" => What::Method,
            "Property" => What::Property,
            "GetAccessor" => What::Get,
            "SetAccessor" => What::Set,
            "actions" | "Actions" | "Methods" | "Properties" | "addData" | "data" => {
                parts(file, reader, &mut unit, diagrams)?;
                continue;
            }
            _ => {
                reader.skip()?;
                continue;
            }
        };
        unit.parts.push(self::unit(file, reader, inner, element, diagrams)?);
    }
    unit.end = reader.last();
    // An action has the variables of its POU.
    if what != What::Action && !diagrams.variables.is_empty() {
        let words = sections(what, &std::mem::take(&mut diagrams.variables));
        unit.declaration.push(Chunk::words(words, &unit.end));
    }
    Ok(unit)
}

/// What lies deeper in a unit, between elements that only hold others.
fn parts<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    unit: &mut Unit<'t>,
    diagrams: &mut Diagrams<'_>,
) -> Result<(), Broken> {
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
        unit.parts.push(self::unit(file, reader, what, element, diagrams)?);
    }
    Ok(())
}

/// The conditions of a chart that have names.
fn transitions<'t>(file: &'t str, reader: &mut Reader<'t>, diagrams: &mut Diagrams<'_>) -> Result<(), Broken> {
    let mut name = String::new();
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
        let found = match element.name {
            "transition" => {
                name = element.attribute(file, "name").unwrap_or_default().to_ascii_uppercase();
                open += 1;
                continue;
            }
            "ST" => chart::Transition::Text(text(reader)?),
            "LD" | "FBD" => chart::Transition::Diagram(drawn::diagram(file, reader)?),
            other => match language(other) {
                Some(language) => {
                    reader.skip()?;
                    chart::Transition::Other(language)
                }
                None => {
                    open += 1;
                    continue;
                }
            },
        };
        diagrams.transitions.insert(std::mem::take(&mut name), found);
    }
    Ok(())
}

fn body<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    unit: &mut Unit<'t>,
    diagrams: &mut Diagrams<'_>,
) -> Result<Body, Broken> {
    let mut body = Body::None;
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => match element.name {
                "ST" => body = Body::Text(text(reader)?),
                "LD" | "FBD" => body = diagram(file, reader, diagrams)?,
                "SFC" if unit.what == What::Unit && !diagrams.context.is_codesys() => {
                    body = chart(file, reader, unit, diagrams)?;
                }
                name => {
                    body = language(name).map_or(body, |it| Body::Other(it, element.place));
                    reader.skip()?;
                }
            },
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(body)
}

fn diagram<'t>(file: &'t str, reader: &mut Reader<'t>, diagrams: &mut Diagrams<'_>) -> Result<Body, Broken> {
    let context = Context { action: &diagrams.action, ..diagrams.context };
    let drawn = drawn::diagram(file, reader)?;
    Ok(Body::Text(match diagram::write(file, &drawn, context, &mut diagrams.names) {
        Ok(Written { statements, variables, groups: _ }) => {
            diagrams.variables.extend(variables);
            statements
        }
        Err(refusal) => refused(refusal, &format!("the diagram of `{}`", diagrams.context.pou)),
    }))
}

fn chart<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    unit: &mut Unit<'t>,
    diagrams: &mut Diagrams<'_>,
) -> Result<Body, Broken> {
    let parts = chart::Parts::of(unit, &diagrams.transitions);
    let read = chart::read(file, reader, diagrams.context, &mut diagrams.names, parts)?;
    Ok(Body::Text(match read {
        Ok(chart::Written { text, variables }) => {
            diagrams.variables.extend(variables);
            text
        }
        Err(refusal) => refused(refusal, &format!("the chart of `{}`", diagrams.context.pou)),
    }))
}

/// What is reported instead of a body.
fn refused(refusal: Refusal, what: &str) -> Vec<Chunk> {
    let Refusal { place, trouble, message } = refusal;
    vec![Chunk { place, says: Says::Wrong(trouble, format!("{what}: {message}")) }]
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
        "SFC" => Some("a sequential function chart (SFC)"),
        "CFC" => Some("a continuous function chart (CFC)"),
        "IL" => Some("Instruction List (IL)"),
        _ => None,
    }
}
