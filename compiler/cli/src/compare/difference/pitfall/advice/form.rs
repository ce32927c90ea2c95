//! What an advice is for: the pitfalls, the moves, and the counters that it is proved for.

use staunch_frontend::Dialect;

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

    pub fn is_for(&self, counting: Counting) -> bool {
        let counts = self.forms.is_empty() || self.forms.contains(&counting.form);
        counts && self.rises.is_none_or(|it| it == counting.rises)
    }
}
