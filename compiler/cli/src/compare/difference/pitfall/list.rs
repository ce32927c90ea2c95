//! The pitfalls by their numbers, and what each says.

/// One of the pitfalls of `docs/compare.md`, by its number less one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Pitfall(usize);

const PITFALLS: [&str; 16] = [
    "CU held TRUE counts once everywhere except CSCAPE, where it counts every call.",
    "Past PV: CSCAPE holds; `IF c.CV > PV` never fires there, `CV = PV` fires for long.",
    "CTD at 0: IEC and Logix go negative; CSCAPE and CODESYS stay.",
    "Logix CTD: DN is TRUE while ACC >= PRE, so it drops when done; there is no load input.",
    "Input already TRUE at start-up: Logix does not count it, the others do.",
    "Input still TRUE after a reset: Logix counts one when the reset goes, CSCAPE goes on counting, IEC and CODESYS do not count.",
    "Limits: IEC, CODESYS saturate; Logix wraps with OV/UN.",
    "Widths: INT, WORD, DINT. `CV < 0` is never TRUE in CODESYS; -1 written to a WORD preset is 65535.",
    "Pin names R/LD against RESET/LOAD: positional calls survive a move, named ones do not.",
    "PV lowered under CV: Q drops on CSCAPE, holds elsewhere.",
    "Restart: Logix keeps all, and so does CODESYS over STOP -> RUN; else IEC and CODESYS restart at 0 unless the instance is RETAIN; CSCAPE needs R_CTU/R_CTD and a RETAIN RCV.",
    "`c(R := done); done := c.Q;` loses a call on CSCAPE, an edge of a CTUD's other input, and an edge when PV moves.",
    "DN of Logix is evaluated only while the rung is TRUE; Q of the others in every call.",
    "The guard `CD := pulse AND c.CV > 0` makes an edge of its own when CV leaves 0.",
    "OPENPLC stops at PV and at 0: `CV > PV` never holds, as on CSCAPE, and no count goes below 0.",
    "F_TRIG called first with CLK FALSE: OPENPLC sees an edge, the others do not.",
];

impl Pitfall {
    pub const RESTART: Self = Self::numbered(11);
    /// Of F_TRIG; all others are of counters.
    pub const FIRST_FALL: Self = Self::numbered(16);
    pub const WIDTHS: Self = Self::numbered(8);

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
        (0..Self::FIRST_FALL.0).map(Self)
    }

    pub fn sentence(self) -> &'static str {
        PITFALLS[self.0]
    }
}
