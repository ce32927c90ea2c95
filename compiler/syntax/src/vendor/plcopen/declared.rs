//! Reads what a project in PLCopen XML declares, for its diagrams.

use super::super::assembly::text;
use super::super::diagram::{Declared, Unit};
use super::super::xml::{Broken, Element, Part, Reader};
use super::declaration::ty_within;

/// Reads the declarations of a whole file. XML that is not well-formed is reported when the file is read.
pub fn declared(file: &str) -> Declared {
    let mut found = Declared::default();
    if let Some(mut reader) = Reader::new(file) {
        let _ = read(file, &mut reader, &mut found);
    }
    found
}

fn read<'t>(file: &'t str, reader: &mut Reader<'t>, found: &mut Declared) -> Result<(), Broken> {
    while let Some(part) = reader.part()? {
        let Part::Open(element) = part else { continue };
        match element.name {
            "pou" | "dataType" => {
                let unit = unit(file, reader, element.name)?;
                found.add(element.attribute(file, "name").unwrap_or_default(), unit);
            }
            "globalVars" => found.add_globals(unit(file, reader, element.name)?.variables),
            _ => {}
        }
    }
    Ok(())
}

/// What a POU, a type or a list of variables declares, to its end.
fn unit<'t>(file: &'t str, reader: &mut Reader<'t>, name: &str) -> Result<Unit, Broken> {
    let mut found = Unit::default();
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) => match element.name {
                "returnType" => found.result = Some(text(file, &ty_within(file, reader)?)),
                "variable" => variable(file, reader, &element, &mut found)?,
                // Bodies, and what an action declares, are not the unit's.
                "body" | "actions" | "transitions" if name == "pou" => reader.skip()?,
                _ => open += 1,
            },
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    Ok(found)
}

fn variable<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>, unit: &mut Unit) -> Result<(), Broken> {
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(inner) if inner.name == "type" => {
                let name = element.attribute(file, "name").unwrap_or_default();
                let ty = text(file, &ty_within(file, reader)?);
                unit.variables.insert(name.to_ascii_uppercase(), ty);
            }
            Part::Open(_) => reader.skip()?,
            Part::Close => break,
            Part::Text(_) => {}
        }
    }
    Ok(())
}
