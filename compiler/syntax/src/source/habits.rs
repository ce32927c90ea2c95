//! What is known of a file before it is read.

/// What decides how a file is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Habits<'s> {
    /// What its project defines for conditional compilation.
    pub defined: &'s [String],
    pub comments: Comments,
    /// It is of a program of B&R's Automation Studio: some words are names there, and others have a meaning.
    pub is_of_studio: bool,
}

/// Where `(* a (* b *) c *)` ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Comments {
    /// At the `*)` of its own `(*`, as the standard's third edition has it.
    #[default]
    Nested,
    /// At the first `*)`, as in its second edition.
    Plain,
}

/// Dialects whose comments end at the first `*)`: MATIEC reads nested ones only by an option, which neither OpenPLC nor
/// Beremiz gives it.
const PLAIN: [&str; 1] = ["openplc"];

impl Comments {
    /// How comments end in a dialect.
    pub fn of_dialect(dialect: &str) -> Self {
        let is_plain = PLAIN.iter().any(|it| it.eq_ignore_ascii_case(dialect));
        if is_plain { Self::Plain } else { Self::Nested }
    }
}
