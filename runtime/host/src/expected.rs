//! What a table expects of a program: the columns right of the bar in a stimulus.

use crate::csv::{self, Cell};
use crate::map::{Map, Type};
use crate::path::{Place, resolve, same};
use crate::stimulus::BAR;
use crate::value::format;
use crate::{Error, literal};
use staunch_runtime::Time;
use std::path::Path;

/// The rows of a table that expect something.
#[derive(Clone, Debug, Default)]
pub struct Expectations {
    /// The variables, as the header names them.
    pub variables: Vec<String>,
    pub rows: Vec<ExpectedRow>,
}

#[derive(Clone, Debug)]
pub struct ExpectedRow {
    pub when: When,
    /// For each cell that is not empty, the column of its variable.
    pub cells: Vec<(usize, ExpectedCell)>,
}

/// After which scan a row is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    Scan(u64),
    /// The first that runs at this time, or later.
    Time(Time),
}

/// A value as someone wrote it.
#[derive(Clone, Debug)]
pub struct ExpectedCell {
    pub text: String,
    pub line: usize,
    pub column: usize,
    wants: Wants,
}

#[derive(Clone, Debug)]
enum Wants {
    /// As a trace shows it.
    Value(String),
    /// `1.5 +- 0.1`.
    Near(f64, f64),
}

impl ExpectedCell {
    /// Whether this is the value of a trace's cell.
    pub fn is(&self, shown: &str) -> bool {
        match &self.wants {
            Wants::Value(value) => value == shown,
            Wants::Near(value, tolerance) => {
                shown.parse::<f64>().is_ok_and(|shown| (shown - value).abs() <= *tolerance)
            }
        }
    }
}

impl Expectations {
    /// Whether a file is such a table: its header has a bar.
    pub fn are_in(bytes: &[u8]) -> bool {
        let text = csv::decoded(bytes);
        let rows = csv::parse(&text).unwrap_or_default();
        rows.first().is_some_and(|header| header.iter().any(|it| it.text == BAR))
    }

    /// `path` is for messages; names are seen from the instances `running`.
    pub fn parse(path: &Path, bytes: &[u8], map: &Map, running: &[usize]) -> Result<Self, Error> {
        let error = |line, column, text| Error::Stimulus { path: path.to_owned(), line, column, text };
        let at = |cell: &Cell, text: String| error(cell.line, cell.column, text);
        let text = csv::decoded(bytes);
        let decimal_comma = csv::has_semicolons(&text);
        let rows =
            csv::parse(&text).map_err(|(line, column)| error(line, column, "a quote that is not closed".into()))?;
        let Some((header, rows)) = rows.split_first() else { return Ok(Self::default()) };
        let bar = header.iter().position(|it| it.text == BAR).unwrap_or(header.len());
        let (inputs, named) = (&header[..bar], header.get(bar + 1..).unwrap_or_default());
        let mut variables = Vec::new();
        for cell in named {
            let place = resolve(map, running, &cell.text).map_err(|text| at(cell, text))?;
            if matches!(place.ty, Type::Array(_) | Type::Struct(_) | Type::Block(_)) {
                return Err(at(cell, format!("`{}` is not a single value: name a member or an element", cell.text)));
            }
            variables.push((cell.text.clone(), place));
        }
        if variables.is_empty() {
            return Err(error(1, 1, "it names no variable to the right of the `|`".to_owned()));
        }
        let column = |name| inputs.iter().take(2).position(|it| same(&it.text, name));
        let (scans, times) = (column("scan"), column("time"));
        let mut expectations = Self { variables: variables.iter().map(|it| it.0.clone()).collect(), rows: Vec::new() };
        for (number, row) in (1..).zip(rows) {
            let cell = |column: Option<usize>| column.and_then(|it| row.get(it)).filter(|it| !it.is_empty());
            // What does not read so, the stimulus has reported.
            let when = match (cell(scans), cell(times)) {
                (Some(scan), _) => When::Scan(scan.text.parse().unwrap_or(number)),
                (None, Some(time)) => When::Time(literal::time(&time.text).unwrap_or(0)),
                (None, None) => When::Scan(number),
            };
            let expected = row.get(bar + 1..).unwrap_or_default();
            if let Some(surplus) = expected.get(variables.len()) {
                return Err(at(surplus, format!("the header has only {} columns", header.len())));
            }
            let mut cells = Vec::new();
            for (column, cell) in expected.iter().enumerate().filter(|(_, it)| !it.is_empty()) {
                let wanted =
                    wants(map, variables[column].1, &cell.text, decimal_comma).map_err(|text| at(cell, text))?;
                let Cell { text, line, column: place, .. } = cell.clone();
                cells.push((column, ExpectedCell { text, line, column: place, wants: wanted }));
            }
            if !cells.is_empty() {
                expectations.rows.push(ExpectedRow { when, cells });
            }
        }
        match expectations.rows.is_empty() {
            true => Err(error(1, 1, "no row expects anything to the right of the `|`".to_owned())),
            false => Ok(expectations),
        }
    }
}

fn wants(map: &Map, place: Place, text: &str, decimal_comma: bool) -> Result<Wants, String> {
    let is_real = matches!(place.ty, Type::Elementary(it) if it.repr().is_float());
    let with_point = (decimal_comma && is_real).then(|| text.replace(',', "."));
    let text = with_point.as_deref().unwrap_or(text);
    if let Some((value, tolerance)) = text.split_once("+-").filter(|_| is_real) {
        let both = value.trim().parse().ok().zip(tolerance.trim().parse().ok());
        let both = both.map(|(value, tolerance)| Wants::Near(value, tolerance));
        return both.ok_or_else(|| format!("`{text}` is not a value with a tolerance: write `1.5 +- 0.1`"));
    }
    let bytes = literal::parse(map, place, text)?;
    // A bit of a word is written alone.
    let ty = if let Type::Bit(_) = place.ty { Type::Bit(0) } else { place.ty };
    let mut value = String::new();
    format(map, ty, &bytes, &mut value);
    Ok(Wants::Value(value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::map;

    fn read(text: &str) -> Result<Expectations, String> {
        Expectations::parse(Path::new("t.csv"), text.as_bytes(), &map(), &[0]).map_err(|it| it.to_string())
    }

    #[test]
    fn cells_are_values_of_their_variables() {
        let table = read("scan,up,|,c.CV,up,speed\n1,1,|,16#F,1,1.50\n3,0,|,,0,2.0 +- 0.5\n4,0,|\n").unwrap();
        assert_eq!(table.variables, ["c.CV", "up", "speed"]);
        let [first, second] = table.rows.as_slice() else { panic!("{table:?}") };
        assert_eq!((first.when, second.when), (When::Scan(1), When::Scan(3)));
        let is = |cell: &(usize, ExpectedCell), value: &str| cell.1.is(value);
        assert!(is(&first.cells[0], "15") && is(&first.cells[1], "TRUE") && is(&first.cells[2], "1.5"));
        assert!(!is(&first.cells[0], "16") && !is(&first.cells[2], "1.25"));
        assert!(second.cells[0].0 == 1 && is(&second.cells[1], "2.5") && !is(&second.cells[1], "2.51"));
        assert_eq!(read("time,up,|,up\nT#25ms,1,|,1\n").unwrap().rows[0].when, When::Time(25_000_000));
        assert_eq!(read("up,|,up\n1,|\n1,|,1\n").unwrap().rows[0].when, When::Scan(2));
    }

    #[test]
    fn mistakes_name_their_place() {
        for (text, expected) in [
            ("up,|,nothing\n1,|,1\n", "t.csv:1:6: there is no variable `nothing`"),
            ("up,|,c\n1,|,1\n", "t.csv:1:6: `c` is not a single value: name a member or an element"),
            ("up,|,c.CV\n1,|,x\n", "t.csv:2:5: `x` is not an INT"),
            ("up,|,c.CV\n1,|,1,2\n", "t.csv:2:7: the header has only 3 columns"),
            ("up,|,c.CV\n1,|\n", "t.csv:1:1: no row expects anything to the right of the `|`"),
            ("up,|\n1,|\n", "t.csv:1:1: it names no variable to the right of the `|`"),
            ("up,|,speed\n1,|,1 +- x\n", "t.csv:2:5: `1 +- x` is not a value with a tolerance: write `1.5 +- 0.1`"),
        ] {
            assert_eq!(read(text).unwrap_err(), expected, "{text}");
        }
    }
}
