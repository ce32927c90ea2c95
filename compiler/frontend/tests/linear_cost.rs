//! What checking a program costs grows as the program does: ten times the program takes at most forty times the
//! time, in each shape that a program can be large in: an IF has at most 1000 branches, an expression as many levels.
//! Anything quadratic would take a hundred times.
#![allow(clippy::unwrap_used)]

use staunch_frontend::{Options, Severity, Source, Sources, check};
use std::fmt::Write;
use std::time::{Duration, Instant};

const SMALL: usize = 1000;
const LARGE: usize = 10 * SMALL;
const MOST: u32 = 40;

/// What a shape's program consists of in addition to its parts.
struct Shape {
    name: &'static str,
    before: &'static str,
    /// Written for each part in turn, with `#` as its number.
    parts: &'static [&'static str],
    after: &'static str,
}

const fn shape(name: &'static str, before: &'static str, parts: &'static [&'static str], after: &'static str) -> Shape {
    Shape { name, before, parts, after }
}

/// Between two lists of parts: what goes there.
const BODY: &str = "|END_VAR\n";

const SHAPES: &[Shape] = &[
    shape(
        "arms of a CASE",
        "PROGRAM Main VAR x, y : DINT; END_VAR CASE x OF\n",
        &["#: y := #;\n"],
        "END_CASE; END_PROGRAM",
    ),
    shape(
        "POUs",
        "PROGRAM Main VAR f : F0; END_VAR f(a := 1); END_PROGRAM\n",
        &["FUNCTION_BLOCK F# VAR_INPUT a : INT; END_VAR VAR_OUTPUT b : INT; END_VAR b := a + 1; END_FUNCTION_BLOCK\n"],
        "",
    ),
    shape("PROGRAMs", "", &["PROGRAM P# VAR x : INT; END_VAR x := x + 1; END_PROGRAM\n"], ""),
    shape(
        "global variables",
        "VAR_GLOBAL\n",
        &["g# : INT := 5;\n", "|END_VAR PROGRAM Main\n", "g# := g# + 1;\n"],
        "END_PROGRAM",
    ),
    shape(
        "statements",
        "PROGRAM Main VAR a, b : INT; END_VAR\n",
        &["a := b + 1; IF a > b THEN b := a * 2; END_IF;\n"],
        "END_PROGRAM",
    ),
    shape(
        "addresses that share bits",
        "PROGRAM Main VAR\n",
        &["w# AT %MW# : INT; b# AT %MB# : BYTE;\n", "|END_VAR\n", "w# := 1;\n"],
        "END_PROGRAM",
    ),
    shape(
        "enumerators",
        "TYPE E : (None",
        &[",\nV#", "|); END_TYPE PROGRAM Main VAR e : E; END_VAR\n", "IF e = V# THEN e := E#V#; END_IF;\n"],
        "END_PROGRAM",
    ),
    shape(
        "elements of an initial value",
        "PROGRAM Main VAR a : ARRAY[0..1000000] OF DINT := [0",
        &[",\n#"],
        "]; END_VAR a[0] := 1; END_PROGRAM",
    ),
    shape(
        "members of a structure",
        "TYPE S : STRUCT\n",
        &["f# : INT;\n", "|END_STRUCT; END_TYPE PROGRAM Main VAR s : S; END_VAR\n", "s.f# := s.f#;\n"],
        "END_PROGRAM",
    ),
    shape(
        "array types",
        "PROGRAM Main VAR\n",
        &["a# : ARRAY[0..#] OF BOOL;\n", BODY, "a#[0] := TRUE;\n"],
        "END_PROGRAM",
    ),
    shape("subranges", "PROGRAM Main VAR\n", &["a# : DINT(-1..#);\n", BODY, "a# := -1;\n"], "END_PROGRAM"),
    shape(
        "structures, and references to them",
        "",
        &[
            "TYPE T# : STRUCT a, b : INT; END_STRUCT; END_TYPE\n",
            "|PROGRAM Main VAR\n",
            "t# : T#; r# : REF_TO T#;\n",
            BODY,
            "r# := REF(t#); r#^.a := 1;\n",
        ],
        "END_PROGRAM",
    ),
    shape(
        "instances",
        "PROGRAM Main VAR\n",
        &["t# : TON; c# : CTU;\n", BODY, "t#(IN := TRUE, PT := T#1s); c#(CU := t#.Q, PV := 3);\n"],
        "END_PROGRAM",
    ),
    shape(
        "METHODs",
        "PROGRAM Main VAR b : Big; x : INT; END_VAR x := b.M0(1); END_PROGRAM FUNCTION_BLOCK Big VAR x : INT; END_VAR\n",
        &["METHOD M# : INT VAR_INPUT a : INT; END_VAR M# := a + x; END_METHOD\n"],
        "END_FUNCTION_BLOCK",
    ),
    shape(
        "calls of one generic FUNCTION",
        "FUNCTION Same : ANY VAR_INPUT x : ANY; END_VAR Same := x; END_FUNCTION PROGRAM Main VAR a : INT; r : REAL; END_VAR\n",
        &["a := Same(a); r := Same(r);\n"],
        "END_PROGRAM",
    ),
    shape(
        "generic FUNCTIONs",
        "",
        &[
            "FUNCTION G# : ANY VAR_INPUT x : ANY; END_VAR G# := x; END_FUNCTION\n",
            "|PROGRAM Main VAR a : INT; END_VAR\n",
            "a := G#(a);\n",
        ],
        "END_PROGRAM",
    ),
];

impl Shape {
    fn program(&self, size: usize) -> Sources {
        let mut text = self.before.to_owned();
        for part in self.parts {
            match part.strip_prefix('|') {
                Some(once) => text.push_str(once),
                None => (0..size).for_each(|at| {
                    // `T#1s` and `E#V` are literals.
                    let numbered = part.replace("T#1s", "T\u{1}1s").replace("E#V", "E\u{1}V");
                    write!(text, "{}", numbered.replace('#', &at.to_string()).replace('\u{1}', "#")).unwrap();
                }),
            }
        }
        text.push_str(self.after);
        let mut sources = Sources::default();
        sources.add(Source::new("large.st", text));
        sources
    }

    /// The shortest of some runs: what else the machine does only adds.
    fn cost(&self, size: usize, runs: usize) -> Duration {
        let sources = self.program(size);
        let cost = || {
            let start = Instant::now();
            let diagnostics = check(&sources, &Options::default());
            let cost = start.elapsed();
            let error = diagnostics.iter().find(|it| it.severity == Severity::Error);
            assert!(error.is_none(), "{}: {}", self.name, error.unwrap().message);
            cost
        };
        (0..runs).map(|_| cost()).min().unwrap()
    }
}

#[test]
fn ten_times_the_program_costs_at_most_forty_times_as_much() {
    let mut wrong = Vec::new();
    for shape in SHAPES {
        let (small, large) = (shape.cost(SMALL, 3), shape.cost(LARGE, 1));
        println!("{}: {small:?}, {large:?}", shape.name);
        if large > small * MOST && shape.cost(LARGE, 2) > shape.cost(SMALL, 5) * MOST {
            wrong.push(shape.name);
        }
    }
    assert!(wrong.is_empty(), "their cost grows faster than they do: {wrong:?}");
}
