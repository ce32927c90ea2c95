//! What a chart is made of: its elements, in the order of the file, and what is connected with what.

use super::super::super::diagram::{Diagram, Name, Wire};
use super::Chunk;
use core::ops::Range;

#[derive(Debug, Default)]
pub struct Chart {
    pub elements: Vec<Element>,
    /// What the conditions of transitions are wired of.
    pub diagram: Diagram,
}

#[derive(Debug)]
pub struct Element {
    /// `localId`, by which connections name it.
    pub id: String,
    pub place: Range<usize>,
    pub kind: Kind,
    /// The connections of each point at which something comes in.
    pub inputs: Vec<Vec<Wire>>,
}

#[derive(Debug)]
pub enum Kind {
    Step {
        name: Name,
        is_initial: bool,
    },
    Transition {
        priority: Option<String>,
        condition: Condition,
    },
    /// What the step does that it is connected with.
    Actions(Vec<Action>),
    /// To a step.
    Jump(Name),
    /// A line at which branches begin or end: parallel ones have a transition around them, alternatives begin and end with one.
    Line,
    Refused(&'static str),
}

#[derive(Debug)]
pub enum Condition {
    Missing,
    /// By the name of a transition of the POU.
    Named(Name),
    Text(Vec<Chunk>),
    Wired(Vec<Wire>),
    /// In a language that is not read.
    Other(&'static str),
}

/// One line of an action block.
#[derive(Debug)]
pub struct Action {
    pub qualifier: String,
    pub duration: Option<Chunk>,
    pub indicator: Option<Chunk>,
    pub does: Does,
    pub place: Range<usize>,
}

#[derive(Debug)]
pub enum Does {
    Missing,
    /// An ACTION of the POU, or a BOOL variable.
    Named(Name),
    Text(Vec<Chunk>),
    /// In a language that is not read.
    Other(&'static str),
}
