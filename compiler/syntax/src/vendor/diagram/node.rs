//! What a diagram is made of: its elements, in the order of the file, and what is wired to what.

use super::super::assembly::{Chunk, text};
use core::ops::Range;

#[derive(Debug, Default)]
pub struct Diagram {
    pub nodes: Vec<Node>,
}

impl Diagram {
    /// What is wired to the variable or coil of a name.
    pub fn wires_to(&self, file: &str, name: &str) -> Option<&[Wire]> {
        let is_meant = |it: &&Node| match &it.kind {
            Kind::Sink(target) | Kind::Coil(target) => text(file, target).eq_ignore_ascii_case(name),
            Kind::LeftRail
            | Kind::RightRail
            | Kind::Source(_)
            | Kind::Both(_)
            | Kind::Contact(_)
            | Kind::Block { .. }
            | Kind::Connector(_)
            | Kind::Continuation(_)
            | Kind::Refused(_) => false,
        };
        let node = self.nodes.iter().find(is_meant)?;
        Some(node.inputs.first().map_or(&[], |it| it.wires.as_slice()))
    }
}

/// An element.
#[derive(Debug)]
pub struct Node {
    /// `localId`, by which wires name it.
    pub id: String,
    /// What the names of variables for its results hold; the `localId`, too, where that is a number.
    pub number: String,
    pub kind: Kind,
    pub place: Range<usize>,
    pub position: Position,
    /// `executionOrderId`; 0 where its position decides.
    pub order: u64,
    pub modifier: Modifier,
    pub inputs: Vec<Input>,
    pub outputs: Vec<Output>,
}

#[derive(Debug)]
pub enum Kind {
    LeftRail,
    RightRail,
    /// `inVariable`, `outVariable` and `inOutVariable`, with their expressions.
    Source(Vec<Chunk>),
    Sink(Vec<Chunk>),
    Both(Vec<Chunk>),
    Contact(Vec<Chunk>),
    Coil(Vec<Chunk>),
    /// A function, or an instance of a function block.
    Block {
        ty: Name,
        instance: Option<Name>,
    },
    Connector(String),
    Continuation(String),
    /// What changes the order of execution, and has no words here.
    Refused(&'static str),
}

/// A name, and how the file writes it.
#[derive(Clone, Debug)]
pub struct Name {
    pub text: String,
    pub chunk: Chunk,
}

impl Name {
    /// One that is missing.
    pub fn empty(place: &Range<usize>) -> Self {
        Self { text: String::new(), chunk: Chunk::words("", place) }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Position {
    pub x: i64,
    pub y: i64,
}

/// What is done to a value on its way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifier {
    pub negated: bool,
    pub storage: Option<Storage>,
    pub edge: Option<Edge>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    Set,
    Reset,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    Rising,
    Falling,
}

/// A pin that takes a value; several wires to it are a parallel connection.
#[derive(Debug)]
pub struct Input {
    /// `formalParameter`; empty where the element has one pin.
    pub formal: String,
    pub modifier: Modifier,
    pub wires: Vec<Wire>,
}

/// A wire, from the pin that it comes from.
#[derive(Clone, Debug)]
pub struct Wire {
    /// The element.
    pub from: String,
    /// The element's pin, where the file names it.
    pub formal: Option<String>,
    /// Where the wire ends at that element.
    pub end: Option<Position>,
    pub place: Range<usize>,
}

#[derive(Debug)]
pub struct Output {
    pub formal: String,
    pub modifier: Modifier,
    /// From the element's own position.
    pub at: Option<Position>,
    /// The variable that CODESYS writes at the pin.
    pub target: Vec<Chunk>,
}

impl Output {
    /// Whether it is what a function returns, and not another output of it: CODESYS numbers it, or calls it as the function.
    pub fn is_result(&self, function: &str) -> bool {
        let number =
            self.formal.get(..3).filter(|it| it.eq_ignore_ascii_case("OUT")).map(|it| &self.formal[it.len()..]);
        self.formal.is_empty()
            || self.formal.eq_ignore_ascii_case(function)
            || number.is_some_and(|it| it.bytes().all(|it| it.is_ascii_digit()))
    }
}

impl Node {
    /// The variable or expression that it stands for.
    pub fn expression(&self) -> Option<&[Chunk]> {
        match &self.kind {
            Kind::Source(it) | Kind::Sink(it) | Kind::Both(it) | Kind::Contact(it) | Kind::Coil(it) => Some(it),
            Kind::LeftRail
            | Kind::RightRail
            | Kind::Block { .. }
            | Kind::Connector(_)
            | Kind::Continuation(_)
            | Kind::Refused(_) => None,
        }
    }

    /// What it is called in messages.
    pub fn shown(&self, file: &str) -> String {
        match &self.kind {
            Kind::Block { ty, instance } => format!("`{}`", instance.as_ref().unwrap_or(ty).text),
            Kind::Coil(it) => format!("the coil `{}`", text(file, it)),
            Kind::Contact(it) | Kind::Source(it) | Kind::Sink(it) | Kind::Both(it) => format!("`{}`", text(file, it)),
            Kind::Connector(name) | Kind::Continuation(name) => format!("`{name}`"),
            Kind::LeftRail | Kind::RightRail => "the power rail".to_owned(),
            Kind::Refused(what) => (*what).to_owned(),
        }
    }

    pub fn input(&self, formal: &str) -> Option<&Input> {
        self.inputs.iter().find(|it| it.formal.eq_ignore_ascii_case(formal))
    }

    /// Whether EN decides if it is executed.
    pub fn has_enable(&self) -> bool {
        self.input("EN").is_some_and(|it| !it.wires.is_empty())
    }

    /// A pin of a block that is an input and an output: a VAR_IN_OUT.
    pub fn is_in_out(&self, formal: &str) -> bool {
        self.input(formal).is_some() && self.outputs.iter().any(|it| it.formal.eq_ignore_ascii_case(formal))
    }

    /// The output that a wire comes from: by its name, else by where the wire ends, else the only one.
    pub fn output(&self, wire: &Wire) -> Option<usize> {
        if let Some(formal) = wire.formal.as_deref().filter(|it| !it.is_empty()) {
            return self.outputs.iter().position(|it| it.formal.eq_ignore_ascii_case(formal));
        }
        let ends = |it: &Output| {
            it.at.zip(wire.end).is_some_and(|(at, end)| {
                self.position.x.checked_add(at.x) == Some(end.x) && self.position.y.checked_add(at.y) == Some(end.y)
            })
        };
        let by_place = self.outputs.iter().position(ends);
        by_place.or_else(|| (self.outputs.len() == 1).then_some(0))
    }
}
