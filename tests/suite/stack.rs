//! The stack that `staunch_ir::stack` says a call takes is never less than what native code takes, for any
//! target; and not so much more that programs are refused for nothing.

use staunch_frontend::{Options, Source, Sources};
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use staunch_ir::stack;
use staunch_native::{Aim, Target, frames};
use staunch_tests::case::{self, Pin};
use staunch_tests::cases;
use staunch_witness::generate;

const TARGETS: [&str; 3] = ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu", "riscv64gc-unknown-linux-gnu"];
const RANDOM_PROGRAMS: u64 = 12;

#[test]
fn frames_are_no_larger_than_is_said() {
    let (cases, _) = case::discover(&cases());
    let mut compared = 0;
    for case in cases.iter().filter(|it| it.pins.contains(&Pin::Scan)) {
        if let Some(program) = case.compile().1.program {
            compared += compare(&program, &case.name);
        }
    }
    assert!(compared > 800, "only {compared} frames were compared");
}

#[test]
fn frames_of_random_programs_are_no_larger_than_is_said() {
    for seed in 0..RANDOM_PROGRAMS {
        if let Some(program) = compile(generate::program(seed)) {
            compare(&program, &format!("seed {seed}"));
        }
    }
}

/// Strings that statements make use the bytes of those before them again.
#[test]
fn strings_are_counted_and_used_again() {
    let program = |statements: usize| {
        let declared = "VAR s : STRING[1000]; t : STRING[999]; n : INT; END_VAR\n";
        let statements = "s := REPLACE(CONCAT(s, t), CONCAT(t, s), 1, 1);\n".repeat(statements);
        compile(format!("PROGRAM Main\n{declared}{statements}END_PROGRAM\n")).unwrap()
    };
    let target = Target::parse(TARGETS[0]).unwrap();
    let found = |statements| frames(&program(statements), &target).unwrap()[0];
    let [one, many] = [1, 9].map(|it| said(&program(it))[0]);
    assert!(found(1) > 5000 && one > 5000 && many < one + 1000, "{one}, {many}");
    assert!(found(9) < found(1) + 200, "{}, {}", found(1), found(9));
    compare(&program(9), "concatenations");
}

/// Their variables are in locals of the routine while they run.
#[test]
fn many_loops_take_no_more_than_is_said() {
    let line =
        |at: usize| format!("FOR i{at} := 1 TO 9 DO v[i{at}] := s{at}; s{at} := s{at} + v[i{at}] * 2; END_FOR\n");
    let text = |loops: usize| {
        let declared: String = (0..loops).map(|at| format!("i{at}, s{at} : INT;\n")).collect();
        let statements: String = (0..loops).map(line).collect();
        format!("PROGRAM Main\nVAR v : ARRAY[1..9] OF INT;\n{declared}END_VAR\n{statements}END_PROGRAM\n")
    };
    for loops in [1, 600] {
        compare(&compile(text(loops)).unwrap(), &format!("{loops} loops"));
    }
}

fn compile(text: String) -> Option<Program> {
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", text));
    staunch_frontend::compile(&sources, &Options::default()).program
}

fn said(program: &Program) -> Vec<u64> {
    let layout = Layout::new(program);
    program.routines.iter().map(|it| stack::of_routine(program, it, &|ty| layout.size(ty))).collect()
}

fn compare(program: &Program, name: &str) -> usize {
    let said = said(program);
    let targets = TARGETS.iter().flat_map(|it| [Aim::Speed, Aim::Debugging].map(|aim| (it, aim)));
    for (target, aim) in targets {
        let found = frames(program, &Target::parse(target).unwrap().aiming_at(aim)).unwrap();
        for ((said, found), routine) in said.iter().zip(&found).zip(&program.routines) {
            assert!(said >= found, "{name}, {}: {found} bytes on {target} for {aim:?}, {said} are said", routine.name);
        }
    }
    said.len() * TARGETS.len()
}
