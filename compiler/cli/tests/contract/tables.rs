//! `staunch test` with tables: a CSV file beside a source.

use super::{COUNTER, Folder, has};

const TABLE: &str = "pulse, reset, |, parts.CV, full
 TRUE,      , |,        1, FALSE
FALSE,      , |,         ,
 TRUE,      , |,        2,     1
     ,  TRUE, |,        0, FALSE
";

#[test]
fn a_table_is_a_test() {
    let folder = Folder::with("table", &[("counter.st", COUNTER), ("counter.csv", TABLE)]);
    for backend in ["native", "interpret", "rust"] {
        let out = folder.staunch(&format!("test . --backend {backend}")).out(0);
        assert_eq!(out, "counter.csv\n  ok      counter\n\n1 passed, 0 failed\n");
    }
    let trace = folder.staunch("run counter.st --stimulus counter.csv --trace - --vars parts.CV").out(0);
    assert_eq!(trace, "scan,time_ms,parts.CV\n1,0,1\n2,10,1\n3,20,2\n4,30,0\n");
    folder.staunch("test . --filter other").err(2);
}

#[test]
fn tests_and_tables_of_a_program_with_bound_addresses() {
    let program = "FUNCTION_BLOCK Lamp
VAR_INPUT on : BOOL; END_VAR
VAR out AT %Q* : BOOL; END_VAR
out := on;
END_FUNCTION_BLOCK
PROGRAM Main
VAR lamp : Lamp; button AT %I* : BOOL; END_VAR
lamp(on := NOT button);
END_PROGRAM
CONFIGURATION Plant
PROGRAM run : Main;
VAR_CONFIG run.button AT %IX0.0 : BOOL; run.lamp.out AT %QX0.0 : BOOL; END_VAR
END_CONFIGURATION
TEST 'a lamp by itself'
VAR lamp : Lamp; END_VAR
lamp(on := TRUE);
ASSERT_TRUE(lamp.out);
END_TEST
";
    let table = "%IX0.0,|,%QX0.0\nFALSE,|,TRUE\nTRUE,|,FALSE\n";
    let folder = Folder::with("table_bound", &[("lamp.st", program), ("lamp.csv", table)]);
    folder.staunch("check lamp.st").err(0);
    for backend in ["native", "interpret", "rust"] {
        let out = folder.staunch(&format!("test . --backend {backend}")).out(0);
        has(&out, &["ok      a lamp by itself", "ok      lamp", "2 passed, 0 failed"]);
    }
}

#[test]
fn what_a_var_config_binds_is_set_where_its_input_lies() {
    let program = "TYPE Probe : STRUCT n : INT; a : ARRAY[1..2] OF INT; END_STRUCT; END_TYPE
PROGRAM Main
VAR probe AT %I* : Probe; go AT %I* : BOOL; y : INT; END_VAR
IF go THEN y := y + probe.n * probe.a[2]; END_IF
END_PROGRAM
VAR_CONFIG Main.probe AT %IW10 : Probe; Main.go AT %IX0.0 : BOOL; END_VAR
";
    let table = "probe.n,%IW10.a[2],go,|,y\n4,5,TRUE,|,20\n-1,,,|,15\n,,FALSE,|,15\n";
    let folder = Folder::with("table_bound_names", &[("bound.st", program), ("bound.csv", table)]);
    for backend in ["native", "interpret", "rust"] {
        has(&folder.staunch(&format!("test . --backend {backend}")).out(0), &["ok      bound", "1 passed, 0 failed"]);
    }
    let trace = "run bound.st --stimulus bound.csv --trace - --vars %IW10.n,%IW10.a[2],probe.n";
    has(&folder.staunch(trace).out(0), &["scan,time_ms,%IW10.n,%IW10.a[2],probe.n\n1,0,4,5,4\n2,10,-1,5,-1\n"]);
    folder.write("bound.csv", "probe.n,%IW10.n,|,y\n4,4,|,0\n");
    has(&folder.staunch("test .").out(1), &["bound.csv:1:9: `%IW10.n` already has a column"]);
    folder.write("bound.csv", "%IW10.m,|,y\n4,|,0\n");
    has(&folder.staunch("test .").out(1), &["bound.csv:1:1: Probe has no member `m`"]);
    folder.write("bound.csv", "%IW12.n,|,y\n4,|,0\n");
    has(&folder.staunch("test .").out(1), &["bound.csv:1:1: no variable has the address `%IW12`"]);
}

#[test]
fn the_first_scan_is_at_time_zero() {
    let program = "PROGRAM Main VAR_INPUT up : INT; END_VAR VAR n : INT; END_VAR n := n + up; END_PROGRAM";
    let table = "time,up,|,n\nT#0ms,1,|,1\nT#10ms,2,|,3\n";
    let folder = Folder::with("table_zero", &[("zero.st", program), ("zero.csv", table)]);
    assert_eq!(folder.staunch("test .").out(0), "zero.csv\n  ok      zero\n\n1 passed, 0 failed\n");
}

#[test]
fn the_first_row_that_differs_is_reported() {
    let table = TABLE.replace("2,     1", "3,     0");
    let folder = Folder::with("table_differs", &[("counter.st", COUNTER), ("counter.csv", &table)]);
    let expected = "counter.csv
  FAILED  counter
          counter.csv:4:25: parts.CV after scan 3
          expected to be 3, found 2
          counter.csv:4:32: full after scan 3
          expected to be 0, found TRUE

0 passed, 1 failed
";
    for backend in ["native", "interpret", "rust"] {
        assert_eq!(folder.staunch(&format!("test . --junit out.xml --backend {backend}")).out(1), expected);
    }
    has(
        &folder.read("out.xml"),
        &["<testcase name=\"counter\" classname=\"counter.csv\" file=\"counter.csv\" line=\"1\">"],
    );
}

#[test]
fn rows_by_time_events_and_faults() {
    let program = "PROGRAM Main
VAR_INPUT on : BOOL; share : INT := 1; END_VAR
VAR t : TON; n : INT; END_VAR
VAR RETAIN kept : INT; END_VAR
t(IN := on, PT := T#20ms);
n := n + 10 / share;
kept := kept + 1;
END_PROGRAM
";
    let by_time =
        "time,on,@event,|,t.Q,n,kept\nT#5ms,TRUE,,|,FALSE,20,2\nT#30ms,,,|,TRUE,40,\nT#45ms,,restart,|,FALSE,10,6\n";
    let folder = Folder::with("table_times", &[("timed.st", program), ("timed.csv", by_time)]);
    for backend in ["native", "interpret", "rust"] {
        has(&folder.staunch(&format!("test . --backend {backend}")).out(0), &["1 passed, 0 failed"]);
    }
    folder.write("timed.csv", "share,|,n\n1,|,10\n0,|,\n");
    for backend in ["native", "interpret", "rust"] {
        let out = folder.staunch(&format!("test . --backend {backend}")).out(1);
        has(&out, &["  FAILED  timed\n          timed.st:6:13: ", "division by zero"]);
    }
    folder.write("timed.csv", "share,|,m\n1,|,10\n");
    has(&folder.staunch("test .").out(1), &["timed.csv:1:9: there is no variable `m`"]);
    // Without a bar it is no test.
    folder.write("timed.csv", "scan,share\n1,10\n");
    has(&folder.staunch("test .").err(2), &["the sources hold no TEST, and no table is beside them"]);
}

#[test]
fn a_table_runs_the_program_of_its_source() {
    let program = |name: &str, by: u8| format!("PROGRAM {name}\nVAR n : INT; END_VAR\nn := n + {by};\nEND_PROGRAM\n");
    let tests = "TEST 'beside' VAR a : A; END_VAR a(); ASSERT_EQ(a.n, 1); END_TEST\n";
    let folder = Folder::with(
        "table_programs",
        &[
            ("a.st", &program("A", 1)),
            ("a.csv", "|,n\n|,1\n|,2\n"),
            ("b.st", &program("B", 2)),
            ("b.csv", "scan,|,n\n3,|,6\n"),
            ("c.st", tests),
            ("c.csv", "|,n\n|,1\n"),
        ],
    );
    let out = folder.staunch("test .").out(1);
    has(
        &out,
        &["c.st\n  ok      beside\na.csv\n  ok      a\nb.csv\n  ok      b\nc.csv\n  FAILED  c\n", "several programs"],
    );
    has(&folder.staunch("test a.st").out(0), &["1 passed, 0 failed"]);
    has(&folder.staunch("test . -q").out(1), &["c.csv\n  FAILED  c\n"]);
}
