//! A trace as comma-separated values.

use super::{Row, Sink, Subject, milliseconds};
use crate::csv;
use std::io::{self, Write};

pub(super) struct Rows {
    out: Box<dyn Write>,
    cell: String,
}

impl Rows {
    pub fn new(mut out: Box<dyn Write>, subject: &Subject<'_>) -> io::Result<Self> {
        let headings = subject.columns.iter().map(|it| it.heading.as_str());
        csv::write_row(&mut out, ["scan", "time_ms"].into_iter().chain(headings))?;
        Ok(Self { out, cell: String::new() })
    }
}

impl Sink for Rows {
    fn row(&mut self, subject: &Subject<'_>, row: Row<'_>) -> io::Result<()> {
        write!(self.out, "{},{}", row.scan, milliseconds(row.time))?;
        for column in &subject.columns {
            subject.cell(column, row.state, &mut self.cell);
            self.out.write_all(b",")?;
            self.out.write_all(csv::quote(&self.cell).as_bytes())?;
        }
        self.out.write_all(b"\n")
    }

    fn finish(&mut self, _subject: &Subject<'_>) -> io::Result<()> {
        Ok(())
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
    use crate::trace::tests::written;

    #[test]
    fn a_row_a_scan() {
        let map = map();
        let columns = columns(&map, &[0], Some("up,c.CV,name,m[1,2]")).unwrap();
        let subject = Subject { map: &map, columns, overlays: Vec::new(), title: String::new(), cycle: 10_000_000 };
        let text = written(&subject, |out| Box::new(Rows::new(out, &subject).unwrap()));
        assert_eq!(
            text,
            "scan,time_ms,up,c.CV,name,\"m[1,2]\"\n1,0,FALSE,0,,0\n2,10,TRUE,1,\"a,b\",-1\n3,10.25,TRUE,1,\"a,b\",-1\n"
        );
    }
}
