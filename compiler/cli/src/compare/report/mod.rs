//! What `staunch compare` prints: a table and a list for people, or an object a finding.

pub mod picture;
pub mod rejection;

mod listed;
mod objects;
mod table;

use crate::args::{Compare, MessageFormat};
use crate::session::Session;
use crate::{NOT_FOUND, REJECTED, output};
use rejection::Rejection;
use staunch_compare::difference::accept::Accepted;
use staunch_compare::difference::pitfall::{self, Cause, Pitfall};
use staunch_compare::findings::finding::Findings;
use staunch_compare::other::missing::Missing;
use staunch_compare::pair::Pair;
use staunch_compare::request::Request;
use staunch_compare::search::world::World;
use staunch_compare::verdict::{Judged, Verdict, stimulus};
use staunch_frontend::Dialect;
use staunch_host::json_text as quoted;
use std::fmt::Write;

pub struct Report<'s> {
    pub session: &'s Session,
    pub args: &'s Compare,
    pub request: &'s Request,
    /// Lines that were rewritten for the other system: before and after.
    pub notes: Vec<(String, String)>,
    /// Names of pins that the move changes.
    pub renamed: usize,
    pub missing: Vec<Missing>,
    /// Variables, and their types that the other system may have or not.
    pub unknown: Vec<(String, String)>,
}

impl Report<'_> {
    fn json(&self) -> bool {
        self.session.common.format() == MessageFormat::Json
    }

    /// Whether both systems run the same text, or what was made of it here.
    fn is_one_program(&self) -> bool {
        self.args.against.is_none()
    }

    fn dialects(&self) -> [Dialect; 2] {
        [self.args.from.dialect, self.args.to.dialect]
    }

    fn names(&self) -> [&'static str; 2] {
        [self.args.from.name, self.args.to.name]
    }

    /// Prints all of it; the exit code.
    pub fn print(
        &self,
        pair: &Pair,
        world: &World,
        judged: &Judged,
        findings: &Findings,
        accepted: &Accepted,
    ) -> Result<u8, String> {
        let verdict = judged.verdict;
        let cause = match verdict {
            Verdict::Differs { rows, .. } => {
                let differences = rows.last().map_or_else(Vec::new, |it| pair.differences(it));
                pitfall::cause(pair, rows, &differences, &world.habits)
            }
            Verdict::Equal(_) | Verdict::NotFound { .. } => Cause::default(),
        };
        if let (Some(path), Verdict::Differs { trace: Some(trace), .. }) = (&self.args.save_stimulus, verdict) {
            output::write(path, stimulus::text(pair, world, trace).as_bytes())?;
        }
        let code = self.code(judged);
        let text = if self.json() {
            self.objects(pair, world, judged, findings, accepted, &cause)
        } else {
            self.human(pair, world, judged, findings, accepted, &cause)
        };
        if !self.session.common.quiet || code != 0 {
            output::print(text.as_bytes())?;
        }
        for line in findings.stale(accepted) {
            output::tell(format_args!("warning: {line}"));
        }
        Ok(code)
    }

    /// 0 where nothing differs, or nothing beyond what is accepted: both are shown, and not only not found.
    fn code(&self, judged: &Judged) -> u8 {
        match (judged.verdict, judged.rest) {
            _ if !self.missing.is_empty() => REJECTED,
            (Verdict::Equal(_), _) | (Verdict::Differs { .. }, Some(Verdict::Equal(_))) => 0,
            (Verdict::NotFound { .. }, _) | (Verdict::Differs { .. }, Some(Verdict::NotFound { .. })) => NOT_FOUND,
            (Verdict::Differs { .. }, None | Some(Verdict::Differs { .. })) => REJECTED,
        }
    }

    pub fn rejection(&self, rejection: &Rejection) -> Result<u8, String> {
        let [from, to] = self.names();
        if self.json() {
            let text = format!(
                "{{\"reason\":\"compare\",\"from\":\"{from}\",\"to\":\"{to}\",\"verdict\":\"rejected\",\"trap\":{},\"why\":{},\"advice\":{}}}\n",
                number(rejection.pitfall),
                quoted(&rejection.why),
                quoted(&rejection.advice)
            );
            output::print(text.as_bytes())?;
            return Ok(REJECTED);
        }
        let mut text = format!("{from} and {to} cannot be compared: {}.\n", rejection.why);
        if let Some(pitfall) = rejection.pitfall {
            let _ = writeln!(text, "Trap {}: {}", pitfall.number(), pitfall.sentence(self.dialects()));
        }
        let _ = writeln!(text, "What to do: {}.", rejection.advice);
        output::print(text.as_bytes())?;
        Ok(REJECTED)
    }

    fn human(
        &self,
        pair: &Pair,
        world: &World,
        judged: &Judged,
        findings: &Findings,
        accepted: &Accepted,
        cause: &Cause,
    ) -> String {
        let [from, to] = self.names();
        let mut text = self.rewritten();
        for it in &self.missing {
            let _ = writeln!(
                text,
                "{}: {} does not have {} (`{}`): use {} there; compared as it is.",
                it.at,
                to.to_ascii_uppercase(),
                it.what,
                it.subject,
                it.instead
            );
        }
        if !self.unknown.is_empty() {
            let each: Vec<_> = self.unknown.iter().map(|(name, ty)| format!("{ty} (`{name}`)")).collect();
            let to = to.to_ascii_uppercase();
            let _ = writeln!(text, "Not known: no public document says whether {to} has {}.", each.join(", "));
        }
        match judged.verdict {
            Verdict::Differs { rows, shortest, .. } => {
                let shortest = shortest.then(|| shortest_of(judged, rows.len()));
                text += &self.table(pair, world, rows, shortest, cause, findings);
                text += &beyond(judged);
                world.unfollowed.iter().for_each(|it| _ = writeln!(text, "Not followed: {it}"));
            }
            Verdict::Equal(why) => {
                let _ = writeln!(text, "{from} and {to} are equal: {why}.");
            }
            Verdict::NotFound { tried, left } => {
                let _ = writeln!(text, "No difference between {from} and {to} was found, but none is ruled out.");
                let _ = writeln!(text, "Tried: {}.\nNot tried: {}.", tried.join(", "), left.join("; "));
            }
        }
        if let Some(it) = judged.without_run {
            let _ = writeln!(
                text,
                "If nobody switches it to STOP (`no run` in the file that --assume names), {}.",
                it.words
            );
        }
        text += &variants(judged, cause.pitfall.is_some());
        if !matches!(judged.verdict, Verdict::Differs { .. }) {
            world.open.iter().chain(&world.in_common).for_each(|it| _ = writeln!(text, "{it}"));
        }
        if self.args.stimulus.is_none() {
            text += &self.listed(findings, accepted);
            text += &self.not_accepted(findings, accepted);
        }
        text + &self.names_change()
    }

    fn names_change(&self) -> String {
        if self.renamed == 0 {
            return String::new();
        }
        let pitfall = Pitfall::numbered(9);
        let count =
            if self.renamed == 1 { "1 name changes".to_owned() } else { format!("{} names change", self.renamed) };
        format!("Trap {} ({count}): {}\n", pitfall.number(), pitfall.sentence(self.dialects()))
    }

    fn rewritten(&self) -> String {
        let mut text = String::new();
        if !self.notes.is_empty() {
            let _ =
                writeln!(text, "{} needs the program rewritten; compared as:", self.args.to.name.to_ascii_uppercase());
            for (before, after) in &self.notes {
                let _ = writeln!(text, "  - {before}\n  + {after}");
            }
            text.push('\n');
        }
        text
    }
}

/// Where nothing shorter makes a difference: with another answer to what is left open, something may.
fn shortest_of(judged: &Judged, scans: usize) -> &'static str {
    match judged.others.iter().any(|it| it.scans.is_some_and(|it| it < scans)) {
        true => "no shorter sequence of these inputs shows a difference with these settings; with others, one does",
        false => "no shorter sequence of these inputs shows a difference",
    }
}

/// What the vendors' documents leave open, and what each answer comes to.
fn variants(judged: &Judged, is_advised: bool) -> String {
    if judged.others.is_empty() {
        return String::new();
    }
    let mut text = judged.variant.questions().join(" ");
    let _ = write!(text, " The verdict above is with {}.", judged.variant.words());
    for other in judged.others {
        let _ = write!(text, " With {}, {}.", other.variant.words(), other.words());
    }
    if is_advised && matches!(judged.verdict, Verdict::Differs { .. }) {
        let _ =
            write!(text, " The advice is valid with {}, but perhaps not with other settings.", judged.variant.words());
    }
    text.push('\n');
    text
}

/// What is said of the search past what is accepted.
fn beyond(judged: &Judged) -> String {
    match judged.rest {
        None | Some(Verdict::Differs { .. }) => String::new(),
        Some(Verdict::Equal(why)) => {
            format!("That is accepted. Apart from it and its consequences, the two are equal: {why}.\n")
        }
        Some(Verdict::NotFound { tried, left }) => format!(
            "That is accepted. No other difference was found, but none is ruled out.\nTried: {}.\nNot tried: {}.\n",
            tried.join(", "),
            left.join("; ")
        ),
    }
}

fn number(pitfall: Option<Pitfall>) -> String {
    pitfall.map_or("null".to_owned(), |it| it.number().to_string())
}
