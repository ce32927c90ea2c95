//! Sequential function charts (IEC 61131-3, 6.7), as their text says them.

use super::{Expr, Name};
use crate::source::Span;

/// The steps and transitions of a PROGRAM or FUNCTION_BLOCK, whose ACTIONs are among its routines.
#[derive(Clone, Debug)]
pub struct Chart<'s> {
    pub steps: Vec<Step<'s>>,
    pub transitions: Vec<Transition<'s>>,
    /// The word that opens its first part.
    pub span: Span,
}

/// `INITIAL_STEP Start: Fill(N); END_STEP`
#[derive(Clone, Debug)]
pub struct Step<'s> {
    pub name: Name<'s>,
    pub is_initial: bool,
    pub associations: Vec<Association<'s>>,
}

/// `Fill(L, T#5s)`: what a step does with an ACTION, or with a BOOL variable.
#[derive(Clone, Debug)]
pub struct Association<'s> {
    pub action: Name<'s>,
    pub qualifier: Qualifier,
    /// Of a qualifier that has one.
    pub time: Option<Expr<'s>>,
    pub span: Span,
}

/// How a step and an action are associated (IEC 61131-3, table 57).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Qualifier {
    /// N: while the step is active.
    While,
    /// R
    Reset,
    /// S
    Set,
    /// L: while the step is active, for at most a time.
    Limited,
    /// D: while the step is active, from a time on.
    Delayed,
    /// P and P1: as the step becomes active.
    Entered,
    /// P0: as the step is left.
    Left,
    /// SD: set after a time, whether the step is active then or not.
    SetDelayed,
    /// DS: set after a time, where the step is still active.
    DelayedSet,
    /// SL: set for a time.
    SetLimited,
}

impl Qualifier {
    const NAMED: [(&'static str, Self); 11] = [
        ("N", Self::While),
        ("R", Self::Reset),
        ("S", Self::Set),
        ("P", Self::Entered),
        ("P0", Self::Left),
        ("P1", Self::Entered),
        ("L", Self::Limited),
        ("D", Self::Delayed),
        ("SD", Self::SetDelayed),
        ("DS", Self::DelayedSet),
        ("SL", Self::SetLimited),
    ];

    pub fn named(name: &str) -> Option<Self> {
        Self::NAMED.iter().find(|it| it.0.eq_ignore_ascii_case(name)).map(|it| it.1)
    }

    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::NAMED.iter().map(|it| it.0)
    }

    /// Whether a time belongs to it.
    pub const fn is_timed(self) -> bool {
        match self {
            Self::Limited | Self::Delayed | Self::SetDelayed | Self::DelayedSet | Self::SetLimited => true,
            Self::While | Self::Reset | Self::Set | Self::Entered | Self::Left => false,
        }
    }
}

/// `TRANSITION (PRIORITY := 1) FROM (a, b) TO c := x > 3; END_TRANSITION`
#[derive(Clone, Debug)]
pub struct Transition<'s> {
    /// The lowest number comes first.
    pub priority: Option<u64>,
    pub from: Vec<Name<'s>>,
    pub to: Vec<Name<'s>>,
    pub condition: Expr<'s>,
    /// Its first word.
    pub span: Span,
}
