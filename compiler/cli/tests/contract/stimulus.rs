//! The stimulus: how rows reach the program, and what is wrong with some.

use super::{Folder, has};

const PROGRAM: &str = "VAR_GLOBAL total : DINT; END_VAR
PROGRAM Main
VAR_INPUT a : INT; on : BOOL; span : TIME; END_VAR
VAR input AT %IW1 : INT; bit AT %IX0.3 : BOOL; list : ARRAY[1..2] OF INT; n : INT;
    levels : ARRAY[0..1, 0..1] OF INT(0..9);
END_VAR
n := n + 1;
END_PROGRAM
";

fn trace(name: &str, stimulus: &str, rest: &str) -> String {
    let folder = Folder::with(name, &[("main.st", PROGRAM), ("in.csv", stimulus)]);
    folder.staunch(&format!("run main.st --stimulus in.csv --trace - -q -A warnings {rest}")).out(0)
}

#[test]
fn rows_are_written_before_their_scan_and_hold() {
    assert_eq!(
        trace(
            "holds",
            "scan,a,Main.on,%IW1,%IX0.3,list[2],total\n2,-5,TRUE,7,TRUE,9,\n4,,FALSE,,,,12\n",
            "--scans 5 --vars a,on,input,bit,list[2],total"
        ),
        "scan,time_ms,a,on,input,bit,list[2],total\n\
         1,0,0,FALSE,0,FALSE,0,0\n\
         2,10,-5,TRUE,7,TRUE,9,0\n\
         3,20,-5,TRUE,7,TRUE,9,0\n\
         4,30,-5,FALSE,7,TRUE,9,12\n\
         5,40,-5,FALSE,7,TRUE,9,12\n"
    );
}

/// W0522: only what is certain is reported.
#[test]
fn a_column_that_the_program_overwrites_is_reported() {
    const TEXT: &str = "VAR_GLOBAL lamp : BOOL; speed : INT; END_VAR
PROGRAM Main
VAR_INPUT start : BOOL; END_VAR
VAR full, before, late, maybe : BOOL; c : CTU; list : ARRAY[1..2] OF INT; END_VAR
c(CU := start, PV := 3);
full := c.Q;
before := late;
late := full;
IF start THEN maybe := TRUE; END_IF
lamp := speed > 3;
list[1] := 4;
IF full THEN RETURN; END_IF
speed := 0;
END_PROGRAM
";
    let table = "scan,start,full,late,maybe,lamp,speed,list[1],|,before\n1,TRUE,FALSE,TRUE,TRUE,TRUE,5,1,|,TRUE\n";
    let folder = Folder::with("overwritten", &[("main.st", TEXT), ("in.csv", table)]);
    let run = "run main.st --stimulus in.csv --scans 1 --message-format short";
    let err = folder.staunch(run).err(0);
    assert_eq!(
        err.lines().filter(|it| it.contains("W0522")).collect::<Vec<_>>(),
        [
            "main.st:6:1: warning[W0522]: the stimulus gives `full` values that the program never reads",
            "main.st:10:1: warning[W0522]: the stimulus gives `lamp` values that the program never reads",
        ]
    );
    folder.staunch(&format!("{run} -D W0522")).err(1);
    folder.write("main.st", TEXT.replace("full := c.Q", "{allow W0522}\nfull := c.Q"));
    assert!(!folder.staunch(run).err(0).contains("`full`"));
    // A trace is a stimulus, in which only inputs count.
    folder.write("in.csv", "scan,time_ms,start,full\n1,0,TRUE,FALSE\n");
    assert!(!folder.staunch(run).err(0).contains("W0522"));
    // Another program may read it before.
    let reader = "PROGRAM Other VAR seen : BOOL; END_VAR seen := lamp; END_PROGRAM
CONFIGURATION Plant RESOURCE Cpu ON Plc TASK t(INTERVAL := T#10ms, PRIORITY := 1);
PROGRAM other WITH t : Other; PROGRAM main WITH t : Main; END_RESOURCE END_CONFIGURATION
";
    folder.write("main.st", format!("{TEXT}{reader}"));
    folder.write("in.csv", "scan,lamp\n1,TRUE\n");
    assert!(!folder.staunch(run).err(0).contains("W0522"));
}

#[test]
fn times_and_scans_place_rows() {
    assert_eq!(
        trace("times", "time,a\nT#0s,1\nT#25ms,2\n", "--vars a"),
        "scan,time_ms,a\n1,0,1\n2,10,1\n3,20,1\n4,30,2\n"
    );
    assert_eq!(
        trace("both", "scan,time,a\n1,T#0s,1\n3,T#1s,2\n", "--scans 4 --vars a"),
        "scan,time_ms,a\n1,0,1\n2,10,1\n3,1000,2\n4,1010,2\n"
    );
}

#[test]
fn events_restart_the_program() {
    assert_eq!(
        trace("events", "scan,@event,a\n1,,3\n3,restart,\n4,run,\n", "--vars n,a"),
        "scan,time_ms,n,a\n1,0,1,3\n2,10,2,3\n3,20,1,3\n4,30,1,3\n"
    );
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    for (number, (stimulus, place, word)) in [
        ("scan,b\n1,1\n", "in.csv:1:6", "`b`"),
        ("scan,a\n1,1\n2,70000\n", "in.csv:3:3", "70000"),
        ("scan,a\n1,x\n", "in.csv:2:3", "`x`"),
        ("scan,a\n2,1\n1,1\n", "in.csv:3:1", "1"),
        ("scan,a\n0,1\n", "in.csv:2:1", "from 1"),
        ("scan,a\n1,1,2\n", "in.csv:2", "2"),
        ("scan,@event\n1,stop\n", "in.csv:2:3", "stop"),
        ("a\n1\n", "in.csv:1:1", "scan"),
        ("", "in.csv:1:1", "scan"),
        ("scan,span\n1,5\n", "in.csv:2:3", "5"),
        ("scan,\"levels[1,1]\"\n1,10\n", "in.csv:2:3", "0..9"),
    ]
    .into_iter()
    .enumerate()
    {
        let folder = Folder::with(&format!("wrong{number}"), &[("main.st", PROGRAM), ("in.csv", stimulus)]);
        let err = folder.staunch("run main.st --stimulus in.csv --trace - -A warnings").err(2);
        has(&err, &[place, word]);
    }
}

#[test]
fn a_spreadsheet_with_decimal_commas_is_read() {
    let folder = Folder::with(
        "commas",
        &[
            (
                "main.st",
                "PROGRAM Main VAR_INPUT on : BOOL; level : REAL; END_VAR VAR m : ARRAY[1..2, 1..2] OF INT; END_VAR ; END_PROGRAM",
            ),
            ("in.csv", "scan;on;level;m[1,2]\r\n1;TRUE;3,5;4\r\n2;;-0,25;\r\n"),
        ],
    );
    let out = folder.staunch("run main.st --stimulus in.csv --trace - -A warnings --vars on,level,m[1,2]").out(0);
    assert_eq!(out, "scan,time_ms,on,level,\"m[1,2]\"\n1,0,TRUE,3.5,4\n2,10,TRUE,-0.25,4\n");
}

#[test]
fn a_spreadsheet_in_utf_16_is_read() {
    let folder = Folder::with(
        "utf16",
        &[("main.st", "PROGRAM Main VAR_INPUT on : BOOL; text : STRING[9]; END_VAR ; END_PROGRAM")],
    );
    let text = "scan;on;text\r\n1;TRUE;aé\r\n2;;b\r\n";
    let units = |mark: &str| -> Vec<u16> { mark.chars().chain(text.chars()).map(|it| u32::from(it) as u16).collect() };
    let files: [Vec<u8>; 4] = [
        units("\u{FEFF}").into_iter().flat_map(u16::to_le_bytes).collect(),
        units("\u{FEFF}").into_iter().flat_map(u16::to_be_bytes).collect(),
        units("").into_iter().flat_map(u16::to_le_bytes).collect(),
        units("").into_iter().flat_map(u16::to_be_bytes).collect(),
    ];
    folder.write("utf8.csv", text);
    let run = |file: &str| {
        folder.staunch(&format!("run main.st --stimulus {file} --trace - -A warnings --vars on,text")).out(0)
    };
    let expected = run("utf8.csv");
    assert!(expected.starts_with("scan,time_ms,on,text\n1,0,TRUE,a"), "{expected}");
    for file in files {
        folder.write("utf16.csv", file);
        assert_eq!(run("utf16.csv"), expected);
    }
}

#[test]
fn an_instance_may_be_called_as_a_variable_of_it_is() {
    let program = "PROGRAM P VAR_INPUT a : BOOL; END_VAR VAR n : INT; END_VAR IF a THEN n := n + 1; END_IF END_PROGRAM\n\
                   CONFIGURATION C RESOURCE R ON PLC TASK t(INTERVAL := T#10ms, PRIORITY := 1);\n\
                   PROGRAM A WITH t : P; PROGRAM B WITH t : P; END_RESOURCE END_CONFIGURATION\n";
    let folder = Folder::with("called_alike", &[("p.st", program), ("in.csv", "scan,A.a\n2,TRUE\n")]);
    let trace = folder.staunch("run p.st --scans 3 --stimulus in.csv --trace - --vars A.a,A.n,B.n").out(0);
    has(&trace, &["1,0,FALSE,0,0", "2,10,TRUE,1,0", "3,20,TRUE,2,0"]);
    has(&folder.staunch("run p.st --vars a").err(2), &["`a` is ambiguous"]);
}
