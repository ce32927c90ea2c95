//! A function block diagram: one field of nodes.

use super::super::super::assembly::{Assembly, text};
use super::super::super::diagram::{Diagram, Kind, Node, Wire};
use super::super::object::Object;
use super::element::{Element, Line, elements, input, lines, output};

pub fn read(body: &Object<'_>, diagram: &mut Diagram, out: &mut Assembly) {
    let Some(rung) = body.object("rung", out) else { return };
    let (elements, lines) = (elements(&rung, out), lines(&rung, out));
    for element in &elements {
        diagram.nodes.extend(node(element, &elements, &lines, out));
    }
    // The editor writes elements of one kind after the other; what is at one place is executed in that order.
    diagram.nodes.sort_by_key(|it| match it.kind {
        Kind::Block { .. } => 0,
        Kind::Source(_) => 1,
        Kind::Both(_) => 2,
        Kind::Sink(_) => 3,
        Kind::Connector(_) => 4,
        Kind::Continuation(_) => 5,
        Kind::LeftRail | Kind::RightRail | Kind::Contact(_) | Kind::Coil(_) | Kind::Refused(_) => 6,
    });
}

fn node<'t>(element: &Element<'t>, elements: &[Element<'t>], lines: &[Line<'t>], out: &mut Assembly) -> Option<Node> {
    let named = |out: &mut Assembly| text(element.data.file, &element.variable(out));
    let kind = match element.kind {
        "block" => element.block(out)?,
        "input-variable" => Kind::Source(element.variable(out)),
        "output-variable" => Kind::Sink(element.variable(out)),
        "inout-variable" => Kind::Refused("a variable that is an input and an output"),
        "connector" => Kind::Connector(named(out)),
        "continuation" => Kind::Continuation(named(out)),
        // Comments, and what the editor shows while one draws.
        _ => return None,
    };
    let mut node = element.node(kind, 0, out);
    let wire = |line: &Line<'t>| {
        let is_block = elements.iter().any(|it| it.id == line.from && it.kind == "block");
        let formal = is_block.then(|| line.from_pin.to_owned());
        Wire { from: line.from.to_owned(), formal, end: None, place: line.place.clone() }
    };
    let to_it = || lines.iter().filter(|it| it.to == element.id);
    match &node.kind {
        Kind::Block { .. } => {
            for pin in element.pins("inputHandles", out) {
                node.inputs.extend(to_it().filter(|it| it.to_pin == pin).map(|it| input(pin, vec![wire(it)])));
            }
            node.outputs = element.pins("outputHandles", out).into_iter().map(output).collect();
        }
        Kind::LeftRail
        | Kind::RightRail
        | Kind::Source(_)
        | Kind::Sink(_)
        | Kind::Both(_)
        | Kind::Contact(_)
        | Kind::Coil(_)
        | Kind::Connector(_)
        | Kind::Continuation(_)
        | Kind::Refused(_) => {
            node.inputs.push(input("", to_it().map(wire).collect()));
            node.outputs.push(output(""));
        }
    }
    Some(node)
}
