//! How a program is read.

use crate::dialect::Dialect;
use staunch_ir::BlockId;
use staunch_runtime::{BLOCKS, BlockOption};

/// How to read the sources.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// For files that do not name their own with `{dialect '…'}`.
    pub dialect: Dialect,
    /// CODESYS `CTU` stops at its preset, as some of its documents say.
    pub ctu_stop_at_pv: bool,
    /// OpenPLC from v4.1: `CTD`, and `CD` of a `CTUD`, count on the rising edge.
    pub openplc4_cd_rises: bool,
    /// S7: `CTD` and `CTUD` are loaded when LD becomes TRUE, and not while it is.
    pub s7_ld_edge: bool,
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
    pub fn is_on(&self, option: BlockOption) -> bool {
        match option {
            BlockOption::CtuStopAtPv => self.ctu_stop_at_pv,
            BlockOption::CdRises => self.openplc4_cd_rises,
            BlockOption::LdEdge => self.s7_ld_edge,
            BlockOption::FTrigBefore202412 => self.f_trig_before_2024_12,
        }
    }

    /// The same with an option set.
    #[must_use]
    pub fn with(self, option: BlockOption, is_on: bool) -> Self {
        match option {
            BlockOption::CtuStopAtPv => Self { ctu_stop_at_pv: is_on, ..self },
            BlockOption::CdRises => Self { openplc4_cd_rises: is_on, ..self },
            BlockOption::LdEdge => Self { s7_ld_edge: is_on, ..self },
            BlockOption::FTrigBefore202412 => Self { f_trig_before_2024_12: is_on, ..self },
        }
    }
}

/// What a vendor's documents leave open about its blocks, so that a program that uses one of them may do either.
#[derive(Debug)]
pub struct OpenOption {
    pub option: BlockOption,
    /// In `staunch.toml`.
    pub name: &'static str,
    /// What is left open, and by whom, as a sentence.
    pub question: &'static str,
    /// How it is written there while it is off, and on.
    pub settings: [&'static str; 2],
}

/// All of them, one row each.
pub const OPEN_OPTIONS: &[OpenOption] = &[
    OpenOption {
        option: BlockOption::CtuStopAtPv,
        name: "ctu-stop-at-pv",
        question: "The documents of CODESYS and TwinCAT disagree on whether CTU and LCTU stop at PV.",
        settings: ["false", "true"],
    },
    OpenOption {
        option: BlockOption::CdRises,
        name: "openplc4-cd-edge",
        question: "OpenPLC Editor counts CD on its falling edge through 4.2.11; a later version may count the rising edge.",
        settings: ["falling", "rising"],
    },
    OpenOption {
        option: BlockOption::LdEdge,
        name: "s7-ld",
        question: "Siemens' pages of CTD and CTUD say that PV is loaded while LD is 1, and that it is loaded when LD changes to 1.",
        settings: ["level", "edge"],
    },
    OpenOption {
        option: BlockOption::FTrigBefore202412,
        name: "openplc-f-trig",
        question: "Before December 2024, F_TRIG of OpenPLC sees an edge in a first call with CLK FALSE.",
        settings: ["now", "before-2024-12"],
    },
];

impl OpenOption {
    /// Whether the option decides what a block does: by its name, or because it stands for that block.
    pub fn decides(&self, block: BlockId) -> bool {
        let info = block.info();
        let replaces = |of: &str| of == info.name;
        let is_row = |it: &&staunch_runtime::BlockInfo| {
            let row = it.facts.option.filter(|it| it.option == self.option);
            it.family == info.family && row.is_some_and(|row| replaces(row.of) || it.name == info.name)
        };
        BLOCKS.iter().any(|it| is_row(&it))
    }

    /// As a line of `staunch.toml`.
    pub fn line(&self, is_on: bool) -> String {
        let setting = self.settings[usize::from(is_on)];
        match setting {
            "false" | "true" => format!("{} = {setting}", self.name),
            _ => format!("{} = \"{setting}\"", self.name),
        }
    }
}
