//! What is counted of the execution of a program, and in which of its globals.

use crate::Span;
use rustc_hash::FxHashMap;
use staunch_ir::{FieldId, Location};

/// A place where execution is counted.
#[derive(Clone, Debug)]
pub struct CoveragePoint {
    pub at: Location,
    /// Of the globals: an UDINT, or an array of them.
    pub field: FieldId,
    pub kind: CoverageKind,
}

#[derive(Clone, Debug)]
pub enum CoverageKind {
    /// How often the statement was begun.
    Statement,
    /// How often the arm that begins with this label was chosen, of the CASE that begins there.
    Arm(Location),
    /// How often no label of a CASE held the value.
    Otherwise,
    /// For each row of values of its conditions, how often it was evaluated with these. The first condition
    /// is bit 0 of the row's number.
    Decision(Decision),
}

/// A BOOL that is made of conditions.
#[derive(Clone, Debug)]
pub struct Decision {
    /// What is executed next depends on it: the condition of an IF, ELSIF, WHILE or UNTIL.
    pub branches: bool,
    /// What is written, where it branches.
    pub span: Option<Span>,
    pub conditions: Vec<Condition>,
    pub formula: Formula,
}

#[derive(Clone, Copy, Debug)]
pub struct Condition {
    /// Where it begins.
    pub at: Location,
    /// What is written, where that is known.
    pub span: Option<Span>,
}

/// How the conditions make the decision.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Formula {
    Condition(usize),
    Constant(bool),
    /// Of one.
    Not(Vec<Formula>),
    And(Vec<Formula>),
    Or(Vec<Formula>),
    Xor(Vec<Formula>),
}

impl Formula {
    /// The decision's value in a row of the conditions' values.
    pub fn value(&self, row: usize) -> bool {
        match self {
            Self::Condition(number) => row >> number & 1 == 1,
            Self::Constant(value) => *value,
            Self::Not(all) => !all.iter().any(|it| it.value(row)),
            Self::And(all) => all.iter().all(|it| it.value(row)),
            Self::Or(all) => all.iter().any(|it| it.value(row)),
            Self::Xor(all) => all.iter().fold(false, |value, it| value ^ it.value(row)),
        }
    }
}

/// What an expression is in a decision: several may be at one place, which is that of an operator or where they begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Role {
    Condition,
    /// It is made by AND, OR, XOR or NOT.
    Decision,
    /// It is what an AND_THEN or OR_ELSE gives.
    Joined,
}

/// The points, while bodies are checked.
#[derive(Debug, Default)]
pub(crate) struct Coverage {
    /// The sources that are covered: this many, from the first.
    pub files: u16,
    pub points: Vec<CoveragePoint>,
    /// A body may be checked more than once, and be inherited: each point is counted in one place.
    pub known: FxHashMap<(Sort, Vec<Location>), FieldId>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Sort {
    Statement,
    Arm,
    Otherwise,
    Decision,
}
