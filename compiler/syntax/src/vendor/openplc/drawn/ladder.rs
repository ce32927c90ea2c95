//! The rungs of a ladder diagram: one is below the other.

use super::super::super::assembly::Assembly;
use super::super::super::diagram::{Diagram, Kind, Node, Wire};
use super::super::super::json::Value;
use super::super::object::Object;
use super::element::{Element, Line, elements, input, lines, output};

/// The points at which branches begin and end.
const BRANCH: &str = "parallel";

struct Rung<'t> {
    /// One that was copied has the names of the other's elements.
    number: usize,
    elements: Vec<Element<'t>>,
    lines: Vec<Line<'t>>,
}

pub fn read(body: &Object<'_>, diagram: &mut Diagram, out: &mut Assembly) {
    let mut below = 0;
    for (number, value) in body.list("rungs", out).iter().enumerate() {
        let Some(object) = Object::required(body.file, value, "a rung", out) else { continue };
        let rung = Rung { number, elements: elements(&object, out), lines: lines(&object, out) };
        for element in &rung.elements {
            diagram.nodes.extend(rung.node(element, below, out));
        }
        let height = object.list("reactFlowViewport", out).get(1).and_then(|it| height(object.file, it));
        below = below.saturating_add(height.unwrap_or(0));
    }
    // The editor writes elements of one kind after the other; what is at one place is executed in that order.
    diagram.nodes.sort_by_key(|it| match it.kind {
        Kind::LeftRail | Kind::RightRail => 0,
        Kind::Block { .. } => 1,
        Kind::Contact(_) => 2,
        Kind::Coil(_) => 3,
        Kind::Source(_) => 4,
        Kind::Both(_) => 5,
        Kind::Sink(_) => 6,
        Kind::Connector(_) | Kind::Continuation(_) | Kind::Refused(_) => 7,
    });
}

fn height(file: &str, value: &Value) -> Option<i64> {
    value.raw(file).split('.').next().unwrap_or_default().parse().ok()
}

impl<'t> Rung<'t> {
    fn node(&self, element: &Element<'t>, below: i64, out: &mut Assembly) -> Option<Node> {
        let kind = match element.kind {
            "powerRail" => match element.data.word("variant", out) {
                Some("left") => Kind::LeftRail,
                _ => Kind::RightRail,
            },
            "contact" => Kind::Contact(element.variable(out)),
            "coil" => Kind::Coil(element.variable(out)),
            "block" => element.block(out)?,
            // One without a name is not connected.
            "variable" if !element.has_variable(out) => return None,
            "variable" if element.data.word("variant", out) == Some("output") => Kind::Sink(element.variable(out)),
            "variable" => Kind::Source(element.variable(out)),
            // Branches, and what the editor shows while one draws.
            _ => return None,
        };
        let mut node = Node { id: self.id(element.id), ..element.node(kind, below, out) };
        match &node.kind {
            Kind::Block { .. } => {
                let pins = element.pins("inputHandles", out);
                let first = element.connector("inputConnector", out);
                for pin in &pins {
                    // A wire that names none of the pins comes in on the rung.
                    let is_here = |to: &str| to == *pin || Some(*pin) == first && !pins.contains(&to);
                    let mut wires = self.wires_to(element, &is_here, out);
                    if wires.is_empty() {
                        wires = self.variable_at(element, pin, out);
                    }
                    node.inputs.extend((!wires.is_empty()).then(|| input(pin, wires)));
                }
                node.outputs = element.pins("outputHandles", out).into_iter().map(output).collect();
            }
            Kind::Sink(_) => node.inputs.push(input("", self.wires_from_block(element, out))),
            Kind::LeftRail
            | Kind::RightRail
            | Kind::Source(_)
            | Kind::Both(_)
            | Kind::Contact(_)
            | Kind::Coil(_)
            | Kind::Connector(_)
            | Kind::Continuation(_)
            | Kind::Refused(_) => {
                node.inputs.push(input("", self.wires_to(element, &|_| true, out)));
                node.outputs.push(output(""));
            }
        }
        Some(node)
    }

    fn id(&self, id: &str) -> String {
        format!("{id} of rung {}", self.number + 1)
    }

    fn element(&self, id: &str) -> Option<&Element<'t>> {
        self.elements.iter().find(|it| it.id == id)
    }

    /// What comes in at some pins, through the branches before it.
    fn wires_to(&self, element: &Element<'t>, is_here: &dyn Fn(&str) -> bool, out: &mut Assembly) -> Vec<Wire> {
        let mut wires = Vec::new();
        let (mut seen, mut waiting) = (Vec::new(), vec![element.id]);
        while let Some(to) = waiting.pop() {
            let mut branches = Vec::new();
            let is_meant = |it: &&Line<'t>| it.to == to && (to != element.id || is_here(it.to_pin));
            for line in self.lines.iter().filter(is_meant) {
                match self.element(line.from) {
                    Some(from) if from.kind == BRANCH => {
                        if !seen.contains(&from.id) {
                            seen.push(from.id);
                            branches.push(from.id);
                        }
                    }
                    // A variable at another pin.
                    Some(from) if from.kind == "variable" => {}
                    Some(from) => wires.push(Wire {
                        from: self.id(from.id),
                        formal: Self::output_of(from, line, out),
                        end: None,
                        place: line.place.clone(),
                    }),
                    None => wires.push(Wire {
                        from: self.id(line.from),
                        formal: None,
                        end: None,
                        place: line.place.clone(),
                    }),
                }
            }
            waiting.extend(branches.into_iter().rev());
        }
        wires
    }

    /// The output that a wire comes from: the one that it names, else the one that the rung continues from.
    fn output_of(from: &Element<'t>, line: &Line<'t>, out: &mut Assembly) -> Option<String> {
        let is_named = from.pins("outputHandles", out).contains(&line.from_pin);
        let pin = if is_named { Some(line.from_pin) } else { from.connector("outputConnector", out) };
        pin.map(str::to_owned)
    }

    /// The variable that is written at a pin of a block.
    fn variable_at(&self, block: &Element<'t>, pin: &str, out: &mut Assembly) -> Vec<Wire> {
        let found = self.elements.iter().find(|it| {
            let at = (it.kind == "variable").then(|| it.data.object("block", out)).flatten();
            at.is_some_and(|at| at.word("id", out) == Some(block.id) && at.word("handleId", out) == Some(pin))
                && it.has_variable(out)
        });
        let wire = |it: &Element<'t>| Wire { from: self.id(it.id), formal: None, end: None, place: it.place(out) };
        found.map(wire).into_iter().collect()
    }

    /// The pin of a block that a variable takes its value from.
    fn wires_from_block(&self, variable: &Element<'t>, out: &mut Assembly) -> Vec<Wire> {
        let Some(block) = variable.data.object("block", out) else { return Vec::new() };
        let Some(from) = block.word("id", out) else { return Vec::new() };
        let formal = block.word("handleId", out).map(str::to_owned);
        vec![Wire { from: self.id(from), formal, end: None, place: variable.place(out) }]
    }
}
