//! The texts, and the moves that each is for.

use super::form::Advice;
use super::form::Form::{Down, Up, UpDown};
use staunch_frontend::Dialect::{self, Codesys, Cscape, Iec, Logix, Openplc, Openplc4, Siemens};

/// Of the systems whose counters are blocks, those that count CU on its rising edge: all but Cscape.
const NOT_CSCAPE: &[Dialect] = &[Iec, Siemens, Codesys, Openplc, Openplc4];

/// And those that count CD on it.
const RISING: &[Dialect] = &[Iec, Siemens, Codesys, Openplc];

const fn advice(
    name: &'static str,
    pitfalls: &'static [usize],
    from: &'static [Dialect],
    to: &'static [Dialect],
    text: &'static str,
) -> Advice {
    Advice { name, pitfalls, from, to, forms: &[Up], rises: None, text }
}

/// What holds between the systems whose counters are blocks.
pub const BLOCKS: &[Advice] = &[
    advice(
        "edge",
        &[1, 6],
        RISING,
        &[Cscape],
        EDGE,
    ),
    advice("edge", &[1, 6], RISING, &[Cscape], EDGE_DOWN).of(&[Down]),
    advice("edge", &[1, 6], &[Openplc4], &[Cscape], EDGE),
    advice(
        "every call",
        &[1, 6, 12],
        &[Cscape],
        NOT_CSCAPE,
        "Make an edge in each call, and stop at the preset (here 50) as CSCAPE does: \
         `c(CU := FALSE, R := …); c(CU := sensor AND c.CV < 50, R := …)`.",
    ),
    advice("great preset", &[2], &[Iec, Siemens, Codesys], &[Cscape], GREAT_PRESET),
    advice("great preset", &[15], &[Iec, Siemens, Codesys], &[Openplc, Openplc4], GREAT_PRESET),
    advice("great preset", &[10], &[Iec, Siemens, Codesys], &[Cscape], GREAT_PRESET),
    advice(
        "great preset, below",
        &[10],
        &[Openplc, Openplc4],
        &[Cscape],
        "Count only below the preset, let PV be 32767, and compare the count yourself: \
         `e(CLK := sensor); c(CU := e.Q AND c.CV < preset, PV := 32767, …)`, `c.CV >= preset`.",
    ),
    advice(
        "equal to the preset",
        &[10],
        &[Cscape],
        NOT_CSCAPE,
        "Count only below the preset, and ask for `c.CV = preset` instead of Q: \
         `e(CLK := sensor); c(CU := e.Q AND c.CV < preset, …)`.",
    ),
    advice(
        "below the preset",
        &[2],
        &[Cscape],
        &[Iec, Siemens, Codesys],
        "Count only below the preset (here 50): `e(CLK := sensor); c(CU := e.Q AND c.CV < 50, …)`.",
    ),
    advice(
        "between 0 and the preset",
        &[15],
        &[Openplc, Openplc4],
        &[Iec, Siemens, Codesys],
        "Count up only below the preset (here 50): `e(CLK := sensor); c(CU := e.Q AND c.CV < 50, …)`.",
    ),
    advice(
        "between 0 and the preset",
        &[15],
        &[Openplc],
        &[Iec, Siemens],
        "Count down only above 0: `e(CLK := sensor); c(CD := e.Q AND c.CV > 0, …)`.",
    )
    .of(&[Down]),
    advice(
        "every call, down",
        &[1, 6],
        &[Cscape],
        RISING,
        "Make an edge in each call, and stop at 0 as CSCAPE does: \
         `c(CD := FALSE, LD := …); c(CD := sensor AND c.CV > 0, LD := …)`.",
    )
    .of(&[Down]),
    advice("above 0", &[3], &[Codesys, Cscape], &[Iec, Siemens], ABOVE_0).of(&[Down]),
    advice("above 0", &[14], &[Codesys, Openplc], &[Iec, Siemens], ABOVE_0).of(&[Down]),
    advice("above 0", &[14], &[Openplc], &[Codesys], ABOVE_0).of(&[Down]),
    advice("own variable", &[3], &[Iec, Siemens], &[Cscape, Codesys], OWN_VARIABLE).of(&[Down]),
    advice("own variable", &[15], &[Iec, Siemens], &[Openplc, Openplc4], OWN_VARIABLE).of(&[Down]),
    advice(
        "count up to 32767",
        &[8],
        &[Iec, Siemens, Openplc, Openplc4],
        &[Codesys],
        "Keep the count within 0..32767: `e(CLK := pulse); c(CU := e.Q AND c.CV < 32767, …)`.",
    ),
    advice(
        "preset from 0",
        &[8],
        &[Iec, Siemens, Openplc, Openplc4],
        &[Codesys],
        "Give a preset that can be negative as `INT_TO_WORD(MAX(preset, 0))`.",
    ),
    advice(
        "wider",
        &[8],
        &[Codesys],
        &[Iec, Siemens, Openplc, Openplc4],
        "Count in a CTU_DINT, and stop where a WORD does: `e(CLK := pulse); c(CU := e.Q AND c.CV < 65535, …)`.",
    ),
    advice(
        "own variable, wider",
        &[8],
        &[Codesys],
        &[Cscape],
        "Count in a DINT of your own: `e(CLK := pulse); IF e.Q AND n < preset THEN n := n + 1; END_IF`, `n >= preset` in place of Q.",
    ),
    advice(
        "loaded in each call",
        &[20],
        &[Iec],
        &[Siemens],
        "Call it twice, so that LD rises in each scan: `c(CD := pulse, LD := FALSE, …); c(LD := load);`.",
    )
    .of(&[Down]),
    advice(
        "loaded once",
        &[20],
        &[Siemens],
        &[Iec],
        "Find both edges yourself: `l(CLK := load); e(CLK := pulse); c(CD := e.Q AND NOT load, LD := l.Q, …)`.",
    )
    .of(&[Down]),
    advice(
        "positions",
        &[9],
        &[Iec, Siemens, Codesys, Openplc, Openplc4, Cscape],
        &[Iec, Siemens, Codesys, Openplc, Openplc4, Cscape],
        "Give the inputs by position, or rename the pins as the lints say; `--write` does.",
    ).of(&[]),
    advice(
        "fall",
        &[16],
        &[Iec, Siemens, Codesys, Cscape, Openplc4, Logix],
        &[Openplc],
        "Find the edge yourself: `fell := before AND NOT sensor; before := sensor;`.",
    ).of(&[]),
    advice(
        "retain",
        &[11],
        &[Iec, Siemens, Codesys, Openplc, Openplc4, Cscape, Logix],
        &[Iec, Siemens, Codesys, Openplc, Openplc4, Cscape, Logix],
        "Declare RETAIN what both are to keep, also in the program that moves (on CSCAPE R_CTU or R_CTD with a RETAIN RCV); CSCAPE, \
         IEC, OPENPLC and S7 have no variable that only STOP -> RUN keeps. Logix keeps all.",
    ).of(&[]),
];

/// What holds on a move to or from OpenPLC from v4.1, which counts CD as it falls.
pub const FALLING: &[Advice] = &[
    advice("negated", &[17], RISING, &[Openplc4], "Give the input negated: `c(CD := NOT pulse, …)`.").of(&[Down]).where_it(false),
    advice(
        "falling edge in every call",
        &[1, 6, 17],
        &[Cscape],
        &[Openplc4],
        "Make a falling edge in each call: `c(CD := TRUE, LD := …); c(CD := NOT pulse, LD := …)`.",
    )
    .of(&[Down]).where_it(false),
    advice(
        "both edges apart",
        &[17, 18],
        RISING,
        &[Openplc4],
        "Find both edges yourself, count where there is one alone, and give CD negated: `u(CLK := up); d(CLK := down); \
         c(CU := u.Q AND NOT d.Q, CD := NOT (d.Q AND NOT u.Q), …)`.",
    )
    .of(&[UpDown]).where_it(false),
    advice(
        "falling edge",
        &[15, 17],
        &[Openplc4],
        &[Iec, Siemens],
        FELL,
    )
    .of(&[Down]).where_it(false),
    advice(
        "falling edge",
        &[17],
        &[Openplc4],
        &[Codesys, Openplc],
        FELL,
    )
    .of(&[Down]).where_it(false),
    advice(
        "falling edge",
        &[1, 6, 17],
        &[Openplc4],
        &[Cscape],
        FELL,
    )
    .of(&[Down]).where_it(false),
    advice("up, then down", &[15, 17, 18], &[Openplc4], &[Iec, Siemens, Codesys], UP_THEN_DOWN).of(&[UpDown]).where_it(false),
    advice("up, then down", &[17, 18], &[Openplc4], &[Openplc], UP_THEN_DOWN).of(&[UpDown]).where_it(false),
    advice(
        "falling edge on Logix",
        &[5, 6, 17],
        &[Openplc4],
        &[Logix],
        "Count down as the input falls, above 0: `edge := before AND NOT pulse AND c.ACC > 0; before := pulse; c.CD := FALSE; \
         CTD(c, edge);`, load after the CTD: `IF load THEN c.ACC := c.PRE; END_IF`, and ask for `c.ACC <= 0` in place of Q.",
    )
    .of(&[Down]).where_it(false),
    advice("own variable for Logix", &[17], &[Logix], &[Openplc4], LOGIX_VARIABLE_DOWN).of(&[Down]).where_it(false),
];

/// And where it counts CD as it rises, as OpenPLC before v4.1 did.
pub const RISES: &[Advice] = &[
    advice(
        "both edges apart, rising",
        &[18],
        RISING,
        &[Openplc4],
        "Find both edges yourself, and count where there is one alone: `u(CLK := up); d(CLK := down); \
         c(CU := u.Q AND NOT d.Q, CD := d.Q AND NOT u.Q, …)`.",
    )
    .of(&[UpDown])
    .where_it(true),
    advice(
        "up, then down, rising",
        &[18],
        &[Openplc4],
        &[Iec, Siemens, Codesys, Openplc],
        "Find both edges yourself; where both count in one call, down alone at the preset (here 50), and else neither: \
         `u(CLK := up); d(CLK := down); c(CU := u.Q AND NOT d.Q AND c.CV < 50, \
         CD := d.Q AND (NOT u.Q OR c.CV >= 50) AND c.CV > 0, …)`.",
    )
    .of(&[UpDown])
    .where_it(true),
    advice(
        "between 0 and the preset, rising",
        &[15],
        &[Openplc4],
        &[Iec, Siemens],
        "Count down only above 0: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.",
    )
    .of(&[Down])
    .where_it(true),
    advice("edge, rising", &[1, 6], &[Openplc4], &[Cscape], EDGE_DOWN).of(&[Down]).where_it(true),
    advice(
        "every call, down, rising",
        &[1, 6],
        &[Cscape],
        &[Openplc4],
        "Make an edge in each call: `c(CD := FALSE, LD := …); c(CD := pulse, LD := …)`.",
    )
    .of(&[Down])
    .where_it(true),
];

/// What holds on a move to Logix.
pub const TO_LOGIX: &[Advice] = &[
    advice(
        "every scan",
        &[1, 2, 5, 6, 10, 12, 13],
        &[Cscape],
        &[Logix],
        "Count in each scan, below the preset, and compare the count yourself: `c.CU := FALSE; CTU(c, sensor AND c.ACC < c.PRE);`, \
         `c.ACC >= c.PRE` in place of Q, and `c.ACC = c.PRE` where the preset moves.",
    ),
    advice(
        "edge on Logix",
        &[5, 6, 12],
        NOT_CSCAPE,
        &[Logix],
        "Find the edge yourself: `edge := sensor AND NOT before; before := sensor; c.CU := FALSE; CTU(c, edge);`, and ask for \
         `c.ACC >= c.PRE` instead of DN.",
    ),
    advice(
        "edge on Logix, down",
        &[5, 6],
        RISING,
        &[Logix],
        "Find the edge yourself: `edge := pulse AND NOT before; before := pulse; c.CD := FALSE; CTD(c, edge);`, load after the CTD: \
         `IF load THEN c.ACC := c.PRE; END_IF`, and ask for `c.ACC <= 0` in place of Q.",
    )
    .of(&[Down]),
    advice(
        "edges on Logix",
        &[5, 6],
        RISING,
        &[Logix],
        "Find both edges yourself, and call CTUD twice, so that it forgets: `eu := up AND NOT bu; bu := up; \
         ed := down AND NOT bd; bd := down; c.CUEnable := FALSE; c.CDEnable := FALSE; CTUD(c); c.CUEnable := eu; c.CDEnable := ed; CTUD(c);`; \
         ask for `c.ACC >= c.PRE` in place of QU, and for `c.ACC <= 0` in place of QD.",
    )
    .of(&[UpDown]),
    advice("no DN", &[13], NOT_CSCAPE, &[Logix], "Ask for `c.ACC >= c.PRE` instead of DN."),
    advice(
        "count and load",
        &[4],
        &[Iec, Siemens, Codesys, Openplc, Cscape],
        &[Logix],
        "Ask for `c.ACC <= 0` instead of DN, and load after the CTD: `IF load THEN c.ACC := c.PRE; END_IF`.",
    ).of(&[Down]),
    advice("above 0 on Logix", &[3], &[Codesys], &[Logix], ABOVE_0_ON_LOGIX).of(&[Down]),
    advice("above 0 on Logix", &[14], &[Codesys, Openplc], &[Logix], ABOVE_0_ON_LOGIX).of(&[Down]),
    advice(
        "above 0 in every scan",
        &[3],
        &[Cscape],
        &[Logix],
        "Count in each scan, above 0: `c.CD := FALSE; CTD(c, pulse AND c.ACC > 0);`.",
    ).of(&[Down]),
    advice(
        "between 0 and the preset on Logix",
        &[15],
        &[Openplc],
        &[Logix],
        "Count only below the preset, and down only above 0: `edge := sensor AND NOT before AND c.ACC < c.PRE; before := sensor; \
         c.CU := FALSE; CTU(c, edge);`, with CTD `c.ACC > 0` and `c.CD`.",
    )
    .of(&[Up, Down]),
    advice("edge", &[12], NOT_CSCAPE, &[Cscape], EDGE),
    advice(
        "before the limit",
        &[7],
        &[Iec, Siemens, Openplc, Openplc4],
        &[Logix],
        "Stop the count before its limit: `edge := pulse AND NOT before AND c.ACC < 2147483647; before := pulse;`.",
    ),
    advice(
        "limit of the old type",
        &[8],
        NOT_CSCAPE,
        &[Logix],
        "Stop the count where the old type did, at 32767 of an INT or 65535 of a WORD: \
         `edge := pulse AND NOT before AND c.ACC < 32767; before := pulse; c.CU := FALSE; CTU(c, edge);`.",
    ),
];

/// What holds on a move from Logix.
pub const FROM_LOGIX: &[Advice] = &[
    advice(
        "edge of Logix",
        &[5, 6, 12],
        &[Logix],
        NOT_CSCAPE,
        "Find the edge yourself, with `before` initially TRUE and not RETAIN; a reset forgets it: \
         `edge := sensor AND NOT before; before := sensor AND NOT clear; c(CU := FALSE, R := clear, …); c(CU := edge, R := clear, …);`.",
    ),
    advice(
        "edge of Logix in each scan",
        &[1, 5, 6, 12],
        &[Logix],
        &[Cscape],
        "Find the edge yourself, with `before` initially TRUE and not RETAIN; a reset forgets it: \
         `edge := sensor AND NOT before; before := sensor AND NOT clear; c(CU := edge, R := clear, PV := 32767, RCV := kept);`.",
    ),
    advice("great preset for Logix", &[2, 10], &[Logix], &[Cscape], GREAT_PRESET),
    advice("great preset for OPENPLC", &[15], &[Logix], &[Openplc, Openplc4], GREAT_PRESET),
    advice(
        "DN as it was",
        &[13],
        &[Logix],
        &[Iec, Siemens, Codesys, Openplc, Openplc4, Cscape],
        "Ask for it only while the rung is TRUE, in a RETAIN variable: `IF rung THEN full := c.CV >= preset; END_IF`.",
    ),
    advice(
        "DN of a CTD",
        &[4],
        &[Logix],
        &[Iec, Siemens],
        "DN of Logix is `c.CV >= preset`, and not Q: `IF rung THEN done := c.CV >= preset; END_IF`, with `done` RETAIN.",
    ).of(&[Down]),
    advice(
        "DN of a variable",
        &[4],
        &[Logix],
        &[Codesys, Cscape, Openplc, Openplc4],
        "Count in a RETAIN variable of your own: `IF edge THEN n := n - 1; END_IF`; DN of Logix is \
         `IF rung THEN done := n >= preset; END_IF`.",
    ).of(&[Down]),
    advice("own variable for Logix", &[3], &[Logix], &[Codesys, Cscape], LOGIX_VARIABLE_DOWN).of(&[Down]),
    advice("own variable for Logix", &[7], &[Logix], &[Iec, Siemens, Openplc, Openplc4], LOGIX_VARIABLE),
    advice("own variable for Logix", &[8], &[Logix], &[Codesys, Cscape], LOGIX_VARIABLE),
    advice("own variable for Logix", &[15], &[Logix], &[Openplc, Openplc4], LOGIX_VARIABLE_DOWN).of(&[Down]),
    advice(
        "wider",
        &[8],
        &[Logix],
        &[Iec, Siemens, Openplc, Openplc4],
        "Count in a CTU_DINT: it holds what a COUNTER does, and stops at 2147483647, where that wraps (trap 7).",
    ),
];

const EDGE: &str = "Feed the counter from an R_TRIG: `e(CLK := sensor); c(CU := e.Q, …)`.";

const EDGE_DOWN: &str = "Feed the counter from an R_TRIG: `e(CLK := pulse); c(CD := e.Q, …)`.";

const GREAT_PRESET: &str = "Let PV be the greatest value of its type (32767 of an INT), and compare the count yourself: \
     `c.CV >= 50` in place of Q, `c.CV > 60`.";

const ABOVE_0: &str = "Put the edge first: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.";

const ABOVE_0_ON_LOGIX: &str =
    "Put the edge first: `edge := pulse AND NOT before AND c.ACC > 0; before := pulse; c.CD := FALSE; CTD(c, edge);`.";

const FELL: &str = "Count down as the input falls, above 0: `fell := before AND NOT pulse; before := pulse; c(CD := fell AND c.CV > 0, …)`.";

const UP_THEN_DOWN: &str = "Count down as the input falls; where both count in one call, down alone at the preset (here 50), and \
     else neither: `u(CLK := up); fell := before AND NOT down; before := down; c(CU := u.Q AND NOT fell AND c.CV < 50, \
     CD := fell AND (NOT u.Q OR c.CV >= 50) AND c.CV > 0, …)`.";

const OWN_VARIABLE: &str = "Count below 0 in a variable of your own: \
     `e(CLK := pulse); IF load THEN n := 50; ELSIF e.Q THEN n := n - 1; END_IF`.";

const LOGIX_VARIABLE: &str = "Count in a RETAIN DINT of your own, with `before` initially TRUE and not RETAIN: \
     `edge := rung AND NOT before; before := rung; IF edge THEN n := n + 1; END_IF`.";

const LOGIX_VARIABLE_DOWN: &str = "Count in a RETAIN DINT of your own, with `before` initially TRUE and not RETAIN: \
     `edge := rung AND NOT before; before := rung; IF edge THEN n := n - 1; END_IF`.";
