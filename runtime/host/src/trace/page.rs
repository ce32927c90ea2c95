//! A trace as a page for a browser: the diagram to zoom and pan, with the values at a cursor. One file,
//! which needs nothing else.

use super::diagram::{Kind, kind, visible};
use super::timeline::{Lane, Piece, Sample, Timeline};
use super::{Row, Sink, Subject};
use crate::json::quote;
use std::fmt::Write as _;
use std::io::{self, Write};

/// The page, with a mark where its data belong.
const PAGE: &str = include_str!("page.html");
const MARK: &str = "/*DATA*/";
/// Pieces of all lanes together: what a browser loads in a moment, some 10 MB at most where there are few lanes.
const PIECES: usize = 100_000;

pub(super) struct Page {
    out: Box<dyn Write>,
    timeline: Timeline,
}

impl Page {
    pub fn new(out: Box<dyn Write>, subject: &Subject<'_>) -> Self {
        Self { out, timeline: Timeline::new(subject, PIECES) }
    }

    /// The title, the times, the scans, and each lane's pieces, as JSON.
    fn data(&self, subject: &Subject<'_>) -> String {
        let (start, end) = (self.timeline.start(), self.timeline.end());
        let scans: Vec<String> = self.timeline.scans.iter().map(|(time, scan)| format!("[{time},{scan}]")).collect();
        let mut out = format!(
            "{{\"title\":{},\"start\":{start},\"end\":{end},\"pace\":{},\"scans\":[{}],\"lanes\":[",
            quote(&subject.title),
            self.timeline.pace(),
            scans.join(",")
        );
        for (number, (column, lane)) in subject.columns.iter().zip(&self.timeline.lanes).enumerate() {
            let comma = if number > 0 { "," } else { "" };
            let kind = match kind(column.place.ty) {
                Kind::Bool => "bool",
                Kind::Number => "number",
                Kind::Text => "text",
            };
            let _ = write!(out, "{comma}\n{{\"name\":{},\"kind\":\"{kind}\",\"pieces\":[", quote(&column.heading));
            pieces(lane, &mut out);
            out.push_str("]}");
        }
        out.push_str("]}");
        out
    }
}

fn pieces(lane: &Lane, out: &mut String) {
    for (number, piece) in lane.pieces.iter().enumerate() {
        if number > 0 {
            out.push(',');
        }
        let Piece { start, settled, changes, low, high, last } = piece;
        let _ = match piece.is_steady() {
            true => write!(out, "[{start},{}]", sample(last)),
            false => write!(out, "[{start},{},{},{},{settled},{changes}]", sample(last), sample(low), sample(high)),
        };
    }
}

/// A text and its number; JSON has no infinities.
fn sample(value: &Sample) -> String {
    let text = quote(&visible(&value.text));
    match value.number.is_finite() {
        true => format!("{text},{}", value.number),
        false => format!("{text},null"),
    }
}

impl Sink for Page {
    fn row(&mut self, subject: &Subject<'_>, row: Row<'_>) -> io::Result<()> {
        self.timeline.row(subject, row);
        Ok(())
    }

    fn finish(&mut self, subject: &Subject<'_>) -> io::Result<()> {
        let (before, after) = PAGE.split_once(MARK).unwrap_or((PAGE, ""));
        self.out.write_all(before.as_bytes())?;
        self.out.write_all(self.data(subject).as_bytes())?;
        self.out.write_all(after.as_bytes())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::columns;
    use crate::fixture::map;
    use crate::trace::tests::{values_written, written};

    fn data(page: &str) -> &str {
        let (before, after) = PAGE.split_once(MARK).unwrap();
        page.strip_prefix(before).unwrap().strip_suffix(after).unwrap()
    }

    #[test]
    fn data_are_the_changes_with_their_texts() {
        let map = map();
        let columns = columns(&map, &[0], Some("up,c.CV,name,speed")).unwrap();
        let subject =
            Subject { map: &map, columns, overlays: Vec::new(), title: "</script>".to_owned(), cycle: 10_000_000 };
        let page = written(&subject, |out| Box::new(Page::new(out, &subject)));
        assert_eq!(
            data(&page),
            "{\"title\":\"\\u003c/script>\",\"start\":0,\"end\":10500000,\"pace\":250000,\"scans\":[[0,1],[10000000,2]],\"lanes\":[
{\"name\":\"up\",\"kind\":\"bool\",\"pieces\":[[0,\"FALSE\",0],[10000000,\"TRUE\",1]]},
{\"name\":\"c.CV\",\"kind\":\"number\",\"pieces\":[[0,\"0\",0],[10000000,\"1\",1]]},
{\"name\":\"name\",\"kind\":\"text\",\"pieces\":[[0,\"\",0],[10000000,\"a,b\",0]]},
{\"name\":\"speed\",\"kind\":\"number\",\"pieces\":[[0,\"0.0\",0],[10250000,\"0.5\",0.5]]}]}"
        );
    }

    #[test]
    fn a_long_run_is_of_bounded_size_and_keeps_its_pulses() {
        let map = map();
        let subject = Subject {
            map: &map,
            columns: columns(&map, &[0], Some("up,level")).unwrap(),
            overlays: Vec::new(),
            title: String::new(),
            cycle: 10_000_000,
        };
        let values = |scan| (scan == 7_777, (scan % 50) as i16);
        let open = |out| Box::new(Page { out, timeline: Timeline::new(&subject, 2_000) }) as Box<dyn Sink>;
        let page = values_written(&subject, 20_000, values, open);
        assert!(data(&page).len() < 100_000, "{}", page.len());
        assert!(
            data(&page).contains("\"pieces\":[[0,\"FALSE\",0],[77760000000,\"TRUE\",1],[77770000000,\"FALSE\",0]]")
        );
        assert!(data(&page).contains("\"49\",49,"), "the peak is in a band");
    }
}
