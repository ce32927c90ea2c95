//! `tests/perf/instructions.tsv`.

use crate::measure::Measured;
use crate::perf;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

/// The columns of figures: instructions of a scan, bytes of machine code, and instructions of the program by hand.
pub const FIGURES: [&str; 5] = ["rust", "native", "rust text", "native text", "by hand"];
/// The first ones must not rise.
pub const GATED: usize = 4;

/// The figures of a program, and why one last rose.
#[derive(Clone, Default)]
pub struct Row {
    pub figures: Measured,
    pub reason: String,
}

pub struct Table(pub BTreeMap<String, Row>);

pub fn path() -> PathBuf {
    perf().join("instructions.tsv")
}

impl Table {
    pub fn read() -> Self {
        let text = fs::read_to_string(path()).unwrap_or_default();
        Self(text.lines().skip(1).map(row).collect())
    }

    pub fn write(&self) {
        let mut text = format!("program\t{}\twhy one last rose\n", FIGURES.join("\t"));
        for (name, row) in &self.0 {
            let figures = row.figures.map(|it| it.map(|it| it.to_string()).unwrap_or_default()).join("\t");
            writeln!(text, "{name}\t{figures}\t{}", row.reason).unwrap();
        }
        fs::write(path(), text).unwrap();
    }
}

fn row(line: &str) -> (String, Row) {
    let mut cells = line.split('\t');
    let name = cells.next().unwrap().to_owned();
    let figures = std::array::from_fn(|_| cells.next().and_then(|it| it.parse().ok()));
    (name, Row { figures, reason: cells.next().unwrap_or_default().to_owned() })
}
