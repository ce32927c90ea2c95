//! `tests/perf/*.tsv`: figures that must not rise without a reason.

use crate::perf;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

/// A rise of up to 1 in 50, or of one instruction, is noise of the optimiser.
const SLACK: u64 = 50;

/// A file of figures.
pub struct Sheet<const N: usize> {
    pub file: &'static str,
    /// The columns.
    pub figures: [&'static str; N],
    /// The first ones must not rise.
    pub gated: usize,
}

/// Instructions of a scan, bytes of machine code, and instructions of the program by hand.
pub const SCANS: Sheet<5> =
    Sheet { file: "instructions.tsv", figures: ["rust", "native", "rust text", "native text", "by hand"], gated: 4 };
/// Instructions of the command.
pub const COMPILING: Sheet<4> = Sheet {
    file: "compiling.tsv",
    figures: ["check", "build --emit rust", "build --emit obj", "lsp, three keys"],
    gated: 4,
};

pub type Measured<const N: usize> = [Option<u64>; N];

/// The figures of a program, and why one last rose.
#[derive(Clone)]
pub struct Row<const N: usize> {
    pub figures: Measured<N>,
    pub reason: String,
}

pub type Table<const N: usize> = BTreeMap<String, Row<N>>;

impl<const N: usize> Sheet<N> {
    fn path(&self) -> PathBuf {
        perf().join(self.file)
    }

    pub fn read(&self) -> Table<N> {
        let text = fs::read_to_string(self.path()).unwrap_or_default();
        text.lines().skip(1).map(row).collect()
    }

    fn write(&self, table: &Table<N>) {
        let mut text = format!("program\t{}\twhy one last rose\n", self.figures.join("\t"));
        for (name, row) in table {
            let figures = row.figures.map(|it| it.map(|it| it.to_string()).unwrap_or_default()).join("\t");
            writeln!(text, "{name}\t{figures}\t{}", row.reason).unwrap();
        }
        fs::write(self.path(), text).unwrap();
    }

    /// Fails where a figure is more than in the file; or blesses all of them, and gives true.
    pub fn hold(&self, measured: &BTreeMap<String, Measured<N>>) -> bool {
        let before = self.read();
        if let Ok(reason) = std::env::var("STAUNCH_BLESS") {
            self.write(&self.blessed(&before, measured, &reason));
            return true;
        }
        let mut complaints = String::new();
        for (name, new) in measured {
            for line in before.get(name).map(|old| self.risen(name, old, new)).unwrap_or_default() {
                writeln!(complaints, "{line}").unwrap();
            }
        }
        assert!(complaints.is_empty(), "more than {} says:\n{complaints}", self.path().display());
        assert!(before.keys().eq(measured.keys()), "{} names other programs", self.path().display());
        false
    }

    /// The gated figures that are more than before, in words.
    fn risen(&self, name: &str, old: &Row<N>, new: &Measured<N>) -> Vec<String> {
        let rises = |at: &usize| match (old.figures[*at], new[*at]) {
            (Some(old), Some(new)) => new > old + old / SLACK + 1,
            _ => false,
        };
        let told = |at: usize| {
            let [old, new] = [old.figures[at], new[at]].map(Option::unwrap_or_default);
            format!("{name}, {}: {new}, {old} before", self.figures[at])
        };
        (0..self.gated).filter(rises).map(told).collect()
    }

    /// The table with what was measured; the reason goes to the rows where a figure rises.
    fn blessed(&self, before: &Table<N>, measured: &BTreeMap<String, Measured<N>>, reason: &str) -> Table<N> {
        let row = |(name, new): (&String, &Measured<N>)| {
            let old = before.get(name).cloned().unwrap_or_else(|| Row { figures: [None; N], reason: String::new() });
            let has_risen = !self.risen(name, &old, new).is_empty();
            let reason = if has_risen { reason.to_owned() } else { old.reason };
            (name.clone(), Row { figures: *new, reason })
        };
        measured.iter().map(row).collect()
    }
}

fn row<const N: usize>(line: &str) -> (String, Row<N>) {
    let mut cells = line.split('\t');
    let name = cells.next().unwrap().to_owned();
    let figures = std::array::from_fn(|_| cells.next().and_then(|it| it.parse().ok()));
    (name, Row { figures, reason: cells.next().unwrap_or_default().to_owned() })
}
