//! The elements of LD and FBD, as PLCopen XML holds them.

use super::super::assembly::text;
use super::super::diagram::{Diagram, Edge, Input, Kind, Modifier, Name, Node, Output, Position, Storage, Wire};
use super::super::xml::{Broken, Element, Part, Reader};

/// The elements of a diagram that was opened, to its end.
pub fn diagram<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Diagram, Broken> {
    let mut found = Diagram::default();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => found.nodes.extend(node(file, reader, &element)?),
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(found)
}

/// An element that was opened, to its end.
pub fn node<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>) -> Result<Option<Node>, Broken> {
    let named = |name: &str| element.attribute(file, name).unwrap_or_default().to_owned();
    let kind = match element.name {
        "leftPowerRail" => Kind::LeftRail,
        "rightPowerRail" => Kind::RightRail,
        "inVariable" => Kind::Source(Vec::new()),
        "outVariable" => Kind::Sink(Vec::new()),
        "inOutVariable" => Kind::Both(Vec::new()),
        "contact" => Kind::Contact(Vec::new()),
        "coil" => Kind::Coil(Vec::new()),
        "block" => {
            let name = |attribute| name(file, element, attribute);
            let Some(ty) = name("typeName") else { return skipped(reader) };
            Kind::Block { ty, instance: name("instanceName") }
        }
        "connector" => Kind::Connector(named("name")),
        "continuation" => Kind::Continuation(named("name")),
        "label" => Kind::Refused("a label"),
        "jump" => Kind::Refused("a jump"),
        "return" => Kind::Refused("a return"),
        // Comments, and what vendors add.
        _ => return skipped(reader),
    };
    let order = element.attribute(file, "executionOrderId").and_then(|it| it.parse().ok()).unwrap_or(0);
    let mut node = Node {
        id: named("localId"),
        number: named("localId"),
        kind,
        place: element.place.clone(),
        position: Position::default(),
        order,
        modifier: modifier(file, element),
        inputs: Vec::new(),
        outputs: Vec::new(),
    };
    contents(file, reader, &mut node)?;
    Ok(Some(node))
}

/// What an attribute says, if it says something.
pub fn name(file: &str, element: &Element<'_>, attribute: &str) -> Option<Name> {
    let chunk = element.attribute_text(file, attribute)?;
    let text = text(file, std::slice::from_ref(&chunk));
    (!text.is_empty()).then_some(Name { text, chunk })
}

fn skipped(reader: &mut Reader<'_>) -> Result<Option<Node>, Broken> {
    reader.skip()?;
    Ok(None)
}

/// What is in an element that was opened, to its end.
fn contents<'t>(file: &'t str, reader: &mut Reader<'t>, node: &mut Node) -> Result<(), Broken> {
    while let Some(part) = reader.part()? {
        let element = match part {
            Part::Open(element) => element,
            Part::Close => break,
            Part::Text(_) => continue,
        };
        match element.name {
            "position" => {
                node.position = position(file, &element);
                reader.skip()?;
            }
            "connectionPointIn" => {
                let wires = wires(file, reader)?;
                node.inputs.push(Input { formal: String::new(), modifier: Modifier::default(), wires });
            }
            "connectionPointOut" => {
                node.outputs.push(output(file, reader, "", Modifier::default())?);
            }
            "expression" | "variable" => {
                let written = reader.content("")?;
                match &mut node.kind {
                    Kind::Source(it) | Kind::Sink(it) | Kind::Both(it) | Kind::Contact(it) | Kind::Coil(it) => {
                        *it = written;
                    }
                    Kind::LeftRail
                    | Kind::RightRail
                    | Kind::Block { .. }
                    | Kind::Connector(_)
                    | Kind::Continuation(_)
                    | Kind::Refused(_) => {}
                }
            }
            "inputVariables" | "inOutVariables" | "outputVariables" => pins(file, reader, node)?,
            _ => reader.skip()?,
        }
    }
    Ok(())
}

/// The pins of a block; one with both connection points is an input and an output.
fn pins<'t>(file: &'t str, reader: &mut Reader<'t>, node: &mut Node) -> Result<(), Broken> {
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if element.name == "variable" => pin(file, reader, &element, node)?,
            Part::Open(_) => reader.skip()?,
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(())
}

fn pin<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>, node: &mut Node) -> Result<(), Broken> {
    let formal = element.attribute(file, "formalParameter").unwrap_or_default();
    let modifier = modifier(file, element);
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if element.name == "connectionPointIn" => {
                let wires = wires(file, reader)?;
                node.inputs.push(Input { formal: formal.to_owned(), modifier, wires });
            }
            Part::Open(element) if element.name == "connectionPointOut" => {
                node.outputs.push(output(file, reader, formal, modifier)?);
            }
            Part::Open(_) => reader.skip()?,
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(())
}

/// What a connection point that was opened is wired to, to its end.
pub fn wires<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Vec<Wire>, Broken> {
    let mut found = Vec::new();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if element.name == "connection" => {
                let named = |name: &str| element.attribute(file, name).map(ToOwned::to_owned);
                let (from, formal) = (named("refLocalId").unwrap_or_default(), named("formalParameter"));
                let mut end = None;
                while let Some(part) = reader.part()? {
                    match part {
                        Part::Open(point) => {
                            end = (point.name == "position").then(|| position(file, &point)).or(end);
                            reader.skip()?;
                        }
                        Part::Close => break,
                        Part::Text(_) => {}
                    }
                }
                found.push(Wire { from, formal, end, place: element.place });
            }
            Part::Open(_) => reader.skip()?,
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(found)
}

/// A connection point that was opened, to its end.
fn output<'t>(file: &'t str, reader: &mut Reader<'t>, formal: &str, modifier: Modifier) -> Result<Output, Broken> {
    let mut output = Output { formal: formal.to_owned(), modifier, at: None, target: Vec::new() };
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if element.name == "expression" => output.target = reader.content("")?,
            Part::Open(element) => {
                output.at = (element.name == "relPosition").then(|| position(file, &element)).or(output.at);
                reader.skip()?;
            }
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(output)
}

fn position<'t>(file: &'t str, element: &Element<'t>) -> Position {
    let of = |name: &str| element.attribute(file, name)?.trim().parse().ok();
    Position { x: of("x").unwrap_or(0), y: of("y").unwrap_or(0) }
}

fn modifier<'t>(file: &'t str, element: &Element<'t>) -> Modifier {
    let of = |name: &str| element.attribute(file, name);
    let storage = match of("storage") {
        Some("set") => Some(Storage::Set),
        Some("reset") => Some(Storage::Reset),
        Some(_) | None => None,
    };
    let edge = match of("edge") {
        Some("rising") => Some(Edge::Rising),
        Some("falling") => Some(Edge::Falling),
        Some(_) | None => None,
    };
    Modifier { negated: of("negated") == Some("true"), storage, edge }
}
