//! Which copies calls need, and that they mean the same.

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
    copies.filter(|(_, origin)| **origin != Origin::Declared).map(|(routine, _)| routine.name.clone()).collect()
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
    assert_eq!(copies(st), ["scan_apart"]);
}

/// A block that uses globals, itself and through what it calls, and `count` global instances of it.
fn motors(count: usize) -> String {
    let names: Vec<String> = (0..count).map(|at| format!("motor_{at}")).collect();
    let (declared, calls) = (names.join(", "), names.join("(); "));
    format!(
        "
VAR_GLOBAL total, limit : INT := 7; {declared} : Motor; END_VAR
FUNCTION Room : INT VAR_INPUT x : INT; END_VAR VAR_EXTERNAL total, limit : INT; END_VAR
Room := MIN(x, limit - total);
END_FUNCTION
FUNCTION_BLOCK Motor VAR n : INT; END_VAR VAR_EXTERNAL total : INT; END_VAR
n := n + 1; total := total - Room(x := n);
END_FUNCTION_BLOCK
PROGRAM Main VAR_EXTERNAL {declared} : Motor; END_VAR
{calls}();
END_PROGRAM"
    )
}

#[test]
fn all_global_instances_share_one_copy() {
    assert_eq!(copies(&motors(1)), ["Room_apart", "scan_apart"]);
    assert_eq!(copies(&motors(200)), ["Room_apart", "scan_apart"]);
}

/// The text grows by what an instance takes: a field with its offset, its initial value, and its call.
#[test]
fn the_code_of_a_block_is_there_once() {
    let text = |count| crate::emit(&program(&motors(count)), &crate::Options::default());
    let (few, many) = (text(20), text(220));
    assert_eq!(few.matches("fn ").count(), many.matches("fn ").count());
    let each = (many.len() - few.len()) / 200;
    assert!(each < 250, "an instance takes {each} bytes of text");
}

#[test]
fn a_global_that_an_instance_and_its_body_share() {
    let st = "
VAR_GLOBAL total : INT; pump, spare : Motor; END_VAR
FUNCTION Of_pump : INT VAR_EXTERNAL pump : Motor; END_VAR
Of_pump := pump.n;
END_FUNCTION
FUNCTION_BLOCK Motor VAR_OUTPUT n : INT; END_VAR VAR_IN_OUT sum : INT; END_VAR VAR_EXTERNAL total : INT; END_VAR
n := n + 1; sum := sum + Of_pump(); total := total + sum;
END_FUNCTION_BLOCK
PROGRAM Main VAR x : INT; END_VAR VAR_EXTERNAL pump, spare : Motor; total : INT; END_VAR
pump(sum := x); spare(sum := x); pump(sum := total); spare(sum := total);
END_PROGRAM";
    let shared = ["scan_sharing_pump", "scan_sharing_pump_sharing_sum_total", "scan_sharing_sum_total"];
    assert_eq!(copies(st), [["Of_pump_apart", "scan_apart"].as_slice(), &shared].concat());
}
