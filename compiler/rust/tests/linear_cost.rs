//! What printing a program costs grows as the program does: ten times the program takes at most forty times the time.
//! Anything quadratic would take a hundred times.
#![allow(clippy::unwrap_used)]

use staunch_frontend::{Options, Source, Sources, compile};
use staunch_ir::Program;
use std::time::{Duration, Instant};

const SMALL: usize = 200;
const LARGE: usize = 10 * SMALL;
const MOST: u32 = 40;

/// A program's name, what is before its parts, a part with `#` as its number, and what is after them.
const SHAPES: [(&str, &str, &str, &str); 4] = [
    (
        "statements",
        "PROGRAM Main VAR a, b : INT; END_VAR\n",
        "a := b + 1; IF a > b THEN b := a * #; END_IF;\n",
        "END_PROGRAM",
    ),
    (
        "FUNCTION_BLOCKs",
        "PROGRAM Main VAR f : F0; END_VAR f(a := 1); END_PROGRAM\n",
        "FUNCTION_BLOCK F# VAR_INPUT a : INT; END_VAR VAR_OUTPUT b : INT; END_VAR b := a + 1; END_FUNCTION_BLOCK\n",
        "",
    ),
    // More of them: what was quadratic in them did little each time.
    (
        "calls",
        "FUNCTION G : INT VAR_INPUT a, b : INT; END_VAR G := a + b; END_FUNCTION\n\
         PROGRAM Main VAR a, b : INT; END_VAR\n",
        "a := G(a, #); b := G(b, 1) * 2; a := G(a, 2); b := G(a, 3); a := G(b, 4); b := G(a, 5);\n",
        "END_PROGRAM",
    ),
    (
        "tables",
        "PROGRAM Main VAR i : INT; END_VAR VAR CONSTANT\n",
        "t# : ARRAY[0..9] OF INT := [1, 2, 3, 4, 5, 6, 7, 8, 9, #];\n",
        "END_VAR i := t0[i MOD 10] + t1[i MOD 10]; END_PROGRAM",
    ),
];

fn program((name, before, part, after): (&str, &str, &str, &str), size: usize) -> Program {
    let parts: String = (0..size).map(|at| part.replace('#', &at.to_string())).collect();
    let mut sources = Sources::default();
    sources.add(Source::new("large.st", format!("{before}{parts}{after}")));
    compile(&sources, &Options::default()).program.expect(name)
}

/// The shortest of some runs: what else the machine does only adds.
fn cost(program: &Program, runs: usize) -> Duration {
    let cost = || {
        let start = Instant::now();
        assert!(!staunch_rust::emit(program, &staunch_rust::Options::default()).is_empty());
        start.elapsed()
    };
    (0..runs).map(|_| cost()).min().unwrap()
}

#[test]
fn ten_times_the_program_costs_at_most_forty_times_as_much() {
    for shape in SHAPES {
        let (small, large) = (program(shape, SMALL), program(shape, LARGE));
        let costs = (cost(&small, 3), cost(&large, 1));
        println!("{}: {costs:?}", shape.0);
        let is_linear = costs.1 <= costs.0 * MOST || cost(&large, 2) <= cost(&small, 5) * MOST;
        assert!(is_linear, "the cost of {} grows faster than they do", shape.0);
    }
}
