//! What the nodes of both languages have.

use super::super::super::assembly::{Assembly, Chunk};
use super::super::super::diagram::{Edge, Input, Kind, Modifier, Name, Node, Output, Position, Storage, Wire};
use super::super::super::json::{Kind as Json, Value};
use super::super::object::Object;
use core::ops::Range;

/// A node, and what it says of itself.
#[derive(Clone, Copy)]
pub struct Element<'t> {
    pub id: &'t str,
    /// Its kind, as the editor calls it.
    pub kind: &'t str,
    object: Object<'t>,
    pub data: Object<'t>,
}

/// From a pin to a pin.
pub struct Line<'t> {
    pub from: &'t str,
    pub from_pin: &'t str,
    pub to: &'t str,
    pub to_pin: &'t str,
    pub place: Range<usize>,
}

/// The nodes of a rung.
pub fn elements<'t>(rung: &Object<'t>, out: &mut Assembly) -> Vec<Element<'t>> {
    let mut found = Vec::new();
    for value in rung.list("nodes", out) {
        let Some(object) = Object::required(rung.file, value, "an element", out) else { continue };
        let Some(data) = object.needed("data", "an element", out) else { continue };
        let (Some(id), Some(kind)) = (object.word("id", out), object.word("type", out)) else { continue };
        found.push(Element { id, kind, object, data });
    }
    found
}

pub fn lines<'t>(rung: &Object<'t>, out: &mut Assembly) -> Vec<Line<'t>> {
    let mut found = Vec::new();
    for value in rung.list("edges", out) {
        let Some(object) = Object::required(rung.file, value, "a wire", out) else { continue };
        let (Some(from), Some(to)) = (object.word("source", out), object.word("target", out)) else { continue };
        let pin = |name: &str, out: &mut Assembly| object.word(name, out).unwrap_or_default();
        let (from_pin, to_pin) = (pin("sourceHandle", out), pin("targetHandle", out));
        found.push(Line { from, from_pin, to, to_pin, place: object.start() });
    }
    found
}

impl<'t> Element<'t> {
    /// Where it is in the file: where it is named, if it is.
    pub fn place(&self, out: &mut Assembly) -> Range<usize> {
        let named = self.variable_value(out).map(inner);
        let id = self.object.get("id").map(|it| it.place.clone());
        named.or(id).unwrap_or_else(|| self.object.start())
    }

    /// `numericId`, if it is that.
    fn number(&self, out: &mut Assembly) -> String {
        let number = self.data.word("numericId", out).unwrap_or_default();
        number.chars().filter(char::is_ascii_digit).collect()
    }

    fn variable_value(&self, out: &mut Assembly) -> Option<&'t Value> {
        self.data.object("variable", out)?.text("name", out)
    }

    /// The variable or expression at it; empty where it has none.
    pub fn variable(&self, out: &mut Assembly) -> Vec<Chunk> {
        self.variable_value(out).map(|it| it.chunks(self.data.file)).unwrap_or_default()
    }

    pub fn has_variable(&self, out: &mut Assembly) -> bool {
        self.variable_value(out).is_some()
    }

    /// What a wire's end is called.
    pub fn connector(&self, name: &str, out: &mut Assembly) -> Option<&'t str> {
        self.data.object(name, out)?.word("id", out)
    }

    /// The pins of a list.
    pub fn pins(&self, name: &str, out: &mut Assembly) -> Vec<&'t str> {
        let mut found = Vec::new();
        for value in self.data.list(name, out) {
            let Some(object) = Object::required(self.data.file, value, "a pin", out) else { continue };
            found.extend(object.word("id", out));
        }
        found
    }

    /// A node of a diagram, `below` so many pixels.
    pub fn node(&self, kind: Kind, below: i64, out: &mut Assembly) -> Node {
        let position = self.object.object("position", out);
        let at = |name: &str| position.and_then(|it| number(&it, name)).unwrap_or(0);
        let (x, y) = (at("x"), at("y"));
        let order = number(&self.data, "executionOrder").and_then(|it| u64::try_from(it).ok()).unwrap_or(0);
        Node {
            id: self.id.to_owned(),
            number: self.number(out),
            kind,
            place: self.place(out),
            position: Position { x, y: y.saturating_add(below) },
            order,
            modifier: self.modifier(out),
            inputs: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Of a contact or a coil its variant, of a variable of FBD whether it is negated.
    fn modifier(&self, out: &mut Assembly) -> Modifier {
        let is_negated = self.data.get("negated").is_some_and(|it| it.raw(self.data.file) == "true");
        let variant = match self.kind {
            "contact" | "coil" => self.data.word("variant", out).unwrap_or_default(),
            _ => "",
        };
        let storage = match variant {
            "set" => Some(Storage::Set),
            "reset" => Some(Storage::Reset),
            _ => None,
        };
        let edge = match variant {
            "risingEdge" => Some(Edge::Rising),
            "fallingEdge" => Some(Edge::Falling),
            _ => None,
        };
        Modifier { negated: is_negated || variant == "negated", storage, edge }
    }

    /// The kind of a block: a function, or an instance.
    pub fn block(&self, out: &mut Assembly) -> Option<Kind> {
        let variant = self.data.needed("variant", "a block", out)?;
        let named = |value: &Value| {
            let text = value.text(self.data.file);
            let is_plain = value.raw(self.data.file) == text;
            let chunk =
                if is_plain { Chunk::verbatim(inner(value)) } else { Chunk::words(text.as_str(), &inner(value)) };
            Name { text, chunk }
        };
        let ty = named(variant.text("name", out)?);
        let is_instance = variant.word("type", out) == Some("function-block");
        let instance = self.variable_value(out).filter(|_| is_instance).map(named);
        Some(Kind::Block { ty, instance })
    }
}

fn inner(value: &Value) -> Range<usize> {
    value.place.start + 1..value.place.end - 1
}

/// A whole number, of which a part may be cut off.
pub fn number(object: &Object<'_>, name: &str) -> Option<i64> {
    let value = object.get(name).filter(|it| it.kind == Json::Number)?;
    let text = value.raw(object.file);
    text.split(['.', 'e', 'E']).next().unwrap_or_default().parse().ok()
}

pub fn input(formal: &str, wires: Vec<Wire>) -> Input {
    Input { formal: formal.to_owned(), modifier: Modifier::default(), wires }
}

pub fn output(formal: &str) -> Output {
    Output { formal: formal.to_owned(), modifier: Modifier::default(), at: None, target: Vec::new() }
}
