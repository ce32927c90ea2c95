//! A difference as a table: the scans that show it, with the inputs that change and the variables that differ.

use super::Report;
use staunch_compare::difference::pitfall::Cause;
use staunch_compare::findings::finding::Findings;
use staunch_compare::findings::reason;
use staunch_compare::pair::{Matched, Pair, Row};
use staunch_compare::search::world::World;
use staunch_frontend::Sources;
use staunch_host::Event;
use std::fmt::Write;

/// Rows at the start and the end of a long trace that are shown.
const HEAD: usize = 4;
const TAIL: usize = 4;
/// Variables that differ, as columns.
pub(super) const SHOWN: usize = 3;
/// And others, by their names.
const ALSO: usize = 12;

/// One line of the table; `None` stands for rows that are left out.
pub(super) struct Line {
    pub scan: usize,
    pub event: Option<Event>,
    pub inputs: Vec<String>,
    /// For each shown variable, the value on both sides.
    pub cells: Vec<[String; 2]>,
}

impl Report<'_> {
    pub(super) fn table(
        &self,
        pair: &Pair,
        world: &World,
        rows: &[Row],
        shortest: Option<&str>,
        cause: &Cause,
        findings: &Findings,
    ) -> String {
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
            let more: Vec<&str> = differences[SHOWN..].iter().map(|it| pair.path(*it)).collect();
            let named = if self.session.common.verbose > 0 { more.len() } else { more.len().min(ALSO) };
            let rest = more.len() - named;
            let rest = if rest > 0 { format!(" and {rest} more; -v lists them") } else { String::new() };
            let _ = writeln!(text, "  also different: {}{rest}", more[..named].join(", "));
        }
        text.extend(shortest.map(|it| format!("  {it}\n")));
        if !world.assumptions.lines.is_empty() {
            let _ = writeln!(text, "  assumed: {}", world.assumptions.lines.join("; "));
        }
        text.push('\n');
        match cause.pitfall {
            Some(pitfall) => {
                let counter = cause.counter.as_ref().map_or_else(String::new, |it| format!(" (`{it}`)"));
                let _ = writeln!(text, "Trap {}{counter}: {}", pitfall.number(), pitfall.sentence(self.dialects()));
                let _ = writeln!(
                    text,
                    "What to do: {}",
                    pitfall.advice(self.args.from.dialect, self.args.to.dialect, cause.counting(pair))
                );
            }
            None => text += &self.unexplained(pair, rows, &differences, findings),
        }
        text
    }

    /// Why it differs, where it is not by a trap.
    fn unexplained(&self, pair: &Pair, rows: &[Row], differences: &[Matched], findings: &Findings) -> String {
        match reason::find(pair, rows, differences, findings) {
            Some(reason::Reason { finding: it, of }) => {
                let place = it.at.map_or_else(String::new, |at| format!(", {}", self.place(at)));
                let path = pair.path(of);
                let follows = if path == it.subject { String::new() } else { format!("`{path}` follows from ") };
                format!(
                    "{follows}`{}` ({}{place}): {}.\n",
                    it.subject,
                    it.kind.name(),
                    it.reason(self.is_one_program())
                )
            }
            None => self.fault_of_one(pair, rows).unwrap_or_else(|| {
                let own = |it: &Matched| findings.all.iter().find(|finding| finding.subject == pair.path(*it));
                let because = differences.iter().find_map(|it| own(it)?.because.as_deref());
                because.map_or_else(
                    || "None of the traps explains it; see `docs/compare.md`.\n".to_owned(),
                    |it| format!("None of the traps explains it: {it}.\n"),
                )
            }),
        }
    }

    /// The inputs that change, or all of them.
    fn inputs(&self, pair: &Pair, rows: &[Row]) -> Vec<usize> {
        let changes = |at: &usize| {
            let initial = pair.sides[0].show(pair.inputs[*at].scalars[0], pair.start()[0]);
            rows.iter().any(|row| row.inputs[*at] != initial)
        };
        let all = 0..pair.inputs.len();
        // Few are shown whole, so that a table does not look as if it had none.
        if self.args.all_inputs || all.len() <= 6 { all.collect() } else { all.filter(changes).collect() }
    }

    /// The rows to show; `None` where some are left out.
    pub(super) fn lines(&self, pair: &Pair, rows: &[Row], inputs: &[usize], shown: &[Matched]) -> Vec<Option<Line>> {
        let mut lines = Vec::new();
        let mut next = 0;
        let told = if self.args.shows_every_scan() { (0..rows.len()).collect() } else { telling(rows) };
        for at in told {
            if at > next {
                lines.push(None);
            }
            lines.push(Some(Line::of(pair, &rows[at], at + 1, inputs, shown)));
            next = at + 1;
        }
        lines
    }

    /// What one system alone makes a fault of.
    fn fault_of_one(&self, pair: &Pair, rows: &[Row]) -> Option<String> {
        let faults = rows.last().map(|it| it.faults).filter(|it| pair.faults_differ(*it))?;
        let side = usize::from(faults[0].is_none());
        let (fault, names) = (faults[side]?, self.names());
        if faults[1 - side].is_some() {
            return None;
        }
        let (place, kind) = (self.place(fault.at), fault.kind);
        Some(format!(
            "None of the traps explains it: a {kind} ({place}) is a fault on {}, but {} continues.\n",
            names[side],
            names[1 - side]
        ))
    }

    fn faults(&self, rows: &[Row]) -> String {
        let Some(Row { faults, .. }) = rows.last() else { return String::new() };
        let mut text = String::new();
        for (name, fault) in self.names().iter().zip(faults) {
            if let Some(fault) = fault {
                let at = fault.at;
                let source = line_of(&self.session.sources, at.file, at.line);
                let _ = writeln!(text, "  {name} faults in the last scan: {fault} (`{source}`)");
            }
        }
        text
    }
}

/// Which rows are shown: all of a short trace; of a longer one those in which an input
/// changes, and the two at its end.
fn telling(rows: &[Row]) -> Vec<usize> {
    if rows.len() <= HEAD + TAIL + 1 {
        return (0..rows.len()).collect();
    }
    let mut before: &[String] = &[];
    let mut told = Vec::new();
    for (at, row) in rows.iter().enumerate() {
        let now = row.inputs.as_slice();
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
            inputs: inputs.iter().map(|it| row.inputs[*it].clone()).collect(),
            cells: shown.iter().map(|[a, b]| [show(0, *a), show(1, *b)]).collect(),
        }
    }

    fn cells(self, events: bool) -> Vec<String> {
        let mut cells = vec![self.scan.to_string()];
        if events {
            cells.push(self.event.map_or("", Event::name).to_owned());
        }
        cells.extend(self.inputs.into_iter().map(|it| part(&it, 0)));
        cells.extend(self.cells.into_iter().flat_map(brief));
        cells
    }
}

/// Characters of a text that a cell shows.
const WIDEST: usize = 28;

/// Long texts where they differ first.
fn brief(both: [String; 2]) -> [String; 2] {
    let same = both[0].chars().zip(both[1].chars()).take_while(|(a, b)| a == b).count();
    both.map(|it| part(&it, same.saturating_sub(WIDEST / 2)))
}

/// A text that is too wide for a cell, from a character on or as much of its end as fits.
fn part(text: &str, from: usize) -> String {
    let length = text.chars().count();
    if length <= WIDEST {
        return text.to_owned();
    }
    let from = from.min(length - WIDEST);
    let shown: String = text.chars().skip(from).take(WIDEST).collect();
    let (before, after) = (if from > 0 { "…" } else { "" }, if from + WIDEST < length { "…" } else { "" });
    format!("{before}{shown}{after}")
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

/// The text of a file by its number, for messages.
fn line_of(sources: &Sources, file: u16, line: u32) -> String {
    let text = &sources.file(file).text;
    let at = usize::try_from(line.saturating_sub(1)).unwrap_or(0);
    text.lines().nth(at).unwrap_or_default().trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_shown_where_they_differ() {
        let long = |end: &str| format!("{}{end}{}", "a".repeat(60), "z".repeat(40));
        let [a, b] = brief([long("1"), long("2")]);
        assert!(a.contains("a1z") && b.contains("a2z") && a.starts_with('…') && a.ends_with('…'), "{a} {b}");
        assert_eq!(a.chars().count(), WIDEST + 2);
        assert_eq!(brief(["7".to_owned(), "T#1s".to_owned()]), ["7".to_owned(), "T#1s".to_owned()]);
        let [a, b] = brief(["x".repeat(WIDEST), "x".repeat(WIDEST + 1)]);
        assert_eq!((a.chars().count(), b.chars().count()), (WIDEST, WIDEST + 1));
    }
}
