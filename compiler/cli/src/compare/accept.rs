//! Findings that a plant lives with, and why: a file of lines as `parts 2: nobody reads CV past 50`.

use super::beyond::Kind;
use super::finding::{Finding, Findings, Verdict};
use super::pitfall::Pitfall;
use std::path::Path;

#[derive(Clone, Debug, Default)]
pub struct Accepted {
    lines: Vec<Line>,
    path: String,
}

/// A trap by its number, or all that is found of a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Trap(usize),
    Kind(&'static str),
}

#[derive(Clone, Debug)]
struct Line {
    number: usize,
    /// A counter or variable; `*` is any.
    subject: String,
    what: What,
}

impl Accepted {
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|it| format!("cannot read {}: {it}", path.display()))?;
        let shown = path.display().to_string();
        Self::parse(&text, &shown).map_err(|(line, text)| format!("{shown}:{line}: {text}"))
    }

    fn parse(text: &str, path: &str) -> Result<Self, (usize, String)> {
        let mut lines = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if !line.is_empty() && !line.starts_with('#') {
                lines.push(Line::parse(line, number + 1).map_err(|it| (number + 1, it))?);
            }
        }
        Ok(Self { lines, path: path.to_owned() })
    }

    /// Whether a finding is accepted.
    pub fn accepts(&self, finding: &Finding) -> bool {
        self.lines.iter().any(|it| it.is_of(finding))
    }

    /// Whether a finding of this kind, subject and trap would be.
    pub fn takes(&self, kind: Kind, subject: &str, pitfall: Option<Pitfall>) -> bool {
        self.lines.iter().any(|it| it.takes(kind, subject, pitfall))
    }

    /// Whether anything is accepted at all.
    pub fn accepts_any(&self) -> bool {
        !self.lines.is_empty()
    }

    /// A sentence for each line that accepts nothing.
    pub fn stale(&self, findings: &Findings) -> Vec<String> {
        let stale = |line: &&Line| {
            let open = |it: &&Finding| line.is_of(it) && !matches!(it.verdict, Verdict::Impossible(_));
            !findings.all.iter().any(|it| open(&it))
        };
        let sentence = |it: &Line| {
            let why = findings.all.iter().find(|finding| it.is_of(finding)).and_then(|it| match &it.verdict {
                Verdict::Impossible(why) => Some(format!("is impossible: {why}")),
                Verdict::Reachable(_) | Verdict::Undecided => None,
            });
            let why = why.unwrap_or_else(|| "is not found".to_owned());
            let what = match it.what {
                What::Trap(number) => format!("trap {number}"),
                What::Kind(name) => name.to_owned(),
            };
            format!("{}:{}: {what} of `{}` is accepted, and {why}", self.path, it.number, it.subject)
        };
        self.lines.iter().filter(stale).map(sentence).collect()
    }
}

impl Line {
    fn parse(line: &str, number: usize) -> Result<Self, String> {
        const SHAPE: &str = "a line is `counter trap: reason`, as `parts 2: nobody reads the count past 50`";
        let (what, reason) = line.split_once(':').ok_or_else(|| format!("there is no reason; {SHAPE}"))?;
        if reason.trim().is_empty() {
            return Err(format!("there is no reason; {SHAPE}"));
        }
        let mut words = what.split_whitespace();
        let (Some(subject), Some(pitfall), None) = (words.next(), words.next(), words.next()) else {
            return Err(SHAPE.to_owned());
        };
        let kind = Kind::ALL.into_iter().map(Kind::name).find(|it| it.eq_ignore_ascii_case(pitfall));
        let what = match (kind, pitfall.parse()) {
            (Some(kind), _) => What::Kind(kind),
            (None, Ok(number)) => What::Trap(number),
            (None, Err(_)) => return Err(format!("`{pitfall}` is no trap's number; {SHAPE}")),
        };
        Ok(Self { number, subject: subject.to_owned(), what })
    }

    fn is_of(&self, finding: &Finding) -> bool {
        self.takes(finding.kind, &finding.subject, finding.pitfall)
    }

    fn takes(&self, kind: Kind, subject: &str, pitfall: Option<Pitfall>) -> bool {
        let subject = self.subject == "*" || self.subject.eq_ignore_ascii_case(subject);
        let what = match self.what {
            What::Trap(number) => pitfall.is_some_and(|it| it.number() == number),
            What::Kind(name) => kind.name() == name,
        };
        subject && what
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn finding(verdict: Verdict) -> Finding {
        Finding {
            kind: Kind::Counter,
            at: None,
            subject: "parts".to_owned(),
            pitfall: Some(Pitfall::numbered(2)),
            verdict,
        }
    }

    #[test]
    fn a_line_accepts_a_trap_of_a_counter() {
        let accepted =
            Accepted::parse("# signed by Ada\nParts 2: nobody reads it\n* 5: no input at start", "a").unwrap();
        assert!(accepted.accepts(&finding(Verdict::Undecided)));
        let other = Finding { pitfall: Some(Pitfall::numbered(3)), ..finding(Verdict::Undecided) };
        assert!(!accepted.accepts(&other));
        assert!(accepted.accepts(&Finding { pitfall: Some(Pitfall::numbered(5)), ..other }));
    }

    #[test]
    fn a_line_that_accepts_nothing_is_stale() {
        let accepted = Accepted::parse("parts 2: nobody reads it\nparts 3: never below 0", "a.txt").unwrap();
        let mut findings = Findings::default();
        findings.all.push(finding(Verdict::Impossible("it does not count up".to_owned())));
        assert_eq!(
            accepted.stale(&findings),
            [
                "a.txt:1: trap 2 of `parts` is accepted, and is impossible: it does not count up",
                "a.txt:2: trap 3 of `parts` is accepted, and is not found"
            ]
        );
    }

    #[test]
    fn a_reason_is_asked_for() {
        assert!(Accepted::parse("parts 2", "a").unwrap_err().1.starts_with("there is no reason"));
        assert!(Accepted::parse("parts two: why", "a").unwrap_err().1.starts_with("`two` is no trap's number"));
    }
}
