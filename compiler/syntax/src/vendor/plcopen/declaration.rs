//! Declarations that are elements, in Structured Text: each name and value at its place in the file.

use super::super::assembly::Chunk;
use super::super::unit::What;
use super::super::xml::{Broken, Element, Part, Reader};
use core::ops::Range;

type Chunks = Result<Vec<Chunk>, Broken>;

/// What a unit begins with, without its result.
pub fn head<'t>(file: &'t str, what: What, element: &Element<'t>) -> Vec<Chunk> {
    let keyword = match (what, element.attribute(file, "pouType")) {
        (What::Unit, Some("program")) => "PROGRAM ",
        (What::Unit, Some("function")) => "FUNCTION ",
        (What::Unit, _) if element.name == "Interface" => "INTERFACE ",
        (What::Unit, _) => "FUNCTION_BLOCK ",
        (What::Method, _) => "METHOD ",
        (What::Property, _) => "PROPERTY ",
        (What::Get | What::Set | What::Action, _) => return Vec::new(),
    };
    let mut chunks = vec![Chunk::words(keyword, &element.place)];
    chunks.extend(element.attribute_text(file, "name"));
    chunks
}

/// The declaration of a unit: its text where CODESYS gives it, else what the elements say.
pub fn interface<'t>(file: &'t str, reader: &mut Reader<'t>, what: What, mut said: Vec<Chunk>) -> Chunks {
    let mut result = Vec::new();
    let mut sections = Vec::new();
    let (mut plain, mut heritage) = (None, Vec::new());
    // Elements that only hold others.
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) => match (element.name, section(element.name)) {
                ("returnType", _) => {
                    result.push(Chunk::words(" : ", &element.place));
                    result.extend(ty_within(file, reader)?);
                }
                ("Extends" | "Implements", _) => heritage.push((element.name, text_within(file, reader)?)),
                ("InterfaceAsPlainText", _) => plain = Some(reader.content("xhtml")?),
                (_, Some(keyword)) => sections.extend(variables(file, reader, &element, keyword)?),
                ("documentation", None) => reader.skip()?,
                _ => open += 1,
            },
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    if let Some(plain) = plain {
        return Ok(plain);
    }
    if matches!(what, What::Action) {
        return Ok(Vec::new());
    }
    said.extend(result);
    for (keyword, word) in [("Extends", " EXTENDS "), ("Implements", " IMPLEMENTS ")] {
        let names = heritage.iter_mut().filter(|it| it.0 == keyword).flat_map(|it| it.1.take());
        for (name, before) in names.zip(std::iter::once(word).chain(std::iter::repeat(", "))) {
            said.extend([Chunk::words(before, &name.place), name]);
        }
    }
    said.push(Chunk::words("\n", &reader.last()));
    said.extend(sections);
    Ok(said)
}

pub fn globals<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>) -> Chunks {
    variables(file, reader, element, "VAR_GLOBAL")
}

fn section(element: &str) -> Option<&'static str> {
    match element {
        "inputVars" => Some("VAR_INPUT"),
        "outputVars" => Some("VAR_OUTPUT"),
        "inOutVars" => Some("VAR_IN_OUT"),
        "localVars" => Some("VAR"),
        "tempVars" => Some("VAR_TEMP"),
        "externalVars" => Some("VAR_EXTERNAL"),
        "globalVars" => Some("VAR_GLOBAL"),
        _ => None,
    }
}

/// A section of variables that was opened, to its end; CODESYS may add it as text.
fn variables<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>, keyword: &str) -> Chunks {
    let is = |name: &str| element.attribute(file, name) == Some("true");
    let mut head = keyword.to_owned();
    for (name, word) in
        [("constant", " CONSTANT"), ("retain", " RETAIN"), ("nonretain", " NON_RETAIN"), ("persistent", " PERSISTENT")]
    {
        head.push_str(if is(name) { word } else { "" });
    }
    let head = head + "\n";
    let mut chunks = vec![Chunk::words(head.clone(), &element.place)];
    let mut plain = None;
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) if element.name == "variable" => {
                chunks.extend(variable_of(file, reader, &element, &head)?);
            }
            Some(Part::Open(element)) if element.name == "InterfaceAsPlainText" => {
                plain = Some(reader.content("xhtml")?)
            }
            Some(Part::Open(element)) if element.name == "documentation" => reader.skip()?,
            Some(Part::Open(_)) => open += 1,
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    chunks.push(Chunk::words("END_VAR\n", &reader.last()));
    Ok(plain.unwrap_or(chunks))
}

/// A variable of a section that begins with `head`; one that says that it is of another one is in a section of its own,
/// so that the order stays.
fn variable_of<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>, head: &str) -> Chunks {
    let (mut chunks, section) = variable(file, reader, element)?;
    if let Some(section) = section {
        chunks.insert(0, Chunk::words(format!("END_VAR\n{section}\n"), &element.place));
        chunks.push(Chunk::words(format!("END_VAR\n{head}"), &element.place));
    }
    Ok(chunks)
}

/// `name AT %IX0.0 : INT := 5;`, and the section that it says that it is of.
fn variable<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    element: &Element<'t>,
) -> Result<(Vec<Chunk>, Option<&'static str>), Broken> {
    let place = &element.place;
    let mut chunks: Vec<Chunk> = element.attribute_text(file, "name").into_iter().collect();
    if let Some(address) = element.attribute_text(file, "address") {
        chunks.extend([Chunk::words(" AT ", place), address]);
    }
    let (mut ty, mut initial, mut section) = (Vec::new(), Vec::new(), None);
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if element.name == "type" => ty = ty_within(file, reader)?,
            Part::Open(element) if element.name == "initialValue" => initial = value_within(file, reader)?,
            Part::Open(element) if element.name == "addData" => {
                if let Some(open) = open_array(file, reader)? {
                    ty = vec![open.ty];
                    section = open.section;
                }
            }
            Part::Open(_) => reader.skip()?,
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    chunks.push(Chunk::words(" : ", place));
    chunks.extend(ty);
    if !initial.is_empty() {
        chunks.push(Chunk::words(" := ", place));
        chunks.extend(initial);
    }
    chunks.push(Chunk::words(";\n", place));
    Ok((chunks, section))
}

/// What CODESYS writes as an input that is a pointer, and is an `ARRAY[*]`.
struct OpenArray {
    ty: Chunk,
    /// The section that it is declared in.
    section: Option<&'static str>,
}

/// The attributes that say so, in data that was opened, to its end.
fn open_array<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Option<OpenArray>, Broken> {
    let (mut ty, mut section) = (None, None);
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) => {
                open += 1;
                let value = element.attribute(file, "Value");
                match element.attribute(file, "Name").filter(|_| element.name == "Attribute") {
                    Some("variable_length_array") => ty = element.attribute_text(file, "Value"),
                    Some("variable_length_array_original_scope") => section = value.and_then(section_of_scope),
                    _ => {}
                }
            }
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    Ok(ty.map(|ty| OpenArray { ty, section }))
}

fn section_of_scope(scope: &str) -> Option<&'static str> {
    let scopes = [("Input", "VAR_INPUT"), ("Output", "VAR_OUTPUT"), ("Inout", "VAR_IN_OUT")];
    scopes.into_iter().find(|it| it.0.eq_ignore_ascii_case(scope)).map(|it| it.1)
}

/// `TYPE name : …; END_TYPE`
pub fn data_type<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>) -> Chunks {
    let place = &element.place;
    let mut chunks = vec![Chunk::words("TYPE ", place)];
    chunks.extend(element.attribute_text(file, "name"));
    let (mut ty, mut initial) = (Vec::new(), Vec::new());
    let mut plain = None;
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) => match element.name {
                "baseType" => ty = ty_within(file, reader)?,
                "initialValue" => initial = value_within(file, reader)?,
                "InterfaceAsPlainText" => plain = Some(reader.content("xhtml")?),
                "documentation" => reader.skip()?,
                _ => open += 1,
            },
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    if let Some(mut plain) = plain {
        plain.push(Chunk::words("\n", &reader.last()));
        return Ok(plain);
    }
    chunks.push(Chunk::words(" : ", place));
    chunks.extend(ty);
    if !initial.is_empty() {
        chunks.push(Chunk::words(" := ", place));
        chunks.extend(initial);
    }
    chunks.push(Chunk::words(";\nEND_TYPE\n", place));
    Ok(chunks)
}

/// The type in an element that was opened, to the element's end.
pub fn ty_within<'t>(file: &'t str, reader: &mut Reader<'t>) -> Chunks {
    let mut chunks = Vec::new();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => chunks.extend(ty(file, reader, &element)?),
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(chunks)
}

fn ty<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>) -> Chunks {
    let place = &element.place;
    match element.name {
        "derived" => {
            let name = element.attribute_text(file, "name");
            reader.skip()?;
            Ok(name.into_iter().collect())
        }
        "string" | "wstring" => {
            let mut chunks = vec![Chunk::words(element.name.to_uppercase(), place)];
            if let Some(length) = element.attribute_text(file, "length") {
                chunks.extend([Chunk::words("[", place), length, Chunk::words("]", place)]);
            }
            reader.skip()?;
            Ok(chunks)
        }
        "pointer" => {
            let mut chunks = vec![Chunk::words("POINTER TO ", place)];
            chunks.extend(nested(file, reader)?.base);
            Ok(chunks)
        }
        "array" => {
            let inner = nested(file, reader)?;
            let mut chunks = vec![Chunk::words("ARRAY[", place)];
            chunks.extend(listed(inner.items, ", ", place));
            chunks.push(Chunk::words("] OF ", place));
            chunks.extend(inner.base);
            Ok(chunks)
        }
        "subrangeSigned" | "subrangeUnsigned" => {
            let inner = nested(file, reader)?;
            let mut chunks = inner.base;
            chunks.push(Chunk::words("(", place));
            chunks.extend(listed(inner.items, ", ", place));
            chunks.push(Chunk::words(")", place));
            Ok(chunks)
        }
        "enum" => {
            let inner = nested(file, reader)?;
            let mut chunks = vec![Chunk::words("(", place)];
            chunks.extend(listed(inner.items, ", ", place));
            chunks.push(Chunk::words(") ", place));
            chunks.extend(inner.base);
            Ok(chunks)
        }
        "struct" => {
            let mut chunks = vec![Chunk::words("STRUCT\n", place)];
            chunks.extend(nested(file, reader)?.items.into_iter().flatten());
            chunks.push(Chunk::words("END_STRUCT", &reader.last()));
            Ok(chunks)
        }
        name => {
            reader.skip()?;
            Ok(vec![Chunk::words(name, place)])
        }
    }
}

/// What a compound type holds.
#[derive(Default)]
struct Nested {
    base: Vec<Chunk>,
    /// Dimensions, bounds, values or members.
    items: Vec<Vec<Chunk>>,
}

fn nested<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Nested, Broken> {
    let mut nested = Nested::default();
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(element)) => match element.name {
                "baseType" => nested.base = ty_within(file, reader)?,
                "variable" => nested.items.push(variable(file, reader, &element)?.0),
                "dimension" | "range" => {
                    let place = &element.place;
                    let low = element.attribute_text(file, "lower");
                    let high = element.attribute_text(file, "upper");
                    let bounds = low.into_iter().chain([Chunk::words("..", place)]).chain(high);
                    nested.items.push(bounds.collect());
                    reader.skip()?;
                }
                "value" => {
                    let mut value: Vec<Chunk> = element.attribute_text(file, "name").into_iter().collect();
                    if let Some(number) = element.attribute_text(file, "value") {
                        value.extend([Chunk::words(" := ", &element.place), number]);
                    }
                    nested.items.push(value);
                    reader.skip()?;
                }
                "documentation" => reader.skip()?,
                _ => open += 1,
            },
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    Ok(nested)
}

fn listed(items: Vec<Vec<Chunk>>, between: &str, place: &Range<usize>) -> Vec<Chunk> {
    let mut chunks = Vec::new();
    for (at, item) in items.into_iter().enumerate() {
        if at > 0 {
            chunks.push(Chunk::words(between, place));
        }
        chunks.extend(item);
    }
    chunks
}

/// The value in an element that was opened, to the element's end.
fn value_within<'t>(file: &'t str, reader: &mut Reader<'t>) -> Chunks {
    let mut chunks = Vec::new();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => chunks.extend(value(file, reader, &element)?),
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(chunks)
}

fn value<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>) -> Chunks {
    let (open, close) = match element.name {
        "simpleValue" => {
            let value = element.attribute_text(file, "value");
            reader.skip()?;
            return Ok(value.into_iter().collect());
        }
        "arrayValue" => ("[", "]"),
        "structValue" => ("(", ")"),
        _ => {
            reader.skip()?;
            return Ok(Vec::new());
        }
    };
    let place = &element.place;
    let mut items = Vec::new();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) => {
                let inner = value_within(file, reader)?;
                items.extend(item(file, &element, inner));
            }
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    if items.is_empty() {
        // It says nothing: what it is for starts as its type does.
        return Ok(Vec::new());
    }
    let mut chunks = vec![Chunk::words(open, place)];
    chunks.extend(listed(items, ", ", place));
    chunks.push(Chunk::words(close, place));
    Ok(chunks)
}

/// `member := value`, `3(value)` or the value alone; an element that says nothing is `1()`, a member is left out.
fn item<'t>(file: &'t str, element: &Element<'t>, value: Vec<Chunk>) -> Option<Vec<Chunk>> {
    let place = &element.place;
    let mut chunks = Vec::new();
    if let Some(member) = element.attribute_text(file, "member") {
        if value.is_empty() {
            return None;
        }
        chunks.extend([member, Chunk::words(" := ", place)]);
        chunks.extend(value);
    } else if let Some(count) = element.attribute_text(file, "repetitionValue") {
        chunks.extend([count, Chunk::words("(", place)]);
        chunks.extend(value);
        chunks.push(Chunk::words(")", place));
    } else if value.is_empty() {
        chunks.push(Chunk::words("1()", place));
    } else {
        chunks.extend(value);
    }
    Some(chunks)
}

/// The text of an element that was opened, to its end.
fn text_within<'t>(file: &'t str, reader: &mut Reader<'t>) -> Result<Option<Chunk>, Broken> {
    let mut found = None;
    while let Some(part) = reader.part()? {
        match part {
            Part::Text(chunk) if !file[chunk.place.clone()].trim().is_empty() => found = Some(chunk),
            Part::Text(_) => {}
            Part::Open(_) => reader.skip()?,
            Part::Close => break,
        }
    }
    Ok(found)
}
