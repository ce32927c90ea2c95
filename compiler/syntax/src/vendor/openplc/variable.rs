//! Declarations of variables, as the rows of the editor's tables hold them.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::super::json::{Kind, Value};
use super::object::{Object, comment, shown};

/// Of which declaration a variable is: whether it has an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    Section,
    /// Of a structure, whose members have none.
    Structure,
}

/// `name AT %QX0.0 : BOOL := TRUE; (* lamp *)`; nothing, where something essential is wrong.
pub fn declaration(object: &Object<'_>, of: Of, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let file = object.file;
    let name = object.name("name", "a variable", out)?;
    let ty = of_member(object, "type", out)?;
    let location = if of == Of::Section { object.text("location", out) } else { None };
    let mut chunks = vec![Chunk::words("    ", &name.place)];
    chunks.extend(name.chunks(file));
    if let Some(location) = location {
        chunks.push(Chunk::words(" AT ", &location.place));
        chunks.extend(place(file, location, out)?);
    }
    chunks.push(Chunk::words(" : ", &name.place));
    chunks.extend(ty);
    if let Some(value) = initial(object, out) {
        chunks.push(Chunk::words(" := ", &value.place));
        chunks.extend(value.chunks(file));
    }
    chunks.push(Chunk::words(";", &name.place));
    chunks.extend(comment(object, out));
    chunks.push(Chunk::words("\n", &name.place));
    Some(chunks)
}

/// `%QX0.0`, or the alias of a pin.
fn place(file: &str, value: &Value, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let text = value.raw(file);
    let is_it = text.chars().all(|it| it.is_alphanumeric() || matches!(it, '%' | '.' | '_' | '*'));
    if !is_it {
        let message = format!("`{}` is neither an address nor the alias of one", shown(&value.text(file)));
        out.problem(Trouble::Odd, message, &value.place);
        return None;
    }
    Some(value.chunks(file))
}

/// What a variable or a type starts with, unless that is left open: a text, or `{"simpleValue": {"value": "1"}}`.
pub fn initial<'t>(object: &Object<'t>, out: &mut Assembly) -> Option<&'t Value> {
    match object.get("initialValue")?.kind {
        Kind::Object(_) => object.object("initialValue", out)?.object("simpleValue", out)?.text("value", out),
        Kind::Null | Kind::Truth | Kind::Number | Kind::Text | Kind::List(_) => object.text("initialValue", out),
    }
}

/// The type that a member names.
pub fn of_member(object: &Object<'_>, name: &str, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let Some(value) = object.get(name) else {
        out.problem(Trouble::Odd, format!("this has no `{name}`"), &object.start());
        return None;
    };
    type_of(object.file, value, out)
}

/// `{"definition": "base-type", "value": "bool"}`; of an array also its bounds, and the type of its elements.
fn type_of(file: &str, value: &Value, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let object = Object::required(file, value, "a type", out)?;
    let data = if object.word("definition", out) == Some("array") { object.object("data", out) } else { None };
    if let Some(data) = data.filter(|it| it.get("dimensions").is_some()) {
        return array(&data, out);
    }
    let Some(value) = object.text("value", out) else {
        out.problem(Trouble::Odd, "this type has no `value`".to_owned(), &object.start());
        return None;
    };
    let text = value.raw(file);
    let is_it = text.chars().all(|it| it.is_alphanumeric() || " _.,[]()#-+".contains(it));
    if !is_it {
        out.problem(Trouble::Odd, format!("`{}` is not a type", shown(&value.text(file))), &value.place);
        return None;
    }
    Some(value.chunks(file))
}

/// `ARRAY[0..9, 1..2] OF INT`; without bounds, the type of the elements alone.
pub fn array(object: &Object<'_>, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let (file, place) = (object.file, object.start());
    let elements = of_member(object, "baseType", out)?;
    let mut chunks = Vec::new();
    for it in object.list("dimensions", out) {
        let bounds = Object::required(file, it, "a dimension", out)?.text("dimension", out)?;
        let is_it = bounds.raw(file).chars().all(|it| it.is_alphanumeric() || " _.#-+*".contains(it));
        if !is_it {
            let message = format!("`{}` does not give the bounds of an array", shown(&bounds.text(file)));
            out.problem(Trouble::Odd, message, &bounds.place);
            return None;
        }
        chunks.push(Chunk::words(if chunks.is_empty() { "ARRAY[" } else { ", " }, &bounds.place));
        chunks.extend(bounds.chunks(file));
    }
    if !chunks.is_empty() {
        chunks.push(Chunk::words("] OF ", &place));
    }
    chunks.extend(elements);
    Some(chunks)
}

/// Declarations in the order of the file, each run of one section in a block. `section` names what a variable without a
/// class is.
pub fn blocks(file: &str, variables: &[Value], section: &str, out: &mut Assembly) -> Vec<Chunk> {
    let (mut blocks, mut opened) = (Vec::new(), None);
    for value in variables {
        let Some(object) = Object::required(file, value, "a variable", out) else { continue };
        let Some(head) = head(&object, section, out) else { continue };
        let Some(chunks) = declaration(&object, Of::Section, out) else { continue };
        if opened.as_ref() != Some(&head) {
            let end = if opened.is_some() { "END_VAR\n" } else { "" };
            blocks.push(Chunk::words(format!("{end}{head}\n"), &object.start()));
            opened = Some(head);
        }
        blocks.extend(chunks);
    }
    if let (true, Some(last)) = (opened.is_some(), variables.last()) {
        blocks.push(Chunk::words("END_VAR\n", &(last.place.end - 1..last.place.end)));
    }
    blocks
}

/// `VAR_INPUT`, `VAR RETAIN`
fn head(object: &Object<'_>, section: &str, out: &mut Assembly) -> Option<String> {
    let word = match object.word("class", out) {
        // A POU's own variable may be of this class, too.
        None | Some("global") => section,
        Some("local") => "VAR",
        Some("input") => "VAR_INPUT",
        Some("output") => "VAR_OUTPUT",
        Some("inOut") => "VAR_IN_OUT",
        Some("external") => "VAR_EXTERNAL",
        Some("temp") => "VAR_TEMP",
        Some(other) => return unknown(object, "class", other, out),
    };
    match object.word("flag", out) {
        None => Some(word.to_owned()),
        Some("constant") => Some(format!("{word} CONSTANT")),
        Some("retain") => Some(format!("{word} RETAIN")),
        Some(other) => unknown(object, "flag", other, out),
    }
}

/// Reports a word that the editor does not write.
pub fn unknown<T>(object: &Object<'_>, name: &str, word: &str, out: &mut Assembly) -> Option<T> {
    let place = object.get(name).map_or(object.start(), |it| it.place.clone());
    out.problem(Trouble::Odd, format!("OpenPLC Editor has no `{name}` called `{}`", shown(word)), &place);
    None
}
