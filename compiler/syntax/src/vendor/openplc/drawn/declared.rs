//! What is known of the variables of a diagram: its POU declares them as text, and each node holds what it knew as it was drawn.

use super::super::super::assembly::Assembly;
use super::super::super::diagram::{Declared, Unit, is_function};
use super::super::object::Object;
use super::element::{Element, elements};

/// The POU that a diagram is the body of.
pub struct Pou<'t> {
    pub name: &'t str,
    /// The variables that it declares, with their types.
    pub variables: Vec<(String, String)>,
}

/// The declarations of the POU, and of the blocks that its diagram holds.
pub fn of(body: &Object<'_>, pou: &Pou<'_>, out: &mut Assembly) -> Declared {
    let mut declared = Declared::default();
    let mut own = Unit::default();
    let mut rungs = Vec::new();
    for value in body.list("rungs", out) {
        rungs.extend(Object::required(body.file, value, "a rung", out));
    }
    rungs.extend(body.object("rung", out));
    for element in rungs.iter().flat_map(|it| elements(it, out)).collect::<Vec<_>>() {
        match element.kind {
            "block" => block(&element, &mut declared, &mut own, out),
            _ => variable(&element, &mut own, out),
        }
    }
    own.variables.extend(pou.variables.iter().cloned());
    declared.add(pou.name, own);
    declared
}

fn variable(element: &Element<'_>, own: &mut Unit, out: &mut Assembly) {
    let Some(variable) = element.data.object("variable", out) else { return };
    if let (Some(name), Some(ty)) = (variable.word("name", out), ty(&variable, out)) {
        own.variables.insert(name.to_ascii_uppercase(), ty);
    }
}

/// `"type": {"definition": "base-type", "value": "bool"}`; nothing of a generic type.
fn ty(of: &Object<'_>, out: &mut Assembly) -> Option<String> {
    let ty = of.object("type", out)?;
    let value = ty.word("value", out)?;
    (ty.word("definition", out) != Some("generic-type")).then(|| value.to_ascii_uppercase())
}

/// The pins of a block, and its instance. Standard functions are known.
fn block(element: &Element<'_>, declared: &mut Declared, own: &mut Unit, out: &mut Assembly) {
    let Some(variant) = element.data.object("variant", out) else { return };
    let Some(name) = variant.word("name", out) else { return };
    let is_instance = variant.word("type", out) == Some("function-block");
    let mut unit = Unit::default();
    for value in variant.list("variables", out) {
        let Some(pin) = Object::required(variant.file, value, "a pin", out) else { continue };
        let (Some(of), Some(ty)) = (pin.word("name", out), ty(&pin, out)) else { continue };
        let is_result = pin.word("class", out) == Some("output") && !of.eq_ignore_ascii_case("ENO");
        if is_result && !is_instance && unit.result.is_none() {
            unit.result = Some(ty.clone());
        }
        unit.variables.insert(of.to_ascii_uppercase(), ty);
    }
    if is_instance {
        let instance = element.data.object("variable", out).and_then(|it| it.word("name", out));
        own.variables.extend(instance.map(|it| (it.to_ascii_uppercase(), name.to_ascii_uppercase())));
        declared.add(name, unit);
    } else if !is_function(name) {
        declared.add(name, unit);
    }
}

/// The rows of the table that a POU has before v4.1.
pub fn in_table(pou: &Object<'_>, out: &mut Assembly) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for value in pou.list("variables", out) {
        let Some(row) = Object::required(pou.file, value, "a variable", out) else { continue };
        found.extend(row.word("name", out).map(str::to_ascii_uppercase).zip(ty(&row, out)));
    }
    found
}

/// `a, b AT %QX0.0 : BOOL := TRUE;` in sections of variables.
pub fn in_text(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let text = without_comments(text);
    for declaration in text.split(';') {
        let Some((names, rest)) = declaration.split_once(':') else { continue };
        let ty = rest.split_once(":=").map_or(rest, |it| it.0).trim().to_ascii_uppercase();
        // The editor writes an address after the type.
        let ty = ty.split_once(" AT %").map_or(ty.as_str(), |it| it.0);
        // The words that open its section are before the first name.
        let names = names.rsplit('\n').next().unwrap_or(names);
        for name in names.split(',') {
            let Some(name) = name.split_whitespace().next() else { continue };
            found.push((name.to_ascii_uppercase(), ty.to_owned()));
        }
    }
    found
}

fn without_comments(text: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    loop {
        let next = ["(*", "//"].into_iter().filter_map(|it| Some((rest.find(it)?, it))).min();
        let Some((at, open)) = next else { return kept + rest };
        kept.push_str(&rest[..at]);
        let inner = &rest[at + open.len()..];
        let close = if open == "//" { "\n" } else { "*)" };
        rest = inner.split_once(close).map_or("", |it| it.1);
        kept.push(if open == "//" { '\n' } else { ' ' });
    }
}
