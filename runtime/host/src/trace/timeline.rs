//! The values of a run over time, in bounded memory: the data of the pictures.
//!
//! A lane keeps every change until there are too many. Then the changes in each cell of a grid of times
//! become one piece, which knows how low and high the values were; the grid gets coarser as the run
//! continues. So a pulse of one scan is still seen after a million scans.

use super::{Row, Subject};
use crate::value;
use staunch_runtime::Time;
use std::rc::Rc;

/// A value, as a number for its height and as text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sample {
    pub number: f64,
    pub text: Rc<str>,
}

/// What a variable did from `start` until the next piece.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub start: Time,
    /// When it got its last value; `start`, unless it changed more than once.
    pub settled: Time,
    pub changes: u64,
    pub low: Sample,
    pub high: Sample,
    pub last: Sample,
}

impl Piece {
    fn new(start: Time, value: Sample) -> Self {
        Self { start, settled: start, changes: 1, low: value.clone(), high: value.clone(), last: value }
    }

    /// It holds one value.
    pub fn is_steady(&self) -> bool {
        self.changes == 1
    }

    /// This piece, and the one that follows it.
    fn absorb(&mut self, next: &Self) {
        if next.low.number < self.low.number || self.low.number.is_nan() {
            self.low = next.low.clone();
        }
        if next.high.number > self.high.number || self.high.number.is_nan() {
            self.high = next.high.clone();
        }
        self.settled = next.settled;
        self.changes += next.changes;
        self.last = next.last.clone();
    }
}

/// The pieces of one column, in the order of time.
#[derive(Debug, Default)]
pub(super) struct Lane {
    pub pieces: Vec<Piece>,
    /// The value's bytes in the last row.
    bytes: Vec<u8>,
    /// Changes in one cell of this length are one piece; 0 while there is room for all.
    grid: Time,
}

impl Lane {
    /// The value never changed.
    pub fn is_constant(&self) -> bool {
        matches!(self.pieces.as_slice(), [] | [Piece { changes: 1, .. }])
    }

    /// The smallest and the largest value.
    pub fn range(&self) -> Option<(Sample, Sample)> {
        let mut all = self.pieces.first()?.clone();
        self.pieces.iter().for_each(|it| all.absorb(it));
        Some((all.low, all.high))
    }

    /// With at most one piece in each cell of `grid`, counted from `origin`.
    pub fn coarser(&self, origin: Time, grid: Time) -> Vec<Piece> {
        merged(self.pieces.iter().cloned(), origin, grid)
    }

    fn push(&mut self, piece: Piece, origin: Time, limit: usize) {
        match self.pieces.last_mut() {
            Some(last) if is_in_one_cell(last, &piece, origin, self.grid) => last.absorb(&piece),
            _ => self.pieces.push(piece),
        }
        while self.pieces.len() > 2 * limit {
            let span = self.pieces.last().map_or(0, |it| it.start - origin);
            let needed = span / Time::try_from(limit).unwrap_or(Time::MAX) + 1;
            self.grid = needed.max(self.grid.saturating_mul(2));
            self.pieces = merged(std::mem::take(&mut self.pieces).into_iter(), origin, self.grid);
        }
    }
}

fn is_in_one_cell(a: &Piece, b: &Piece, origin: Time, grid: Time) -> bool {
    grid > 0 && (a.start - origin).div_euclid(grid) == (b.start - origin).div_euclid(grid)
}

fn merged(pieces: impl Iterator<Item = Piece>, origin: Time, grid: Time) -> Vec<Piece> {
    let mut out: Vec<Piece> = Vec::new();
    for piece in pieces {
        match out.last_mut() {
            Some(last) if is_in_one_cell(last, &piece, origin, grid) => last.absorb(&piece),
            _ => out.push(piece),
        }
    }
    out
}

/// The lanes of a run, one for each column of its subject.
#[derive(Debug)]
pub(super) struct Timeline {
    pub lanes: Vec<Lane>,
    /// Pieces that a lane may have; it has up to twice as many for a while.
    limit: usize,
    /// Times of the first and last row, and of the row before the last.
    first: Option<Time>,
    last: Time,
    before: Time,
    cycle: Time,
    pub rows: u64,
    /// `(time, scan)` of the first row, and of those after which time and scans advance at another pace.
    pub scans: Vec<(Time, u64)>,
    /// The last row's distance from the one before, and its scan.
    pace: Option<(Time, u64)>,
}

/// More irregular scans than this are not counted.
const PACES: usize = 10_000;

impl Timeline {
    /// With room for `pieces` in all lanes together, and some for each.
    pub fn new(subject: &Subject<'_>, pieces: usize) -> Self {
        let lanes: Vec<Lane> = subject.columns.iter().map(|_| Lane::default()).collect();
        let limit = (pieces / lanes.len().max(1)).max(500);
        Self {
            lanes,
            limit,
            cycle: subject.cycle,
            first: None,
            last: 0,
            before: 0,
            rows: 0,
            scans: Vec::new(),
            pace: None,
        }
    }

    pub fn start(&self) -> Time {
        self.first.unwrap_or(0)
    }

    /// The last value holds for as long as the scan before it did; that of a single scan for a cycle.
    pub fn end(&self) -> Time {
        let held = if self.rows > 1 { self.last - self.before } else { self.cycle };
        self.last + held.max(1_000)
    }

    /// Time between the last two rows.
    pub fn pace(&self) -> Time {
        self.last - self.before
    }

    pub fn row(&mut self, subject: &Subject<'_>, row: Row<'_>) {
        let origin = *self.first.get_or_insert(row.time);
        self.note_scan(row);
        self.before = if self.rows == 0 { row.time } else { self.last };
        (self.last, self.rows) = (row.time, self.rows + 1);
        for (column, lane) in subject.columns.iter().zip(&mut self.lanes) {
            let size = subject.map.size_of(column.place.ty);
            let bytes = &row.state[column.place.offset..column.place.offset + size];
            if !lane.pieces.is_empty() && lane.bytes == bytes {
                continue;
            }
            lane.bytes.clear();
            lane.bytes.extend_from_slice(bytes);
            let mut text = String::new();
            subject.cell(column, row.state, &mut text);
            // Bytes after a string's end are none of its value.
            if lane.pieces.last().is_some_and(|it| *it.last.text == *text) {
                continue;
            }
            let number = value::number(subject.map, column.place.ty, bytes).unwrap_or(0.0);
            lane.push(Piece::new(row.time, Sample { number, text: text.into() }), origin, self.limit);
        }
    }

    fn note_scan(&mut self, row: Row<'_>) {
        if self.rows > 0 {
            let pace = (row.time - self.last, row.scan);
            let is_even = self.pace.is_some_and(|(step, scan)| step == pace.0 && scan + 1 == pace.1);
            self.pace = Some(pace);
            if is_even {
                return;
            }
            // The row before is where the new pace begins.
            let knot = (self.last, row.scan - 1);
            if self.scans.last() != Some(&knot) && self.scans.len() < PACES {
                self.scans.push(knot);
            }
        } else {
            self.scans.push((row.time, row.scan));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::columns;
    use crate::fixture::{map, offset_of};
    use staunch_runtime::Value;

    /// A run of so many scans of 10 ms, in which `c.CV` is what `value` says.
    fn run(scans: u64, pieces: usize, value: impl Fn(u64) -> i16) -> Timeline {
        let map = map();
        let subject = Subject {
            map: &map,
            columns: columns(&map, &[0], Some("c.CV")).unwrap(),
            overlays: Vec::new(),
            title: String::new(),
            cycle: 10_000_000,
        };
        let mut timeline = Timeline::new(&subject, pieces);
        let mut state = vec![0; 128];
        for scan in 1..=scans {
            Value::I16(value(scan)).write(&mut state[offset_of("c.CV")..]);
            let time = i64::try_from(scan - 1).unwrap() * 10_000_000;
            timeline.row(&subject, Row { scan, time, state: &state });
        }
        timeline
    }

    #[test]
    fn few_changes_are_kept_as_they_are() {
        let timeline = run(100, 1000, |scan| i16::from(scan >= 50));
        let [before, after] = timeline.lanes[0].pieces.as_slice() else { panic!("{timeline:?}") };
        assert!(before.is_steady() && after.is_steady());
        assert_eq!((before.start, after.start, &*after.last.text), (0, 490_000_000, "1"));
        assert_eq!((timeline.start(), timeline.end(), timeline.rows), (0, 1_000_000_000, 100));
        assert!(run(100, 1000, |_| 7).lanes[0].is_constant() && !timeline.lanes[0].is_constant());
    }

    #[test]
    fn no_pulse_is_lost_in_a_long_run() {
        // One scan at 100 among a saw tooth that never gets above 9.
        let scans = 20_000;
        let timeline = run(scans, 1000, |scan| if scan == 12_345 { 100 } else { (scan % 10) as i16 });
        let pieces = &timeline.lanes[0].pieces;
        assert!(pieces.len() <= 2000, "{}", pieces.len());
        let peak: Vec<_> = pieces.iter().filter(|it| it.high.number == 100.0).collect();
        let [peak] = peak.as_slice() else { panic!("{peak:?}") };
        assert!(peak.start <= 123_440_000_000 && peak.settled >= 123_440_000_000);
        assert_eq!((&*peak.low.text, &*peak.high.text), ("0", "100"));
        // Each scan but the first changes the value, and the first counts as it begins.
        assert_eq!(pieces.iter().map(|it| it.changes).sum::<u64>(), scans);
        let (low, high) = timeline.lanes[0].range().unwrap();
        assert_eq!((low.number, high.number), (0.0, 100.0));
    }

    #[test]
    fn a_coarser_lane_says_the_same() {
        let timeline = run(1000, 1000, |scan| i16::from(scan == 510));
        let pieces = timeline.lanes[0].coarser(0, 1_000_000_000);
        let [quiet, pulse] = pieces.as_slice() else { panic!("{pieces:?}") };
        assert_eq!((quiet.changes, pulse.changes), (1, 2));
        assert_eq!((pulse.start, pulse.settled), (5_090_000_000, 5_100_000_000));
        assert_eq!((pulse.low.number, pulse.high.number, pulse.last.number), (0.0, 1.0, 0.0));
    }

    #[test]
    fn scans_are_counted_where_their_pace_changes() {
        let map = map();
        let subject =
            Subject { map: &map, columns: Vec::new(), overlays: Vec::new(), title: String::new(), cycle: 10_000_000 };
        let mut timeline = Timeline::new(&subject, 10);
        for (scan, time) in [(1, 0), (2, 10), (3, 20), (4, 25), (5, 30), (6, 35)] {
            timeline.row(&subject, Row { scan, time, state: &[] });
        }
        assert_eq!(timeline.scans, [(0, 1), (20, 3)]);
    }
}
