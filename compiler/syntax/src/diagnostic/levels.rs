//! What settings say of lints: warn, deny or allow.

use super::{Code, Diagnostic, Severity};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    Warn,
    Deny,
    Allow,
}

/// Rules for lints; a later one wins.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    /// `None`: all lints.
    rules: Vec<(Option<Code>, Level)>,
}

impl Levels {
    /// Adds a rule for each of `names`: a lint's code, or `warnings`.
    ///
    /// The error is a sentence without a full stop.
    pub fn add<'n>(&mut self, level: Level, names: impl IntoIterator<Item = &'n str>) -> Result<(), String> {
        for name in names {
            self.rules.push((lint(name)?, level));
        }
        Ok(())
    }

    /// The diagnostic at its level, or `None` where it is allowed.
    pub fn apply(&self, mut diagnostic: Diagnostic) -> Option<Diagnostic> {
        if diagnostic.severity == Severity::Error {
            return Some(diagnostic);
        }
        let applies = |(code, _): &&(Option<Code>, Level)| code.is_none_or(|it| it == diagnostic.code);
        match self.rules.iter().rev().find(applies).map(|(_, level)| *level) {
            Some(Level::Allow) => None,
            Some(Level::Deny) => {
                diagnostic.severity = Severity::Error;
                Some(diagnostic)
            }
            Some(Level::Warn) | None => Some(diagnostic),
        }
    }
}

/// A lint by its code; `None` for `warnings`, which means all.
pub fn lint(name: &str) -> Result<Option<Code>, String> {
    if name.eq_ignore_ascii_case("warnings") {
        return Ok(None);
    }
    match Code::named(name) {
        Some(code) if code.severity() == Severity::Warning => Ok(Some(code)),
        Some(code) => Err(format!("{} is an error; only lints (W…) have levels", code.name())),
        None => Err(match Code::meant(name).filter(|it| it.severity() == Severity::Warning) {
            Some(meant) => format!("there is no lint `{name}`; did you mean `{}`?", meant.name()),
            None => format!("there is no lint `{name}`; `staunch explain` lists them"),
        }),
    }
}
