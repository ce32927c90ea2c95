//! What both sides are given before a scan, and what they leave after it.

use crate::program::held;
use staunch_host::Event;
use staunch_ir::{Chars, Program, Type, Value};
use staunch_runtime::Fault;

/// Something that the world outside sets.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its position among the scalars of each side.
    pub scalars: [usize; 2],
    /// What it holds before anything sets it.
    pub initial: Value,
    /// Whole numbers that it is always within, by its type or an assumption.
    pub range: Option<(i128, i128)>,
    /// Of a string, those that are tried: a value is the position of one.
    pub texts: Vec<Chars>,
    /// How many of these an assumption may speak of: the others stand for all texts that nothing names.
    pub named: usize,
}

impl Input {
    /// A value of it as a stimulus takes it, but for quotes.
    pub fn spelled(&self, program: &Program, ty: Type, value: Value) -> String {
        self.text(value).map_or_else(|| held::spell(program, ty, value), Chars::text)
    }

    pub fn text(&self, value: Value) -> Option<&Chars> {
        self.texts.get(usize::try_from(value.as_integer()?).ok()?)
    }

    /// Whether it starts with what all memory starts with.
    pub fn starts_at_zero(&self) -> bool {
        self.texts.first().map_or_else(|| self.initial == self.initial.repr().zero(), Chars::is_empty)
    }
}

/// What comes before one scan: an event, and a value for each input.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    pub event: Option<Event>,
    pub inputs: Vec<Value>,
}

impl Step {
    pub fn of(inputs: Vec<Value>) -> Self {
        Self { event: None, inputs }
    }
}

/// The states of both sides after a scan, and how the scan ended.
#[derive(Clone, Debug)]
pub struct Row {
    pub event: Option<Event>,
    /// What each input was given before the scan; the program may have written it since.
    pub inputs: Vec<String>,
    pub states: [Vec<u8>; 2],
    pub faults: [Option<Fault>; 2],
}

/// How a scan ended on both sides.
pub type Faults = [Option<Fault>; 2];

/// Two scalars, or two instances, of one meaning, by their positions.
pub type Matched = [usize; 2];
