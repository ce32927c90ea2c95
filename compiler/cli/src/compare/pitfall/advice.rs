//! What to do about a pitfall, by the direction of the move: what keeps a count on one system loses it on another.
//! Each text is proved by running it, in `tests/compare_advice.rs`.

use super::Pitfall;
use staunch_frontend::Dialect;

/// Where no text is proved.
const OWN: &str =
    "No way of writing it is proved for this direction: write it anew, and compare that with `--against`.";

const GUARD: &str = "Put the edge first: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.";

const EVERY_CALL: &str = "Make an edge in each call, and stop at the preset (here 50) as CSCAPE does: \
     `c(CU := FALSE, R := …); c(CU := sensor AND c.CV < 50, R := …)`.";

impl Pitfall {
    /// What to do on the system that the program moves to.
    pub fn advice(self, from: Dialect, to: Dialect) -> String {
        let text = match self.number() {
            1 | 6 if from == Dialect::Cscape && to != Dialect::Logix => EVERY_CALL,
            1 if to == Dialect::Cscape => "Feed the counter from an R_TRIG: `e(CLK := sensor); c(CU := e.Q, …)`.",
            2 | 15 => beyond_preset(from, to),
            3 => below_zero(to),
            4 | 5 | 7 | 13 if to == Dialect::Logix => of_logix(self.number()),
            6 if matches!(to, Dialect::Cscape | Dialect::Logix) => {
                "Feed the counter from an R_TRIG, on Logix from `edge := sensor AND NOT before; before := sensor;`."
            }
            8 if to == Dialect::Codesys => {
                "Keep the count within 0..32767 by `e(CLK := pulse); c(CU := e.Q AND c.CV < 32767, …)`, and a preset by `MAX(preset, 0)`."
            }
            9 => "Rename the pins as the lints say, or give the inputs by position.",
            10 if to == Dialect::Cscape => {
                "Let PV be the greatest value of its type (32767 of an INT), and compare the count with the preset yourself: `c.CV >= preset`."
            }
            10 if from == Dialect::Cscape => {
                "Count only below the preset, and ask for `c.CV = preset` instead of Q: `e(CLK := sensor); c(CU := e.Q AND c.CV < preset, …)`."
            }
            11 => {
                "Declare RETAIN what Logix keeps, and what CODESYS keeps over STOP -> RUN (IEC, CODESYS), or use R_CTU/R_CTD with a \
                 RETAIN RCV (CSCAPE). IEC and CSCAPE have no variable that only STOP -> RUN keeps."
            }
            12 if from != Dialect::Cscape && to != Dialect::Logix => {
                "Give R := FALSE in the call that counts, and after the statements that read Q reset in a second call with all \
                 inputs: `IF c.Q THEN c(CU := sensor, R := TRUE, PV := n); END_IF`; on CSCAPE feed CU from an R_TRIG."
            }
            14 => GUARD,
            16 if from == Dialect::Openplc => {
                "Find the edge yourself, with `before` initially TRUE: `fell := before AND NOT sensor; before := sensor;`."
            }
            16 => "Find the edge yourself: `fell := before AND NOT sensor; before := sensor;`.",
            _ => OWN,
        };
        match to {
            Dialect::Cscape | Dialect::Codesys => text.replace("R := ", "RESET := "),
            Dialect::Iec | Dialect::Openplc | Dialect::Logix | Dialect::Siemens => text.to_owned(),
        }
    }
}

/// Traps 2 and 15: one system stops at the preset, and OPENPLC also at 0.
fn beyond_preset(from: Dialect, to: Dialect) -> &'static str {
    match (from, to) {
        (_, Dialect::Logix | Dialect::Siemens) | (Dialect::Logix, _) => OWN,
        (_, Dialect::Openplc) => {
            "Let PV be the greatest value of its type (32767 of an INT), and compare the count yourself; count below 0 in a variable of your own."
        }
        (_, Dialect::Cscape) => {
            "Let PV be the greatest value of its type (32767 of an INT), and compare the count yourself: `c.CV >= 50`, `c.CV > 60`."
        }
        (Dialect::Cscape, _) => {
            "Count only below the preset (here 50): `e(CLK := sensor); c(CU := e.Q AND c.CV < 50, …)`; where a held input counts on \
             CSCAPE, `c(CU := FALSE, …); c(CU := sensor AND c.CV < 50, …)`."
        }
        _ => {
            "Count up only below the preset (here 50), and down only above 0: `e(CLK := sensor); c(CU := e.Q AND c.CV < 50, …)`, \
             `c(CD := e.Q AND c.CV > 0, …)`."
        }
    }
}

/// Trap 3: who goes below 0 on the way to one that stays, and the other way round.
fn below_zero(to: Dialect) -> &'static str {
    match to {
        Dialect::Iec => {
            "Where the count has to stay at 0, put the edge first: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`."
        }
        Dialect::Cscape | Dialect::Codesys => {
            "Count below 0 in a variable of your own: `e(CLK := pulse); IF load THEN n := 50; ELSIF e.Q THEN n := n - 1; END_IF`."
        }
        Dialect::Openplc | Dialect::Logix | Dialect::Siemens => OWN,
    }
}

/// On a move to Logix.
fn of_logix(number: usize) -> &'static str {
    match number {
        4 => "Ask for `c.ACC <= 0` instead of DN, and load after the CTD: `IF load THEN c.ACC := c.PRE; END_IF`.",
        5 => {
            "To count it on Logix, find the edge yourself: `edge := sensor AND NOT before; before := sensor; \
             c.CU := FALSE; CTU(c, edge);`."
        }
        7 => {
            "Stop the count before its limit: `edge := pulse AND NOT before AND c.ACC < 2147483647; before := pulse;`."
        }
        _ => "Ask for `c.ACC >= c.PRE` instead of DN.",
    }
}
