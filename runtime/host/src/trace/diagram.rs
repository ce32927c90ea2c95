//! A trace as a timing diagram: a lane a variable, as an SVG picture.

use super::axis::ticks;
use super::timeline::{Lane, Piece, Sample, Timeline};
use super::{Row, Sink, Subject};
use crate::column::Column;
use crate::map::Type;
use staunch_runtime::{Elementary, Time};
use std::fmt::Write as _;
use std::io::{self, Write};

const CHARACTER: f64 = 7.2;
const TOP: f64 = 56.0;
const GAP: f64 = 10.0;
const AXIS: f64 = 34.0;
/// Lines of variables that never change.
const UNCHANGED: usize = 6;
/// Pieces of all lanes together: far more than a picture has points, where there are few lanes.
const PIECES: usize = 200_000;
const STYLE: &str = "text{font:12px ui-monospace,Menlo,Consolas,monospace;fill:#24292f}\
.name{text-anchor:end}.title{font-size:15px;font-weight:600}.axis{fill:#6e7781;text-anchor:middle;font-size:11px}\
.end{fill:#6e7781;text-anchor:end;font-size:10px}.same{fill:#6e7781}\
.value{fill:#0550ae;font-size:11px}.grid{stroke:#eaeef2}.base{stroke:#d0d7de}\
.bool{fill:#2da44e33;stroke:#1a7f37;stroke-width:1.5}.number{fill:none;stroke:#0969da;stroke-width:1.5}\
.second{stroke:#bf3989}.third{stroke:#8250df}text.second{stroke:none;fill:#bf3989}text.third{stroke:none;fill:#8250df}\
.text{fill:#fff8c5;stroke:#bf8700}.pulses{fill:#2da44e}.swing{fill:#0969da99}.turmoil{fill:#bf870066}";

/// Draws at the end: only then the scale is known.
pub(super) struct Diagram {
    out: Box<dyn Write>,
    timeline: Timeline,
}

/// How a type is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Bool,
    Number,
    Text,
}

pub(super) fn kind(ty: Type) -> Kind {
    match ty {
        Type::Elementary(Elementary::Bool) | Type::Bit(_) => Kind::Bool,
        Type::Elementary(_) => Kind::Number,
        Type::String(_)
        | Type::Characters(_)
        | Type::Enum(_)
        | Type::Array(_)
        | Type::Struct(_)
        | Type::Block(_)
        | Type::Reference => Kind::Text,
    }
}

/// Times as places in the picture.
struct Scale {
    /// Where names end.
    names: f64,
    left: f64,
    width: f64,
    start: Time,
    end: Time,
}

impl Scale {
    fn x(&self, time: Time) -> f64 {
        self.left + (time - self.start) as f64 / (self.end - self.start).max(1) as f64 * self.width
    }

    fn right(&self) -> f64 {
        self.left + self.width
    }

    /// The time that a point of the picture takes.
    fn point(&self) -> Time {
        ((self.end - self.start) as f64 / self.width) as Time
    }
}

/// A lane in its place.
struct Strip<'a> {
    svg: &'a mut String,
    scale: &'a Scale,
    pieces: &'a [Piece],
    /// What its classes have besides.
    colour: &'static str,
    y: f64,
    height: f64,
}

impl Diagram {
    pub fn new(out: Box<dyn Write>, subject: &Subject<'_>) -> Self {
        Self { out, timeline: Timeline::new(subject, PIECES) }
    }

    fn picture(&self, subject: &Subject<'_>) -> String {
        let all = || subject.columns.iter().zip(&self.timeline.lanes);
        let shown = self.tracks(subject);
        let scale = self.scale(&shown);
        let is_shown = |column: &Column| shown.iter().flatten().any(|it| std::ptr::eq(it.0, column));
        let unchanged = unchanged(all().filter(|(column, _)| !is_shown(column)), &scale);
        let bottom = TOP + shown.iter().map(|track| height(track) + GAP).sum::<f64>();
        let (width, height) = (scale.right() + 24.0, bottom + AXIS + unchanged.len() as f64 * 16.0);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\">\n<style>{STYLE}</style>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<text class=\"title\" x=\"16\" y=\"28\">{}</text>\n",
            escape(&subject.title)
        );
        axis(&mut svg, &scale, bottom);
        let mut y = TOP;
        for track in &shown {
            draw(&mut svg, &scale, y, track);
            y += self::height(track) + GAP;
        }
        for (line, number) in unchanged.iter().zip(1_u8..) {
            let y = bottom + AXIS - 6.0 + f64::from(number) * 16.0;
            let _ = writeln!(svg, "<text class=\"same\" x=\"16\" y=\"{y:.0}\">{}</text>", escape(line));
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// What changes, or is drawn with what does, in the order of the columns.
    fn tracks<'a>(&'a self, subject: &'a Subject<'_>) -> Vec<Track<'a>> {
        let lane = |at: usize| (&subject.columns[at], &self.timeline.lanes[at]);
        let mut tracks: Vec<Track<'a>> = Vec::new();
        for at in 0..subject.columns.len() {
            match subject.overlays.iter().find(|it| it.contains(&at)) {
                Some(overlay) if overlay.iter().min() == Some(&at) => {
                    tracks.push(overlay.iter().map(|at| lane(*at)).collect());
                }
                Some(_) => {}
                None => tracks.push(vec![lane(at)]),
            }
        }
        tracks.retain(|track| track.iter().any(|(_, lane)| !lane.is_constant()));
        tracks
    }

    fn scale(&self, shown: &[Track<'_>]) -> Scale {
        let names = shown.iter().flatten().map(|(column, _)| column.heading.chars().count()).max().unwrap_or(0);
        let ends = shown.iter().filter_map(|it| ends(it)).map(|(a, b)| a.text.len().max(b.text.len())).max();
        let names = names as f64 * CHARACTER + 16.0;
        Scale {
            names,
            left: names + (ends.unwrap_or(0) as f64 + 2.0) * CHARACTER * 0.85,
            width: (self.timeline.rows as f64 * 26.0).clamp(560.0, 1500.0),
            start: self.timeline.start(),
            end: self.timeline.end(),
        }
    }
}

/// The variables of one lane of the picture: one, or some numbers.
type Track<'a> = Vec<(&'a Column, &'a Lane)>;

/// How the first, second and third number of a lane are coloured.
const COLOURS: [&str; 3] = ["", " second", " third"];

fn kind_of(track: &Track<'_>) -> Kind {
    track.first().map_or(Kind::Number, |(column, _)| kind(column.place.ty))
}

fn height(track: &Track<'_>) -> f64 {
    match kind_of(track) {
        Kind::Number => 40.0,
        Kind::Bool | Kind::Text => 20.0,
    }
}

/// The least and the greatest of the numbers that a lane of the picture shows.
fn ends(track: &Track<'_>) -> Option<(Sample, Sample)> {
    if kind_of(track) != Kind::Number {
        return None;
    }
    let ranges = track.iter().filter_map(|(_, lane)| lane.range());
    ranges.reduce(|all, it| {
        let low = if it.0.number < all.0.number { it.0 } else { all.0 };
        let high = if it.1.number > all.1.number { it.1 } else { all.1 };
        (low, high)
    })
}

/// `Unchanged: a = 1, b = FALSE`, in lines as wide as the picture.
fn unchanged<'a>(lanes: impl Iterator<Item = (&'a Column, &'a Lane)>, scale: &Scale) -> Vec<String> {
    let room = ((scale.right() - 16.0) / CHARACTER) as usize;
    let (mut lines, mut left_out) = (Vec::<String>::new(), 0);
    for (column, lane) in lanes {
        let value = lane.pieces.first().map_or_else(String::new, |it| visible(&it.last.text));
        let value = if value.is_empty() { "''" } else { &value };
        let text = shortened(format!("{} = {value}", column.heading), room.saturating_sub("Unchanged: ".len()));
        let is_last = lines.len() >= UNCHANGED;
        match lines.last_mut() {
            None => lines.push(format!("Unchanged: {text}")),
            Some(line) if line.chars().count() + text.chars().count() + 2 <= room => *line += &format!(", {text}"),
            Some(line) if !is_last => {
                line.push(',');
                lines.push(text);
            }
            Some(_) => left_out += 1,
        }
    }
    if left_out > 0 {
        lines.push(format!("and {left_out} more"));
    }
    lines
}

/// Vertical lines at round times.
fn axis(svg: &mut String, scale: &Scale, bottom: f64) {
    for (time, label) in ticks(scale.start, scale.end, scale.point().saturating_mul(110)) {
        let x = scale.x(time);
        let _ = writeln!(svg, "<path class=\"grid\" d=\"M{x:.1} {:.1}V{bottom:.1}\"/>", TOP - 8.0);
        let _ = writeln!(svg, "<text class=\"axis\" x=\"{x:.1}\" y=\"{:.1}\">{label}</text>", bottom + 16.0);
    }
}

fn draw(svg: &mut String, scale: &Scale, y: f64, track: &Track<'_>) {
    let (height, ends) = (height(track), ends(track));
    let (left, base) = (scale.left, y + height);
    let _ = writeln!(svg, "<path class=\"base\" d=\"M{left:.1} {base:.1}H{:.1}\"/>", scale.right());
    let mut middle = y + height / 2.0 + 4.0 - (track.len() as f64 - 1.0) * 6.5;
    for ((column, lane), colour) in track.iter().zip(COLOURS) {
        let (name, x) = (escape(&column.heading), scale.names);
        let _ = writeln!(svg, "<text class=\"name{colour}\" x=\"{x:.1}\" y=\"{middle:.1}\">{name}</text>");
        middle += 13.0;
        let pieces = lane.coarser(scale.start, scale.point());
        let mut strip = Strip { svg, scale, pieces: &pieces, colour, y, height };
        match kind(column.place.ty) {
            Kind::Bool => strip.bool(),
            Kind::Number => strip.number(ends.as_ref().map_or((0.0, 0.0), |(low, high)| (low.number, high.number))),
            Kind::Text => strip.text(),
        }
    }
    for (text, y) in ends.iter().flat_map(|(low, high)| [(&high.text, y + 8.0), (&low.text, base)]) {
        let _ = writeln!(svg, "<text class=\"end\" x=\"{:.1}\" y=\"{y:.1}\">{}</text>", left - 6.0, escape(text));
    }
}

impl Strip<'_> {
    /// Each piece with where it begins, where it has settled, and where it ends; a band is a point wide at least.
    fn spans(&self) -> Vec<(f64, f64, f64, &Piece)> {
        let ends = self.pieces.iter().skip(1).map(|it| it.start).chain([self.scale.end]);
        let place = |(piece, end): (_, Time)| {
            let piece: &Piece = piece;
            let (from, to) = (self.scale.x(piece.start), self.scale.x(end));
            let settled = if piece.is_steady() { from } else { self.scale.x(piece.settled).max(from + 1.0) };
            (from, settled, to.max(settled), piece)
        };
        self.pieces.iter().zip(ends).map(place).collect()
    }

    fn band(&mut self, class: &str, from: f64, to: f64, top: f64, bottom: f64) {
        let (width, height) = (to - from, (bottom - top).max(1.0));
        let _ = writeln!(
            self.svg,
            "<rect class=\"{class}\" x=\"{from:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>"
        );
    }

    fn bool(&mut self) {
        let (high, low) = (self.y, self.y + self.height);
        let mut path = format!("M{:.1} {low:.1}", self.scale.left);
        let mut bands = Vec::new();
        for (from, settled, to, piece) in self.spans() {
            let level = if piece.last.number == 0.0 { low } else { high };
            let _ = write!(path, "H{settled:.1}V{level:.1}H{to:.1}");
            if !piece.is_steady() {
                bands.push((from, settled));
            }
        }
        let _ = writeln!(self.svg, "<path class=\"bool\" d=\"{path}V{low:.1}\"/>");
        bands.into_iter().for_each(|(from, to)| self.band("pulses", from, to, high, low));
    }

    fn number(&mut self, (low, high): (f64, f64)) {
        let (y, height) = (self.y, self.height);
        let level = move |number: f64| {
            let part = if high > low { (number - low) / (high - low) } else { 0.5 };
            let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
            y + height - 2.0 - part * (height - 4.0)
        };
        let (mut path, mut bands, mut is_drawn) = (String::new(), Vec::new(), false);
        for (from, settled, to, piece) in self.spans() {
            let at = level(piece.last.number);
            // A value that soon changes again is a part of its band.
            let is_seen = piece.is_steady() || to - settled >= 1.0;
            if is_seen {
                let _ = match is_drawn {
                    true => write!(path, "H{settled:.1}V{at:.1}H{to:.1}"),
                    false => write!(path, "M{settled:.1} {at:.1}H{to:.1}"),
                };
            }
            is_drawn = is_seen;
            if !piece.is_steady() {
                bands.push((from, settled, level(piece.high.number), level(piece.low.number)));
            }
        }
        let _ = writeln!(self.svg, "<path class=\"number{}\" d=\"{path}\"/>", self.colour);
        bands.into_iter().for_each(|(from, to, top, bottom)| self.band("swing", from, to, top, bottom));
        // Above its line where there is room, else below.
        self.labels(false, |piece| match level(piece.last.number) - 3.0 {
            at if at < y + 8.0 => at + 14.0,
            at => at,
        });
    }

    fn text(&mut self) {
        let (y, height) = (self.y, self.height);
        let (middle, low) = (y + height / 2.0, y + height);
        let spans: Vec<_> = self.spans().into_iter().map(|(a, b, c, piece)| (a, b, c, piece.is_steady())).collect();
        for (from, settled, to, is_steady) in spans {
            if !is_steady {
                self.band("turmoil", from, settled, y, low);
            }
            let slant = ((to - settled) / 4.0).min(4.0);
            let (left, right) = (settled + slant, to - slant);
            let _ = writeln!(
                self.svg,
                "<path class=\"text\" d=\"M{settled:.1} {middle:.1}L{left:.1} {y:.1}H{right:.1}L{to:.1} {middle:.1}\
                 L{right:.1} {low:.1}H{left:.1}Z\"/>"
            );
        }
        self.labels(true, |_| y + height / 2.0 + 4.0);
    }

    /// The values, where there is room for them.
    fn labels(&mut self, is_text: bool, y: impl Fn(&Piece) -> f64) {
        let (mut labels, colour) = (String::new(), self.colour);
        for (_, settled, to, piece) in self.spans() {
            let room = ((to - settled - 6.0) / (CHARACTER * 0.92)) as usize;
            let shown = visible(&piece.last.text);
            // The first digits of a number are another number.
            let shown = if is_text { shortened(shown, room) } else { shown };
            if !shown.is_empty() && shown.chars().count() <= room {
                let (x, y) = (settled + 5.0, y(piece));
                let _ = writeln!(
                    labels,
                    "<text class=\"value{colour}\" x=\"{x:.1}\" y=\"{y:.1}\">{}</text>",
                    escape(&shown)
                );
            }
        }
        self.svg.push_str(&labels);
    }
}

/// A text that ends in `…` where there is not enough room for it.
fn shortened(text: String, room: usize) -> String {
    match room {
        // A letter and `…` say nothing.
        _ if text.chars().count() <= room || room < 3 => text,
        _ => text.chars().take(room - 1).chain(['…']).collect(),
    }
}

fn escape(text: &str) -> String {
    visible(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Characters that cannot be seen, and those that XML cannot hold, as escapes of Structured Text.
pub(super) fn visible(text: &str) -> String {
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

impl Sink for Diagram {
    fn row(&mut self, subject: &Subject<'_>, row: Row<'_>) -> io::Result<()> {
        self.timeline.row(subject, row);
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
    use crate::column::{columns, overlays};
    use crate::fixture::map;
    use crate::trace::tests::{texts_written, values_written, written};

    fn subject<'a>(map: &'a crate::Map, vars: &str, title: &str) -> Subject<'a> {
        Subject {
            map,
            columns: columns(map, &[0], Some(vars)).unwrap(),
            overlays: Vec::new(),
            title: title.to_owned(),
            cycle: 10_000_000,
        }
    }

    #[test]
    fn every_variable_that_changes_has_a_lane() {
        let map = map();
        let subject = subject(&map, "up,c.CV,name,speed,level,c.Q", "A < B");
        let svg = written(&subject, |out| Box::new(Diagram::new(out, &subject)));
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{svg}");
        assert!(svg.contains("A &lt; B"));
        for name in ["up", "c.CV", "name", "speed"] {
            assert!(svg.contains(&format!(">{name}</text>")), "{svg}");
        }
        assert_eq!(svg.matches("class=\"bool\"").count(), 1);
        assert_eq!(svg.matches("class=\"number\"").count(), 2);
        assert!(svg.contains(">a,b</text>") || svg.contains("class=\"text\""), "{svg}");
        assert!(svg.contains(">Unchanged: level = 0, c.Q = FALSE</text>"), "{svg}");
        assert!(!svg.contains("NaN"), "{svg}");
        // The scale of `speed`, and the time with its unit.
        assert!(svg.contains("class=\"end\"") && svg.contains(">0.5</text>"), "{svg}");
        assert!(svg.contains(">10 ms</text>"), "{svg}");
    }

    #[test]
    fn a_pulse_narrower_than_a_point_is_a_band() {
        let map = map();
        let subject = subject(&map, "up,level", "Long");
        let svg = values_written(
            &subject,
            100_000,
            |scan| (scan == 3_333, i16::from(scan == 7_777) * 9),
            |out| Box::new(Diagram::new(out, &subject)),
        );
        assert_eq!((svg.matches("class=\"pulses\"").count(), svg.matches("class=\"swing\"").count()), (1, 1), "{svg}");
        assert!(svg.contains(">9</text>") && svg.contains(">0</text>"), "{svg}");
        assert!(svg.len() < 5_000, "{}", svg.len());
    }

    #[test]
    fn a_long_run_gives_a_picture_of_bounded_size() {
        let map = map();
        let subject = subject(&map, "up,level", "Long");
        let svg = values_written(
            &subject,
            20_000,
            |scan| (scan % 3 == 0, (scan % 100) as i16),
            |out| Box::new(Diagram::new(out, &subject)),
        );
        assert!(svg.len() < 500_000, "{}", svg.len());
    }

    /// One scale for both, which is from the least to the greatest of them.
    #[test]
    fn numbers_share_a_lane() {
        let map = map();
        let mut subject = subject(&map, "up,c.CV,level", "Shared");
        subject.overlays = overlays(&subject.columns, &["level,c.CV".to_owned()]).unwrap();
        let svg =
            values_written(&subject, 20, |scan| (true, (scan % 7) as i16), |out| Box::new(Diagram::new(out, &subject)));
        assert_eq!(svg.matches("class=\"end\"").count(), 2, "{svg}");
        assert!(svg.contains("class=\"name\"") && svg.contains("class=\"name second\""), "{svg}");
        assert!(svg.contains("class=\"number second\""), "{svg}");
        for (wanted, said) in [
            ("level", "`level` is not two or three names, separated by commas"),
            ("level,up", "`up` is not a number"),
            ("level,level", "`level` is named twice"),
            ("level,lever", "`lever` is not among the variables of the trace; did you mean `level`?"),
        ] {
            assert_eq!(overlays(&subject.columns, &[wanted.to_owned()]).unwrap_err(), said);
        }
    }

    /// A number is whole or not shown: its first digits are another one.
    #[test]
    fn a_text_without_room_ends_in_dots() {
        let map = map();
        let subject = subject(&map, "name", "Narrow");
        let texts: Vec<&str> = ["abcd", "efgh"].into_iter().cycle().take(40).collect();
        let svg = texts_written(&subject, &texts, |out| Box::new(Diagram::new(out, &subject)));
        assert!(svg.contains(">ab…</text>") && svg.contains(">ef…</text>"), "{svg}");
        assert_eq!(shortened("12345".to_owned(), 2), "12345");
    }

    #[test]
    fn what_cannot_be_seen_is_escaped() {
        let map = map();
        let subject = subject(&map, "name", "A\u{1}");
        let texts = ["a\nb", "a\0<", "\u{ffff}", "\u{7f}\t"];
        let svg = texts_written(&subject, &texts, |out| Box::new(Diagram::new(out, &subject)));
        for shown in ["A$01", "a$Nb", "a$00&lt;", "$FFFF", "$7F$T"] {
            assert!(svg.contains(&format!(">{shown}</text>")), "{shown}: {svg}");
        }
        assert!(svg.chars().all(|it| it == '\n' || !it.is_control() && it != '\u{ffff}'), "{svg}");
    }
}
