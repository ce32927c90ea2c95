//! Data types: structures, enumerations and arrays.

use super::super::assembly::{Assembly, Chunk};
use super::super::json::Value;
use super::object::{Object, comment, is_name};
use super::variable::{Of, array, declaration, initial, unknown};

/// `TYPE Name : … := …; END_TYPE`
pub fn write(file: &str, value: &Value, out: &mut Assembly) {
    let Some(object) = Object::required(file, value, "a data type", out) else { return };
    let Some(name) = object.name("name", "a data type", out) else { return };
    let Some(kind) = kind(&object, out) else { return };
    let mut chunks = vec![Chunk::words("TYPE ", &name.place)];
    chunks.extend(name.chunks(file));
    chunks.push(Chunk::words(" : ", &name.place));
    chunks.extend(kind);
    if let Some(value) = initial(&object, out) {
        chunks.push(Chunk::words(" := ", &value.place));
        chunks.extend(value.chunks(file));
    }
    chunks.push(Chunk::words(";", &name.place));
    chunks.extend(comment(&object, out));
    chunks.push(Chunk::words("\nEND_TYPE\n", &name.place));
    out.copy(file, &chunks);
}

fn kind(object: &Object<'_>, out: &mut Assembly) -> Option<Vec<Chunk>> {
    match object.word("derivation", out).unwrap_or_default() {
        "enumerated" => Some(enumeration(object, out)),
        "structure" => Some(structure(object, out)),
        "array" => array(object, out),
        other => unknown(object, "derivation", other, out),
    }
}

/// `(Red, Green)`, `USINT (Idle := 0, Run)`
fn enumeration(object: &Object<'_>, out: &mut Assembly) -> Vec<Chunk> {
    let (file, place, mut chunks) = (object.file, object.start(), Vec::new());
    if let Some(base) = object.text("baseType", out).filter(|it| is_name(file, it, out)) {
        chunks.extend(base.chunks(file));
        chunks.push(Chunk::words(" ", &place));
    }
    let mut between = "(";
    for it in object.list("values", out) {
        let Some(object) = Object::required(file, it, "a value of an enumeration", out) else { continue };
        let Some(name) = object.name("description", "a value of an enumeration", out) else { continue };
        chunks.push(Chunk::words(between, &name.place));
        chunks.extend(name.chunks(file));
        if let Some(number) = object.text("value", out) {
            chunks.push(Chunk::words(" := ", &number.place));
            chunks.extend(number.chunks(file));
        }
        between = ", ";
    }
    let end = if between == "(" { "()" } else { ")" };
    chunks.push(Chunk::words(end, &place));
    chunks
}

fn structure(object: &Object<'_>, out: &mut Assembly) -> Vec<Chunk> {
    let (file, place) = (object.file, object.start());
    let mut chunks = vec![Chunk::words("STRUCT\n", &place)];
    for it in object.list("variable", out) {
        let member = Object::required(file, it, "a member of a structure", out);
        chunks.extend(member.and_then(|it| declaration(&it, Of::Structure, out)).unwrap_or_default());
    }
    chunks.push(Chunk::words("END_STRUCT", &place));
    chunks
}
