//! What an advice is for: the pitfalls, the moves, and the counters that it is proved for.

use staunch_frontend::Dialect;
use staunch_runtime::Family;

/// Which way a counter counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// CTU
    Up,
    /// CTD
    Down,
    /// CTUD
    UpDown,
}

/// A counter that an advice is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counting {
    pub form: Form,
    /// OPENPLC4 counts CD as it rises.
    pub rises: bool,
    /// What it does on the system that the program comes from; `None` where no counter is known.
    pub rules: Option<Rules>,
    /// An input is given in one call, and left out in another.
    pub is_partial: bool,
}

/// What a counter does on the system that the program comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    pub family: Family,
    pub least: i128,
    pub greatest: i128,
    /// It counts up only below its preset.
    pub stops: bool,
    /// It counts down on the falling edge.
    pub falls: bool,
    /// It is loaded when its input rises, and not while that is TRUE.
    pub loads_once: bool,
}

/// What is said about some pitfalls of a CTU, or of other counters, on a move from one of these systems to one of those.
pub struct Advice {
    /// What its cases call it.
    #[cfg_attr(not(test), expect(dead_code, reason = "a test finds the cases by it"))]
    pub name: &'static str,
    pub pitfalls: &'static [usize],
    pub from: &'static [Dialect],
    pub to: &'static [Dialect],
    /// The counters that it is proved for; empty where it says nothing of counting.
    pub forms: &'static [Form],
    /// Whether OPENPLC4 counts CD as it rises, where it matters.
    pub rises: Option<bool>,
    /// Whether CTU stops at its preset on the system that the program comes from, where it matters.
    pub stops: Option<bool>,
    pub text: &'static str,
}

impl Advice {
    pub const fn of(self, forms: &'static [Form]) -> Self {
        Self { forms, ..self }
    }

    /// Where OPENPLC4 counts CD as it falls, as its Editor through 4.2.11 does; or as it rises.
    pub const fn where_it(self, rises: bool) -> Self {
        Self { rises: Some(rises), ..self }
    }

    /// Where CTU of the system that the program comes from stops at its preset, or counts further.
    pub const fn where_it_stops(self, stops: bool) -> Self {
        Self { stops: Some(stops), ..self }
    }

    pub fn is_for(&self, counting: Counting) -> bool {
        let counts = self.forms.is_empty() || self.forms.contains(&counting.form);
        let stops = counting.rules.is_some_and(|it| it.stops);
        counts && self.rises.is_none_or(|it| it == counting.rises) && self.stops.is_none_or(|it| it == stops)
    }
}
