//! The elements of SFC, as the file holds them.

use super::super::super::diagram::{Name, Wire};
use super::super::super::xml::{Broken, Element as Tag, Part, Reader};
use super::super::drawn::{name, node, wires};
use super::super::{language, text};
use super::element::{Action, Chart, Condition, Does, Element, Kind};

/// The elements of a chart that was opened, to its end.
pub fn chart<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Chart, Broken> {
    let mut found = Chart::default();
    while let Some(part) = reader.part()? {
        let tag = match part {
            Part::Open(tag) => tag,
            Part::Close => break,
            Part::Text(_) => continue,
        };
        let named = |attribute| name(file, &tag, attribute);
        let empty = || Name::empty(&tag.place);
        let kind = match tag.name {
            "step" => {
                let is_initial = matches!(tag.attribute(file, "initialStep"), Some("true" | "1"));
                Kind::Step { name: named("name").unwrap_or_else(empty), is_initial }
            }
            "macroStep" => Kind::Refused("a macro step"),
            "transition" => {
                let priority = tag.attribute(file, "priority").map(str::to_owned);
                Kind::Transition { priority, condition: Condition::Missing }
            }
            "actionBlock" => Kind::Actions(Vec::new()),
            "jumpStep" => Kind::Jump(named("targetName").unwrap_or_else(empty)),
            "selectionDivergence" | "selectionConvergence" | "simultaneousDivergence" | "simultaneousConvergence" => {
                Kind::Line
            }
            _ => {
                found.diagram.nodes.extend(node(file, reader, &tag)?);
                continue;
            }
        };
        let id = tag.attribute(file, "localId").unwrap_or_default().to_owned();
        let mut element = Element { id, place: tag.place, kind, inputs: Vec::new() };
        contents(file, reader, &mut element)?;
        found.elements.push(element);
    }
    Ok(found)
}

/// What is in an element that was opened, to its end.
fn contents<'t>(file: &'t str, reader: &mut Reader<'t>, element: &mut Element) -> Result<(), Broken> {
    while let Some(part) = reader.part()? {
        let tag = match part {
            Part::Open(tag) => tag,
            Part::Close => break,
            Part::Text(_) => continue,
        };
        match (tag.name, &mut element.kind) {
            ("connectionPointIn", _) => element.inputs.push(wires(file, reader)?),
            ("condition", Kind::Transition { condition, .. }) => *condition = self::condition(file, reader)?,
            ("action", Kind::Actions(actions)) => actions.push(action(file, reader, &tag)?),
            _ => reader.skip()?,
        }
    }
    Ok(())
}

fn condition<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Condition, Broken> {
    let mut found = Condition::Missing;
    let mut direct: Vec<Wire> = Vec::new();
    while let Some(part) = reader.part()? {
        let tag = match part {
            Part::Open(tag) => tag,
            Part::Close => break,
            Part::Text(_) => continue,
        };
        match tag.name {
            "reference" => {
                found = name(file, &tag, "name").map_or(Condition::Missing, Condition::Named);
                reader.skip()?;
            }
            "inline" => {
                found = match inline(reader)? {
                    Ok(text) => Condition::Text(text),
                    Err(language) => Condition::Other(language),
                };
            }
            "connectionPointIn" => found = Condition::Wired(wires(file, reader)?),
            // As the first version of the format has it.
            "connection" => {
                let formal = tag.attribute(file, "formalParameter").map(str::to_owned);
                let from = tag.attribute(file, "refLocalId").unwrap_or_default().to_owned();
                direct.push(Wire { from, formal, end: None, place: tag.place });
                reader.skip()?;
            }
            _ => reader.skip()?,
        }
    }
    Ok(if direct.is_empty() { found } else { Condition::Wired(direct) })
}

/// Text in ST, or the language that it is in instead.
fn inline(reader: &mut Reader<'_>) -> Result<Result<Vec<super::Chunk>, &'static str>, Broken> {
    let mut found = Ok(Vec::new());
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(tag) if tag.name == "ST" => found = Ok(text(reader)?),
            Part::Open(tag) => {
                found = language(tag.name).map_or(found, Err);
                reader.skip()?;
            }
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(found)
}

fn action<'t>(file: &'t str, reader: &mut Reader<'t>, tag: &Tag<'t>) -> Result<Action, Broken> {
    let mut does = Does::Missing;
    while let Some(part) = reader.part()? {
        let inner = match part {
            Part::Open(inner) => inner,
            Part::Close => break,
            Part::Text(_) => continue,
        };
        match inner.name {
            "reference" => {
                does = name(file, &inner, "name").map_or(Does::Missing, Does::Named);
                reader.skip()?;
            }
            "inline" => {
                does = match inline(reader)? {
                    Ok(text) => Does::Text(text),
                    Err(language) => Does::Other(language),
                };
            }
            _ => reader.skip()?,
        }
    }
    Ok(Action {
        qualifier: tag.attribute(file, "qualifier").unwrap_or("N").to_owned(),
        duration: tag.attribute_text(file, "duration"),
        indicator: tag.attribute_text(file, "indicator"),
        does,
        place: tag.place.clone(),
    })
}
