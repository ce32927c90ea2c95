//! What `staunch compare` prints: a table for people, or one object.

use super::obstacle::Obstacle;
use super::pair::{Matched, Pair, Row};
use super::trap::{self, Cause};
use crate::args::MessageFormat;
use crate::session::Session;
use crate::{REJECTED, output};
use staunch_frontend::Dialect;
use std::fmt::Write;

/// Rows at the start and the end of a long trace that are shown.
const HEAD: usize = 4;
const TAIL: usize = 4;
/// Variables that differ, as columns.
const SHOWN: usize = 3;

pub struct Report<'s> {
    pub session: &'s Session,
    pub from: Dialect,
    pub to: Dialect,
    /// Lines that were rewritten for the other system: before and after.
    pub notes: Vec<(String, String)>,
    /// Names of pins that the move changes.
    pub renamed: usize,
}

/// One line of the table; `None` stands for rows that are left out.
struct Line {
    scan: usize,
    restart: bool,
    inputs: Vec<String>,
    /// For each shown variable, the value on both sides.
    cells: Vec<[String; 2]>,
}

impl Report<'_> {
    fn json(&self) -> bool {
        self.session.common.format() == MessageFormat::Json
    }

    fn names(&self) -> [&'static str; 2] {
        [self.from.name(), self.to.name()]
    }

    pub fn same(&self, how: &str) -> Result<u8, String> {
        let [from, to] = self.names();
        if self.json() {
            let mut text = self.head(false, None);
            let _ = writeln!(text, ",\"looked_at\":{}}}", quoted(how));
            output::print(text.as_bytes())?;
            return Ok(0);
        }
        if !self.session.common.quiet {
            let (rewritten, names) = (self.rewritten(), self.names_change());
            let text = format!("{rewritten}No difference between {from} and {to}: {how}.\n{names}");
            output::print(text.as_bytes())?;
        }
        Ok(0)
    }

    pub fn obstacle(&self, obstacle: &Obstacle) -> Result<u8, String> {
        let [from, to] = self.names();
        if self.json() {
            let mut text = self.head(true, obstacle.trap.map(trap::Trap::number));
            let sentence = obstacle.trap.map_or("null".to_owned(), |it| quoted(it.sentence()));
            let _ = writeln!(
                text,
                ",\"comparable\":false,\"sentence\":{sentence},\"why\":{},\"advice\":{}}}",
                quoted(&obstacle.why),
                quoted(&obstacle.advice)
            );
            output::print(text.as_bytes())?;
            return Ok(REJECTED);
        }
        let mut text = format!("{from} and {to} cannot be compared: {}.\n", obstacle.why);
        if let Some(trap) = obstacle.trap {
            let _ = writeln!(text, "Trap {}: {}", trap.number(), trap.sentence());
        }
        let _ = writeln!(text, "What to do: {}.", obstacle.advice);
        output::print(text.as_bytes())?;
        Ok(REJECTED)
    }

    pub fn difference(&self, pair: &Pair, rows: &[Row], feeding: &[String]) -> Result<u8, String> {
        let Some(last) = rows.last() else { return Ok(REJECTED) };
        let differences = pair.differences(last);
        let cause = trap::cause(pair, rows, &differences, feeding);
        let text = if self.json() {
            self.object(pair, rows, &differences, &cause)
        } else {
            self.table(pair, rows, &differences, &cause)
        };
        output::print(text.as_bytes())?;
        Ok(REJECTED)
    }

    fn names_change(&self) -> String {
        if self.renamed == 0 {
            return String::new();
        }
        let trap = trap::Trap::numbered(9);
        let count =
            if self.renamed == 1 { "1 name changes".to_owned() } else { format!("{} names change", self.renamed) };
        format!("Trap {} ({count}): {}\n", trap.number(), trap.sentence())
    }

    fn rewritten(&self) -> String {
        let mut text = String::new();
        if !self.notes.is_empty() {
            let _ = writeln!(text, "{} needs the program rewritten; compared as:", self.to.name().to_ascii_uppercase());
            for (before, after) in &self.notes {
                let _ = writeln!(text, "  - {before}\n  + {after}");
            }
            text.push('\n');
        }
        text
    }

    fn table(&self, pair: &Pair, rows: &[Row], differences: &[Matched], cause: &Cause) -> String {
        let [from, to] = self.names();
        let mut text = self.rewritten();
        let scans = if rows.len() == 1 { "1 scan".to_owned() } else { format!("{} scans", rows.len()) };
        let _ = writeln!(text, "{from} and {to} differ after {scans}:\n");
        let shown = &differences[..differences.len().min(SHOWN)];
        let restarts = rows.iter().any(|it| it.restart);
        let mut header = vec!["scan".to_owned()];
        if restarts {
            header.push("@event".to_owned());
        }
        header.extend(pair.inputs.iter().map(|it| pair.sides[0].leaves.all[it.leaves[0]].path.clone()));
        for it in shown {
            let path = pair.sides[0].leaves.all[it[0]].path.as_str();
            header.extend([format!("{path} {from}"), format!("{path} {to}")]);
        }
        let mut table = vec![header];
        for line in self.lines(pair, rows, shown) {
            table.push(line.map_or_else(Vec::new, |it| it.cells(restarts)));
        }
        // The last row ends in the cell where they part.
        if let (Some(row), false) = (table.last_mut(), shown.is_empty()) {
            let first = row.len() - 2 * shown.len() + 1;
            row[first].push_str(" ◀");
        }
        text += &aligned(&table);
        text += &self.faults(rows);
        if differences.len() > SHOWN {
            let more = differences[SHOWN..].iter().map(|it| pair.sides[0].leaves.all[it[0]].path.as_str());
            let _ = writeln!(text, "  also different: {}", more.take(12).collect::<Vec<_>>().join(", "));
        }
        text.push('\n');
        match cause.trap {
            Some(trap) => {
                let counter = cause.counter.as_ref().map_or_else(String::new, |it| format!(" (`{it}`)"));
                let _ = writeln!(text, "Trap {}{counter}: {}", trap.number(), trap.sentence());
                let _ = writeln!(text, "What to do: {}", trap.advice());
            }
            None => text.push_str("None of the twelve traps explains it; see `docs/compare.md`.\n"),
        }
        text + &self.names_change()
    }

    /// The rows to show; `None` where some are left out.
    fn lines(&self, pair: &Pair, rows: &[Row], shown: &[Matched]) -> Vec<Option<Line>> {
        let mut lines = Vec::new();
        let mut next = 0;
        for at in telling(pair, rows) {
            if at > next {
                lines.push(None);
            }
            lines.push(Some(Line::of(pair, &rows[at], at + 1, shown)));
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

    /// An object's beginning, without its end.
    fn head(&self, differs: bool, trap: Option<usize>) -> String {
        let [from, to] = self.names();
        let trap = trap.map_or("null".to_owned(), |it| it.to_string());
        let rewritten: Vec<_> =
            self.notes.iter().map(|(before, after)| format!("[{},{}]", quoted(before), quoted(after))).collect();
        format!(
            "{{\"reason\":\"compare\",\"from\":\"{from}\",\"to\":\"{to}\",\"differs\":{differs},\"trap\":{trap},\"renamed_pins\":{},\"rewritten\":[{}]",
            self.renamed,
            rewritten.join(",")
        )
    }

    fn object(&self, pair: &Pair, rows: &[Row], differences: &[Matched], cause: &Cause) -> String {
        let mut text = self.head(true, cause.trap.map(trap::Trap::number));
        let sentence = cause.trap.map_or("null".to_owned(), |it| quoted(it.sentence()));
        let advice = cause.trap.map_or("null".to_owned(), |it| quoted(it.advice()));
        let counter = cause.counter.as_deref().map_or("null".to_owned(), quoted);
        let path = |it: &Matched| quoted(&pair.sides[0].leaves.all[it[0]].path);
        let variables: Vec<_> = differences.iter().map(path).collect();
        let _ = write!(
            text,
            ",\"comparable\":true,\"sentence\":{sentence},\"advice\":{advice},\"counter\":{counter},\"scans\":{},\"different\":[{}],\"trace\":[",
            rows.len(),
            variables.join(",")
        );
        let shown = &differences[..differences.len().min(SHOWN)];
        let lines: Vec<_> =
            self.lines(pair, rows, shown).into_iter().flatten().map(|it| it.object(pair, shown)).collect();
        let _ = writeln!(text, "{}]}}", lines.join(","));
        text
    }
}

/// Which rows tell the story: all of a short trace; of a longer one those in which an input
/// changes, and the two at its end.
fn telling(pair: &Pair, rows: &[Row]) -> Vec<usize> {
    if rows.len() <= HEAD + TAIL + 1 {
        return (0..rows.len()).collect();
    }
    let inputs = |row: &Row| pair.inputs.iter().map(|it| pair.sides[0].show(it.leaves[0], &row.states[0])).collect();
    let mut before: Vec<String> = Vec::new();
    let mut told = Vec::new();
    for (at, row) in rows.iter().enumerate() {
        let now: Vec<String> = inputs(row);
        if now != before || row.restart || at + 2 >= rows.len() {
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
    fn of(pair: &Pair, row: &Row, scan: usize, shown: &[Matched]) -> Self {
        let show = |side: usize, leaf: usize| pair.sides[side].show(leaf, &row.states[side]);
        Self {
            scan,
            restart: row.restart,
            inputs: pair.inputs.iter().map(|it| show(0, it.leaves[0])).collect(),
            cells: shown.iter().map(|[a, b]| [show(0, *a), show(1, *b)]).collect(),
        }
    }

    fn cells(self, restarts: bool) -> Vec<String> {
        let mut cells = vec![self.scan.to_string()];
        if restarts {
            cells.push(if self.restart { "restart" } else { "" }.to_owned());
        }
        cells.extend(self.inputs);
        cells.extend(self.cells.into_iter().flatten());
        cells
    }

    fn object(&self, pair: &Pair, shown: &[Matched]) -> String {
        let path = |leaf: usize| quoted(&pair.sides[0].leaves.all[leaf].path);
        let inputs =
            pair.inputs.iter().zip(&self.inputs).map(|(it, value)| format!("{}:{}", path(it.leaves[0]), quoted(value)));
        let inputs: Vec<_> = inputs.collect();
        let side = |side: usize| {
            let cells =
                shown.iter().zip(&self.cells).map(|(it, cell)| format!("{}:{}", path(it[0]), quoted(&cell[side])));
            cells.collect::<Vec<_>>().join(",")
        };
        let event = if self.restart { "\"restart\"" } else { "null" };
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
