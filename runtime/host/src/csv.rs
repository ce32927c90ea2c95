//! Comma-separated values, as RFC 4180 has them, with the place of every cell. Where a comma is the decimal
//! sign, spreadsheets write semicolons between cells; these are read too.

use std::borrow::Cow;
use std::io::{self, Write};

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cell {
    pub text: String,
    /// It stood in quotes, so an empty one means an empty text.
    pub quoted: bool,
    /// 1-based.
    pub line: usize,
    /// 1-based, in characters.
    pub column: usize,
}

impl Cell {
    pub fn is_empty(&self) -> bool {
        self.text.is_empty() && !self.quoted
    }
}

/// Reads all rows; a blank line is none. `Err` is the line and column of a quote that is not
/// closed.
pub(crate) fn parse(text: &str) -> Result<Vec<Vec<Cell>>, (usize, usize)> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let separator = if has_semicolons(text) { ';' } else { ',' };
    let mut reader = Reader { rest: text.chars().peekable(), line: 1, column: 1, separator };
    let mut rows = Vec::new();
    while reader.rest.peek().is_some() {
        let row = reader.row()?;
        if row.len() > 1 || row.iter().any(|it| !it.is_empty()) {
            rows.push(row);
        }
    }
    Ok(rows)
}

/// The texts of all rows and their cells; `None` where a quote is not closed.
pub fn cells(text: &str) -> Option<Vec<Vec<String>>> {
    let texts = |row: Vec<Cell>| row.into_iter().map(|it| it.text).collect();
    Some(parse(text).ok()?.into_iter().map(texts).collect())
}

/// Whether the first of both signs in the header is a semicolon.
pub(crate) fn has_semicolons(text: &str) -> bool {
    let header = text.trim_start().lines().next().unwrap_or_default();
    header.chars().find(|it| matches!(it, ',' | ';')) == Some(';')
}

struct Reader<'t> {
    rest: std::iter::Peekable<std::str::Chars<'t>>,
    line: usize,
    column: usize,
    separator: char,
}

impl Reader<'_> {
    fn next(&mut self) -> Option<char> {
        let character = self.rest.next()?;
        self.column += 1;
        if character == '\n' {
            (self.line, self.column) = (self.line + 1, 1);
        }
        Some(character)
    }

    fn row(&mut self) -> Result<Vec<Cell>, (usize, usize)> {
        let mut row = Vec::new();
        loop {
            let (cell, last) = self.cell()?;
            row.push(cell);
            if last {
                return Ok(row);
            }
        }
    }

    /// A cell, and whether it ends its row.
    fn cell(&mut self) -> Result<(Cell, bool), (usize, usize)> {
        while self.rest.next_if(|it| matches!(it, ' ' | '\t')).is_some() {
            self.column += 1;
        }
        let mut cell = Cell { line: self.line, column: self.column, ..Cell::default() };
        if self.rest.peek() == Some(&'"') {
            self.next();
            cell.quoted = true;
            self.quoted(&mut cell)?;
        }
        loop {
            match self.next() {
                Some(it) if it == self.separator => break Ok((trimmed(cell), false)),
                Some('\n') | None => break Ok((trimmed(cell), true)),
                Some('\r') if matches!(self.rest.peek(), Some('\n') | None) => {}
                Some(' ' | '\t') if cell.quoted => {}
                Some(other) => cell.text.push(other),
            }
        }
    }

    fn quoted(&mut self, cell: &mut Cell) -> Result<(), (usize, usize)> {
        loop {
            match self.next() {
                Some('"') if self.rest.peek() == Some(&'"') => {
                    self.next();
                    cell.text.push('"');
                }
                Some('"') => return Ok(()),
                Some(other) => cell.text.push(other),
                None => return Err((cell.line, cell.column)),
            }
        }
    }
}

fn trimmed(mut cell: Cell) -> Cell {
    if !cell.quoted {
        cell.text.truncate(cell.text.trim_end().len());
    }
    cell
}

/// A cell as it is written: in quotes where it needs them.
pub(crate) fn quote(text: &str) -> Cow<'_, str> {
    let plain = !text.contains([',', '"', '\n', '\r']) && text.trim() == text;
    if plain { Cow::Borrowed(text) } else { Cow::Owned(format!("\"{}\"", text.replace('"', "\"\""))) }
}

pub(crate) fn write_row<'t>(out: &mut dyn Write, cells: impl Iterator<Item = &'t str>) -> io::Result<()> {
    for (number, cell) in cells.enumerate() {
        if number > 0 {
            out.write_all(b",")?;
        }
        out.write_all(quote(cell).as_bytes())?;
    }
    out.write_all(b"\n")
}

/// A file's text: UTF-8, or UTF-16 as spreadsheets write "Unicode text", with or without its mark.
pub fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let from: fn([u8; 2]) -> u16 = match bytes {
        [0xFF, 0xFE, ..] => u16::from_le_bytes,
        [0xFE, 0xFF, ..] => u16::from_be_bytes,
        // A header begins with a letter or a sign of ASCII.
        [1..=0xFF, 0, ..] => u16::from_le_bytes,
        [0, 1..=0xFF, ..] => u16::from_be_bytes,
        _ => return String::from_utf8_lossy(bytes),
    };
    let words = bytes.chunks_exact(2).map(|it| from([it[0], it[1]]));
    let text: String = char::decode_utf16(words).map(|it| it.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    Cow::Owned(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<Vec<String>> {
        let rows = parse(text).unwrap();
        rows.into_iter().map(|row| row.into_iter().map(|it| it.text).collect()).collect()
    }

    #[test]
    fn rows_of_any_origin() {
        let expected = [["scan", "a b"], ["1", "x,\"y\""]];
        assert_eq!(texts("scan,a b\n1,\"x,\"\"y\"\"\"\n"), expected);
        assert_eq!(texts("\u{FEFF}scan , a b\r\n\r\n 1,\"x,\"\"y\"\"\" \r\n"), expected);
        assert_eq!(texts("scan,a b\n1,\"x,\"\"y\"\"\""), expected);
        assert_eq!(texts(""), Vec::<Vec<String>>::new());
        assert_eq!(texts("a\n,\n"), [vec!["a".to_owned()], vec![String::new(), String::new()]]);
    }

    #[test]
    fn semicolons_part_cells_where_the_header_has_them() {
        assert_eq!(texts("scan;m[1,2]\n1;3,5\n"), [["scan", "m[1,2]"], ["1", "3,5"]]);
        assert_eq!(texts("scan,a\n1,x;y\n"), [["scan", "a"], ["1", "x;y"]]);
    }

    #[test]
    fn cells_know_their_place() {
        let rows = parse("é,b\n\"two\nlines\", c\n").unwrap();
        assert_eq!((rows[0][1].line, rows[0][1].column), (1, 3));
        assert_eq!((rows[1][0].line, rows[1][0].column), (2, 1));
        assert_eq!((rows[1][1].line, rows[1][1].column), (3, 9));
        assert!(parse("a,\"\"").unwrap()[0][1].quoted);
        assert_eq!(parse("a\nb,\"c"), Err((2, 3)));
    }

    #[test]
    fn written_cells_read_back() {
        for text in ["plain", "a,b", "say \"x\"", "two\nlines", " spaces ", ""] {
            let mut out = Vec::new();
            write_row(&mut out, ["first", text].into_iter()).unwrap();
            assert_eq!(texts(std::str::from_utf8(&out).unwrap())[0][1], text);
        }
    }
}
