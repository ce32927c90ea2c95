//! The report as JSON: an object for each finding, and one for the verdict.

use super::table::{Line, SHOWN};
use super::{Report, number};
use staunch_compare::difference::accept::Accepted;
use staunch_compare::difference::pitfall::Cause;
use staunch_compare::findings::finding::{self, Finding, Findings};
use staunch_compare::pair::{Matched, Pair, Row};
use staunch_compare::search::world::World;
use staunch_compare::verdict::{Judged, Other, Verdict, stimulus};
use staunch_host::json_text as quoted;
use std::fmt::Write;

impl Report<'_> {
    /// An object for each finding, and one for the verdict.
    pub(super) fn objects(
        &self,
        pair: &Pair,
        world: &World,
        judged: &Judged,
        findings: &Findings,
        accepted: &Accepted,
        cause: &Cause,
    ) -> String {
        let [from, to] = self.names();
        let mut text = String::new();
        if self.args.stimulus.is_none() {
            for finding in &findings.all {
                text += &self.object(pair, world, [from, to], finding, accepted);
            }
        }
        for it in &self.missing {
            let _ = writeln!(
                text,
                "{{\"reason\":\"finding\",\"from\":\"{from}\",\"to\":\"{to}\",\"kind\":\"missing\",\"at\":{},\"counter\":{},\"trap\":null,\"verdict\":\"missing\",\"scans\":null,\"stimulus\":null,\"why\":{},\"accepted\":false}}",
                quoted(&it.at),
                quoted(&it.subject),
                quoted(&format!("{}: {to} does not have {}: use {} there", it.at, it.what, it.instead))
            );
        }
        for (name, ty) in &self.unknown {
            let _ = writeln!(
                text,
                "{{\"reason\":\"finding\",\"from\":\"{from}\",\"to\":\"{to}\",\"kind\":\"missing\",\"at\":null,\"counter\":{},\"trap\":null,\"verdict\":\"unknown\",\"scans\":null,\"stimulus\":null,\"why\":{},\"accepted\":false}}",
                quoted(name),
                quoted(&format!("no public document says whether {to} has {ty}"))
            );
        }
        let rewritten: Vec<_> =
            self.notes.iter().map(|(before, after)| format!("[{},{}]", quoted(before), quoted(after))).collect();
        let name = match judged.verdict {
            Verdict::Differs { .. } => "different",
            Verdict::Equal(_) => "equal",
            Verdict::NotFound { .. } => "not found",
        };
        let _ = write!(
            text,
            "{{\"reason\":\"compare\",\"from\":\"{from}\",\"to\":\"{to}\",\"verdict\":\"{name}\",\"renamed_pins\":{},\"rewritten\":[{}]",
            self.renamed,
            rewritten.join(",")
        );
        match judged.verdict {
            Verdict::Differs { rows, trace, shortest } => {
                text += &self.difference(pair, rows, *shortest, cause);
                let saved = trace.as_ref().map_or("null".to_owned(), |it| quoted(&stimulus::text(pair, world, it)));
                let _ = write!(text, ",\"stimulus\":{saved}");
            }
            Verdict::Equal(why) => {
                let _ = write!(text, ",\"why\":{}", quoted(why));
            }
            Verdict::NotFound { tried, left } => {
                let _ = write!(text, ",\"tried\":[{}],\"not_tried\":[{}]", list(tried), list(left));
            }
        }
        let beyond = judged.rest.map_or("null", |it| match it {
            Verdict::Differs { .. } => "\"different\"",
            Verdict::Equal(_) => "\"equal\"",
            Verdict::NotFound { .. } => "\"not found\"",
        });
        let _ = write!(text, ",\"beyond_accepted\":{beyond}");
        if let Some(it) = judged.without_run {
            let scans = it.scans.map_or("null".to_owned(), |it| it.to_string());
            let trap = number(it.pitfall);
            let _ =
                write!(text, ",\"without_run\":{{\"verdict\":\"{}\",\"scans\":{scans},\"trap\":{trap}}}", it.verdict);
        }
        let said = [("not_followed", &world.unfollowed), ("open", &world.open), ("in_common", &world.in_common)];
        for (name, sentences) in said {
            let _ = write!(text, ",\"{name}\":[{}]", list(sentences));
        }
        if !judged.others.is_empty() {
            let other = |it: &Other| {
                let without = it.without_run.map(|it| format!(",\"without_run\":{}", quoted(it.0))).unwrap_or_default();
                format!("{{\"settings\":{},\"verdict\":{}{without}}}", it.variant.object(), quoted(it.verdict))
            };
            let others: Vec<_> = judged.others.iter().map(other).collect();
            let settings = judged.variant.object();
            let _ = write!(text, ",\"settings\":{settings},\"other_settings\":[{}]", others.join(","));
        }
        text + "}\n"
    }

    /// One finding as an object.
    fn object(
        &self,
        pair: &Pair,
        world: &World,
        [from, to]: [&str; 2],
        finding: &Finding,
        accepted: &Accepted,
    ) -> String {
        let (verdict, why) = match &finding.verdict {
            finding::Verdict::Reachable(_) if finding.pitfall.is_none() => {
                ("reachable", quoted(finding.reason(self.is_one_program())))
            }
            finding::Verdict::Reachable(_) => ("reachable", "null".to_owned()),
            finding::Verdict::Impossible(why) => ("impossible", quoted(why)),
            finding::Verdict::Undecided => ("undecided", "null".to_owned()),
        };
        let scans = finding.trace().map_or("null".to_owned(), |it| it.scans().to_string());
        let saved = finding.trace().map_or("null".to_owned(), |it| quoted(&stimulus::text(pair, world, it)));
        let at = finding.at.map_or("null".to_owned(), |it| quoted(&self.place(it)));
        format!(
            "{{\"reason\":\"finding\",\"from\":\"{from}\",\"to\":\"{to}\",\"kind\":\"{}\",\"at\":{at},\"counter\":{},\"trap\":{},\"verdict\":\"{verdict}\",\"scans\":{scans},\"stimulus\":{saved},\"why\":{why},\"accepted\":{}}}\n",
            finding.kind.name(),
            quoted(&finding.subject),
            number(finding.pitfall),
            finding.is_accepted(accepted)
        )
    }

    fn difference(&self, pair: &Pair, rows: &[Row], shortest: bool, cause: &Cause) -> String {
        let differences = rows.last().map_or_else(Vec::new, |it| pair.differences(it));
        let sentence = cause.pitfall.map_or("null".to_owned(), |it| quoted(&it.sentence(self.dialects())));
        let advice = cause.pitfall.map_or("null".to_owned(), |it| {
            quoted(&it.advice(self.args.from.dialect, self.args.to.dialect, cause.counting(pair)))
        });
        let counter = cause.counter.as_deref().map_or("null".to_owned(), quoted);
        let variables: Vec<_> = differences.iter().map(|it| quoted(pair.path(*it))).collect();
        let shown = &differences[..differences.len().min(SHOWN)];
        let inputs: Vec<usize> = (0..pair.inputs.len()).collect();
        let lines: Vec<_> =
            self.lines(pair, rows, &inputs, shown).into_iter().flatten().map(|it| it.object(pair, shown)).collect();
        format!(
            ",\"trap\":{},\"sentence\":{sentence},\"advice\":{advice},\"counter\":{counter},\"scans\":{},\"shortest\":{shortest},\"different\":[{}],\"trace\":[{}]",
            number(cause.pitfall),
            rows.len(),
            variables.join(","),
            lines.join(",")
        )
    }
}

fn list(sentences: &[String]) -> String {
    sentences.iter().map(|it| quoted(it)).collect::<Vec<_>>().join(",")
}

impl Line {
    fn object(&self, pair: &Pair, shown: &[Matched]) -> String {
        let inputs = pair
            .inputs
            .iter()
            .zip(&self.inputs)
            .map(|(it, value)| format!("{}:{}", quoted(pair.path(it.scalars)), quoted(value)));
        let inputs: Vec<_> = inputs.collect();
        let side = |side: usize| {
            let cells = shown
                .iter()
                .zip(&self.cells)
                .map(|(it, cell)| format!("{}:{}", quoted(pair.path(*it)), quoted(&cell[side])));
            cells.collect::<Vec<_>>().join(",")
        };
        let event = self.event.map_or("null".to_owned(), |it| quoted(it.name()));
        format!(
            "{{\"scan\":{},\"event\":{event},\"inputs\":{{{}}},\"from\":{{{}}},\"to\":{{{}}}}}",
            self.scan,
            inputs.join(","),
            side(0),
            side(1)
        )
    }
}
