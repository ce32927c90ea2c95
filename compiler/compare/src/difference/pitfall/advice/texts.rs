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
    Advice { name, pitfalls, from, to, forms: &[Up], rises: None, stops: None, text }
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
        &[1, 2, 6, 10, 12],
        &[Cscape],
        NOT_CSCAPE,
        "Make an edge in each call, stop at the preset as CSCAPE does, and compare the count yourself: \
         `c(CU := FALSE, R := clear, PV := preset); c(CU := sensor AND c.CV < preset, R := clear, PV := preset); \
         full := c.CV = preset;`, with `full` in place of Q.",
    ),
    advice("great preset", &[2], &[Iec, Siemens, Codesys], &[Cscape], GREAT_PRESET).where_it_stops(false),
    advice("great preset", &[15], &[Iec, Siemens, Codesys], &[Openplc, Openplc4], GREAT_PRESET).where_it_stops(false),
    advice("great preset", &[10], &[Iec, Siemens, Codesys], &[Cscape], GREAT_PRESET).where_it_stops(false),
    advice(
        "great preset, below",
        &[10],
        &[Openplc, Openplc4],
        &[Cscape],
        "Count only below the preset, let PV be 32767, and compare the count yourself: \
         `e(CLK := sensor); c(CU := e.Q AND c.CV < preset, R := clear, PV := 32767); full := c.CV >= preset;`, \
         with `full` in place of Q.",
    ),
    advice(
        "between 0 and the preset",
        &[15],
        &[Openplc, Openplc4],
        &[Iec, Siemens, Codesys],
        "Count up only below the preset: `e(CLK := sensor); c(CU := e.Q AND c.CV < preset, …)`.",
    ),
    advice(
        "between 0 and the preset",
        &[15],
        &[Openplc],
        &[Iec, Siemens],
        "Count down only above 0: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.",
    )
    .of(&[Down]),
    advice(
        "every call, down",
        &[1, 3, 6],
        &[Cscape],
        RISING,
        "Make an edge in each call, stop at 0 as CSCAPE does, and compare the count yourself: \
         `c(CD := FALSE, LD := load, PV := preset); c(CD := pulse AND c.CV > 0, LD := load, PV := preset); \
         empty := c.CV = 0;`, with `empty` in place of Q.",
    )
    .of(&[Down]),
    advice("above 0", &[3], &[Codesys], &[Iec, Siemens], ABOVE_0).of(&[Down]),
    advice("above 0", &[14], &[Codesys, Openplc], &[Iec, Siemens], ABOVE_0).of(&[Down]),
    advice("above 0", &[14], &[Openplc], &[Codesys], ABOVE_0).of(&[Down]),
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
        "loaded in each call, up and down",
        &[20],
        &[Iec],
        &[Siemens],
        "Call it twice, so that LD rises in each scan: `c(CU := up, CD := pulse, R := clear, LD := FALSE, …); c(LD := load);`.",
    )
    .of(&[UpDown]),
    advice(
        "loaded once, up and down",
        &[20],
        &[Siemens],
        &[Iec],
        "Find the edges yourself: `l(CLK := load); u(CLK := up); d(CLK := pulse); \
         c(CU := u.Q AND NOT load, CD := d.Q AND NOT load, R := clear, LD := l.Q, …)`.",
    )
    .of(&[UpDown]),
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
        "Declare RETAIN what both are to keep, also in the program that moves[cscape| (on CSCAPE R_CTU or R_CTD with a RETAIN RCV)].\
         [cscape| CSCAPE has no variable that only STOP -> RUN keeps.][iec| IEC has no variable that only STOP -> RUN keeps.]\
         [openplc openplc4| OPENPLC has no variable that only STOP -> RUN keeps.]\
         [siemens| S7 has no variable that only STOP -> RUN keeps.][logix| Logix keeps all.]",
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
        "Make a falling edge in each call, and compare the count yourself: `c(CD := TRUE, LD := load, PV := preset); \
         c(CD := NOT pulse, LD := load, PV := preset); empty := c.CV = 0;`, with `empty` in place of Q.",
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
        "Count down as the input falls, above 0: `edge := before AND NOT pulse AND c.ACC > 0; before := pulse; c.PRE := preset; \
         c.CD := FALSE; CTD(c, edge); IF load THEN c.ACC := c.PRE; END_IF; empty := c.ACC <= 0;`, with `empty` in place of Q.",
    )
    .of(&[Down]).where_it(false),
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
        "Find both edges yourself; where both count in one call, down alone at the preset, up alone below 0, and else \
         neither: `u(CLK := up); d(CLK := down); c(CU := u.Q AND (NOT d.Q OR c.CV < 0) AND c.CV < preset, \
         CD := d.Q AND (NOT u.Q OR c.CV >= preset) AND c.CV > 0, …)`.",
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
        "Make an edge in each call, and compare the count yourself: `c(CD := FALSE, LD := load, PV := preset); \
         c(CD := pulse, LD := load, PV := preset); empty := c.CV = 0;`, with `empty` in place of Q.",
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
        "Count in each scan, below the preset, and compare the count yourself: `c.PRE := preset; c.CU := FALSE; \
         CTU(c, sensor AND c.ACC < c.PRE); RES(c, clear); full := c.ACC = c.PRE;`, with `full` in place of Q.",
    ),
    advice(
        "edge on Logix",
        &[5, 6],
        NOT_CSCAPE,
        &[Logix],
        "Find the edge yourself: `edge := sensor AND NOT before; before := sensor; c.PRE := preset; c.CU := FALSE; CTU(c, edge); \
         RES(c, clear); full := c.ACC >= c.PRE;`, with `full` in place of Q.",
    ),
    advice(
        "edge on Logix, down",
        &[5, 6],
        RISING,
        &[Logix],
        "Find the edge yourself: `edge := pulse AND NOT before; before := pulse; c.PRE := preset; c.CD := FALSE; CTD(c, edge); \
         IF load THEN c.ACC := c.PRE; END_IF; empty := c.ACC <= 0;`, with `empty` in place of Q.",
    )
    .of(&[Down]),
    advice("no DN", &[13], NOT_CSCAPE, &[Logix], "Compare the count yourself, after CTU and RES: `full := c.ACC >= c.PRE;`, with `full` in place of Q."),
    advice(
        "count and load",
        &[4],
        &[Iec, Siemens, Codesys, Openplc, Cscape],
        &[Logix],
        "Load after the CTD, and compare the count yourself: `IF load THEN c.ACC := c.PRE; END_IF; empty := c.ACC <= 0;`, with \
         `empty` in place of Q.",
    ).of(&[Down]),
    advice("above 0 on Logix", &[3], &[Codesys], &[Logix], ABOVE_0_ON_LOGIX).of(&[Down]),
    advice("above 0 on Logix", &[14], &[Codesys, Openplc], &[Logix], ABOVE_0_ON_LOGIX).of(&[Down]),
    advice(
        "above 0 in every scan",
        &[3],
        &[Cscape],
        &[Logix],
        "Count in each scan, above 0, and compare the count yourself: `c.PRE := preset; c.CD := FALSE; \
         CTD(c, pulse AND c.ACC > 0); IF load THEN c.ACC := c.PRE; END_IF; empty := c.ACC = 0;`, with `empty` in place of Q.",
    ).of(&[Down]),
    advice(
        "between 0 and the preset on Logix",
        &[15],
        &[Openplc],
        &[Logix],
        "Count only below the preset: `edge := sensor AND NOT before AND c.ACC < preset; before := sensor; c.PRE := preset; \
         c.CU := FALSE; CTU(c, edge); RES(c, clear); full := c.ACC >= c.PRE;`, with `full` in place of Q.",
    ),
    advice("between 0 and the preset on Logix", &[15], &[Openplc], &[Logix], ABOVE_0_ON_LOGIX).of(&[Down]),
    advice("edge", &[12], NOT_CSCAPE, &[Cscape], EDGE),
    advice(
        "before the limit",
        &[7],
        &[Iec, Siemens, Openplc, Openplc4],
        &[Logix],
        "Stop the count before its limit: `edge := sensor AND NOT before AND c.ACC < 2147483647; before := sensor; \
         c.PRE := preset; c.CU := FALSE; CTU(c, edge); RES(c, clear); full := c.ACC >= c.PRE;`, with `full` in place of Q.",
    ),
    advice(
        "preset of a WORD",
        &[8],
        &[Codesys],
        &[Logix],
        "Give a preset that can be negative as the WORD that it is to CODESYS: `c.PRE := WORD_TO_DINT(INT_TO_WORD(preset));`.",
    ),
    advice(
        "limit of the old type",
        &[8],
        NOT_CSCAPE,
        &[Logix],
        "Stop the count where the old type did, at 32767 of an INT or 65535 of a WORD: \
         `edge := sensor AND NOT before AND c.ACC < 32767; before := sensor; c.PRE := preset; c.CU := FALSE; CTU(c, edge); \
         RES(c, clear); full := c.ACC >= c.PRE;`, with `full` in place of Q.",
    ),
];

const EDGE: &str = "Feed the counter from an R_TRIG: `e(CLK := sensor); c(CU := e.Q, …)`.";

const EDGE_DOWN: &str = "Feed the counter from an R_TRIG: `e(CLK := pulse); c(CD := e.Q, …)`.";

const GREAT_PRESET: &str = "Let PV be the greatest value of its type (32767 of an INT), and compare the count yourself: \
     `c(CU := sensor, R := clear, PV := 32767); full := c.CV >= preset;`, with `full` in place of Q.";

const ABOVE_0: &str = "Put the edge first: `e(CLK := pulse); c(CD := e.Q AND c.CV > 0, …)`.";

const ABOVE_0_ON_LOGIX: &str = "Put the edge first, and count above 0: `edge := pulse AND NOT before AND c.ACC > 0; before := pulse; c.PRE := preset; \
     c.CD := FALSE; CTD(c, edge); IF load THEN c.ACC := c.PRE; END_IF; empty := c.ACC <= 0;`, with `empty` in place of Q.";

const FELL: &str = "Count down as the input falls, above 0: `fell := before AND NOT pulse; before := pulse; c(CD := fell AND c.CV > 0, …)`.";

const UP_THEN_DOWN: &str = "Count down as the input falls; where both count in one call, down alone at the preset, up alone below 0, and \
     else neither: `u(CLK := up); fell := before AND NOT down; before := down; \
     c(CU := u.Q AND (NOT fell OR c.CV < 0) AND c.CV < preset, CD := fell AND (NOT u.Q OR c.CV >= preset) AND c.CV > 0, …)`.";
