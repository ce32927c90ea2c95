//! The output of a run's values: one row per scan.

mod axis;
mod diagram;
mod page;
mod rows;
mod table;
mod timeline;
mod waves;

use crate::Error;
use crate::column::Column;
use crate::map::Map;
use crate::replace::{Replacement, open_at_once};
use crate::value;
use staunch_runtime::Time;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

pub(crate) use table::Table;

/// The state after a scan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<'a> {
    /// 0 for the state before the first scan.
    pub scan: u64,
    /// When the scan began.
    pub time: Time,
    pub state: &'a [u8],
}

/// The subject of a trace.
#[derive(Debug)]
pub(crate) struct Subject<'a> {
    pub map: &'a Map,
    pub columns: Vec<Column>,
    /// The columns of numbers that a picture shows in one lane.
    pub overlays: Vec<Vec<usize>>,
    /// The title of the run.
    pub title: String,
    /// Time between scans.
    pub cycle: Time,
}

impl Subject<'_> {
    /// Writes a column's value over `cell`.
    pub fn cell(&self, column: &Column, state: &[u8], cell: &mut String) {
        cell.clear();
        value::format(self.map, column.place.ty, &state[column.place.offset..], cell);
    }
}

pub(crate) trait Sink {
    fn row(&mut self, subject: &Subject<'_>, row: Row<'_>) -> io::Result<()>;
    /// Writes the rest, after the last row.
    fn finish(&mut self, subject: &Subject<'_>) -> io::Result<()>;
    /// Shows what has been written so far.
    fn flush(&mut self) -> io::Result<()>;
}

/// The forms of a trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Rows,
    Waves,
    Page,
    Diagram,
}

impl Form {
    /// By the file's ending; rows for one without, as `-` and devices are.
    fn of(path: &Path) -> Result<Self, Error> {
        let Some(ending) = path.extension().filter(|_| path.as_os_str() != "-") else { return Ok(Self::Rows) };
        match ending.to_string_lossy().to_ascii_lowercase().as_str() {
            "csv" => Ok(Self::Rows),
            "vcd" => Ok(Self::Waves),
            "html" | "htm" => Ok(Self::Page),
            "svg" => Ok(Self::Diagram),
            _ => Err(Error::Usage(format!(
                "--trace {}: a trace ends in .csv, .vcd, .svg or .html; - is standard output",
                path.display()
            ))),
        }
    }
}

/// Whether a trace can have this name.
pub(crate) fn check_name(path: &Path) -> Result<(), Error> {
    Form::of(path).map(|_| ())
}

/// Whether it is drawn in lanes.
pub(crate) fn is_picture(path: &Path) -> bool {
    Form::of(path).is_ok_and(|it| it == Form::Diagram)
}

/// An open trace file.
pub(crate) struct Trace {
    path: PathBuf,
    sink: Box<dyn Sink>,
    /// A picture: nothing of it is written before the last row.
    is_picture: bool,
    /// A file that is there as a whole at the end.
    replacement: Option<Replacement>,
}

impl Trace {
    /// The file's ending says the form; `-` is standard output. In real time each row is there after its scan, under
    /// the file's own name, and nothing waits for who reads it.
    pub fn create(path: &Path, subject: &Subject<'_>, realtime: bool) -> Result<Self, Error> {
        let file = |error| Error::file(path, "write", error);
        let form = Form::of(path)?;
        let (out, replacement) = opened(path, realtime).map_err(file)?;
        let sink = match form {
            Form::Rows => rows::Rows::new(out, subject).map(|it| Box::new(it) as Box<dyn Sink>),
            Form::Waves => waves::Waves::new(out, subject).map(|it| Box::new(it) as Box<dyn Sink>),
            Form::Page => Ok(Box::new(page::Page::new(out, subject)) as Box<dyn Sink>),
            Form::Diagram => Ok(Box::new(diagram::Diagram::new(out, subject)) as Box<dyn Sink>),
        };
        let is_picture = matches!(form, Form::Page | Form::Diagram);
        Ok(Self { path: path.to_owned(), sink: sink.map_err(file)?, is_picture, replacement })
    }

    /// Whether all rows are lost where it cannot be finished.
    pub fn is_picture(&self) -> bool {
        self.is_picture
    }

    pub fn row(&mut self, subject: &Subject<'_>, row: Row<'_>) -> Result<(), Error> {
        self.sink.row(subject, row).map_err(|error| Error::file(&self.path, "write", error))
    }

    pub fn finish(&mut self, subject: &Subject<'_>) -> Result<(), Error> {
        let finished = self.sink.finish(subject).and_then(|()| self.sink.flush());
        let finished = finished.and_then(|()| self.replacement.take().map_or(Ok(()), Replacement::keep));
        finished.map_err(|error| Error::file(&self.path, "write", error))
    }

    pub fn flush(&mut self) -> Result<(), Error> {
        self.sink.flush().map_err(|error| Error::file(&self.path, "write", error))
    }
}

fn opened(path: &Path, realtime: bool) -> io::Result<(Box<dyn Write>, Option<Replacement>)> {
    let buffered = |file: File| Box::new(BufWriter::with_capacity(1 << 16, file));
    if path.as_os_str() == "-" {
        return Ok((Box::new(BufWriter::new(io::stdout())), None));
    }
    if realtime {
        return Ok((buffered(open_at_once(path)?), None));
    }
    let (replacement, file) = Replacement::create(path)?;
    Ok((buffered(file), Some(replacement)))
}

/// Milliseconds without needless zeros.
pub(crate) fn milliseconds(time: Time) -> String {
    let (whole, rest) = (time / 1_000_000, time % 1_000_000);
    match rest {
        0 => whole.to_string(),
        _ => format!("{whole}.{rest:06}").trim_end_matches('0').to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::offset_of;
    use staunch_runtime::Value;
    use std::cell::RefCell;
    use std::rc::Rc;

    /// A file in memory.
    #[derive(Clone, Default)]
    struct Shared(Rc<RefCell<Vec<u8>>>);

    impl Write for Shared {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.borrow_mut().extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    /// What a sink writes of three scans.
    pub(super) fn written(subject: &Subject<'_>, open: impl FnOnce(Box<dyn Write>) -> Box<dyn Sink>) -> String {
        let file = Shared::default();
        let mut sink = open(Box::new(file.clone()));
        let mut state = vec![0; 128];
        sink.row(subject, Row { scan: 1, time: 0, state: &state }).unwrap();
        Value::Bool(true).write(&mut state[offset_of("up")..]);
        Value::I16(1).write(&mut state[offset_of("c.CV")..]);
        Value::I16(-1).write(&mut state[offset_of("m[1,2]")..]);
        let name = offset_of("name");
        state[name..name + 5].copy_from_slice(&[3, 0, b'a', b',', b'b']);
        sink.row(subject, Row { scan: 2, time: 10_000_000, state: &state }).unwrap();
        Value::F32(0.5).write(&mut state[offset_of("speed")..]);
        sink.row(subject, Row { scan: 3, time: 10_250_000, state: &state }).unwrap();
        sink.finish(subject).unwrap();
        let bytes = file.0.borrow().clone();
        String::from_utf8(bytes).unwrap()
    }

    /// What a sink writes of so many scans in which `up` and `level` are what `values` says.
    pub(super) fn values_written(
        subject: &Subject<'_>,
        scans: u64,
        values: impl Fn(u64) -> (bool, i16),
        open: impl FnOnce(Box<dyn Write>) -> Box<dyn Sink>,
    ) -> String {
        let file = Shared::default();
        let mut sink = open(Box::new(file.clone()));
        let mut state = vec![0; 128];
        let (up, level) = (offset_of("up"), offset_of("level"));
        for scan in 1..=scans {
            let values = values(scan);
            Value::Bool(values.0).write(&mut state[up..]);
            Value::I16(values.1).write(&mut state[level..]);
            let time = Time::try_from(scan - 1).unwrap() * 10_000_000;
            sink.row(subject, Row { scan, time, state: &state }).unwrap();
        }
        sink.finish(subject).unwrap();
        let bytes = file.0.borrow().clone();
        String::from_utf8(bytes).unwrap()
    }

    /// What a sink writes of scans in which `name` holds these texts.
    pub(super) fn texts_written(
        subject: &Subject<'_>,
        texts: &[&str],
        open: impl FnOnce(Box<dyn Write>) -> Box<dyn Sink>,
    ) -> String {
        let file = Shared::default();
        let mut sink = open(Box::new(file.clone()));
        let name = offset_of("name");
        for (text, number) in texts.iter().zip(1_u32..) {
            let mut state = vec![0; 128];
            let length = u16::try_from(text.len()).unwrap();
            state[name..name + 2].copy_from_slice(&length.to_ne_bytes());
            state[name + 2..name + 2 + text.len()].copy_from_slice(text.as_bytes());
            let row = Row { scan: u64::from(number), time: i64::from(number) * 10_000_000, state: &state };
            sink.row(subject, row).unwrap();
        }
        sink.finish(subject).unwrap();
        let bytes = file.0.borrow().clone();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn milliseconds_are_short() {
        assert_eq!(milliseconds(0), "0");
        assert_eq!(milliseconds(10_000_000), "10");
        assert_eq!(milliseconds(10_250_000), "10.25");
        assert_eq!(milliseconds(1), "0.000001");
    }
}
