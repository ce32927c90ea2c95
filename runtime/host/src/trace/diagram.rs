//! A trace as a timing diagram: a lane a variable, as an SVG picture.

use super::{Row, Sink, Subject, milliseconds};
use crate::map::Type;
use crate::value;
use staunch_runtime::{Elementary, Time};
use std::fmt::Write as _;
use std::io::{self, Write};

const CHARACTER: f64 = 7.2;
const TOP: f64 = 56.0;
const GAP: f64 = 10.0;
const AXIS: f64 = 34.0;
const STYLE: &str = "text{font:12px ui-monospace,Menlo,Consolas,monospace;fill:#24292f}\
.name{text-anchor:end}.title{font-size:15px;font-weight:600}.axis{fill:#6e7781;text-anchor:middle;font-size:11px}\
.value{fill:#0550ae;font-size:11px}.grid{stroke:#eaeef2}.base{stroke:#d0d7de}\
.bool{fill:#2da44e33;stroke:#1a7f37;stroke-width:1.5}.number{fill:none;stroke:#0969da;stroke-width:1.5}\
.text{fill:#fff8c5;stroke:#bf8700}";

/// Keeps every change until the end: only then the scale is known.
pub(super) struct Diagram {
    out: Box<dyn Write>,
    lanes: Vec<LaneOf>,
    /// Times of the first and last row, and of the row before the last.
    first: Option<Time>,
    last: Time,
    before: Time,
    rows: u64,
}

/// The changes of one column.
#[derive(Default)]
struct LaneOf {
    changes: Vec<Change>,
}

struct Change {
    time: Time,
    text: String,
    number: f64,
}

/// Times as places in the picture.
struct Scale {
    left: f64,
    width: f64,
    start: Time,
    end: Time,
}

impl Scale {
    fn x(&self, time: Time) -> f64 {
        self.left + (time - self.start) as f64 / (self.end - self.start).max(1) as f64 * self.width
    }
}

impl Diagram {
    pub fn new(out: Box<dyn Write>, subject: &Subject<'_>) -> Self {
        let lanes = subject.columns.iter().map(|_| LaneOf::default()).collect();
        Self { out, lanes, first: None, last: 0, before: 0, rows: 0 }
    }

    fn picture(&self, subject: &Subject<'_>) -> String {
        let names = subject.columns.iter().map(|it| it.heading.chars().count()).max().unwrap_or(0);
        let start = self.first.unwrap_or(0);
        // The last value holds for as long as the scan before it did.
        let step = (self.last - self.before).max(1_000);
        let scale = Scale {
            left: names as f64 * CHARACTER + 24.0,
            width: (self.rows as f64 * 26.0).clamp(560.0, 1500.0),
            start,
            end: self.last + step,
        };
        let heights: Vec<f64> = subject.columns.iter().map(|it| height(it.place.ty)).collect();
        let bottom = TOP + heights.iter().map(|it| it + GAP).sum::<f64>();
        let (width, height) = (scale.left + scale.width + 24.0, bottom + AXIS);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\">\n<style>{STYLE}</style>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<text class=\"title\" x=\"16\" y=\"28\">{}</text>\n",
            escape(&subject.title)
        );
        axis(&mut svg, &scale, bottom);
        let mut y = TOP;
        for ((column, lane), height) in subject.columns.iter().zip(&self.lanes).zip(heights) {
            let (name, base) = (escape(&column.heading), y + height);
            let (text_x, text_y) = (scale.left - 12.0, y + height / 2.0 + 4.0);
            let _ = writeln!(svg, "<text class=\"name\" x=\"{text_x:.1}\" y=\"{text_y:.1}\">{name}</text>");
            let right = scale.left + scale.width;
            let _ = writeln!(svg, "<path class=\"base\" d=\"M{:.1} {base:.1}H{right:.1}\"/>", scale.left);
            match column.place.ty {
                Type::Elementary(Elementary::Bool) => lane.draw_bool(&mut svg, &scale, y, height),
                Type::Elementary(_) => lane.draw_number(&mut svg, &scale, y, height),
                Type::String(_) | Type::Enum(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
                    lane.draw_text(&mut svg, &scale, y, height);
                }
            }
            y += height + GAP;
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn height(ty: Type) -> f64 {
    match ty {
        Type::Elementary(it) if it != Elementary::Bool => 40.0,
        _ => 20.0,
    }
}

/// Vertical lines at round times.
fn axis(svg: &mut String, scale: &Scale, bottom: f64) {
    let span = (scale.end - scale.start).max(1);
    let wanted = span / ((scale.width / 90.0) as Time).max(1);
    let mut step: Time = 1;
    while step < wanted {
        step = [2, 5, 10].into_iter().map(|it| step * it).find(|it| *it >= wanted).unwrap_or(step * 10);
    }
    let mut time = scale.start.div_euclid(step) * step;
    while time <= scale.end {
        if time >= scale.start {
            let x = scale.x(time);
            let _ = writeln!(svg, "<path class=\"grid\" d=\"M{x:.1} {:.1}V{bottom:.1}\"/>", TOP - 8.0);
            let label = axis_label(time, step);
            let _ = writeln!(svg, "<text class=\"axis\" x=\"{x:.1}\" y=\"{:.1}\">{label}</text>", bottom + 16.0);
        }
        time += step;
    }
}

fn axis_label(time: Time, step: Time) -> String {
    match step {
        1_000_000_000.. => format!("{} s", milliseconds(time / 1000)),
        _ => format!("{} ms", milliseconds(time)),
    }
}

fn escape(text: &str) -> String {
    visible(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Characters that cannot be seen, and those that XML cannot hold, as escapes of Structured Text.
fn visible(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        let _ = match character {
            '\n' => write!(out, "$N"),
            '\r' => write!(out, "$R"),
            '\t' => write!(out, "$T"),
            '\u{c}' => write!(out, "$P"),
            it if it.is_control() => write!(out, "${:02X}", u32::from(it)),
            it @ '\u{fffe}'..='\u{ffff}' => write!(out, "${:04X}", u32::from(it)),
            it => write!(out, "{it}"),
        };
    }
    out
}

impl LaneOf {
    /// The changes as spans `(from, to, change)` in the picture; of several that fall on one
    /// point, the last.
    fn spans<'a>(&'a self, scale: &'a Scale) -> impl Iterator<Item = (f64, f64, &'a Change)> {
        let ends = self.changes.iter().skip(1).map(|it| it.time).chain([scale.end]);
        let spans = self.changes.iter().zip(ends).map(|(change, end)| (scale.x(change.time), scale.x(end), change));
        spans.filter(|(from, to, _)| to - from > 0.05)
    }

    fn draw_bool(&self, svg: &mut String, scale: &Scale, y: f64, height: f64) {
        let (high, low) = (y, y + height);
        let _ = write!(svg, "<path class=\"bool\" d=\"M{:.1} {low:.1}", scale.left);
        for (from, to, change) in self.spans(scale) {
            let level = if change.number == 0.0 { low } else { high };
            let _ = write!(svg, "H{from:.1}V{level:.1}H{to:.1}");
        }
        let _ = writeln!(svg, "V{low:.1}\"/>");
    }

    fn draw_number(&self, svg: &mut String, scale: &Scale, y: f64, height: f64) {
        let finite = || self.changes.iter().map(|it| it.number).filter(|it| it.is_finite());
        let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        // A constant lies in the middle; room for the labels stays above.
        let level = |number: f64| {
            let part = if high > low { (number - low) / (high - low) } else { 0.3 };
            let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
            y + height - 2.0 - part * (height - 16.0)
        };
        let _ = write!(svg, "<path class=\"number\" d=\"");
        for (number, (from, to, change)) in self.spans(scale).enumerate() {
            let at = level(change.number);
            let _ = match number {
                0 => write!(svg, "M{from:.1} {at:.1}H{to:.1}"),
                _ => write!(svg, "H{from:.1}V{at:.1}H{to:.1}"),
            };
        }
        svg.push_str("\"/>\n");
        self.labels(svg, scale, |change| level(change.number) - 4.0);
    }

    fn draw_text(&self, svg: &mut String, scale: &Scale, y: f64, height: f64) {
        for (from, to, _) in self.spans(scale) {
            let slant = ((to - from) / 4.0).min(4.0);
            let (middle, low) = (y + height / 2.0, y + height);
            let _ = writeln!(
                svg,
                "<path class=\"text\" d=\"M{from:.1} {middle:.1}L{:.1} {y:.1}H{:.1}L{to:.1} {middle:.1}L{:.1} {low:.1}H{:.1}Z\"/>",
                from + slant,
                to - slant,
                to - slant,
                from + slant
            );
        }
        self.labels(svg, scale, |_| y + height / 2.0 + 4.0);
    }

    /// The values, where there is room for them.
    fn labels(&self, svg: &mut String, scale: &Scale, y: impl Fn(&Change) -> f64) {
        for (from, to, change) in self.spans(scale) {
            let room = ((to - from - 6.0) / (CHARACTER * 0.92)) as usize;
            let shown = visible(&change.text);
            if !shown.is_empty() && shown.chars().count() <= room {
                let (x, y) = (from + 5.0, y(change));
                let _ = writeln!(svg, "<text class=\"value\" x=\"{x:.1}\" y=\"{y:.1}\">{}</text>", escape(&shown));
            }
        }
    }
}

impl Sink for Diagram {
    fn row(&mut self, subject: &Subject<'_>, row: Row<'_>) -> io::Result<()> {
        self.first.get_or_insert(row.time);
        self.before = if self.rows == 0 { row.time } else { self.last };
        (self.last, self.rows) = (row.time, self.rows + 1);
        let mut text = String::new();
        for (column, lane) in subject.columns.iter().zip(&mut self.lanes) {
            subject.cell(column, row.state, &mut text);
            if lane.changes.last().is_none_or(|it| it.text != text) {
                let bytes = &row.state[column.place.offset..];
                let number = value::number(subject.map, column.place.ty, bytes).unwrap_or(0.0);
                lane.changes.push(Change { time: row.time, text: text.clone(), number });
            }
        }
        Ok(())
    }

    fn finish(&mut self, subject: &Subject<'_>) -> io::Result<()> {
        let picture = self.picture(subject);
        self.out.write_all(picture.as_bytes())
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
    use crate::trace::tests::{texts_written, written};

    #[test]
    fn every_variable_has_a_lane() {
        let map = map();
        let columns = columns(&map, &[0], Some("up,c.CV,name,speed")).unwrap();
        let subject = Subject { map: &map, columns, title: "A < B".to_owned() };
        let svg = written(&subject, |out| Box::new(Diagram::new(out, &subject)));
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{svg}");
        assert!(svg.contains("A &lt; B"));
        for name in ["up", "c.CV", "name", "speed"] {
            assert!(svg.contains(&format!(">{name}</text>")), "{svg}");
        }
        assert_eq!(svg.matches("class=\"bool\"").count(), 1);
        assert_eq!(svg.matches("class=\"number\"").count(), 2);
        assert!(svg.contains(">a,b</text>") || svg.contains("class=\"text\""), "{svg}");
        assert!(!svg.contains("NaN"), "{svg}");
    }

    #[test]
    fn what_cannot_be_seen_is_escaped() {
        let map = map();
        let columns = columns(&map, &[0], Some("name")).unwrap();
        let subject = Subject { map: &map, columns, title: "A\u{1}".to_owned() };
        let texts = ["a\nb", "a\0<", "\u{ffff}", "\u{7f}\t"];
        let svg = texts_written(&subject, &texts, |out| Box::new(Diagram::new(out, &subject)));
        for shown in ["A$01", "a$Nb", "a$00&lt;", "$FFFF", "$7F$T"] {
            assert!(svg.contains(&format!(">{shown}</text>")), "{shown}: {svg}");
        }
        assert!(svg.chars().all(|it| it == '\n' || !it.is_control() && it != '\u{ffff}'), "{svg}");
    }
}
