//! How a program is read.

use crate::dialect::Dialect;
use crate::source::{Comments, Habits};
use crate::{Source, Sources};
use staunch_ir::{BlockId, Location, Part, Use, Uses};
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
    /// In `codesys`, a number with a fraction and without a type is an LREAL also next to a REAL.
    pub codesys_lreal_literals: bool,
    /// In `codesys`, an integer becomes one of fewer bits by itself, with a lint.
    pub implicit_narrowing: bool,
    /// How many objects the pool of a type has that `__NEW` names and that declares none.
    pub default_pool: Option<u32>,
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
    /// A run can stop before each statement of the user's.
    pub stops: Option<Stops>,
}

/// Where a run can stop, and what is evaluated there.
#[derive(Clone, Debug, Default)]
pub struct Stops {
    /// The sources with stops: this many, from the first.
    pub files: u16,
    pub asked: Vec<AskedAt>,
}

/// What is asked before a statement.
#[derive(Clone, Copy, Debug)]
pub struct AskedAt {
    /// Of the statement.
    pub at: Location,
    /// The source that [is](crate::Source::is_expression) the expression.
    pub expression: u16,
    /// It is a condition; else any value.
    pub is_condition: bool,
}

impl Options {
    /// What is known of a file before it is read, its dialect among it, unless the file names another.
    pub(crate) fn habits<'s>(&self, sources: &'s Sources, source: &Source) -> Habits<'s> {
        let own = sources.habits(source);
        match own.comments {
            Comments::Plain => own,
            Comments::Nested => Habits { comments: Comments::of_dialect(self.dialect.name()), ..own },
        }
    }

    pub fn is_on(&self, option: BlockOption) -> bool {
        match option {
            BlockOption::CtuStopAtPv => self.ctu_stop_at_pv,
            BlockOption::CdRises => self.openplc4_cd_rises,
            BlockOption::LdEdge => self.s7_ld_edge,
            BlockOption::FTrigBefore202412 => self.f_trig_before_2024_12,
        }
    }

    /// How an open question is answered.
    pub fn answer(&self, question: Question) -> bool {
        match question {
            Question::Block(option) => self.is_on(option),
            Question::RealLiterals => self.codesys_lreal_literals,
        }
    }

    /// The same with a question answered.
    #[must_use]
    pub fn with(self, question: Question, is_on: bool) -> Self {
        let option = match question {
            Question::Block(option) => option,
            Question::RealLiterals => return Self { codesys_lreal_literals: is_on, ..self },
        };
        match option {
            BlockOption::CtuStopAtPv => Self { ctu_stop_at_pv: is_on, ..self },
            BlockOption::CdRises => Self { openplc4_cd_rises: is_on, ..self },
            BlockOption::LdEdge => Self { s7_ld_edge: is_on, ..self },
            BlockOption::FTrigBefore202412 => Self { f_trig_before_2024_12: is_on, ..self },
        }
    }
}

/// What a vendor's documents leave open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// About a block.
    Block(BlockOption),
    /// CODESYS: the type of a number with a fraction next to a REAL.
    RealLiterals,
}

/// An open question as a setting: a program to which it matters may do either.
#[derive(Debug)]
pub struct OpenOption {
    pub asks: Question,
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
        asks: Question::Block(BlockOption::CtuStopAtPv),
        name: "ctu-stop-at-pv",
        question: "The documents of CODESYS and TwinCAT disagree on whether CTU and LCTU stop at PV.",
        settings: ["false", "true"],
    },
    OpenOption {
        asks: Question::Block(BlockOption::CdRises),
        name: "openplc4-cd-edge",
        question: "OpenPLC Editor counts CD on its falling edge through 4.2.11; a later version may count the rising edge.",
        settings: ["falling", "rising"],
    },
    OpenOption {
        asks: Question::Block(BlockOption::LdEdge),
        name: "s7-ld",
        question: "Siemens' pages of CTD and CTUD say that PV is loaded while LD is 1, and that it is loaded when LD changes to 1.",
        settings: ["level", "edge"],
    },
    OpenOption {
        asks: Question::Block(BlockOption::FTrigBefore202412),
        name: "openplc-f-trig",
        question: "Before December 2024, F_TRIG of OpenPLC sees an edge in a first call with CLK FALSE.",
        settings: ["now", "before-2024-12"],
    },
    OpenOption {
        asks: Question::RealLiterals,
        name: "codesys-real-literals",
        question: "CODESYS and Beckhoff say on one page that a number with a fraction is always an LREAL, on another that it has the type that its \
                   place asks for.",
        settings: ["place", "lreal"],
    },
];

impl OpenOption {
    /// Whether a program of a dialect does otherwise by the answer: it has such a block, or such a number.
    pub fn matters(&self, dialect: Dialect, blocks: impl IntoIterator<Item = BlockId>, uses: &Uses) -> bool {
        match self.asks {
            Question::Block(option) => blocks.into_iter().any(|it| decides(option, it)),
            Question::RealLiterals => {
                dialect == Dialect::Codesys && uses.first(Use::Part(Part::FractionBesideReal)).is_some()
            }
        }
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

/// Whether an option decides what a block does: by its name, or because it stands for that block.
fn decides(option: BlockOption, block: BlockId) -> bool {
    let info = block.info();
    let is_row = |it: &&staunch_runtime::BlockInfo| {
        let row = it.facts.option.filter(|it| it.option == option);
        it.family == info.family && row.is_some_and(|row| row.of == info.name || it.name == info.name)
    };
    BLOCKS.iter().any(|it| is_row(&it))
}
