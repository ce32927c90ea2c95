//! Runs: traces, names, faults, the clock.

use super::{COUNTER, Folder, has};

const TYPES: &str = "TYPE
    Color : (Red, Green := 5, Blue);
    Point : STRUCT x, y : INT; END_STRUCT;
END_TYPE
VAR_GLOBAL total : DINT := 7; END_VAR
PROGRAM Main
VAR_INPUT Start : BOOL; END_VAR
VAR_OUTPUT Done : BOOL; END_VAR
VAR
    c : CTU;
    p : Point := (x := -1);
    a : ARRAY[1..2] OF INT := [3, 4];
    m : ARRAY[1..2, 0..1] OF BYTE;
    r : REAL := 0.1;
    l : ARRAY[0..3] OF LREAL := [1.0, 1.0E21, 0.1, 1.0E-7];
    t : TIME := T#1s500ms;
    Hue : Color := Green;
    s : STRING[8] := 'a,\"b$'';
    w : LWORD := 16#FFFF_FFFF_FFFF_FFFF;
END_VAR
c(CU := Start, R := FALSE, PV := 2);
Done := c.Q;
END_PROGRAM
";

#[test]
fn a_trace_has_every_variable_in_order_and_spelling() {
    let folder = Folder::with("trace", &[("types.st", TYPES)]);
    assert_eq!(
        folder.staunch("run types.st --scans 1 --trace - -q -A warnings").out(0),
        "scan,time_ms,Start,Done,c.CU,c.R,c.PV,c.Q,c.CV,p.x,p.y,a[1],a[2],\"m[1,0]\",\"m[1,1]\",\"m[2,0]\",\"m[2,1]\",\
         r,l[0],l[1],l[2],l[3],t,Hue,s,w\n\
         1,0,FALSE,FALSE,FALSE,FALSE,2,FALSE,0,-1,0,3,4,0,0,0,0,0.1,1.0,1e21,0.1,1e-7,T#1s500ms,Green,\"a,\"\"b'\",\
         18446744073709551615\n"
    );
    folder.staunch("run types.st --scans 1 --trace out.csv -q").out(0);
    assert_eq!(folder.read("out.csv"), folder.staunch("run types.st --scans 1 --trace - -q").out(0));
}

const CONVEYOR: &str = "VAR_GLOBAL
    Start AT %IX0.0 : BOOL := TRUE; Motor AT %QX0.0 : BOOL; spare : INT; parts : INT; total : INT;
END_VAR
VAR_GLOBAL CONSTANT lot : INT := 3; END_VAR
FUNCTION_BLOCK Belt VAR_EXTERNAL parts : INT; END_VAR parts := parts + lot; END_FUNCTION_BLOCK
FUNCTION_BLOCK Idle VAR_EXTERNAL spare : INT; END_VAR spare := 1; END_FUNCTION_BLOCK
PROGRAM Main
VAR_EXTERNAL total : INT; END_VAR
VAR belt : Belt; load : INT; END_VAR
belt();
Motor := Start AND NOT %IX3.1;
total := total + 1;
END_PROGRAM
";

#[test]
fn a_trace_has_the_globals_in_use_first() {
    let folder = Folder::with("globals", &[("main.st", CONVEYOR)]);
    let expected = "scan,time_ms,Start,Motor,parts,%IX3.1,total,load\n1,0,TRUE,TRUE,3,FALSE,1,0\n";
    for backend in ["native", "interpret", "rust"] {
        let run = format!("run main.st --scans 1 --trace - -A warnings --backend {backend}");
        assert_eq!(folder.staunch(&run).out(0), expected, "{backend}");
    }
    folder.staunch("build main.st -o plant -q -A warnings").out(0);
    let built = std::process::Command::new(folder.0.join("plant")).args(["--scans", "1", "--trace", "-"]).output();
    assert_eq!(super::Ran::of(built.unwrap()).out(0), expected);
    has(&folder.staunch("run main.st --scans 1 -A warnings").out(0), &["Start  Motor  parts  %IX3.1  total  load"]);
}

#[test]
fn names_are_paths_in_any_case() {
    let folder = Folder::with("names", &[("types.st", TYPES)]);
    assert_eq!(
        folder
            .staunch("run types.st --scans 0 --trace - -q --vars start,A[1],m[1,0],Main.C.cv,c.CU_BEFORE,total,Hue")
            .out(0),
        "scan,time_ms,start,A[1],\"m[1,0]\",Main.C.cv,c.CU_BEFORE,total,Hue\n0,0,FALSE,3,0,0,FALSE,7,Green\n"
    );
    has(&folder.staunch("run types.st --vars c.CW --trace -").err(2), &["CW", "CU"]);
}

#[test]
fn every_back_end_gives_the_same_trace() {
    let folder = Folder::with("backends", &[("main.st", COUNTER), ("in.csv", "scan,pulse\n1,TRUE\n2,FALSE\n3,TRUE\n")]);
    let trace =
        |backend| folder.staunch(&format!("run main.st --stimulus in.csv --trace - --backend {backend}")).out(0);
    let native = trace("native");
    assert!(native.ends_with("3,20,TRUE,FALSE,TRUE,TRUE,FALSE,2,TRUE,2\n"), "{native}");
    assert_eq!(native, trace("interpret"));
    assert_eq!(native, trace("rust"));
}

#[test]
fn a_fault_ends_the_run_after_the_rows_before_it() {
    let divides = "PROGRAM Main\nVAR_INPUT d : INT := 1; END_VAR\nVAR q : INT; END_VAR\nq := 6 / d;\nEND_PROGRAM\n";
    let folder = Folder::with("fault", &[("main.st", divides), ("in.csv", "scan,d\n2,2\n3,0\n9,1\n")]);
    for backend in ["native", "interpret"] {
        let ran = folder.staunch(&format!("run main.st --stimulus in.csv --trace - --backend {backend}"));
        has(&ran.err, &["division by zero", "main.st:4:", "scan 3"]);
        assert_eq!(ran.out(3), "scan,time_ms,d,q\n1,0,1,6\n2,10,2,3\n");
    }
}

#[test]
fn the_clock_moves_by_the_cycle() {
    let timer = "PROGRAM Main\nVAR t : TON; END_VAR\nt(IN := TRUE, PT := T#50ms);\nEND_PROGRAM\n";
    let folder = Folder::with("clock", &[("main.st", timer)]);
    assert_eq!(
        folder.staunch("run main.st --scans 3 --cycle 25ms --trace - --vars t.ET,t.Q").out(0),
        "scan,time_ms,t.ET,t.Q\n1,0,T#0s,FALSE\n2,25,T#25ms,FALSE\n3,50,T#50ms,TRUE\n"
    );
    let task = format!(
        "{timer}CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#20ms, PRIORITY := 1); \
         PROGRAM P WITH T : Main; END_RESOURCE END_CONFIGURATION"
    );
    folder.write("task.st", task);
    let out = folder.staunch("run task.st --scans 2 --trace - --vars t.ET").out(0);
    assert_eq!(out, "scan,time_ms,t.ET\n1,0,T#0s\n2,20,T#20ms\n");
}

/// The program, the stimulus and an initial value write to the variable, and nobody sees what they write.
#[test]
fn a_forced_variable_has_its_value_in_each_scan() {
    let text = "PROGRAM P VAR_INPUT up : BOOL; END_VAR VAR n : INT; m : ARRAY[0..1] OF INT; s : STRING[3] := 'a'; END_VAR \
                m[0] := n; n := n + 1; IF up THEN n := 0; END_IF END_PROGRAM";
    let folder = Folder::with("force", &[("p.st", text), ("in.csv", "scan,up,n\n1,TRUE,5\n2,FALSE,9\n")]);
    for backend in ["native", "rust", "interpret"] {
        let run = format!("run p.st --scans 2 --stimulus in.csv --trace - --backend {backend}");
        assert_eq!(
            folder.staunch(&run).out(0),
            "scan,time_ms,up,n,m[0],m[1],s\n1,0,TRUE,0,5,0,a\n2,10,FALSE,10,9,0,a\n"
        );
        let forced = folder.staunch(&format!("{run} --force n=7 --force m[1]=-1 --force=s=="));
        has(&forced.err, &["note: `n`, `m[1]`, `s` are forced\n"]);
        assert_eq!(forced.out(0), "scan,time_ms,up,n,m[0],m[1],s\n1,0,TRUE,7,7,-1,=\n2,10,FALSE,7,7,-1,=\n");
    }
    let wrong = |force: &str| folder.staunch(&format!("run p.st --scans 1 --force {force}")).err(2);
    has(&wrong("nn=1"), &["--force: there is no variable `nn`; did you mean `n`?"]);
    has(&wrong("n"), &["--force: `n` has no value: write `NAME=VALUE`"]);
    has(&wrong("n=a"), &["--force: `a` is not an INT"]);
}

#[test]
fn numbers_share_a_lane_of_a_picture() {
    let text = "PROGRAM P VAR a, b : INT; END_VAR a := a + 1; b := a / 2; END_PROGRAM";
    let folder = Folder::with("overlay", &[("p.st", text)]);
    for backend in ["native", "rust", "interpret"] {
        folder.staunch(&format!("run p.st --scans 5 --backend {backend} --trace o.svg --overlay a,b")).out(0);
        has(&folder.read("o.svg"), &[">b</text>", "class=\"number second\""]);
    }
    let error = folder.staunch("run p.st --scans 5 --trace o.csv --overlay a,b").err(2);
    has(&error, &["--overlay: it is only for a picture: write --trace OUT.svg"]);
}

#[test]
fn traces_are_waves_and_diagrams_too() {
    let folder = Folder::with("waves", &[("main.st", COUNTER)]);
    folder.staunch("run main.st --scans 3 --trace out.vcd").out(0);
    has(&folder.read("out.vcd"), &["$timescale", "$enddefinitions", "pulse", "$dumpvars"]);
    folder.staunch("run main.st --scans 3 --trace out.svg").out(0);
    has(&folder.read("out.svg"), &["<svg", "pulse", "</svg>"]);
}

/// No ending is taken for another one in silence; a picture of one scan is a cycle wide.
#[test]
fn the_ending_of_a_trace_is_one_of_its_forms() {
    let folder = Folder::new("trace_endings");
    folder.write("p.st", "PROGRAM P VAR x : INT; END_VAR x := 1; END_PROGRAM");
    for name in ["out.xyz", "out.txt", "out.csv.gz"] {
        let error = folder.staunch(&format!("run p.st --scans 2 --trace {name}")).err(2);
        has(&error, &[name, "a trace ends in .csv, .vcd, .svg or .html"]);
        assert!(!folder.0.join(name).exists());
    }
    folder.staunch("run p.st --scans 1 --cycle 20ms --trace one.svg").out(0);
    has(&folder.read("one.svg"), &[">20 ms</text>"]);
}

#[test]
fn a_window_is_cut_by_scans_or_times() {
    let count = "PROGRAM Main VAR_OUTPUT n : INT; END_VAR n := n + 1; END_PROGRAM";
    let folder = Folder::with("window", &[("main.st", count)]);
    let rows = "scan,time_ms,n\n5,40,5\n6,50,6\n";
    for backend in ["native", "rust"] {
        for window in ["--from 5 --to 6", "--from 40ms --to 6", "--from 5 --to T#50ms", "--from 5 --scans 6"] {
            let run = format!("run main.st --trace - --backend {backend} {window}");
            assert_eq!(folder.staunch(&run).out(0), rows, "{run}");
        }
    }
    // Without `--scans` the run ends with the window.
    has(&folder.staunch("run main.st --from 249 --to 250").out(0), &[" 249  2s480ms  249\n", "250 scans"]);
    has(&folder.staunch("run main.st --from 9 --to 8").err(0), &["note: no scan is between"]);
    has(&folder.staunch("run main.st --to soon").err(2), &["`120` or `1s200ms`"]);
}

#[test]
fn results_and_faults_are_objects_on_request() {
    let divides =
        "PROGRAM Main\nVAR d : INT := 3; END_VAR\nVAR q : INT; END_VAR\nd := d - 1; q := 6 / d;\nEND_PROGRAM\n";
    let folder = Folder::with("objects", &[("main.st", divides)]);
    for backend in ["native", "interpret", "rust"] {
        let run = |more: &str| folder.staunch(&format!("run main.st --message-format json --backend {backend} {more}"));
        let report: serde_json::Value = serde_json::from_str(&run("--scans 2").out(0)).unwrap();
        assert_eq!((&report["reason"], &report["scans"]), (&"run".into(), &2.into()), "{report}");
        assert_eq!((&report["program"], &report["time_ns"]), (&"Main".into(), &20_000_000.into()), "{report}");
        let fault: serde_json::Value = serde_json::from_str(&run("").out(3)).unwrap();
        let place = (&fault["file"], &fault["line"], &fault["column"], &fault["scan"]);
        assert_eq!(place, (&"main.st".into(), &4.into(), &20.into(), &3.into()), "{fault}");
        assert_eq!((&fault["reason"], &fault["kind"]), (&"fault".into(), &"division by zero".into()), "{fault}");
        // A trace on standard output stays whole.
        let traced = run("--scans 1 --trace -");
        assert_eq!(traced.out, "scan,time_ms,d,q\n1,0,2,3\n");
        has(&traced.err, &["{\"reason\":\"run\""]);
    }
}

#[test]
fn without_a_trace_there_is_a_table() {
    let folder = Folder::with("table", &[("main.st", COUNTER)]);
    has(&folder.staunch("run main.st --scans 5").out(0), &["parts.CV", "5  40ms"]);
}

#[test]
fn a_table_fits_its_terminal() {
    let folder = Folder::with("narrow", &[("main.st", COUNTER)]);
    for width in [40, 60, 120] {
        let ran = folder.command("run main.st --scans 5").env("COLUMNS", width.to_string()).output().unwrap();
        let out = super::Ran::of(ran).out(0);
        let lines: Vec<usize> = out.lines().take(7).map(|it| it.chars().count()).collect();
        assert!(lines.iter().all(|it| *it <= width), "{out}");
        assert_eq!(out.contains("parts.CV"), width == 120, "{out}");
    }
}

#[test]
fn bench_reports_one_object() {
    let folder = Folder::with("bench", &[("main.st", COUNTER)]);
    let out = folder.staunch("bench main.st --scans 2000 --message-format json").out(0);
    let report: serde_json::Value = serde_json::from_str(out.trim()).unwrap();
    for key in ["scans", "ns_min", "ns_median", "ns_p99", "ns_overhead", "text_bytes", "state_bytes", "compile_ms"] {
        assert!(report[key].is_number(), "{key} in {report}");
    }
}

#[test]
fn a_function_of_very_many_statements_does_what_a_small_one_does() {
    let step = "IF a > 20000 THEN a := a - 30000; s := CONCAT(s, 'x'); END_IF\n\
                a := a + 7; r := SIN(r) + 1.0; m[a MOD 4] := a; c(CU := ODD(a), R := FALSE, PV := 9);\n";
    let program = |times| {
        format!(
            "FUNCTION ODD : BOOL VAR_INPUT x : INT; END_VAR ODD := x MOD 2 <> 0; END_FUNCTION\n\
             PROGRAM Main VAR a : INT; r : LREAL; s : STRING[9]; m : ARRAY[-3..3] OF INT; c : CTU; END_VAR\n{}END_PROGRAM\n",
            step.repeat(times)
        )
    };
    let folder = Folder::with("large", &[("small.st", &program(1)), ("large.st", &program(2000))]);
    let last = |arguments: &str| {
        let out = folder.staunch(&format!("run {arguments} --trace - -q -A warnings")).out(0);
        // Behind the scan's number and time.
        out.lines().last().unwrap().splitn(3, ',').nth(2).unwrap().to_owned()
    };
    assert_eq!(last("large.st --scans 10"), last("small.st --scans 20000"));
}

const LARGE: &str = "TYPE Row : STRUCT on : BOOL := TRUE; x : LREAL; END_STRUCT; END_TYPE
VAR_GLOBAL total : DINT := 40; plain : ARRAY[1..1200000] OF LREAL; END_VAR
PROGRAM Main
VAR started : ARRAY[0..1100000] OF LREAL := [1100001(1.5)]; rows : ARRAY[1..600000] OF Row; r : LREAL; END_VAR
total := total + 2;
r := r + started[1100000]; plain[1200000] := r;
IF rows[600000].on THEN rows[1].x := plain[1200000]; END_IF
END_PROGRAM
";

#[test]
fn a_state_larger_than_the_stack_starts() {
    let folder = Folder::with("large_state", &[("main.st", LARGE)]);
    let shown = "--scans 2 --trace - --vars total,r,rows[1].x,started[7],plain[1]";
    let expected =
        "scan,time_ms,total,r,rows[1].x,started[7],plain[1]\n1,0,42,1.5,1.5,1.5,0.0\n2,10,44,3.0,3.0,1.5,0.0\n";
    for backend in ["interpret", "native", "rust"] {
        assert_eq!(folder.staunch(&format!("run main.st --backend {backend} {shown}")).out(0), expected, "{backend}");
    }
    folder.staunch("build main.st --backend rust -o large -q").out(0);
    let mut built = std::process::Command::new(folder.0.join("large"));
    let ran = super::Ran::of(built.args(shown.split(' ')).output().unwrap());
    assert_eq!(ran.out(0), expected);
}

/// The library has a SCALE_X that takes no two whole numbers without a type; the program's own does.
#[test]
fn the_path_of_a_file_does_not_change_what_it_means() {
    let own = "FUNCTION SCALE_X : REAL VAR_INPUT MIN, VALUE, MAX : REAL; END_VAR
SCALE_X := MIN + VALUE * (MAX - MIN);
END_FUNCTION
PROGRAM Main VAR r : REAL; END_VAR r := SCALE_X(0, 0.5, 100); END_PROGRAM
";
    let folder = Folder::with("path", &[("main.st", own)]);
    std::fs::create_dir_all(folder.0.join("library")).unwrap();
    folder.write("library/scale_x.st", own);
    for path in ["main.st", "library/scale_x.st"] {
        let shown = folder.staunch(&format!("run {path} --dialect siemens --scans 1 --trace -")).out(0);
        assert_eq!(shown, "scan,time_ms,r\n1,0,50.0\n", "{path}");
    }
}

/// A CONFIGURATION says which programs run, whatever it calls them.
#[test]
fn a_configuration_may_name_programs_as_they_are() {
    let programs = "PROGRAM A VAR x : INT; END_VAR x := x + 1; END_PROGRAM
PROGRAM B VAR y : INT; END_VAR y := y + 2; END_PROGRAM
";
    let configuration =
        "CONFIGURATION C RESOURCE R ON PLC PROGRAM A : A; PROGRAM B : B; END_RESOURCE END_CONFIGURATION\n";
    let configured = format!("{programs}{configuration}");
    let folder = Folder::with("configured", &[("plain.st", programs), ("configured.st", &configured)]);
    let expected = "scan,time_ms,A.x,B.y\n1,0,1,2\n2,10,2,4\n";
    assert_eq!(folder.staunch("run configured.st --scans 2 --trace -").out(0), expected);
    has(&folder.staunch("compare configured.st --from iec --to siemens").out(0), &["are equal"]);
    let which = "the sources have several programs; choose one with --program: A, B";
    has(&folder.staunch("run plain.st --scans 2").err(2), &[which]);
}

#[test]
fn every_error_of_every_command_is_an_object_on_request() {
    let folder = Folder::with("errors", &[("main.st", COUNTER), ("bad.csv", "scan,nothing\n1,1\n")]);
    for command in [
        "check none.st",
        "run none.st",
        "run main.st --vars nothing",
        "run main.st --stimulus bad.csv",
        "run main.st --retain main.st",
        "run main.st --program Other",
        "bench none.st",
        "test none.st",
        "compare none.st --from codesys --to logix",
        "build main.st --emit rust -o no/such/folder/x.rs",
        "explain E9999",
        "new .",
    ] {
        let out = folder.staunch(&format!("{command} --message-format json")).out(2);
        let error: serde_json::Value = serde_json::from_str(&out).unwrap_or_else(|_| panic!("{command}: {out}"));
        assert_eq!(error["reason"], "error", "{command}");
        assert!(!error["message"].as_str().unwrap().is_empty(), "{command}");
    }
}

#[test]
fn what_a_program_logs_is_printed_after_the_scan() {
    let logs = "{dialect 'codesys'} PROGRAM Main
VAR n : DINT; i : DINT; zero : DINT; END_VAR
n := n + 1;
IF n = 2 THEN ADSLOGSTR(ADSLOG_MSGTYPE_ERROR, 'pump %s', 'P7'); ADSLOGDINT(ADSLOG_MSGTYPE_WARN, '%d \"parts\"', 3); END_IF
IF n = 3 THEN FOR i := 1 TO 18 DO ADSLOGDINT(0, '%d', i); END_FOR END_IF
IF n = 4 THEN ADSLOGSTR(ADSLOG_MSGTYPE_HINT, 'before the fault', ''); n := n / zero; END_IF
END_PROGRAM
";
    let restart = "scan,@event\n3,restart\n4,\n";
    let folder = Folder::with("logs", &[("main.st", logs), ("in.csv", restart)]);
    let told = folder.staunch("run main.st --scans 3").err(0);
    let of_scan_2 = "log, scan 2: error: pump P7\nlog, scan 2: warning: 3 \"parts\"\n";
    has(&told, &[of_scan_2, "\nlog, scan 3: note: 2 earlier messages were not kept\nlog, scan 3: message: 3\n"]);
    assert!(told.ends_with("log, scan 3: message: 18\n"), "{told}");
    let fault = folder.staunch("run main.st").err(3);
    has(&fault, &["log, scan 4: hint: before the fault\nerror: "]);
    assert_eq!(folder.staunch("run main.st --scans 3 -q").err(0), "");
    let json = folder.staunch("run main.st --scans 2 --message-format json").out(0);
    has(&json, &["{\"reason\":\"log\",\"scan\":2,\"kind\":\"warning\",\"message\":\"3 \\\"parts\\\"\"}\n"]);
    // After a power cycle the counts begin anew.
    assert_eq!(
        folder.staunch("run main.st --stimulus in.csv").err(0),
        format!("{of_scan_2}{}", of_scan_2.replace('2', "4"))
    );
}

#[test]
fn a_unit_test_looks_at_what_is_logged() {
    let source = "{dialect 'codesys'} FUNCTION_BLOCK Pump
VAR_INPUT on : BOOL; END_VAR
IF on THEN ADSLOGSTR(ADSLOG_MSGTYPE_HINT, 'pump %s', 'P7'); END_IF
END_FUNCTION_BLOCK
";
    let test = "{dialect 'codesys'} TEST 'logs'
VAR pump : Pump; END_VAR
pump(on := FALSE); pump(on := TRUE);
ASSERT_EQ(__AdsLogCount, 1);
ASSERT_EQ(__AdsLogTexts[0], 'pump P7');
END_TEST
";
    let folder = Folder::with("logs_of_tests", &[("pump.st", source), ("pump_test.st", test)]);
    has(&folder.staunch("test .").out(0), &["1 passed, 0 failed"]);
}

const TASK_INFO: &str = "{dialect 'codesys'} PROGRAM Main
VAR cycle, count : UDINT; first : BOOL; END_VAR
cycle := _TaskInfo[GETCURTASKINDEXEX()].CycleTime;
count := _TaskInfo[1].CycleCount;
first := _TaskInfo[1].FirstCycle;
END_PROGRAM
";

#[test]
fn a_program_knows_the_time_between_its_scans() {
    let task = "CONFIGURATION c RESOURCE r ON x TASK t (INTERVAL := T#20ms, PRIORITY := 1); PROGRAM p WITH t : Main; \
                END_RESOURCE END_CONFIGURATION\n";
    let folder = Folder::with("task_info", &[("main.st", TASK_INFO), ("task.st", task)]);
    let trace = "--scans 2 --trace - --vars cycle,count,first";
    for backend in ["interpret", "native", "rust"] {
        let run = |arguments: &str| folder.staunch(&format!("run {arguments} {trace} --backend {backend}")).out(0);
        // Of what lies around the program, nothing is shown that is not asked for.
        has(&run("main.st"), &["\n1,0,100000,1,TRUE\n2,10,100000,2,FALSE\n"]);
        has(&run("main.st --cycle 5ms"), &["\n1,0,50000,1,TRUE\n2,5,50000,2,FALSE\n"]);
        has(&run("main.st task.st"), &["\n1,0,200000,1,TRUE\n2,20,200000,2,FALSE\n"]);
        has(&run("main.st task.st --cycle 5ms"), &["\n1,0,50000,1,TRUE\n2,5,50000,2,FALSE\n"]);
    }
    let all = folder.staunch("run main.st --scans 1 --trace -").out(0);
    has(&all, &["scan,time_ms,cycle,count,first\n"]);
    has(&folder.staunch("run main.st --scans 1 --trace - --vars _TaskInfo[1].CycleCount").out(0), &["\n1,0,1\n"]);
}

#[test]
fn a_unit_test_is_a_task_of_the_cycle_of_tests() {
    let test = |cycle: u32| {
        format!(
            "{{dialect 'codesys'}} TEST 'task'
VAR first, second : UDINT; END_VAR
ASSERT_EQ(_TaskInfo[GETCURTASKINDEXEX()].CycleTime, {cycle});
first := _TaskInfo[1].CycleCount;
ADVANCE_TIME(T#1s);
second := _TaskInfo[1].CycleCount;
ASSERT_EQ(first, 1); ASSERT_EQ(second, 1); ASSERT_TRUE(_TaskInfo[1].FirstCycle);
END_TEST
"
        )
    };
    let folder = Folder::with("task_info_of_tests", &[("main.st", TASK_INFO), ("main_test.st", &test(100_000))]);
    has(&folder.staunch("test .").out(0), &["1 passed, 0 failed"]);
    has(&folder.staunch("test . --backend rust").out(0), &["1 passed, 0 failed"]);
    let suite = "{dialect 'codesys'} FUNCTION_BLOCK Sums EXTENDS TcUnit.FB_TestSuite
VAR first, now, scans : UDINT; END_VAR
now := _TaskInfo[GETCURTASKINDEXEX()].CycleCount;
IF scans = 0 THEN first := now; END_IF
scans := scans + 1;
TEST('cycles');
IF scans = 5 THEN
    AssertEquals_UDINT(Expected := 4, Actual := now - first, Message := 'cycles');
    AssertEquals_UDINT(Expected := 100000, Actual := _TaskInfo[1].CycleTime, Message := 'time');
    AssertFalse(_TaskInfo[1].FirstCycle, 'first');
    TEST_FINISHED();
END_IF
END_FUNCTION_BLOCK
PROGRAM Prg
VAR sums : Sums; END_VAR
TcUnit.RUN();
END_PROGRAM
";
    has(&Folder::with("task_info_of_a_suite", &[("main.st", suite)]).staunch("test .").out(0), &["1 passed, 0 failed"]);
    let tasks = "CONFIGURATION c RESOURCE r ON x TASK a (INTERVAL := T#20ms, PRIORITY := 1); \
                 TASK b (INTERVAL := T#30ms, PRIORITY := 2); PROGRAM p WITH b : Main; END_RESOURCE END_CONFIGURATION\n";
    let of_two = "{dialect 'codesys'} TEST 'two tasks'
ASSERT_EQ(_AppInfo.TaskCnt, 2);
ASSERT_EQ(_TaskInfo[1].CycleTime, 100000); ASSERT_EQ(_TaskInfo[2].CycleTime, 300000);
ASSERT_EQ(_TaskInfo[2].CycleCount, 0); ASSERT_EQ(_TaskInfo[2].TaskName, 'b');
END_TEST
";
    let files = [("main.st", TASK_INFO), ("tasks.st", tasks), ("main_test.st", of_two)];
    has(&Folder::with("task_info_of_two", &files).staunch("test .").out(0), &["1 passed, 0 failed"]);
    let project = [("staunch.toml", "cycle = \"25ms\"\n"), ("main.st", TASK_INFO), ("main_test.st", &test(250_000))];
    let folder = Folder::with("task_info_of_a_project", &project);
    has(&folder.staunch("test .").out(0), &["1 passed, 0 failed"]);
}

/// Logix continues after a division by zero: each command says how often, and where first.
#[test]
fn minor_faults_are_told() {
    let main = "{dialect 'logix'}\nPROGRAM Main\nVAR n, d, q : DINT; END_VAR\nn := n + 1;\nq := n / d;\nEND_PROGRAM\n";
    let folder = Folder::with("minor", &[("main.st", main)]);
    let note =
        "3 divisions by zero, the first at main.st:5:8: a minor fault (type 4, code 4), and the program continues";
    has(&folder.staunch("run main.st --scans 3").err, &[note]);
    let json = folder.staunch("run main.st --scans 3 --message-format json").out(0);
    has(&json, &["{\"reason\":\"minor-faults\",\"count\":3,\"file\":\"main.st\",\"line\":5,\"column\":8}\n"]);
    has(&folder.staunch("bench main.st --scans 3").err, &[" by zero, the first at main.st:5:8"]);
    let test = "{dialect 'logix'}\nTEST 'share'\nVAR a : DINT := 7; b, q : DINT; END_VAR\nq := a / b;\nASSERT_EQ(q, 7);\nEND_TEST\n";
    let folder = Folder::with("minor_test", &[("main.st", test)]);
    has(&folder.staunch("test main.st").err, &["1 division by zero, the first at main.st:4:8"]);
    let json = folder.staunch("test main.st --message-format json").out(0);
    has(&json, &["{\"reason\":\"minor-faults\",\"count\":1,\"file\":\"main.st\",\"line\":4,\"column\":8}\n"]);
}
