//! What is known of each counter, block and variable, as a list.

use super::Report;
use staunch_compare::difference::accept::Accepted;
use staunch_compare::difference::kind::Kind;
use staunch_compare::difference::pitfall::OF_OTHERS;
use staunch_compare::findings::finding::{self, Finding, Findings};
use staunch_compare::search::trace::Trace;
use staunch_ir::Location;
use std::fmt::Write;

/// Counters, blocks and variables of which the same is known that are named.
const HEADINGS: usize = 8;

impl Report<'_> {
    /// `file:line`
    pub(super) fn place(&self, at: Location) -> String {
        let source = self.session.sources.files().get(usize::from(at.file));
        format!("{}:{}", source.map_or("", |it| it.path.as_str()), at.line)
    }

    /// What is known of each counter, block and variable, in a line for each verdict.
    pub(super) fn listed(&self, findings: &Findings, accepted: &Accepted) -> String {
        let mut subjects: Vec<(&str, Kind, Option<Location>)> = Vec::new();
        for finding in &findings.all {
            let subject = (finding.subject.as_str(), finding.kind, finding.at);
            if !subjects.contains(&subject) {
                subjects.push(subject);
            }
        }
        let mut known: Vec<((Kind, String), Vec<String>)> = Vec::new();
        for (subject, kind, at) in subjects {
            let is_own = |it: &&Finding| (it.subject.as_str(), it.kind, it.at) == (subject, kind, at);
            let own: Vec<&Finding> = findings.all.iter().filter(is_own).collect();
            let lines = (kind, self.of_subject(&own, accepted));
            let place = at.map_or_else(String::new, |it| format!(" ({}, {})", kind.name(), self.place(it)));
            let heading = format!("`{subject}`{place}");
            match known.iter_mut().find(|it| it.0 == lines) {
                Some((_, alike)) => alike.push(heading),
                None => known.push((lines, vec![heading])),
            }
        }
        let mut text = String::new();
        for ((_, lines), headings) in known {
            let _ = write!(text, "\n{}\n{lines}", self.headings(&headings));
        }
        text
    }
}

impl Report<'_> {
    /// Those of which the same is known.
    fn headings(&self, all: &[String]) -> String {
        let is_verbose = self.session.common.verbose > 0;
        let shown = if is_verbose { all.len() } else { HEADINGS };
        match all.len().saturating_sub(shown) {
            0 => all.join("\n"),
            more => format!("{}\nand {more} more of the same kind; -v lists them", all[..shown].join("\n")),
        }
    }

    /// What is known of one counter.
    fn of_subject(&self, own: &[&Finding], accepted: &Accepted) -> String {
        let mut text = String::new();
        for finding in own {
            if let finding::Verdict::Reachable(trace) = &finding.verdict {
                let _ = writeln!(text, "  {}{}", self.reached(finding, trace.as_ref()), note(finding, accepted));
            }
        }
        let undecided: Vec<&&Finding> =
            own.iter().filter(|it| matches!(it.verdict, finding::Verdict::Undecided)).collect();
        let traps: Vec<String> =
            undecided.iter().filter_map(|it| Some(format!("{}{}", it.pitfall?.number(), note(it, accepted)))).collect();
        if !traps.is_empty() {
            let _ = writeln!(text, "  undecided: trap {}", traps.join(", "));
        } else if !undecided.is_empty() {
            text.push_str("  undecided: no difference was seen\n");
        }
        text + &impossible(own, self.session.common.verbose > 0)
    }

    fn reached(&self, finding: &Finding, trace: Option<&Trace>) -> String {
        let when = match trace.map(Trace::scans) {
            Some(1) => "after 1 scan".to_owned(),
            Some(scans) => format!("after {scans} scans"),
            None => "in the text".to_owned(),
        };
        match finding.pitfall {
            Some(pitfall) => {
                format!("reachable {when}: trap {}. {}", pitfall.number(), pitfall.sentence(self.dialects()))
            }
            None => format!("differs {when}: {}", finding.reason(self.is_one_program())),
        }
    }
}

impl Report<'_> {
    /// Why the command fails, although some of what was found is accepted.
    pub(super) fn not_accepted(&self, findings: &Findings, accepted: &Accepted) -> String {
        let open = findings.all.iter().filter(|it| it.is_reachable() && !it.is_accepted(accepted));
        let names = open.map(|it| match it.pitfall {
            Some(pitfall) => format!("`{} {}`", it.subject, pitfall.number()),
            None => format!("`{} {}`", it.subject, it.kind.name()),
        });
        let names: Vec<String> = names.collect();
        match names.as_slice() {
            [] => String::new(),
            _ if !accepted.accepts_any() => String::new(),
            names => format!("\nNot accepted: {}.\n{}", names.join(", "), outputs(findings, accepted)),
        }
    }
}

/// How to accept outputs that follow from what is accepted.
fn outputs(findings: &Findings, accepted: &Accepted) -> String {
    let open = findings.all.iter().filter(|it| it.kind == Kind::Output && !it.is_accepted(accepted));
    let lines: Vec<String> = open.map(|it| format!("`{} output: reason`", it.subject)).collect();
    match lines.as_slice() {
        [] => String::new(),
        lines => format!("An output needs a line of its own in the file of accepted findings: {}.\n", lines.join(", ")),
    }
}

fn note(finding: &Finding, accepted: &Accepted) -> &'static str {
    if finding.is_accepted(accepted) { " (accepted)" } else { "" }
}

/// The pitfalls that cannot happen, by the reasons why; those of other systems only where all is asked for.
fn impossible(own: &[&Finding], verbose: bool) -> String {
    let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
    for finding in own {
        let finding::Verdict::Impossible(why) = &finding.verdict else { continue };
        if why.ends_with(OF_OTHERS) && !verbose {
            continue;
        }
        let pitfall = finding.pitfall.map(|it| it.number().to_string());
        match reasons.iter_mut().find(|it| it.0 == why) {
            Some((_, pitfalls)) => pitfalls.extend(pitfall),
            None => reasons.push((why, pitfall.into_iter().collect())),
        }
    }
    let line = |(why, pitfalls): (&str, Vec<String>)| match pitfalls.as_slice() {
        [] => format!("  does not differ: {why}\n"),
        _ => format!("  impossible: trap {}: {why}\n", pitfalls.join(", ")),
    };
    reasons.into_iter().map(line).collect()
}
