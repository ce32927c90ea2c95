//! A POU in JSON, as the editors before v4.1 held them: its variables are a table, its body is a text or a diagram.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::super::json::{Kind, Value};
use super::super::unit::{Body, Unit, What};
use super::drawn::{self, Language, Pou};
use super::object::{Object, comment};
use super::other_language;
use super::variable::{blocks, unknown};

pub fn read(file: &str, value: &Value, out: &mut Assembly) {
    let Some(whole) = Object::required(file, value, "a POU", out) else { return };
    let Some(data) = whole.needed("data", "a POU", out) else { return };
    let Some(name) = data.name("name", "a POU", out) else { return };
    let Some(word) = keyword(&whole, out) else { return };
    let mut unit = Unit::new(What::Unit, name.raw(file), whole.start());
    unit.end = value.place.end - 1..value.place.end;
    unit.declaration = declaration(&data, word, name, out);
    unit.body = body(&data, name, &mut unit.declaration, out);
    unit.write(file, out);
}

fn keyword(whole: &Object<'_>, out: &mut Assembly) -> Option<&'static str> {
    match whole.word("type", out).unwrap_or_default() {
        "program" => Some("PROGRAM "),
        "function" => Some("FUNCTION "),
        "function-block" => Some("FUNCTION_BLOCK "),
        other => unknown(whole, "type", other, out),
    }
}

/// The head and the variables.
fn declaration(data: &Object<'_>, word: &str, name: &Value, out: &mut Assembly) -> Vec<Chunk> {
    let file = data.file;
    let mut chunks = Vec::new();
    if let Some(comment) = comment(data, out) {
        let place = comment.place.clone();
        chunks.extend([comment, Chunk::words("\n", &place)]);
    }
    chunks.push(Chunk::words(word, &name.place));
    chunks.extend(name.chunks(file));
    if let Some(result) = data.text("returnType", out).filter(|_| word == "FUNCTION ") {
        chunks.push(Chunk::words(" : ", &result.place));
        chunks.extend(result.chunks(file));
    }
    chunks.push(Chunk::words("\n", &name.place));
    match data.text("variablesText", out) {
        Some(text) => chunks.extend(text.chunks(file)),
        None => chunks.extend(blocks(file, data.list("variables", out), "VAR", out)),
    }
    chunks
}

fn body(data: &Object<'_>, name: &Value, declaration: &mut Vec<Chunk>, out: &mut Assembly) -> Body {
    let Some(body) = data.object("body", out) else { return Body::None };
    let word = body.word("language", out).unwrap_or("st");
    if let (Some(language), Some(value)) = (Language::named(word), body.get("value")) {
        let variables = match data.text("variablesText", out) {
            Some(text) => drawn::in_text(&text.text(data.file)),
            None => drawn::in_table(data, out),
        };
        let pou = Pou { name: name.raw(data.file), variables };
        let (statements, variables) = drawn::read(data.file, value, language, &pou, out);
        declaration.push(Chunk::words(variables, &body.start()));
        return Body::Text(statements);
    }
    let language = match word {
        "st" => return body.get("value").map_or(Body::None, |it| text(data.file, it, out)),
        "sfc" => Some("a sequential function chart (SFC)"),
        other => other_language::named(other),
    };
    let place = body.get("language").map_or(body.start(), |it| it.place.clone());
    match language {
        Some(language) => Body::Other(language, place),
        None => unknown(&body, "language", word, out).unwrap_or(Body::None),
    }
}

fn text(file: &str, value: &Value, out: &mut Assembly) -> Body {
    if value.kind == Kind::Text {
        return Body::Text(value.chunks(file));
    }
    let message = format!("a body in Structured Text must be a string, not {}", value.what());
    out.problem(Trouble::Odd, message, &(value.place.start..value.place.start + 1));
    Body::None
}
