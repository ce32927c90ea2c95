//! `staunch test --mutants`: which changes the tests notice is worked out by hand.

use super::{Folder, has};

const SOURCE: &str = "FUNCTION_BLOCK Gate
VAR_INPUT pulse, open : BOOL; END_VAR
VAR_OUTPUT full : BOOL; spare : INT; END_VAR
VAR c : CTU; END_VAR
c(CU := pulse, R := FALSE, PV := 2);
full := c.CV >= 2 AND open;
spare := 7;
END_FUNCTION_BLOCK
";

/// One pulse, and then a second; the gate is open all the time.
const TESTS: &str = "TEST 'two pulses'
VAR g : Gate; END_VAR
g(pulse := TRUE, open := TRUE);
ASSERT_FALSE(g.full);
g(pulse := FALSE);
g(pulse := TRUE);
ASSERT_TRUE(g.full);
END_TEST
";

/// Nothing reads the block's preset, nor `spare`. Of line 6, a count of 2 where 2 is enough and one of 1 where it is not
/// are tested: `>=` is held on both sides, `2` too.
const SURVIVORS: &str = "gate.st:5:34: no test detects
  - c(CU := pulse, R := FALSE, PV := 2);
  + c(CU := pulse, R := FALSE, PV := 3);
gate.st:5:34: no test detects
  - c(CU := pulse, R := FALSE, PV := 2);
  + c(CU := pulse, R := FALSE, PV := 1);
gate.st:7:1: no test detects
  - spare := 7;
  + ;
gate.st:7:10: no test detects
  - spare := 7;
  + spare := 8;
gate.st:7:10: no test detects
  - spare := 7;
  + spare := 6;
";

#[test]
fn survivors_are_listed() {
    let folder = Folder::with("mutants", &[("gate.st", SOURCE), ("gate_test.st", TESTS)]);
    for jobs in [1, 3] {
        let out = folder.staunch(&format!("test . -q -A warnings --mutants --jobs {jobs}")).out(1);
        assert_eq!(out, format!("\n1 passed, 0 failed\n{SURVIVORS}\n10 mutants killed, 5 survived\n"));
    }
    let few = folder.staunch("test . -q -A warnings --mutants=5").out(1);
    has(&few, &["(5 of 15 changes were tried)\n"]);
    let json = folder.staunch("test . -A warnings --mutants --message-format json").out(1);
    has(
        &json,
        &[
            "{\"reason\":\"mutant\",\"file\":\"gate.st\",\"line\":7,\"column\":1,\"before\":\"spare := 7;\",\"after\":\";\"}",
        ],
    );
    has(&json, &["{\"reason\":\"mutants\",\"killed\":10,\"survived\":5,\"of\":15}\n"]);
}

/// A table notices what the unit test does not; all are killed then.
#[test]
fn tables_kill_mutants_too() {
    let source = "PROGRAM Main
VAR_INPUT on : BOOL; END_VAR
VAR_OUTPUT n : INT; END_VAR
IF on THEN n := n + 1; END_IF
END_PROGRAM
";
    let folder = Folder::with("mutants_table", &[("main.st", source), ("main.csv", "on,|,n\n0,|,0\n1,|,1\n")]);
    has(&folder.staunch("test . --mutants").out(0), &["5 mutants killed, 0 survived"]);
    folder.write("main.csv", "on,|,n\n0,|,0\n1,|,2\n");
    let out = folder.staunch("test . --mutants").out(1);
    assert!(out.ends_with("0 passed, 1 failed\n"), "{out}");
}

/// A change that makes a loop endless is noticed, soon.
#[test]
fn endless_loops_are_noticed() {
    let source = "FUNCTION Sum : INT
VAR_INPUT n : INT; END_VAR
VAR i : INT; END_VAR
WHILE i < n DO i := i + 1; Sum := Sum + i; END_WHILE
END_FUNCTION
TEST 'sum' ASSERT_EQ(Sum(4), 10); END_TEST
";
    let folder = Folder::with("mutants_loops", &[("sum.st", source)]);
    has(&folder.staunch("test . --mutants --loop-budget 1000").out(0), &[" 0 survived\n"]);
    has(&folder.staunch("test . --mutants --loop-budget 4").out(0), &[" 0 survived\n"]);
}
