#![allow(clippy::unwrap_used)]

use super::*;
use staunch_frontend::{Source, Sources};
use staunch_ir::interpret::Interpreter;
use staunch_runtime::Context;

fn program(st: &str) -> Program {
    let mut sources = Sources::default();
    sources.add(Source::new("case.st", st.to_owned()));
    staunch_frontend::compile(&sources, &staunch_frontend::Options::default()).program.unwrap()
}

/// The result verifies, and does the same; returns the names of its copies.
fn copies(st: &str) -> Vec<String> {
    let source = program(st);
    let separated = separate(&source);
    staunch_ir::verify::verify(&separated.program).unwrap();
    let (mut a, mut b) = (Interpreter::new(&source), Interpreter::new(&separated.program));
    for scan in 0..3 {
        assert_eq!(a.scan(0, &Context::at(scan)), b.scan(0, &Context::at(scan)));
        assert_eq!(a.state(), b.state());
    }
    let copies = separated.program.routines.iter().zip(&separated.origins);
    copies.filter(|(_, origin)| **origin == Origin::Copy).map(|(routine, _)| routine.name.clone()).collect()
}

const SWAP: &str = "
FUNCTION Swap : INT VAR_IN_OUT a, b : INT; END_VAR VAR t : INT; END_VAR
t := a; a := b; b := t + 1; Swap := a;
END_FUNCTION
PROGRAM Main VAR x, y, r, i : INT; v : ARRAY[0..3] OF INT := [1, 2, 3, 4]; END_VAR
";

#[test]
fn disjoint_variables_need_no_copy() {
    assert_eq!(copies(&format!("{SWAP} r := Swap(x, y); r := Swap(v[i], y); END_PROGRAM")), [""; 0]);
}

#[test]
fn one_variable_twice() {
    assert_eq!(copies(&format!("{SWAP} r := Swap(x, x); r := Swap(y, y); END_PROGRAM")), ["Swap_sharing_a_b"]);
}

#[test]
fn two_elements() {
    assert_eq!(copies(&format!("{SWAP} r := Swap(v[i], v[i + 1]); i := i + 1; END_PROGRAM")), ["Swap_sharing_a_b"]);
}

#[test]
fn a_global_instance_that_uses_globals() {
    let st = "
VAR_GLOBAL total : INT; pump : Motor; END_VAR
FUNCTION_BLOCK Motor VAR n : INT; END_VAR VAR_EXTERNAL total : INT; END_VAR
n := n + 1; total := total + n;
END_FUNCTION_BLOCK
PROGRAM Main VAR own : Motor; END_VAR VAR_EXTERNAL pump : Motor; END_VAR
pump(); own();
END_PROGRAM";
    assert_eq!(copies(st), ["Motor_scan_on_pump"]);
}
