//! The inputs of a program, scan by scan: a CSV file.

use crate::csv::{self, Cell};
use crate::literal;
use crate::map::{Map, Type};
use crate::path::{self, Place, same};
use crate::replace::open_to_read;
use crate::start::Event;
use crate::{Error, Machine};
use staunch_runtime::Time;
use std::borrow::Cow;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Rows in the order in which they act.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stimulus {
    path: PathBuf,
    /// The maximum number of values in a row.
    pub columns: usize,
    pub rows: Vec<Row>,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Row {
    /// Acts before this scan; by `time` alone if there is none.
    pub scan: Option<u64>,
    /// With `scan`, when that scan runs; alone, the row acts before the first scan from then on.
    pub time: Option<Time>,
    /// A power cycle, or a change from IDLE to RUN, comes first.
    pub event: Option<Event>,
    pub writes: Vec<Write>,
    /// Line and column.
    at: (usize, usize),
    time_at: (usize, usize),
}

/// Bytes that go into the state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Write {
    pub offset: usize,
    pub bytes: Vec<u8>,
    /// The one bit of the byte that is written.
    pub bit: Option<u8>,
    /// To an input, which holds over a restart.
    pub input: bool,
}

impl Write {
    /// A value as it is written in a table or an argument.
    pub fn parse(map: &Map, place: Place, text: &str) -> Result<Self, String> {
        let bytes = literal::parse(map, place, text)?;
        let bit = match place.ty {
            Type::Bit(number) => Some(number),
            _ => None,
        };
        Ok(Self { offset: place.offset, bytes, bit, input: place.input })
    }

    /// The bytes as they are written over a state.
    pub fn over(&self, state: &[u8]) -> Cow<'_, [u8]> {
        match self.bit {
            Some(_) => vec![self.byte(state)].into(),
            None => self.bytes.as_slice().into(),
        }
    }

    /// The byte with the bit that is written.
    fn byte(&self, state: &[u8]) -> u8 {
        let number = self.bit.unwrap_or(0);
        state[self.offset] & !(1 << number) | self.bytes[0] << number
    }

    /// Writes it, without allocating.
    pub fn put(&self, machine: &mut dyn Machine) {
        match self.bit {
            Some(_) => machine.write(self.offset, &[self.byte(machine.state())]),
            None => machine.write(self.offset, &self.bytes),
        }
    }

    /// Whether both write the same bit of the state.
    pub fn overlaps(&self, other: &Self) -> bool {
        let is_apart = |a: &Self, b: &Self| a.offset + a.bytes.len() <= b.offset;
        let are_bits = self.bit.is_some() && other.bit.is_some() && self.bit != other.bit;
        !is_apart(self, other) && !is_apart(other, self) && !are_bits
    }

    /// Whether it is to the same variable.
    pub fn replaces(&self, other: &Self) -> bool {
        (self.offset, self.bit, self.bytes.len()) == (other.offset, other.bit, other.bytes.len())
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    Scan,
    Time,
    Event,
    Variable(Place),
    /// Of a trace, what is not an input: the program computes it.
    Computed(usize),
    /// `|`: columns to the right of it are expected values, which a stimulus ignores.
    Bar,
}

/// Separates the inputs from the expected outputs.
pub(crate) const BAR: &str = "|";

/// The column of a trace that says when its scan ran.
const MILLISECONDS: &str = "time_ms";

impl Stimulus {
    pub fn read(path: &Path, map: &Map, running: &[usize]) -> Result<Self, Error> {
        let mut bytes = Vec::new();
        let read = open_to_read(path).and_then(|mut file| file.read_to_end(&mut bytes));
        read.map_err(|error| Error::file(path, "read", error))?;
        let text = csv::decoded(&bytes);
        Self::parse(path, &text, map, running)
    }

    /// `path` is for messages.
    pub fn parse(path: &Path, text: &str, map: &Map, running: &[usize]) -> Result<Self, Error> {
        let decimal_comma = csv::has_semicolons(text);
        let mut parser =
            Parser { path, map, running, columns: Vec::new(), is_numbered: false, is_trace: false, decimal_comma };
        let open = |(line, column)| parser.error(line, column, "a quote that is not closed".to_owned());
        let cells = csv::parse(text).map_err(open)?;
        let Some((header, rows)) = cells.split_first() else {
            return Err(parser.error(
                1,
                1,
                "it is empty: expected a header that names `scan` or `time`, and variables".to_owned(),
            ));
        };
        parser.header(header)?;
        let rows = (1..).zip(rows).map(|(number, cells)| parser.row(number, cells)).collect::<Result<Vec<_>, _>>()?;
        parser.in_order(&rows)?;
        Ok(Self { path: path.to_owned(), columns: parser.columns.len(), rows })
    }

    /// When scan `number` runs, if the row at `next` places it in time; `before` is when the last
    /// scan ran.
    pub fn placed(&self, next: usize, number: u64, before: Option<Time>) -> Result<Option<Time>, Error> {
        let Some(Row { scan: Some(scan), time: Some(time), time_at: (line, column), .. }) = self.rows.get(next) else {
            return Ok(None);
        };
        if *scan != number {
            return Ok(None);
        }
        match before {
            Some(before) if before > *time => Err(Error::Stimulus {
                path: self.path.clone(),
                line: *line,
                column: *column,
                text: format!(
                    "scan {number} cannot run at {}: the scan before it runs at {}",
                    crate::format_time(*time),
                    crate::format_time(before)
                ),
            }),
            _ => Ok(Some(*time)),
        }
    }

    /// TRUE when the row at `next` acts before scan `number`, at `time`.
    pub fn acts(&self, next: usize, number: u64, time: Time) -> bool {
        self.rows.get(next).is_some_and(|row| match (row.scan, row.time) {
            (Some(scan), _) => scan <= number,
            (None, Some(at)) => at <= time,
            (None, None) => true,
        })
    }
}

struct Parser<'a> {
    path: &'a Path,
    map: &'a Map,
    running: &'a [usize],
    columns: Vec<Column>,
    /// There is neither a column `scan` nor `time`: the rows are scans 1, 2, 3.
    is_numbered: bool,
    /// It is a trace: its inputs are replayed.
    is_trace: bool,
    /// Reals are written `3,5`.
    decimal_comma: bool,
}

impl Parser<'_> {
    fn error(&self, line: usize, column: usize, text: String) -> Error {
        Error::Stimulus { path: self.path.to_owned(), line, column, text }
    }

    fn at(&self, cell: &Cell, text: impl Into<String>) -> Error {
        self.error(cell.line, cell.column, text.into())
    }

    fn header(&mut self, cells: &[Cell]) -> Result<(), Error> {
        let bar = cells.iter().position(|it| it.text == BAR);
        let is_clock = |it: &Cell| same(&it.text, "scan") || same(&it.text, "time");
        self.is_trace = cells.get(1).is_some_and(|it| same(&it.text, MILLISECONDS));
        self.is_numbered = bar.is_some() && !cells.first().is_some_and(is_clock);
        for (position, cell) in cells.iter().take(bar.unwrap_or(cells.len())).enumerate() {
            let column = self.column(position, cell)?;
            if self.columns.contains(&column) {
                return Err(self.at(cell, format!("`{}` already has a column", cell.text)));
            }
            self.columns.push(column);
        }
        self.columns.extend(bar.map(|_| Column::Bar));
        Ok(())
    }

    fn column(&self, position: usize, cell: &Cell) -> Result<Column, Error> {
        let is_clock = |it| matches!(it, &Column::Scan | &Column::Time);
        match cell.text.as_str() {
            text if position < 2 && same(text, "scan") && !self.columns.contains(&Column::Scan) => Ok(Column::Scan),
            text if position < 2 && same(text, "time") && !self.columns.contains(&Column::Time) => Ok(Column::Time),
            text if position == 1 && same(text, MILLISECONDS) => Ok(Column::Time),
            text if same(text, "@event") => Ok(Column::Event),
            text if self.is_numbered => self.variable(cell, text),
            _ if position == 0 => {
                Err(self.at(cell, format!("the first column must be `scan` or `time`, not `{}`", cell.text)))
            }
            _ if !self.columns.iter().any(is_clock) => Err(self.at(cell, "the first column must be `scan` or `time`")),
            text if self.is_trace => self.of_trace(position, cell, text),
            text => self.variable(cell, text),
        }
    }

    /// A column of a trace: an input that can be given.
    fn of_trace(&self, position: usize, cell: &Cell, name: &str) -> Result<Column, Error> {
        let place = path::resolve(self.map, self.running, name).map_err(|text| self.at(cell, text))?;
        match place.input && !place.constant && place.ty != Type::Reference {
            true => self.variable(cell, name),
            false => Ok(Column::Computed(position)),
        }
    }

    fn variable(&self, cell: &Cell, name: &str) -> Result<Column, Error> {
        let place = path::resolve(self.map, self.running, name).map_err(|text| self.at(cell, text))?;
        match place.constant {
            true => Err(self.at(cell, format!("`{name}` is CONSTANT and cannot be written"))),
            false => Ok(Column::Variable(path::written(self.map, self.running, place))),
        }
    }

    fn row(&self, number: u64, cells: &[Cell]) -> Result<Row, Error> {
        let at = cells.first().map_or((1, 1), |it| (it.line, it.column));
        let mut row = Row { at, scan: self.is_numbered.then_some(number), ..Row::default() };
        if self.columns.last() == Some(&Column::Bar) {
            let bar = self.columns.len() - 1;
            if let Some(other) = cells.get(bar).filter(|it| it.text != BAR) {
                return Err(self.at(other, "here is a `|` in the header"));
            }
        } else if let Some(surplus) = cells.get(self.columns.len()) {
            return Err(self.at(surplus, format!("the header has only {} columns", self.columns.len())));
        }
        for (cell, column) in cells.iter().zip(&self.columns).filter(|(cell, _)| self.is_trace || !cell.is_empty()) {
            match column {
                Column::Scan => row.scan = Some(self.scan(cell)?),
                Column::Time => {
                    row.time = Some(self.time(cell)?);
                    row.time_at = (cell.line, cell.column);
                }
                Column::Event => row.event = Some(self.event(cell)?),
                Column::Variable(place) => row.writes.push(self.write(cell, *place)?),
                Column::Computed(_) | Column::Bar => {}
            }
        }
        match (row.scan, row.time, cells.first()) {
            (None, None, Some(first)) => Err(self.at(first, "the row has no scan or time: its first cell is empty")),
            _ => Ok(row),
        }
    }

    fn scan(&self, cell: &Cell) -> Result<u64, Error> {
        match cell.text.parse() {
            Ok(0) => Err(self.at(cell, "scans count from 1")),
            Ok(scan) => Ok(scan),
            Err(_) => Err(self.at(cell, format!("`{}` is not the number of a scan", cell.text))),
        }
    }

    fn time(&self, cell: &Cell) -> Result<Time, Error> {
        let in_milliseconds = self.is_trace.then(|| format!("{}ms", cell.text));
        match literal::time(in_milliseconds.as_deref().unwrap_or(&cell.text)) {
            Ok(time) if time < 0 => Err(self.at(cell, "time starts at T#0s")),
            Ok(time) => Ok(time),
            Err(text) => Err(self.at(cell, text)),
        }
    }

    fn event(&self, cell: &Cell) -> Result<Event, Error> {
        let named = Event::ALL.into_iter().find(|it| it.name().eq_ignore_ascii_case(&cell.text));
        named.ok_or_else(|| {
            self.at(cell, format!("`{}` is not an event: expected `restart`, `run` or `reset`", cell.text))
        })
    }

    fn write(&self, cell: &Cell, place: Place) -> Result<Write, Error> {
        let is_real = matches!(place.ty, Type::Elementary(it) if it.repr().is_float());
        let with_point = (self.decimal_comma && is_real).then(|| cell.text.replacen(',', ".", 1));
        let text = with_point.as_deref().unwrap_or(&cell.text);
        // What is said of it is said of it as it is written.
        Write::parse(self.map, place, text)
            .map_err(|it| self.at(cell, it.replace(&format!("`{text}`"), &format!("`{}`", cell.text))))
    }

    fn in_order(&self, rows: &[Row]) -> Result<(), Error> {
        let (mut scan, mut time) = (0, 0);
        for row in rows {
            let back = row.scan.is_some_and(|it| it < scan) || row.time.is_some_and(|it| it < time);
            if back {
                let (line, column) = row.at;
                return Err(self.error(
                    line,
                    column,
                    "rows are out of order: this one is earlier than one above".to_owned(),
                ));
            }
            (scan, time) = (row.scan.unwrap_or(scan), row.time.unwrap_or(time));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{map, offset_of};

    fn read(text: &str) -> Result<Stimulus, String> {
        Stimulus::parse(Path::new("in.csv"), text, &map(), &[0]).map_err(|it| it.to_string())
    }

    #[test]
    fn rows_write_their_non_empty_cells() {
        let stimulus = read("scan,up,@event,c.CV\n1,TRUE,,\n3,,restart,16#F\n3,0,,\n").unwrap();
        let [first, second, third] = stimulus.rows.as_slice() else { panic!("{stimulus:?}") };
        let up = |value| vec![Write { offset: offset_of("up"), bytes: vec![value], bit: None, input: true }];
        assert_eq!((first.scan, first.event, &first.writes), (Some(1), None, &up(1)));
        assert_eq!((second.scan, second.event), (Some(3), Some(Event::Restart)));
        assert_eq!(second.writes[0].bytes, 15_i16.to_ne_bytes());
        assert_eq!(third.writes, up(0));
    }

    /// Values that a program computes are not written to it; a string may have become empty.
    #[test]
    fn a_trace_gives_its_inputs() {
        let stimulus = read("scan,time_ms,up,c.CV,name\n1,0,TRUE,5,a\n2,10.25,FALSE,6,\n").unwrap();
        let [first, second] = stimulus.rows.as_slice() else { panic!("{stimulus:?}") };
        let up = |value| vec![Write { offset: offset_of("up"), bytes: vec![value], bit: None, input: true }];
        assert_eq!((first.scan, first.time, &first.writes), (Some(1), Some(0), &up(1)));
        assert_eq!((second.scan, second.time, &second.writes), (Some(2), Some(10_250_000), &up(0)));
    }

    #[test]
    fn a_comma_is_a_decimal_sign_between_semicolons() {
        let stimulus = read("scan;speed;c.CV\n1;-3,5;4\n2;1,5E2;\n3;2.5;\n").unwrap();
        let speeds: Vec<_> = stimulus.rows.iter().map(|it| it.writes[0].bytes.clone()).collect();
        assert_eq!(speeds, [-3.5_f32, 150.0, 2.5].map(|it| it.to_ne_bytes().to_vec()));
        assert!(read("scan;c.CV\n1;4,5\n").is_err() && read("scan;speed\n1;1,2,3\n").is_err());
        let wrong = read("scan;speed\n1;1.234,5\n").unwrap_err();
        assert!(wrong.contains("`1.234,5` is not a REAL"), "{wrong}");
    }

    #[test]
    fn what_is_right_of_a_bar_is_no_stimulus() {
        let numbered = read("up, |, c.CV\nTRUE, |, 1\n, |,\n").unwrap();
        assert_eq!(
            numbered.rows.iter().map(|it| (it.scan, it.writes.len())).collect::<Vec<_>>(),
            [(Some(1), 1), (Some(2), 0)]
        );
        let placed = read("scan,up,|,nonsense\n3,1,|,x\n").unwrap();
        assert_eq!((placed.rows[0].scan, placed.rows[0].writes.len()), (Some(3), 1));
        assert_eq!(read("|,c.CV\n|,1\n|,2\n").unwrap().rows.len(), 2);
        assert_eq!(read("up,|,c.CV\n1,2\n").unwrap_err(), "in.csv:2:3: here is a `|` in the header");
    }

    #[test]
    fn rows_are_placed_by_scan_or_time() {
        let by_time = read("time,up\nT#0s,1\nT#25ms,0\n").unwrap();
        assert!(by_time.acts(0, 1, 0) && !by_time.acts(1, 3, 20_000_000) && by_time.acts(1, 4, 30_000_000));
        assert!(!by_time.acts(2, 9, i64::MAX));
        let placed = read("scan,time,up\n2,T#25ms,1\n").unwrap();
        assert_eq!(placed.placed(0, 1, None).unwrap(), None);
        assert_eq!(placed.placed(0, 2, Some(0)).unwrap(), Some(25_000_000));
        let error = placed.placed(0, 2, Some(30_000_000)).unwrap_err().to_string();
        assert_eq!(error, "in.csv:2:3: scan 2 cannot run at T#25ms: the scan before it runs at T#30ms");
    }

    #[test]
    fn mistakes_name_their_place() {
        for (text, expected) in [
            ("", "in.csv:1:1: it is empty: expected a header that names `scan` or `time`, and variables"),
            ("up\n1\n", "in.csv:1:1: the first column must be `scan` or `time`, not `up`"),
            ("scan,Upp\n", "in.csv:1:6: there is no variable `Upp`; did you mean `up`?"),
            ("scan,up,UP\n", "in.csv:1:9: `UP` already has a column"),
            ("scan,limit\n", "in.csv:1:6: `limit` is CONSTANT and cannot be written"),
            ("scan,up\n0,1\n", "in.csv:2:1: scans count from 1"),
            ("scan,up\nx,1\n", "in.csv:2:1: `x` is not the number of a scan"),
            ("time,up\n5,1\n", "in.csv:2:1: `5` is not a TIME: write `T#500ms` or `500ms`"),
            ("scan,up\n1,5\n", "in.csv:2:3: `5` is not a BOOL: write TRUE or FALSE"),
            ("scan,up\n1,1,1\n", "in.csv:2:5: the header has only 2 columns"),
            ("scan,up\n,1\n", "in.csv:2:1: the row has no scan or time: its first cell is empty"),
            ("scan,@event\n1,stop\n", "in.csv:2:3: `stop` is not an event: expected `restart`, `run` or `reset`"),
            ("scan,up\n3,1\n2,1\n", "in.csv:3:1: rows are out of order: this one is earlier than one above"),
            ("scan,up\n1,\"1\n", "in.csv:2:3: a quote that is not closed"),
        ] {
            assert_eq!(read(text).unwrap_err(), expected, "{text}");
        }
    }
}
