//! The types of what wires carry: the result of a function is kept in a variable, which needs one. A type goes from what is declared
//! along the wires, through functions of any type, in the order of the file, as Beremiz' editor has it go.

use super::super::assembly::text;
use super::declared::Declared;
use super::functions::{converted, is_of_times_too, of_times, signature};
use super::node::{Diagram, Input, Kind, Node, Output, Wire};
use rustc_hash::FxHashMap;

/// A pin of an element.
type Point = usize;

pub struct Types<'d> {
    diagram: &'d Diagram,
    by_id: FxHashMap<&'d str, usize>,
    /// The first pin of each element: its inputs, then its outputs.
    first: Vec<Point>,
    known: Vec<Option<String>>,
    /// Pins of one type that is not known yet.
    groups: Vec<Vec<Point>>,
    group_of: FxHashMap<Point, usize>,
}

impl<'d> Types<'d> {
    pub fn of(file: &str, diagram: &'d Diagram, declared: &Declared, pou: &str) -> Self {
        let mut first = Vec::with_capacity(diagram.nodes.len());
        let mut pins = 0;
        for node in &diagram.nodes {
            first.push(pins);
            pins += node.inputs.len() + node.outputs.len();
        }
        let by_id = diagram.nodes.iter().enumerate().map(|(at, it)| (it.id.as_str(), at)).collect();
        let (known, groups, group_of) = (vec![None; pins], Vec::new(), FxHashMap::default());
        let mut types = Self { diagram, by_id, first, known, groups, group_of };
        types.find(file, declared, pou);
        types
    }

    pub fn node(&self, id: &str) -> Option<usize> {
        self.by_id.get(id).copied()
    }

    pub fn output(&self, node: usize, output: usize) -> Option<&str> {
        self.known[self.output_point(node, output)].as_deref()
    }

    fn input_point(&self, node: usize, input: usize) -> Point {
        self.first[node] + input
    }

    fn output_point(&self, node: usize, output: usize) -> Point {
        self.first[node] + self.diagram.nodes[node].inputs.len() + output
    }

    /// The pin that a wire comes from.
    fn source(&self, wire: &Wire) -> Option<Point> {
        let at = self.node(&wire.from)?;
        self.diagram.nodes[at].output(wire).map(|it| self.output_point(at, it))
    }

    /// The pin that the one wire to an input comes from.
    fn connected(&self, input: &Input) -> Option<Point> {
        match input.wires.as_slice() {
            [wire] => self.source(wire),
            [] | [_, _, ..] => None,
        }
    }

    /// The pins of one unknown type with this one, which then have no group.
    fn take(&mut self, point: Point) -> Vec<Point> {
        let Some(group) = self.group_of.get(&point).copied() else { return vec![point] };
        let points = std::mem::take(&mut self.groups[group]);
        for it in &points {
            self.group_of.remove(it);
        }
        points
    }

    fn set(&mut self, point: Point, ty: &str) {
        for it in self.take(point) {
            self.known[it] = Some(ty.to_owned());
        }
    }

    fn set_if_unknown(&mut self, point: Option<Point>, ty: &str) {
        if let Some(point) = point.filter(|it| self.known[*it].is_none()) {
            self.set(point, ty);
        }
    }

    /// These are of one type: that of the last which has one.
    fn unify(&mut self, points: &[Point]) {
        let mut found = None;
        let mut unknown: Vec<Point> = Vec::new();
        for point in points {
            match &self.known[*point] {
                Some(ty) => found = Some(ty.clone()),
                None if unknown.contains(point) => {}
                None => unknown.extend(self.take(*point)),
            }
        }
        match found {
            Some(ty) => {
                for it in unknown {
                    self.known[it] = Some(ty.clone());
                }
            }
            None => {
                let group = self.groups.len();
                self.group_of.extend(unknown.iter().map(|it| (*it, group)));
                self.groups.push(unknown);
            }
        }
    }

    fn find(&mut self, file: &str, declared: &Declared, pou: &str) {
        let mut of_times = Vec::new();
        let diagram = self.diagram;
        for (at, node) in diagram.nodes.iter().enumerate() {
            match &node.kind {
                Kind::Source(written) | Kind::Sink(written) | Kind::Both(written) => {
                    let written = text(file, written);
                    if let Some(ty) = declared.variable(pou, &written).or_else(|| literal(&written)) {
                        self.variable(at, node, &ty);
                    }
                }
                Kind::LeftRail | Kind::RightRail | Kind::Contact(_) | Kind::Coil(_) => self.bits(at, node),
                Kind::Continuation(name) => self.continuation(at, name),
                Kind::Block { ty, instance: None } if is_of_times_too(&ty.text) => {
                    for (input, pin) in node.inputs.iter().enumerate() {
                        let point = self.input_point(at, input);
                        let connected = self.connected(pin);
                        self.unify(&connected.into_iter().chain([point]).collect::<Vec<_>>());
                    }
                    of_times.push(at);
                }
                Kind::Block { ty, instance } => self.block(at, node, &ty.text, instance.is_some(), declared),
                Kind::Connector(_) | Kind::Refused(_) => {}
            }
        }
        for at in of_times {
            self.of_times(at);
        }
    }

    fn variable(&mut self, at: usize, node: &Node, ty: &str) {
        for output in 0..node.outputs.len() {
            self.set(self.output_point(at, output), ty);
        }
        for (input, pin) in node.inputs.iter().enumerate() {
            let (point, connected) = (self.input_point(at, input), self.connected(pin));
            self.known[point] = Some(ty.to_owned());
            self.set_if_unknown(connected, ty);
        }
    }

    fn bits(&mut self, at: usize, node: &Node) {
        for output in 0..node.outputs.len() {
            self.set(self.output_point(at, output), "BOOL");
        }
        for (input, pin) in node.inputs.iter().enumerate() {
            let point = self.input_point(at, input);
            self.known[point] = Some("BOOL".to_owned());
            for wire in &pin.wires {
                self.set_if_unknown(self.source(wire), "BOOL");
            }
        }
    }

    fn continuation(&mut self, at: usize, name: &str) {
        let is_its = |it: &&Node| matches!(&it.kind, Kind::Connector(other) if other == name);
        let Some(connector) = self.diagram.nodes.iter().find(is_its) else { return };
        let Some(input) = connector.inputs.first() else { return };
        let mut points: Vec<Point> =
            (0..self.diagram.nodes[at].outputs.len()).map(|it| self.output_point(at, it)).collect();
        points.extend(self.connected(input));
        self.unify(&points);
    }

    /// A function of one signature, or an instance of a function block.
    fn block(&mut self, at: usize, node: &Node, ty: &str, is_instance: bool, declared: &Declared) {
        let signature = if is_instance { None } else { signature(ty) };
        let of_output = |pin: &Output| -> Option<String> {
            let formal = pin.formal.as_str();
            match () {
                () if formal.eq_ignore_ascii_case("ENO") => Some("BOOL".to_owned()),
                () if is_instance => declared.member(ty, formal).map(ToOwned::to_owned),
                () => {
                    let own = declared.result(ty).map(ToOwned::to_owned);
                    let is_result = pin.is_result(ty);
                    let pin = || declared.member(ty, formal).map(ToOwned::to_owned);
                    let standard = || signature.as_ref().map(|it| it.output().to_owned()).or_else(|| converted(ty));
                    pin().or_else(|| own.filter(|_| is_result)).or_else(|| standard().filter(|_| is_result))
                }
            }
        };
        let mut unknown: Vec<(String, Vec<Point>)> = Vec::new();
        for (output, pin) in node.outputs.iter().enumerate() {
            let point = self.output_point(at, output);
            match of_output(pin) {
                Some(ty) if ty.starts_with("ANY") => add(&mut unknown, &ty, [point]),
                Some(ty) if self.known[point].is_none() => self.set(point, &ty),
                Some(_) | None => {}
            }
        }
        let mut number = 0;
        for (input, pin) in node.inputs.iter().enumerate() {
            let (point, connected) = (self.input_point(at, input), self.connected(pin));
            let ty = match &signature {
                _ if pin.formal.eq_ignore_ascii_case("EN") => Some("BOOL".to_owned()),
                Some(signature) => {
                    number += 1;
                    signature.input(number - 1).map(ToOwned::to_owned)
                }
                None => declared.member(ty, &pin.formal).map(ToOwned::to_owned),
            };
            match ty {
                Some(ty) if ty.starts_with("ANY") => {
                    add(&mut unknown, &ty, std::iter::once(point).chain(connected));
                }
                Some(ty) => {
                    self.known[point] = Some(ty.clone());
                    self.set_if_unknown(connected, &ty);
                }
                None => {}
            }
        }
        for (_, points) in unknown {
            self.unify(&points);
        }
    }

    fn of_times(&mut self, at: usize) {
        let node = &self.diagram.nodes[at];
        let Kind::Block { ty: name, .. } = &node.kind else { return };
        let of_input = |input: usize| {
            let pin = &node.inputs[input];
            let source = self.connected(pin).and_then(|it| self.known[it].clone());
            source.or_else(|| self.known[self.input_point(at, input)].clone())
        };
        let inputs: Vec<usize> =
            (0..node.inputs.len()).filter(|it| !node.inputs[*it].formal.eq_ignore_ascii_case("EN")).collect();
        let types: Vec<Option<String>> = inputs.iter().map(|it| of_input(*it)).collect();
        let first = types.first().and_then(Option::as_deref);
        let second = types.get(1).and_then(Option::as_deref);
        let time = first.and_then(|it| of_times(&name.text, it, second));
        for (output, pin) in node.outputs.iter().enumerate() {
            let point = self.output_point(at, output);
            match time {
                _ if pin.formal.eq_ignore_ascii_case("ENO") => self.set_if_unknown(Some(point), "BOOL"),
                Some(ty) => self.set_if_unknown(Some(point), ty),
                None => {
                    let mut points = vec![point];
                    for input in &inputs {
                        points.push(self.input_point(at, *input));
                        points.extend(self.connected(&node.inputs[*input]));
                    }
                    self.unify(&points);
                }
            }
        }
    }
}

fn add(unknown: &mut Vec<(String, Vec<Point>)>, ty: &str, points: impl IntoIterator<Item = Point>) {
    match unknown.iter_mut().find(|it| it.0 == ty) {
        Some(found) => found.1.extend(points),
        None => unknown.push((ty.to_owned(), points.into_iter().collect())),
    }
}

/// The type that a literal says by itself, `T#2s`, `REAL#1` or `'text'`.
fn literal(written: &str) -> Option<String> {
    if let Some((prefix, _)) = written.split_once('#') {
        let ty = match prefix.to_ascii_uppercase().as_str() {
            "T" => "TIME".to_owned(),
            "D" => "DATE".to_owned(),
            "2" | "8" | "16" => return None,
            other => other.to_owned(),
        };
        return Some(ty);
    }
    match written.chars().next()? {
        '\'' => Some("STRING".to_owned()),
        '"' => Some("WSTRING".to_owned()),
        _ => None,
    }
}
