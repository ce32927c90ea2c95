//! How a program is read.

use crate::dialect::Dialect;

/// How to read the sources.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// For files that do not name their own with `{dialect '…'}`.
    pub dialect: Dialect,
    /// CODESYS `CTU` stops at its preset, as some of its documents say.
    pub ctu_stop_at_pv: bool,
    /// OpenPLC `F_TRIG` sees an edge in a first call with FALSE, as before 2024-12.
    pub f_trig_before_2024_12: bool,
    /// In `codesys`, an integer becomes one of fewer bits by itself, with a lint.
    pub implicit_narrowing: bool,
    /// The dialect that the sources were written in, where `dialect` is the one they move to:
    /// its pragma then means the new dialect, and a pin by its old name is a lint.
    pub moved_from: Option<Dialect>,
    /// Each TEST becomes an instance of the program, and no other PROGRAM runs.
    pub tests: bool,
    /// It runs as it is: what is declared `{external}` is not there, and a call of it faults.
    pub is_run: bool,
    /// It runs in a test: what has no body here faults, and is not reported where it is called.
    pub is_tested: bool,
    /// Counts what is executed of the first so many sources.
    pub coverage: Option<u16>,
}

impl Options {
    pub(crate) fn is_on(&self, option: staunch_runtime::BlockOption) -> bool {
        match option {
            staunch_runtime::BlockOption::CtuStopAtPv => self.ctu_stop_at_pv,
            staunch_runtime::BlockOption::FTrigBefore202412 => self.f_trig_before_2024_12,
        }
    }
}
