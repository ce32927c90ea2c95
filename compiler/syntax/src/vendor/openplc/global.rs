//! Global variables: those of the resource, and lists of them, which are structures.

use super::super::assembly::{Assembly, Chunk};
use super::super::json::{Kind, Value};
use super::object::Object;
use super::variable::{Of, blocks, declaration, unknown};

/// Those of the resource.
pub fn variables(file: &str, resource: &Object<'_>, out: &mut Assembly) {
    let blocks = blocks(file, resource.list("globalVariables", out), "VAR_GLOBAL", out);
    out.copy(file, &blocks);
}

/// A list whose name is before its variables', `GVL.x`: one variable of a structure, as the editor compiles it. So its
/// variables have no addresses, and one without variables is nothing.
pub fn list(file: &str, value: &Value, out: &mut Assembly) {
    let Some(object) = Object::required(file, value, "a list of global variables", out) else { return };
    let Some(name) = object.name("name", "a list of global variables", out) else { return };
    let Some(qualifier) = qualifier(&object, out) else { return };
    let place = &name.place;
    let mut chunks = vec![Chunk::words("TYPE ", place)];
    chunks.extend(name.chunks(file));
    chunks.push(Chunk::words("_TYPE : STRUCT\n", place));
    let before = chunks.len();
    for it in object.list("variables", out) {
        let member = Object::required(file, it, "a variable", out);
        chunks.extend(member.and_then(|it| declaration(&it, Of::Structure, out)).unwrap_or_default());
    }
    if chunks.len() == before {
        return;
    }
    chunks.push(Chunk::words(format!("END_STRUCT; END_TYPE\nVAR_GLOBAL {qualifier}\n    "), place));
    chunks.extend(name.chunks(file));
    chunks.push(Chunk::words(" : ", place));
    chunks.extend(name.chunks(file));
    chunks.push(Chunk::words("_TYPE;\nEND_VAR\n", place));
    out.copy(file, &chunks);
}

fn qualifier<'t>(object: &Object<'t>, out: &mut Assembly) -> Option<&'t str> {
    match object.word("qualifier", out) {
        None => Some(""),
        Some(it @ ("CONSTANT" | "RETAIN" | "PERSISTENT" | "NON_RETAIN")) => Some(it),
        Some(other) => unknown(object, "qualifier", other, out),
    }
}

/// Whether a project has such lists.
pub fn has_lists(data: &Object<'_>) -> bool {
    matches!(data.get("globalVariableLists").map(|it| &it.kind), Some(Kind::List(_)))
}
