//! The pitfalls by their numbers, and what each says.

use staunch_frontend::Dialect;

/// One of the pitfalls of `docs/compare.md`, by its number less one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Pitfall(usize);

/// In brackets, what is said where one of the systems before the stroke is compared.
const PITFALLS: [&str; 22] = [
    "CU held TRUE counts once everywhere except CSCAPE, where it counts every call.",
    "Past PV: [cscape|the count of CSCAPE stays at PV; ][codesys|the count of a CTU of CODESYS and TwinCAT stays at PV with `ctu-stop-at-pv = true`; ]others continue to count. Where it stays, `CV > PV` is never TRUE, and `CV = PV` stays TRUE.",
    "CTD at 0: [iec|IEC goes negative; ][siemens|S7 goes negative; ][logix|Logix goes negative; ][cscape|CSCAPE stays at 0; ][codesys|CODESYS stays at 0; ]",
    "Logix CTD: DN is TRUE while ACC >= PRE, so it drops when done; it has no load input.",
    "Input already TRUE at start-up: Logix does not count it, the others do.",
    "Input still TRUE after a reset: [logix|Logix counts one when the reset ends; ][cscape|CSCAPE continues to count; ][iec|IEC does not count; ][siemens|S7 does not count; ][codesys|CODESYS does not count; ][openplc openplc4|OPENPLC does not count; ]",
    "Limits: [iec|IEC saturates; ][siemens|S7 saturates; ][codesys|CODESYS saturates; ][logix|Logix wraps with OV/UN; ]",
    "Widths: an INT, a WORD and a DINT do not hold the same counts. [codesys|`CV < 0` is never TRUE in CODESYS; -1 written to a WORD preset is 65535. ]",
    "Pin names R/LD against RESET/LOAD: positional calls survive a move, named ones do not.",
    "PV lowered under CV: Q drops on CSCAPE, holds elsewhere.",
    "Restart: [logix|Logix keeps all; ][codesys|CODESYS keeps all over STOP -> RUN; ][cscape|CSCAPE needs R_CTU/R_CTD and a RETAIN RCV; ]else what is not RETAIN starts anew.",
    "`c(R := done); done := c.Q;` loses a call on CSCAPE, an edge of a CTUD's other input, and an edge when PV moves.",
    "DN of Logix is evaluated only while the rung is TRUE; Q of the others in every call.",
    "The guard `CD := pulse AND c.CV > 0` makes an edge of its own when CV leaves 0.",
    "OPENPLC, before and from v4.1, stops at PV and at 0: `CV > PV` never holds, and no count goes below 0.",
    "F_TRIG called first with CLK FALSE: OPENPLC before December 2024 sees an edge, the others do not.",
    "CD: OPENPLC4 (OpenPLC from v4.1, Editor 4.2.11 too) counts down when the input falls, the others when it rises.",
    "Both edges of a CTUD in one call: OPENPLC4 counts up, then down, so at PV it counts down; on the others CV stays.",
    "TON, TOF and TP on OPENPLC, before and from v4.1, see in a later call that the time is over: with PT = 0, Q of a TON comes, and of a TOF goes, one call late, and a TP gives a pulse of one call.",
    "LD held TRUE: S7 with `s7-ld = \"edge\"` loads PV in its first call; the others in each, so that CV follows PV and equals PV when R ends.",
    "Q of a CTD whose count is negative, as after a load of a negative PV: CSCAPE compares `CV = 0`, the others `CV <= 0`.",
    "Q of a CTD, and QD, is FALSE before the first call; its equivalent in Logix, `ACC <= 0`, is TRUE at once.",
];

impl Pitfall {
    pub const RESTART: Self = Self::numbered(11);
    /// Of F_TRIG.
    pub const FIRST_FALL: Self = Self::numbered(16);
    /// Of timers.
    pub const LATER_CALL: Self = Self::numbered(19);
    pub const WIDTHS: Self = Self::numbered(8);
    /// CU is a level on CSCAPE.
    pub const LEVEL: Self = Self::numbered(1);
    /// Logix does not count an input that is TRUE at start-up.
    pub const START: Self = Self::numbered(5);
    /// Of a negative count.
    pub const BELOW: Self = Self::numbered(21);
    /// Of Q before the first call.
    pub const BEFORE: Self = Self::numbered(22);
    /// What is not about how a counter counts.
    pub const OF_MORE: [Self; 4] = [Self::numbered(9), Self::RESTART, Self::FIRST_FALL, Self::LATER_CALL];

    /// Its number, from 1.
    pub const fn number(self) -> usize {
        self.0 + 1
    }

    pub const fn numbered(number: usize) -> Self {
        assert!(number >= 1 && number <= PITFALLS.len(), "pitfalls count from 1");
        Self(number - 1)
    }

    #[cfg(test)]
    pub fn all() -> impl Iterator<Item = Self> {
        (0..PITFALLS.len()).map(Self)
    }

    pub fn of_counters() -> impl Iterator<Item = Self> {
        (0..PITFALLS.len()).map(Self).filter(|it| ![Self::FIRST_FALL, Self::LATER_CALL].contains(it))
    }

    /// What it says of two systems.
    pub fn sentence(self, systems: [Dialect; 2]) -> String {
        let text = said_of(systems, PITFALLS[self.0]);
        match text.trim_end().strip_suffix(';') {
            Some(clauses) => format!("{clauses}."),
            None => text.trim_end().to_owned(),
        }
    }
}

/// A text without what is in brackets for systems that are not compared: `[iec siemens|…]`.
pub fn said_of(systems: [Dialect; 2], text: &str) -> String {
    let mut said = String::new();
    for part in text.split_inclusive(['[', ']']) {
        match part.strip_suffix(']') {
            Some(clause) => {
                let (names, clause) = clause.split_once('|').unwrap_or(("", clause));
                let is_of = |it: &str| systems.iter().any(|system| system.name() == it);
                said += if names.split(' ').any(is_of) { clause } else { "" };
            }
            None => said += part.trim_end_matches('['),
        }
    }
    said
}
