//! Findings that a plant lives with, and why: a file of lines as `parts 2: nobody reads CV past 50`.

use super::kind::Kind;
use super::pitfall::Pitfall;
use std::path::Path;

#[derive(Clone, Debug, Default)]
pub struct Accepted {
    pub lines: Vec<Line>,
    path: String,
}

/// A trap by its number, or all that is found of a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Trap(usize),
    Kind(&'static str),
}

#[derive(Clone, Debug)]
pub struct Line {
    number: usize,
    /// A counter or variable; `*` is any.
    subject: String,
    what: What,
}

impl Accepted {
    pub fn of(path: &Path, text: &str) -> Result<Self, String> {
        let shown = path.display().to_string();
        Self::parse(text, &shown).map_err(|(line, text)| format!("{shown}:{line}: {text}"))
    }

    pub fn parse(text: &str, path: &str) -> Result<Self, (usize, String)> {
        let mut lines = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if !line.is_empty() && !line.starts_with('#') {
                lines.push(Line::parse(line, number + 1).map_err(|it| (number + 1, it))?);
            }
        }
        Ok(Self { lines, path: path.to_owned() })
    }

    /// Whether a finding of this kind, subject and trap would be.
    pub fn takes(&self, kind: Kind, subject: &str, pitfall: Option<Pitfall>) -> bool {
        self.lines.iter().any(|it| it.takes(kind, subject, pitfall))
    }

    /// Whether an output has a line of its own that accepts a finding of this kind: a line of all subjects is none.
    pub fn names(&self, kind: Kind, path: &str) -> bool {
        self.lines.iter().any(|it| it.subject != "*" && it.takes(kind, path, None))
    }

    /// Whether anything is accepted at all.
    pub fn accepts_any(&self) -> bool {
        !self.lines.is_empty()
    }

    /// A line's place, and what it accepts.
    pub fn describe(&self, line: &Line) -> String {
        let what = match line.what {
            What::Trap(number) => format!("trap {number}"),
            What::Kind(name) => name.to_owned(),
        };
        format!("{}:{}: {what} of `{}`", self.path, line.number, line.subject)
    }
}

impl Line {
    fn parse(line: &str, number: usize) -> Result<Self, String> {
        const SHAPE: &str = "expected `counter trap: reason`, as `parts 2: nobody reads the count past 50`";
        let (what, reason) = line.split_once(':').ok_or_else(|| format!("the reason is missing; {SHAPE}"))?;
        if reason.trim().is_empty() {
            return Err(format!("the reason is missing; {SHAPE}"));
        }
        let mut words = what.split_whitespace();
        let (Some(subject), Some(pitfall), None) = (words.next(), words.next(), words.next()) else {
            return Err(SHAPE.to_owned());
        };
        let kind = Kind::ALL.into_iter().map(Kind::name).find(|it| it.eq_ignore_ascii_case(pitfall));
        let what = match (kind, pitfall.parse()) {
            (Some(kind), _) => What::Kind(kind),
            (None, Ok(number)) => What::Trap(number),
            (None, Err(_)) => return Err(format!("`{pitfall}` is not the number of a trap; {SHAPE}")),
        };
        Ok(Self { number, subject: subject.to_owned(), what })
    }

    /// Whether it is about this variable by its name.
    pub fn names(&self, path: &str) -> bool {
        self.subject.eq_ignore_ascii_case(path)
    }

    /// Whether it accepts findings of a kind, and no trap.
    pub fn is_of(&self, kind: Kind) -> bool {
        self.what == What::Kind(kind.name())
    }

    pub fn takes(&self, kind: Kind, subject: &str, pitfall: Option<Pitfall>) -> bool {
        let subject = match kind == Kind::Output {
            true => is_in(subject, &self.subject),
            false => self.subject == "*" || self.subject.eq_ignore_ascii_case(subject),
        };
        let what = match self.what {
            What::Trap(number) => pitfall.is_some_and(|it| it.number() == number),
            What::Kind(name) => kind.name() == name,
        };
        subject && what
    }
}

/// Whether a path is that of a variable, or of an element or a member of it.
fn is_in(path: &str, whole: &str) -> bool {
    let (path, whole) = (path.to_ascii_lowercase(), whole.to_ascii_lowercase());
    path.strip_prefix(&whole).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_line_accepts_a_trap_of_a_counter() {
        let accepted =
            Accepted::parse("# signed by Ada\nParts 2: nobody reads it\n* 5: no input at start", "a").unwrap();
        let takes = |number: usize| accepted.takes(Kind::Counter, "parts", Some(Pitfall::numbered(number)));
        assert!(takes(2));
        assert!(!takes(3));
        assert!(takes(5));
    }

    #[test]
    fn a_reason_is_asked_for() {
        assert!(Accepted::parse("parts 2", "a").unwrap_err().1.starts_with("the reason is missing"));
        assert!(Accepted::parse("parts two: why", "a").unwrap_err().1.starts_with("`two` is not the number of a trap"));
    }
}
