//! What `staunch compare` prints: a table and a list for people, or an object a finding.

use super::accept::Accepted;
use super::beyond::Kind;
use super::finding::{self, Finding, Findings};
use super::missing::Missing;
use super::pair::{Matched, Pair, Row};
use super::pitfall::{self, Cause, Pitfall};
use super::rejection::Rejection;
use super::search::{Outcome, World};
use super::trace::Trace;
use super::{Verdict, alphabet, stimulus};
use crate::args::{Compare, MessageFormat};
use crate::session::Session;
use crate::{NOT_FOUND, REJECTED, output};
use staunch_host::Event;
use staunch_ir::Location;
use std::fmt::Write;

/// Rows at the start and the end of a long trace that are shown.
const HEAD: usize = 4;
const TAIL: usize = 4;
/// Variables that differ, as columns.
const SHOWN: usize = 3;

pub struct Report<'s> {
    pub session: &'s Session,
    pub args: &'s Compare,
    /// Lines that were rewritten for the other system: before and after.
    pub notes: Vec<(String, String)>,
    /// Names of pins that the move changes.
    pub renamed: usize,
    pub missing: Vec<Missing>,
}

/// One line of the table; `None` stands for rows that are left out.
struct Line {
    scan: usize,
    event: Option<Event>,
    inputs: Vec<String>,
    /// For each shown variable, the value on both sides.
    cells: Vec<[String; 2]>,
}

/// What an exhausted search has shown.
pub fn every_state(pair: &Pair, world: &World, outcome: &Outcome) -> String {
    let compared = world.alphabet.choices.iter().zip(&pair.inputs);
    let compared: Vec<&str> = compared
        .filter(|it| it.0.covered == Some(alphabet::Covered::Compared))
        .map(|it| pair.path(it.1.scalars))
        .collect();
    let mut text = format!("every reachable state was seen ({} scans)", outcome.scans);
    match compared.as_slice() {
        [] => text.push_str(", under every value of the inputs"),
        names => {
            let _ = write!(
                text,
                ", under every value of the inputs on every side of the constants that the program compares {} with",
                names.join(", ")
            );
        }
    }
    if let Some(events) = events(pair) {
        let _ = write!(text, ", with {events} at every point");
    }
    assumed(&mut text, world);
    text
}

/// The events that are tried.
fn events(pair: &Pair) -> Option<String> {
    let words = pair.events().into_iter().map(|it| match it {
        Event::Restart => "a restart",
        Event::Run => "STOP -> RUN",
        Event::Reset => "a reset",
    });
    words.map(str::to_owned).reduce(|all, it| format!("{all} and {it}"))
}

fn assumed(text: &mut String, world: &World) {
    if !world.assumptions.lines.is_empty() {
        let _ = write!(text, "; assumed: {}", world.assumptions.lines.join("; "));
    }
}

/// What a search that found nothing has tried, and what it has not.
pub fn not_found(pair: &Pair, world: &World, outcome: &Outcome) -> Verdict {
    let alphabet = &world.alphabet;
    let mut tried = vec![match outcome.complete {
        true => "every state that the values tried can reach".to_owned(),
        false => format!("every sequence of inputs over {} scans", outcome.depth),
    }];
    if outcome.places > 0 {
        tried.push(format!("inputs that hold, pulse and wait, from {} states", outcome.places));
    }
    tried.extend(events(pair).map(|it| format!("{it} at each of them")));
    tried.push(format!("{} scans in all", outcome.scans));
    if !world.assumptions.lines.is_empty() {
        tried.push(format!("assumed: {}", world.assumptions.lines.join("; ")));
    }
    let mut left = Vec::new();
    if !outcome.complete {
        left.push("longer sequences; a larger --budget tries more of them".to_owned());
    }
    for (choice, input) in alphabet.choices.iter().zip(&pair.inputs).filter(|it| it.0.covered.is_none()) {
        let path = pair.path(input.scalars);
        left.push(format!("values of {path} other than the {} that were tried", choice.values.len()));
    }
    if !alphabet.complete {
        left.push(format!("combinations of inputs other than the {} that change few of them", alphabet.vectors.len()));
    }
    if alphabet::has_untried(pair) {
        left.push("inputs that are strings, or of another type on the other system".to_owned());
    }
    if !pair.whole {
        left.push("elements of long arrays".to_owned());
    }
    Verdict::NotFound { tried, left }
}

impl Report<'_> {
    fn json(&self) -> bool {
        self.session.common.format() == MessageFormat::Json
    }

    fn names(&self) -> [&'static str; 2] {
        [self.args.from.name(), self.args.to.name()]
    }

    /// Prints all of it; the exit code.
    pub fn print(
        &self,
        pair: &Pair,
        world: &World,
        verdict: &Verdict,
        findings: &Findings,
        accepted: &Accepted,
    ) -> Result<u8, String> {
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
        let code = self.code(verdict, &cause, findings, accepted);
        let text = if self.json() {
            self.objects(pair, world, verdict, findings, accepted, &cause)
        } else {
            self.human(pair, world, verdict, findings, accepted, &cause)
        };
        if !self.session.common.quiet || code != 0 {
            output::print(text.as_bytes())?;
        }
        for line in accepted.stale(findings) {
            eprintln!("warning: {line}");
        }
        Ok(code)
    }

    /// 0 where nothing differs, or what does is accepted with what is undecided.
    fn code(&self, verdict: &Verdict, cause: &Cause, findings: &Findings, accepted: &Accepted) -> u8 {
        let open = |wanted: fn(&Finding) -> bool| findings.all.iter().any(|it| wanted(it) && !accepted.accepts(it));
        let reachable = open(Finding::is_reachable);
        let undecided = open(Finding::is_open);
        let explained = cause.pitfall.is_some() && !reachable;
        match verdict {
            _ if !self.missing.is_empty() => REJECTED,
            Verdict::Differs { .. } if !explained || !accepted.accepts_any() => REJECTED,
            Verdict::Differs { .. } if undecided => NOT_FOUND,
            Verdict::Differs { .. } | Verdict::Equal(_) => 0,
            Verdict::NotFound { .. } if accepted.accepts_any() && !undecided => 0,
            Verdict::NotFound { .. } => NOT_FOUND,
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
            let _ = writeln!(text, "Trap {}: {}", pitfall.number(), pitfall.sentence());
        }
        let _ = writeln!(text, "What to do: {}.", rejection.advice);
        output::print(text.as_bytes())?;
        Ok(REJECTED)
    }

    fn human(
        &self,
        pair: &Pair,
        world: &World,
        verdict: &Verdict,
        findings: &Findings,
        accepted: &Accepted,
        cause: &Cause,
    ) -> String {
        let [from, to] = self.names();
        let mut text = self.rewritten();
        for it in &self.missing {
            let _ = writeln!(
                text,
                "{}: {} has no {} (`{}`): there it is {}; compared as it stands.",
                it.at,
                to.to_ascii_uppercase(),
                it.what,
                it.subject,
                it.instead
            );
        }
        match verdict {
            Verdict::Differs { rows, shortest, .. } => text += &self.table(pair, world, rows, *shortest, cause),
            Verdict::Equal(why) => {
                let _ = writeln!(text, "{from} and {to} are equal: {why}.");
            }
            Verdict::NotFound { tried, left } => {
                let _ = writeln!(text, "No difference between {from} and {to} was found, and none is ruled out.");
                let _ = writeln!(text, "Tried: {}.\nNot tried: {}.", tried.join(", "), left.join("; "));
            }
        }
        if self.args.stimulus.is_none() {
            text += &self.listed(findings, accepted);
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
        format!("Trap {} ({count}): {}\n", pitfall.number(), pitfall.sentence())
    }

    fn rewritten(&self) -> String {
        let mut text = String::new();
        if !self.notes.is_empty() {
            let _ = writeln!(
                text,
                "{} needs the program rewritten; compared as:",
                self.args.to.name().to_ascii_uppercase()
            );
            for (before, after) in &self.notes {
                let _ = writeln!(text, "  - {before}\n  + {after}");
            }
            text.push('\n');
        }
        text
    }

    fn table(&self, pair: &Pair, world: &World, rows: &[Row], shortest: bool, cause: &Cause) -> String {
        let [from, to] = self.names();
        let Some(last) = rows.last() else { return String::new() };
        let differences = pair.differences(last);
        let scans = if rows.len() == 1 { "1 scan".to_owned() } else { format!("{} scans", rows.len()) };
        let mut text = format!("{from} and {to} differ after {scans}:\n\n");
        let shown = &differences[..differences.len().min(SHOWN)];
        let inputs = self.inputs(pair, rows);
        let events = rows.iter().any(|it| it.event.is_some());
        let mut header = vec!["scan".to_owned()];
        if events {
            header.push("@event".to_owned());
        }
        header.extend(inputs.iter().map(|it| pair.path(pair.inputs[*it].scalars).to_owned()));
        for it in shown {
            let path = pair.path(*it);
            header.extend([format!("{path} {from}"), format!("{path} {to}")]);
        }
        let mut table = vec![header];
        for line in self.lines(pair, rows, &inputs, shown) {
            table.push(line.map_or_else(Vec::new, |it| it.cells(events)));
        }
        // The last row ends in the cell where they part.
        if let (Some(row), false) = (table.last_mut(), shown.is_empty()) {
            let first = row.len() - 2 * shown.len() + 1;
            row[first].push_str(" ◀");
        }
        text += &aligned(&table);
        text += &self.faults(rows);
        if inputs.len() < pair.inputs.len() {
            let _ =
                writeln!(text, "  {} inputs do not change; --all-inputs shows them", pair.inputs.len() - inputs.len());
        }
        if differences.len() > SHOWN {
            let more = differences[SHOWN..].iter().map(|it| pair.path(*it));
            let _ = writeln!(text, "  also different: {}", more.take(12).collect::<Vec<_>>().join(", "));
        }
        if shortest {
            text.push_str("  no shorter sequence of these inputs makes a difference\n");
        }
        if !world.assumptions.lines.is_empty() {
            let _ = writeln!(text, "  assumed: {}", world.assumptions.lines.join("; "));
        }
        text.push('\n');
        match cause.pitfall {
            Some(pitfall) => {
                let counter = cause.counter.as_ref().map_or_else(String::new, |it| format!(" (`{it}`)"));
                let _ = writeln!(text, "Trap {}{counter}: {}", pitfall.number(), pitfall.sentence());
                let _ = writeln!(text, "What to do: {}", pitfall.advice());
            }
            None => text.push_str("None of the traps explains it; see `docs/compare.md`.\n"),
        }
        text
    }

    /// The inputs that change, or all of them.
    fn inputs(&self, pair: &Pair, rows: &[Row]) -> Vec<usize> {
        let value = |row: &Row, at: usize| pair.sides[0].show(pair.inputs[at].scalars[0], &row.states[0]);
        let changes = |at: &usize| {
            let initial = pair.sides[0].show(pair.inputs[*at].scalars[0], pair.start()[0]);
            rows.iter().any(|row| value(row, *at) != initial)
        };
        let all = 0..pair.inputs.len();
        // Few are shown whole, so that a table does not look as if it had none.
        if self.args.all_inputs || all.len() <= 6 { all.collect() } else { all.filter(changes).collect() }
    }

    /// The rows to show; `None` where some are left out.
    fn lines(&self, pair: &Pair, rows: &[Row], inputs: &[usize], shown: &[Matched]) -> Vec<Option<Line>> {
        let mut lines = Vec::new();
        let mut next = 0;
        let told = if self.args.shows_every_scan() { (0..rows.len()).collect() } else { telling(pair, rows) };
        for at in told {
            if at > next {
                lines.push(None);
            }
            lines.push(Some(Line::of(pair, &rows[at], at + 1, inputs, shown)));
            next = at + 1;
        }
        lines
    }

    fn faults(&self, rows: &[Row]) -> String {
        let Some(Row { faults, .. }) = rows.last() else { return String::new() };
        let mut text = String::new();
        for (name, fault) in self.names().iter().zip(faults) {
            if let Some(fault) = fault {
                let at = fault.at;
                let source = super::line_of(&self.session.sources, at.file, at.line);
                let _ = writeln!(text, "  {name} faults in the last scan: {fault} (`{source}`)");
            }
        }
        text
    }

    /// An object for each finding, and one for the verdict.
    fn objects(
        &self,
        pair: &Pair,
        world: &World,
        verdict: &Verdict,
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
                "{{\"reason\":\"finding\",\"from\":\"{from}\",\"to\":\"{to}\",\"counter\":{},\"trap\":null,\"verdict\":\"missing\",\"scans\":null,\"stimulus\":null,\"why\":{},\"accepted\":false}}",
                quoted(&it.subject),
                quoted(&format!("{}: {to} has no {}: there it is {}", it.at, it.what, it.instead))
            );
        }
        let rewritten: Vec<_> =
            self.notes.iter().map(|(before, after)| format!("[{},{}]", quoted(before), quoted(after))).collect();
        let name = match verdict {
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
        match verdict {
            Verdict::Differs { rows, trace, shortest } => {
                text += &self.difference(pair, rows, *shortest, cause);
                let saved = trace.as_ref().map_or("null".to_owned(), |it| quoted(&stimulus::text(pair, world, it)));
                let _ = write!(text, ",\"stimulus\":{saved}");
            }
            Verdict::Equal(why) => {
                let _ = write!(text, ",\"why\":{}", quoted(why));
            }
            Verdict::NotFound { tried, left } => {
                let list = |it: &[String]| it.iter().map(|it| quoted(it)).collect::<Vec<_>>().join(",");
                let _ = write!(text, ",\"tried\":[{}],\"not_tried\":[{}]", list(tried), list(left));
            }
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
            finding::Verdict::Reachable(_) if finding.pitfall.is_none() => ("reachable", quoted(finding.kind.reason())),
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
            accepted.accepts(finding)
        )
    }

    /// `file:line`
    fn place(&self, at: Location) -> String {
        let source = self.session.sources.files().get(usize::from(at.file));
        format!("{}:{}", source.map_or("", |it| it.path.as_str()), at.line)
    }

    /// What is known of each counter, block and variable, in a line for each verdict.
    fn listed(&self, findings: &Findings, accepted: &Accepted) -> String {
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
            let lines = (kind, of_subject(&own, accepted));
            let place = at.map_or_else(String::new, |it| format!(" ({}, {})", kind.name(), self.place(it)));
            let heading = format!("`{subject}`{place}");
            match known.iter_mut().find(|it| it.0 == lines) {
                Some((_, alike)) => alike.push(heading),
                None => known.push((lines, vec![heading])),
            }
        }
        let mut text = String::new();
        for ((_, lines), headings) in known {
            let more =
                if headings.len() > 1 { format!(" and {} more alike", headings.len() - 1) } else { String::new() };
            let _ = write!(text, "\n{}{more}\n{lines}", headings[0]);
        }
        text
    }

    fn difference(&self, pair: &Pair, rows: &[Row], shortest: bool, cause: &Cause) -> String {
        let differences = rows.last().map_or_else(Vec::new, |it| pair.differences(it));
        let sentence = cause.pitfall.map_or("null".to_owned(), |it| quoted(it.sentence()));
        let advice = cause.pitfall.map_or("null".to_owned(), |it| quoted(it.advice()));
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

fn number(pitfall: Option<Pitfall>) -> String {
    pitfall.map_or("null".to_owned(), |it| it.number().to_string())
}

/// What is known of one counter.
fn of_subject(own: &[&Finding], accepted: &Accepted) -> String {
    let mut text = String::new();
    for finding in own {
        if let finding::Verdict::Reachable(trace) = &finding.verdict {
            let _ = writeln!(text, "  {}{}", reached(finding, trace.as_ref()), note(finding, accepted));
        }
    }
    let undecided: Vec<&&Finding> = own.iter().filter(|it| matches!(it.verdict, finding::Verdict::Undecided)).collect();
    let traps: Vec<String> =
        undecided.iter().filter_map(|it| Some(format!("{}{}", it.pitfall?.number(), note(it, accepted)))).collect();
    if !traps.is_empty() {
        let _ = writeln!(text, "  undecided: trap {}", traps.join(", "));
    } else if !undecided.is_empty() {
        text.push_str("  undecided: it was not seen to differ\n");
    }
    text + &impossible(own)
}

fn reached(finding: &Finding, trace: Option<&Trace>) -> String {
    let when = match trace.map(Trace::scans) {
        Some(1) => "after 1 scan".to_owned(),
        Some(scans) => format!("after {scans} scans"),
        None => "in the text".to_owned(),
    };
    match finding.pitfall {
        Some(pitfall) => format!("reachable {when}: trap {}. {}", pitfall.number(), pitfall.sentence()),
        None => format!("differs {when}: {}", finding.kind.reason()),
    }
}

fn note(finding: &Finding, accepted: &Accepted) -> &'static str {
    if accepted.accepts(finding) { " (accepted)" } else { "" }
}

/// The pitfalls that cannot happen, by the reasons why.
fn impossible(own: &[&Finding]) -> String {
    let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
    for finding in own {
        let finding::Verdict::Impossible(why) = &finding.verdict else { continue };
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

/// Which rows tell the story: all of a short trace; of a longer one those in which an input
/// changes, and the two at its end.
fn telling(pair: &Pair, rows: &[Row]) -> Vec<usize> {
    if rows.len() <= HEAD + TAIL + 1 {
        return (0..rows.len()).collect();
    }
    let inputs = |row: &Row| pair.inputs.iter().map(|it| pair.sides[0].show(it.scalars[0], &row.states[0])).collect();
    let mut before: Vec<String> = Vec::new();
    let mut told = Vec::new();
    for (at, row) in rows.iter().enumerate() {
        let now: Vec<String> = inputs(row);
        if now != before || row.event.is_some() || at + 2 >= rows.len() {
            told.push(at);
        }
        before = now;
    }
    if told.len() > HEAD + TAIL + 1 {
        told.drain(HEAD..told.len() - TAIL);
    }
    told
}

impl Line {
    fn of(pair: &Pair, row: &Row, scan: usize, inputs: &[usize], shown: &[Matched]) -> Self {
        let show = |side: usize, scalar: usize| pair.sides[side].show(scalar, &row.states[side]);
        Self {
            scan,
            event: row.event,
            inputs: inputs.iter().map(|it| show(0, pair.inputs[*it].scalars[0])).collect(),
            cells: shown.iter().map(|[a, b]| [show(0, *a), show(1, *b)]).collect(),
        }
    }

    fn cells(self, events: bool) -> Vec<String> {
        let mut cells = vec![self.scan.to_string()];
        if events {
            cells.push(self.event.map_or("", Event::name).to_owned());
        }
        cells.extend(self.inputs);
        cells.extend(self.cells.into_iter().flatten());
        cells
    }

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

/// Columns at equal width, numbers and words to the right; an empty row is left out rows.
fn aligned(table: &[Vec<String>]) -> String {
    let columns = table[0].len();
    let width = |at: usize| {
        let cells = table.iter().filter_map(|row| row.get(at));
        cells.map(|it| it.trim_end_matches(" ◀").chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<_> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in table {
        let mut line = String::new();
        if row.is_empty() {
            line.push_str("     …");
        }
        for (cell, width) in row.iter().zip(&widths) {
            let plain = cell.trim_end_matches(" ◀");
            let _ = write!(line, "  {plain:>width$}{}", &cell[plain.len()..]);
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// A JSON string.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            it if it.is_control() => {
                let _ = write!(out, "\\u{:04x}", u32::from(it));
            }
            it => out.push(it),
        }
    }
    out.push('"');
    out
}
