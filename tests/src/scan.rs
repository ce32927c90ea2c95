//! A `.scan` file: what goes into a program and what must come out, a row a scan.
//!
//! ```text
//! # a remark
//! CU,    R, |, c.CV, c.Q
//! TRUE,   , |,    1, FALSE
//! FALSE,  , |,    1, FALSE
//! fault, division by zero, 12:5
//! ```
//!
//! Left of `|` is a stimulus as `staunch run` reads it; without a column `scan` the rows are
//! scans 1, 2, 3. Right of it are columns of the trace. In front of a `fault` row comes the
//! scan that faults, which has no outputs. The place is line and column, after the file's name
//! if that is not the case's first.

use std::fmt;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// Remarks, each in front of the row with this number.
    remarks: Vec<(usize, String)>,
    pub inputs: Vec<String>,
    pub outputs: Vec<String>,
    pub rows: Vec<Row>,
    pub fault: Option<Fault>,
}

/// Cells as they are in the file, with their quotes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    pub inputs: Vec<String>,
    pub outputs: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    pub text: String,
    pub place: String,
}

impl Table {
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut remarks = Vec::new();
        let mut rows: Vec<Vec<String>> = Vec::new();
        for line in text.lines().filter(|it| !it.trim().is_empty()) {
            match line.starts_with('#') {
                true => remarks.push((rows.len(), line.to_owned())),
                false => rows.push(cells(line)),
            }
        }
        let (header, rows) = rows.split_first().ok_or("it has no header")?;
        let (inputs, outputs) = halves(header)?;
        let mut table = Self { remarks, inputs, outputs, rows: Vec::new(), fault: None };
        for row in rows {
            table.row(row)?;
        }
        table.whole()
    }

    fn row(&mut self, cells: &[String]) -> Result<(), String> {
        if self.fault.is_some() {
            return Err("a row after the fault, which ends the run".to_owned());
        }
        if let [first, text, place] = cells
            && first == "fault"
        {
            self.fault = Some(Fault { text: text.clone(), place: place.clone() });
            return Ok(());
        }
        let (inputs, outputs) = halves(cells)?;
        let counts = (inputs.len(), outputs.len());
        let fits = inputs.len() == self.inputs.len() && (outputs.is_empty() || outputs.len() == self.outputs.len());
        if !fits {
            return Err(format!("row {} has {counts:?} cells, the header has others", self.rows.len() + 1));
        }
        self.rows.push(Row { inputs, outputs });
        Ok(())
    }

    fn whole(self) -> Result<Self, String> {
        if self.outputs.is_empty() {
            return Err("it names no outputs, right of a `|`".to_owned());
        }
        if self.rows.is_empty() {
            return Err("it has no rows".to_owned());
        }
        Ok(self)
    }

    /// The number of each row's scan.
    pub fn scans(&self) -> Vec<u64> {
        let column = self.inputs.iter().position(|it| it.eq_ignore_ascii_case("scan"));
        let number = |(at, row): (usize, &Row)| {
            let given = column.and_then(|it| row.inputs[it].parse().ok());
            given.unwrap_or_else(|| u64::try_from(at + 1).unwrap_or(u64::MAX))
        };
        self.rows.iter().enumerate().map(number).collect()
    }

    /// The outputs that are variables: `time_ms` is in every trace.
    pub fn variables(&self) -> Vec<&str> {
        self.outputs.iter().map(String::as_str).filter(|it| *it != "time_ms").collect()
    }

    /// As `staunch run --stimulus` reads it.
    pub fn stimulus(&self) -> String {
        let numbered = self.inputs.iter().any(|it| it.eq_ignore_ascii_case("scan"));
        let line = |first: String, cells: &[String]| match (numbered, cells) {
            (true, cells) => cells.join(","),
            (false, []) => first,
            (false, cells) => format!("{first},{}", cells.join(",")),
        };
        let mut text = line("scan".to_owned(), &self.inputs) + "\n";
        for (row, scan) in self.rows.iter().zip(self.scans()) {
            text.push_str(&line(scan.to_string(), &row.inputs));
            text.push('\n');
        }
        text
    }

    /// The same stimulus with what came out of it: a trace's text, and the fault that ended it.
    pub fn with_outputs(&self, trace: &str, fault: Option<Fault>) -> Result<Self, String> {
        let mut lines = trace.lines().map(cells);
        let header = lines.next().ok_or("the trace is empty")?;
        let column = |name: &str| header.iter().position(|it| plain(it) == plain(name));
        let missing = |name: &String| format!("the trace has no column {name}");
        let columns: Vec<usize> =
            self.outputs.iter().map(|it| column(it).ok_or_else(|| missing(it))).collect::<Result<_, _>>()?;
        let rows: Vec<Vec<String>> = lines.collect();
        let mut table = Self { fault, ..self.clone() };
        for (row, scan) in table.rows.iter_mut().zip(self.scans()) {
            let traced = rows.iter().find(|it| it[0] == scan.to_string());
            row.outputs = traced.map_or_else(Vec::new, |it| columns.iter().map(|at| it[*at].clone()).collect());
        }
        Ok(table)
    }
}

/// A line's cells, with their quotes but without the spaces around them.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    for character in line.chars() {
        quoted ^= character == '"';
        match character {
            ',' if !quoted => cells.push(String::new()),
            other => cells.last_mut().expect("there is a first cell").push(other),
        }
    }
    cells.into_iter().map(|it| it.trim().to_owned()).collect()
}

fn plain(cell: &str) -> &str {
    cell.trim_matches('"')
}

fn halves(cells: &[String]) -> Result<(Vec<String>, Vec<String>), String> {
    let bar = cells.iter().position(|it| it == "|").ok_or("a row has no `|` between inputs and outputs")?;
    let outputs = cells[bar + 1..].to_vec();
    let empty = outputs.iter().all(String::is_empty);
    Ok((cells[..bar].to_vec(), if empty { Vec::new() } else { outputs }))
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bar = || ["|".to_owned()].into_iter();
        let whole = |inputs: &[String], outputs: &[String]| {
            inputs.iter().cloned().chain(bar()).chain(outputs.iter().cloned()).collect::<Vec<_>>()
        };
        let header = whole(&self.inputs, &self.outputs);
        let rows: Vec<_> = self.rows.iter().map(|it| whole(&it.inputs, &it.outputs)).collect();
        let lines: Vec<&Vec<String>> = [&header].into_iter().chain(&rows).collect();
        let width = |at: usize| lines.iter().filter_map(|it| it.get(at)).map(|it| it.chars().count()).max();
        let widths: Vec<usize> = (0..header.len()).map(|at| width(at).unwrap_or(0)).collect();
        for (number, cells) in lines.iter().enumerate() {
            for (_, remark) in self.remarks.iter().filter(|it| it.0 == number) {
                writeln!(f, "{remark}")?;
            }
            let padded: Vec<_> = cells.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
            writeln!(f, "{}", padded.join(", ").trim_end())?;
        }
        for (_, remark) in self.remarks.iter().filter(|it| it.0 >= lines.len()) {
            writeln!(f, "{remark}")?;
        }
        self.fault.as_ref().map_or(Ok(()), |it| writeln!(f, "fault, {}, {}", it.text, it.place))
    }
}
