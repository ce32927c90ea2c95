//! `staunch test` with tables: a CSV file next to a source.

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
    // Without a bar it is not a test.
    folder.write("timed.csv", "scan,share\n1,10\n");
    has(&folder.staunch("test .").err(2), &["the sources have no TEST, and no table is next to them"]);
}

#[test]
fn a_table_runs_the_program_of_its_source() {
    let program = |name: &str, by: u8| format!("PROGRAM {name}\nVAR n : INT; END_VAR\nn := n + {by};\nEND_PROGRAM\n");
    let tests = "TEST 'next to' VAR a : A; END_VAR a(); ASSERT_EQ(a.n, 1); END_TEST\n";
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
        &[
            "c.st\n  ok      next to\na.csv\n  ok      a\nb.csv\n  ok      b\nc.csv\n  FAILED  c\n",
            "no CONFIGURATION says which PROGRAMs run",
            "there are `A`, `B`\n",
        ],
    );
    has(&folder.staunch("test a.st").out(0), &["1 passed, 0 failed"]);
    has(&folder.staunch("test . -q").out(1), &["c.csv\n  FAILED  c\n"]);
}

/// A reads what B has written in the scan before.
#[test]
fn several_programs_of_one_source_run_in_their_order() {
    let source = "VAR_GLOBAL shared : INT; END_VAR
PROGRAM A
VAR_INPUT i : INT; END_VAR
VAR_OUTPUT o : INT; END_VAR
VAR_EXTERNAL shared : INT; END_VAR
    o := i + shared;
END_PROGRAM
PROGRAM B
VAR_INPUT k : INT; END_VAR
VAR_EXTERNAL shared : INT; END_VAR
    shared := k;
END_PROGRAM
";
    let table = "i,k,|,o,shared\n1,2,|,1,2\n,5,|,3,5\n,,|,6,5\n";
    let other = "PROGRAM Other\nVAR n : INT; END_VAR\n    n := n + 1;\nEND_PROGRAM\n";
    let folder = Folder::with("table_several", &[("x.st", source), ("x.csv", table), ("other.st", other)]);
    for backend in ["native", "interpret", "rust"] {
        has(&folder.staunch(&format!("test . --backend {backend}")).out(0), &["ok      x\n", "1 passed, 0 failed"]);
    }
    folder.write("plant.st", "CONFIGURATION Plant\nPROGRAM run : Other;\nEND_CONFIGURATION\n");
    has(
        &folder.staunch("test . -A warnings").out(1),
        &[
            "x.csv:1:7: there is no variable `o`; did you mean `n`?\n          no CONFIGURATION runs a PROGRAM of x.st: `A`, `B`\n",
        ],
    );
}

/// A table has no mocks: what a library declares without a body fails the row that calls it.
#[test]
fn a_table_beside_calls_without_a_body() {
    let program = "PROGRAM Main
VAR_INPUT go : BOOL; END_VAR
VAR_OUTPUT e : INT; END_VAR
    IF go THEN e := Ext(3); END_IF
END_PROGRAM
";
    let library = "FUNCTION Ext : INT\nVAR_INPUT a : INT; END_VAR\nEND_FUNCTION\n";
    let folder = Folder::new("table_bodies");
    std::fs::create_dir(folder.0.join("lib")).unwrap();
    folder.write("lib/x.st", library);
    folder.write("staunch.toml", "files = [\"main.st\"]\nlibraries = [\"lib\"]\n");
    folder.write("main.st", program);
    for (table, code, said) in [
        ("go,|,e\nFALSE,|,0\n", 0, "ok      main\n"),
        (
            "go,|,e\nFALSE,|,0\nTRUE,|,0\n",
            1,
            "          lib/x.st:1:10: fault: what is called is not implemented here (scan 2, program Main)
          FUNCTION Ext : INT
          the program calls `Ext`, which has no body here: a TEST can replace it, with `MOCK_FUNCTION Ext RETURNS value;`\n",
        ),
    ] {
        folder.write("main.csv", table);
        for backend in ["native", "interpret", "rust"] {
            has(&folder.staunch(&format!("test --backend {backend}")).out(code), &[said]);
        }
    }
}
