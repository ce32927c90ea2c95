//! The last scans as a table for people.

use super::{Row, Subject};
use crate::column::Column;
use crate::format_time;
use crate::map::Type;
use staunch_runtime::{Elementary, Time};
use std::collections::VecDeque;
use std::io::{self, Write};
use std::ops::Range;

/// Rows that are shown.
const ROWS: usize = 20;
/// Characters that a column takes at least.
const NARROWEST: usize = 3;

/// Keeps the last rows of a run.
#[derive(Debug)]
pub(crate) struct Table {
    rows: VecDeque<Kept>,
    /// With room for the values, so that no row allocates.
    spare: Vec<Kept>,
    /// Characters in a line.
    width: usize,
    /// The places of the columns in the state, in their order; neighbours are one range.
    parts: Vec<Range<usize>>,
}

#[derive(Debug, Default)]
struct Kept {
    scan: u64,
    time: Time,
    /// The values of the columns, as they are in the state, one after the other.
    bytes: Vec<u8>,
}

impl Table {
    pub fn new(subject: &Subject<'_>, width: usize) -> Self {
        let mut parts: Vec<Range<usize>> = Vec::new();
        for column in most_columns(subject, width) {
            let (start, size) = (column.place.offset, subject.map.size_of(column.place.ty));
            match parts.last_mut() {
                Some(last) if last.end == start => last.end += size,
                _ => parts.push(start..start + size),
            }
        }
        let size = parts.iter().map(Range::len).sum();
        let spare = || Kept { bytes: Vec::with_capacity(size), ..Kept::default() };
        let spare = (0..ROWS).map(|_| spare()).collect();
        Self { rows: VecDeque::with_capacity(ROWS), spare, width, parts }
    }

    pub fn row(&mut self, row: Row<'_>) {
        let mut kept = self.spare.pop().or_else(|| self.rows.pop_front()).unwrap_or_default();
        (kept.scan, kept.time) = (row.scan, row.time);
        kept.bytes.clear();
        for part in &self.parts {
            kept.bytes.extend_from_slice(&row.state[part.clone()]);
        }
        self.rows.push_back(kept);
    }

    pub fn print(&self, subject: &Subject<'_>, out: &mut dyn Write) -> io::Result<()> {
        let Some(last) = self.rows.back() else { return Ok(()) };
        let mut columns = vec![
            Printed::new("scan", true, self.rows.iter().map(|it| it.scan.to_string())),
            Printed::new("time", true, self.rows.iter().map(|it| short_time(it.time))),
        ];
        let mut offset = 0;
        let mut left_out = subject.columns.len();
        for column in most_columns(subject, self.width) {
            let size = subject.map.size_of(column.place.ty);
            let cell = |kept: &Kept| {
                let mut cell = String::new();
                crate::value::format(subject.map, column.place.ty, &kept.bytes[offset..offset + size], &mut cell);
                cell
            };
            columns.push(Printed::new(&column.heading, is_number(column.place.ty), self.rows.iter().map(cell)));
            if columns.iter().map(|it| it.width + 2).sum::<usize>() > self.width + 2 {
                columns.pop();
                break;
            }
            offset += size;
            left_out -= 1;
        }
        let hidden = last.scan.saturating_sub(self.rows.len() as u64);
        print_all(&columns, self.rows.len(), hidden, out)?;
        match left_out {
            0 => Ok(()),
            1 => writeln!(out, "1 more variable: --vars picks, --trace - shows all"),
            _ => writeln!(out, "{left_out} more variables: --vars picks, --trace - shows all"),
        }
    }
}

/// More columns than these never fit.
fn most_columns<'a>(subject: &'a Subject<'_>, width: usize) -> impl Iterator<Item = &'a Column> {
    subject.columns.iter().take(width / NARROWEST)
}

/// A column as it is printed.
struct Printed {
    heading: String,
    width: usize,
    /// Numbers are at the right.
    right: bool,
    cells: Vec<String>,
}

impl Printed {
    fn new(heading: &str, right: bool, cells: impl Iterator<Item = String>) -> Self {
        // A control character, as a line break in a string, would tear the table.
        let cells: Vec<String> = cells.map(|it| it.replace(char::is_control, "·")).collect();
        let widest = cells.iter().map(|it| it.chars().count()).max().unwrap_or(0);
        Self { heading: heading.to_owned(), width: widest.max(heading.chars().count()), right, cells }
    }

    fn cell(&self, text: &str) -> String {
        let width = self.width;
        if self.right { format!("{text:>width$}") } else { format!("{text:<width$}") }
    }
}

fn print_all(columns: &[Printed], rows: usize, hidden: u64, out: &mut dyn Write) -> io::Result<()> {
    line(out, columns.iter().map(|it| it.cell(&it.heading)))?;
    line(out, columns.iter().map(|it| "─".repeat(it.width)))?;
    if hidden > 0 {
        line(out, columns.iter().map(|it| it.cell("⋮")))?;
    }
    for row in 0..rows {
        line(out, columns.iter().map(|it| it.cell(&it.cells[row])))?;
    }
    Ok(())
}

fn line(out: &mut dyn Write, cells: impl Iterator<Item = String>) -> io::Result<()> {
    let cells: Vec<String> = cells.collect();
    writeln!(out, "{}", cells.join("  ").trim_end())
}

fn is_number(ty: Type) -> bool {
    matches!(ty, Type::Elementary(it) if it != Elementary::Bool)
}

/// A duration without the prefix that every cell would have.
fn short_time(time: Time) -> String {
    format_time(time).trim_start_matches("T#").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::columns;
    use crate::fixture::map;
    use crate::map::Map;

    fn table(map: &Map, vars: Option<&str>, scans: u64, width: usize) -> String {
        let subject = Subject {
            map,
            columns: columns(map, &[0], vars).unwrap(),
            overlays: Vec::new(),
            title: String::new(),
            cycle: 10_000_000,
        };
        let (mut table, mut state) = (Table::new(&subject, width), vec![0; 128]);
        for scan in 1..=scans {
            state[8] = u8::from(scan % 2 == 0);
            let time = Time::try_from(scan - 1).unwrap() * 10_000_000;
            table.row(Row { scan, time, state: &state });
        }
        let mut out = Vec::new();
        table.print(&subject, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn columns_line_up() {
        let expected =
            "scan  time  up     c.CV\n────  ────  ─────  ────\n   1    0s  FALSE     0\n   2  10ms  TRUE      0\n";
        assert_eq!(table(&map(), Some("up,c.CV"), 2, 100), expected);
    }

    #[test]
    fn only_the_last_rows_and_what_fits_is_shown() {
        for width in [40, 80, 200] {
            let text = table(&map(), None, 50, width);
            let widest = text.lines().skip(1).take(20).map(|it| it.chars().count()).max().unwrap();
            assert!(widest <= width && widest + 20 > width.min(180), "{width}: {text}");
        }
        let text = table(&map(), None, 50, 100);
        assert_eq!(text.lines().count(), 2 + 1 + ROWS + 1);
        assert!(text.contains("\n  31  300ms  FALSE"), "{text}");
        assert!(text.ends_with("more variables: --vars picks, --trace - shows all\n"), "{text}");
        assert!(text.lines().all(|it| it.chars().count() <= 100));
    }
}
