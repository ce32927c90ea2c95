//! The pitfalls of a move between systems, which of them a difference shows, and which cannot happen.

mod cause;
mod classify;
mod impossible;

pub use cause::{Cause, cause, seen};
pub use classify::Habits;
pub use impossible::{Use, impossible};

/// One of the pitfalls of `docs/compare.md`, by its number less one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Pitfall(usize);

struct Text {
    sentence: &'static str,
    advice: &'static str,
}

const PITFALLS: [Text; 16] = [
    Text {
        sentence: "CU held TRUE counts once everywhere except CSCAPE, where it counts every call.",
        advice: "Feed the counter from an R_TRIG: `e(CLK := sensor); c(CU := e.Q, …)`.",
    },
    Text {
        sentence: "Past PV: CSCAPE holds; `IF c.CV > PV` never fires there, `CV = PV` fires for long.",
        advice: "Let PV be 32767, which no INT passes, and compare the count yourself: `c.CV >= 50`, `c.CV > 60`.",
    },
    Text {
        sentence: "CTD at 0: IEC and Logix go negative; CSCAPE and CODESYS stay.",
        advice: "Where the count has to stay at 0, put the edge first: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.",
    },
    Text {
        sentence: "Logix CTD: DN is TRUE while ACC >= PRE, so it drops when done; there is no load input.",
        advice: "Ask for `c.ACC <= 0` instead of DN, and load after the CTD: `IF load THEN c.ACC := c.PRE; END_IF`.",
    },
    Text {
        sentence: "Input already TRUE at start-up: Logix does not count it, the others do.",
        advice: "To count it on Logix, find the edge yourself: `edge := sensor AND NOT before; before := sensor; \
                 c.CU := FALSE; CTU(c, edge);`.",
    },
    Text {
        sentence: "Input still TRUE after a reset: Logix counts one when the reset goes, CSCAPE goes on counting, IEC and CODESYS do not count.",
        advice: "Feed the counter from an R_TRIG, on Logix from `edge := sensor AND NOT before; before := sensor;`.",
    },
    Text {
        sentence: "Limits: IEC, CODESYS saturate; Logix wraps with OV/UN.",
        advice: "Stop the count before its limit: `e(CLK := pulse); c(CU := e.Q AND c.CV < 32767, …)`.",
    },
    Text {
        sentence: "Widths: INT, WORD, DINT. `CV < 0` is never TRUE in CODESYS; -1 written to a WORD preset is 65535.",
        advice: "Keep the count within 0..32767 by `e(CLK := pulse); c(CU := e.Q AND c.CV < 32767, …)`, and a preset by `MAX(preset, 0)`.",
    },
    Text {
        sentence: "Pin names R/LD against RESET/LOAD: positional calls survive a move, named ones do not.",
        advice: "Rename the pins as the lints say, or give the inputs by position.",
    },
    Text {
        sentence: "PV lowered under CV: Q drops on CSCAPE, holds elsewhere.",
        advice: "Let PV be 32767, which no INT passes, and compare the count with the preset yourself: `c.CV >= preset`.",
    },
    Text {
        sentence: "Restart: Logix keeps all, and so does CODESYS over STOP -> RUN; else IEC and CODESYS restart at 0 unless the instance is RETAIN; CSCAPE needs R_CTU/R_CTD and a RETAIN RCV.",
        advice: "Declare RETAIN what Logix keeps, and what CODESYS keeps over STOP -> RUN (IEC, CODESYS), or use R_CTU/R_CTD with a \
                 RETAIN RCV (CSCAPE). IEC and CSCAPE have no variable that only STOP -> RUN keeps.",
    },
    Text {
        sentence: "`c(R := done); done := c.Q;` loses a call on CSCAPE, an edge of a CTUD's other input, and an edge when PV moves.",
        advice: "Give R := FALSE in the call that counts, and after the statements that read Q reset in a second call with all \
                 inputs: `IF c.Q THEN c(CU := sensor, R := TRUE, PV := n); END_IF`; on CSCAPE feed CU from an R_TRIG.",
    },
    Text {
        sentence: "DN of Logix is evaluated only while the rung is TRUE; Q of the others in every call.",
        advice: "Ask for `c.ACC >= c.PRE` instead of DN.",
    },
    Text {
        sentence: "The guard `CD := pulse AND c.CV > 0` makes an edge of its own when CV leaves 0.",
        advice: "Put the edge first: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.",
    },
    Text {
        sentence: "OPENPLC stops at PV and at 0: `CV > PV` never holds, as on CSCAPE, and no count goes below 0.",
        advice: "Let PV be 32767, which no INT passes, and compare the count yourself; count below 0 in a variable of your own.",
    },
    Text {
        sentence: "F_TRIG called first with CLK FALSE: OPENPLC sees an edge, the others do not.",
        advice: "Find the edge yourself: `fell := before AND NOT sensor; before := sensor;`.",
    },
];

impl Pitfall {
    pub const RESTART: Self = Self::numbered(11);
    /// Of F_TRIG; all others are of counters.
    pub const FIRST_FALL: Self = Self::numbered(16);
    const WIDTHS: Self = Self::numbered(8);

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
        PITFALLS[self.0].sentence
    }

    pub fn advice(self) -> &'static str {
        PITFALLS[self.0].advice
    }
}
