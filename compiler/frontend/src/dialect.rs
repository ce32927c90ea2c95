//! Whose blocks a bare name means, and what a dialect allows beyond the standard.

use staunch_ir::BlockId;
use staunch_runtime::{BLOCKS, Family};

/// The system whose habits a source file follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Dialect {
    /// IEC 61131-3 third edition, with the counters of Autonomy Edge / OpenPLC.
    #[default]
    Iec,
    /// Horner Cscape, IEC editor.
    Cscape,
    /// CODESYS (and TwinCAT).
    Codesys,
    /// Rockwell Logix 5000.
    Logix,
}

impl Dialect {
    pub const ALL: [Self; 4] = [Self::Iec, Self::Cscape, Self::Codesys, Self::Logix];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Iec => "iec",
            Self::Cscape => "cscape",
            Self::Codesys => "codesys",
            Self::Logix => "logix",
        }
    }

    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|it| it.name().eq_ignore_ascii_case(name))
    }

    pub const fn family(self) -> Family {
        match self {
            Self::Iec => Family::Iec,
            Self::Cscape => Family::Cscape,
            Self::Codesys => Family::Codesys,
            Self::Logix => Family::Logix,
        }
    }

    /// Bit strings count as unsigned integers, and same-size sign changes are implicit.
    pub const fn mixes_bits_and_integers(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// Integers and bit strings of fewer than 32 bits are computed at 32, and cut where they are stored.
    pub const fn promotes_integers(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A call of a FUNCTION gives every input that has no default.
    pub const fn wants_all_inputs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// TON, TOF and TP take an LTIME as well, as the standard overloads them.
    pub const fn overloads_timers(self) -> bool {
        matches!(self, Self::Iec)
    }

    /// A call of a block that names no input gives all of them.
    pub const fn wants_all_positions(self) -> bool {
        matches!(self, Self::Iec)
    }

    /// The internal variables of an instance may be read from outside.
    pub const fn shows_inner_variables(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A PROGRAM may be called by its name, and its variables read.
    pub const fn calls_programs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// Nothing is assigned at an address of inputs, `%I`.
    pub const fn protects_inputs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// SHR of a signed integer keeps its sign.
    pub const fn keeps_sign(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A POU's own EN and ENO are inputs and outputs like any other.
    pub const fn declares_plain_enable(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// Assigning an input from inside, or a FOR counter in its loop, is a lint, not an error.
    pub const fn assigns_inputs(self) -> bool {
        matches!(self, Self::Codesys)
    }
}

/// The families by the names that qualify them.
pub(crate) const FAMILIES: [(&str, Family); 4] =
    [("IEC", Family::Iec), ("CSCAPE", Family::Cscape), ("CODESYS", Family::Codesys), ("LOGIX", Family::Logix)];

pub(crate) fn family_named(name: &str) -> Option<Family> {
    FAMILIES.iter().find(|(it, _)| it.eq_ignore_ascii_case(name)).map(|(_, family)| *family)
}

pub(crate) fn family_name(family: Family) -> &'static str {
    FAMILIES.iter().find(|(_, it)| *it == family).map_or("IEC", |(name, _)| name)
}

/// The block called `name` in `family`.
pub(crate) fn block_in(family: Family, name: &str) -> Option<BlockId> {
    let typed = TYPED_TIMERS.iter().find(|(it, _)| family == Family::Iec && it.eq_ignore_ascii_case(name));
    let name = typed.map_or(name, |(_, row)| row);
    let at = BLOCKS.iter().position(|it| it.family == family && it.name.eq_ignore_ascii_case(name))?;
    Some(BlockId::next(at))
}

/// The standard's names of the timers for one type, and ours.
const TYPED_TIMERS: [(&str, &str); 6] = [
    ("TON_TIME", "TON"),
    ("TOF_TIME", "TOF"),
    ("TP_TIME", "TP"),
    ("TON_LTIME", "LTON"),
    ("TOF_LTIME", "LTOF"),
    ("TP_LTIME", "LTP"),
];

/// Whether a block is a timer that the standard overloads: TIME and LTIME count the same nanoseconds.
pub(crate) fn is_overloaded_timer(block: BlockId) -> bool {
    let info = block.info();
    info.family == Family::Iec && matches!(info.name, "TON" | "TOF" | "TP")
}

/// A variant of a block that an option selects.
pub(crate) fn is_option_row(name: &str) -> bool {
    name.to_ascii_uppercase().ends_with("_STOP_AT_PV")
}

/// What the bare `name` means under `dialect`: a counter belongs to the dialect's own family
/// alone; timers, edges and bistables are the standard's unless the family has its own.
pub(crate) fn bare_block(dialect: Dialect, name: &str) -> Option<BlockId> {
    if is_option_row(name) {
        return None;
    }
    block_in(dialect.family(), name).or_else(|| {
        let shared = !is_counter(name);
        shared.then(|| block_in(Family::Iec, name)).flatten()
    })
}

pub(crate) fn is_counter(name: &str) -> bool {
    let name = name.to_ascii_uppercase();
    ["CTU", "CTD", "LCT", "R_CT"].iter().any(|prefix| name.starts_with(prefix))
}
