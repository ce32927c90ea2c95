//! Runs that stop: `run --break`.

use super::{Folder, Ran, has};
use std::process::Stdio;

/// The lines with statements: 4, 8, 15, 16, 18, 19, 25, 26, 29.
const PLANT: &str = "TYPE Mode : (Off, Fast); END_TYPE
FUNCTION Twice : INT
VAR_INPUT a : INT; END_VAR
Twice := a * 2;
END_FUNCTION
FUNCTION Unused : INT
VAR_INPUT a : INT; END_VAR
Unused := a;
END_FUNCTION
FUNCTION_BLOCK Motor
VAR_INPUT on : BOOL; END_VAR
VAR_OUTPUT speed : INT; END_VAR
VAR mode : Mode; t : TON; END_VAR
METHOD PUBLIC Step : INT VAR_INPUT amount : INT; END_VAR
speed := speed + amount;
Step := speed;
END_METHOD
t(IN := on, PT := T#1s500ms);
IF on THEN mode := Fast; Step(amount := Twice(1)); END_IF;
END_FUNCTION_BLOCK
PROGRAM Main
VAR motors : ARRAY[1..2] OF Motor; i : INT; list : ARRAY[0..2] OF INT; text : STRING[9] := 'it$'s'; END_VAR
VAR r : REF_TO INT; sum : DINT; END_VAR

r := REF(i);
FOR i := 1 TO 2 DO
    (* every motor *)

    motors[i](on := i = 2);
END_FOR;
END_PROGRAM
";

fn plant(name: &str) -> Folder {
    Folder::with(name, &[("plant.st", PLANT)])
}

/// A run of the plant with nothing but what `--break` says.
fn run(folder: &Folder, arguments: &str) -> Ran {
    folder.staunch(&format!("run plant.st -q -A warnings {arguments}"))
}

#[test]
fn a_stop_shows_where_the_run_is_and_its_variables() {
    let folder = plant("debug_stop");
    let err = run(&folder, "--break plant.st:15").err(0);
    let expected = "stopped: in scan 1, at T#0s
  --> plant.st:15:1
   |
15 | speed := speed + amount;
   | ^^^^^^^^^^^^^^^^^^^^^^^^
Main > motors[2] > Step
  Step   : INT = 0
  amount : INT = 2
  on     : BOOL = TRUE
  speed  : INT = 0
  mode   : Mode = Fast
  t      : TON = (IN := TRUE, PT := T#1s500ms, Q := FALSE, ET := T#0s)

note: the run ends with scan 1, after 1 stop (--stops 0 prints all stops)
";
    assert_eq!(err, expected);
    let main = run(&folder, "--break 26").err(0);
    has(&main, &["\nMain\n", "text   : STRING[9] = 'it$'s'", "list   : ARRAY[0..2] OF INT = [0, 0, 0]"]);
    has(&main, &["r      : REF_TO INT = &Main.i", "mode := Off", "…"]);
}

#[test]
fn a_line_without_a_statement_is_the_next_one_of_its_pou() {
    let folder = plant("debug_lines");
    let at = |line: u32| run(&folder, &format!("--break {line}")).err(0);
    has(&at(27), &["note: plant.st:27 has no statement; the breakpoint is at line 29", "--> plant.st:29:5"]);
    has(&at(22), &["the breakpoint is at line 25"]);
    has(&at(12), &["the breakpoint is at line 18", "Main > motors[1]\n"]);
    let refused = run(&folder, "--break 31").err(2);
    has(&refused, &["no statement follows line 31 in its POU; the nearest line of plant.st with a statement is 29"]);
    // Between two POUs: neither is meant.
    has(&run(&folder, "--break 5").err(2), &["the nearest lines of plant.st with statements are 4 and 8"]);
}

#[test]
fn a_run_that_faults_before_its_breakpoint_says_both() {
    let text = "PROGRAM Main\nVAR n : INT := 2; a : ARRAY[0..2] OF INT; END_VAR\nn := n + 1;\na[n] := 1;\nn := 0;\nEND_PROGRAM\n";
    let folder = Folder::with("debug_fault", &[("plant.st", text)]);
    let err = run(&folder, "--break 5 --scans 3").err(3);
    has(
        &err,
        &["note: the run never stopped at --break plant.st:5\n", "plant.st:4:3: fault: index out of range (scan 1"],
    );
}

#[test]
fn a_pou_that_never_runs_is_reported() {
    let folder = plant("debug_unused");
    let err = run(&folder, "--break 8 --scans 3").err(0);
    assert_eq!(err, "note: plant.st:8 is never reached: no running PROGRAM calls `Unused`\n");
    let err = run(&folder, "--break 16 --scans 3 --when FALSE").err(0);
    assert_eq!(err, "note: the run never stopped at --break plant.st:16\n");
}

#[test]
fn a_file_is_named_by_the_end_of_its_path() {
    let main = "PROGRAM Main VAR a : INT; END_VAR\na := Add(a);\nEND_PROGRAM\n";
    let add = "FUNCTION Add : INT VAR_INPUT x : INT; END_VAR\nAdd := x + 1;\nEND_FUNCTION\n";
    let folder = Folder::new("debug_files");
    std::fs::create_dir_all(folder.0.join("lib")).unwrap();
    folder.write("main.st", main);
    folder.write("lib/add.st", add);
    let run = |at: &str| folder.staunch(&format!("run main.st lib -q --break {at}"));
    for name in ["add.st:2", "lib/add.st:2"] {
        has(&run(name).err(0), &["add.st:2:1", "Main > Add\n", "Add : INT = 0\n", "x   : INT = 0\n"]);
    }
    has(&run("2").err(2), &["--break 2: name the file, as in `--break main.st:2`"]);
    has(&run("dd.st:2").err(2), &["no source is named `dd.st`"]);
    has(&run("2x").err(2), &["write a line, 12, or a file and a line, motor.st:12"]);
    has(&run("main.st:0").err(2), &["write a line"]);
}

/// The arguments of `run`, where one of them has spaces.
fn run_when(folder: &Folder, arguments: &str, condition: &str) -> Ran {
    let command = format!("run plant.st -q -A warnings {arguments}");
    Ran::of(folder.command(&command).args(["--when", condition]).output().unwrap())
}

#[test]
fn a_condition_is_an_expression_of_the_pou() {
    let folder = plant("debug_when");
    let scan = |at: &str, condition: &str| {
        let err = run_when(&folder, at, condition).err(0);
        err.lines().find(|it| it.starts_with("stopped")).map(str::to_owned).unwrap_or(err)
    };
    assert_eq!(scan("--break 15", "speed >= 4 AND NOT (speed = 5)"), "stopped: in scan 3, at T#20ms");
    assert_eq!(
        scan("--break 15", "THIS^.mode = Fast AND amount = 2 AND t.ET > T#25ms"),
        "stopped: in scan 4, at T#30ms"
    );
    assert_eq!(scan("--break 15", "ABS(speed) MOD 8 = 6 OR FALSE"), "stopped: in scan 4, at T#30ms");
    assert_eq!(scan("--break 29", "i = 2 AND motors[i].speed > 2"), "stopped: in scan 3, at T#20ms");
    assert_eq!(scan("--break 29", "i > 2"), "note: the run never stopped at --break plant.st:29\n");
}

#[test]
fn a_wrong_condition_is_a_diagnostic() {
    let folder = plant("debug_wrong");
    let wrong = |condition: &str| run_when(&folder, "--break 15", condition).err(2);
    let unknown = wrong("speeed > 4");
    has(&unknown, &["error[E0101]: `speeed` is not declared", "--> --when:1:1", "1 | speeed > 4"]);
    has(&wrong("speed"), &["a condition must be a BOOL, but this is INT"]);
    has(&wrong("speed > TRUE"), &["error[", "--> --when:1:"]);
    has(&wrong("Twice(speed) > 2"), &["a call in an expression of a breakpoint is not supported"]);
    has(&wrong("speed > 2; x"), &["expected the end of the expression, found `;`"]);
    has(&wrong(""), &["expected an expression"]);
    let json = Ran::of(
        folder
            .command("run plant.st -q -A warnings --break 15 --message-format json")
            .args(["--when", "nothing"])
            .output()
            .unwrap(),
    );
    has(&json.out(2), &["{\"reason\":\"diagnostic\",\"code\":\"E0101\"", "\"file\":\"--when\""]);
}

#[test]
fn a_condition_that_faults_stops_and_says_so() {
    let folder = plant("debug_when_fault");
    let err = run_when(&folder, "--break 29", "list[i + 2] = 0").err(0);
    has(&err, &["--> plant.st:29:5", "--when cannot be evaluated here: index out of range"]);
}

#[test]
fn as_many_stops_are_printed_as_are_asked_for() {
    let folder = plant("debug_stops");
    let stops = |arguments: &str| {
        let err = run(&folder, arguments).err(0);
        (err.matches("stopped: ").count(), err)
    };
    // Each turn of the loop is a stop.
    let (count, err) = stops("--break 29 --stops 3");
    assert_eq!(count, 3, "{err}");
    has(&err, &["in scan 2, at T#10ms", "the run ends with scan 2, after 3 stops"]);
    let (count, err) = stops("--break 29 --break 15 --stops 0 --scans 4");
    assert_eq!(count, 12, "{err}");
    assert!(!err.contains("the run ends"), "{err}");
}

#[test]
fn a_trace_has_the_scan_of_the_last_stop() {
    let folder = plant("debug_trace");
    let ran = run(&folder, "--break 29 --stops 3 --trace - --vars i,motors[2].speed");
    assert_eq!(ran.out(0), "scan,time_ms,i,motors[2].speed\n1,0,3,2\n2,10,3,4\n");
    let plain = run(&folder, "--backend interpret --scans 2 --trace - --vars i,motors[2].speed");
    assert_eq!(plain.out(0), "scan,time_ms,i,motors[2].speed\n1,0,3,2\n2,10,3,4\n");
}

#[test]
fn stops_are_objects_where_they_are_asked_for() {
    let folder = plant("debug_json");
    let out = run(&folder, "--break 16 --message-format json --stops 2").out(0);
    let lines: Vec<&str> = out.lines().collect();
    let first = "{\"reason\":\"stop\",\"stop\":1,\"scan\":1,\"time_ns\":0,\"file\":\"plant.st\",\"line\":16,\"column\":1,\
        \"source\":\"Step := speed;\",\"path\":[\"Main\",\"motors[2]\",\"Step\"],\"when_fault\":null,\
        \"locals\":[{\"name\":\"Step\",\"type\":\"INT\",\"value\":\"0\"},{\"name\":\"amount\",\"type\":\"INT\",\"value\":\"2\"}],\
        \"members\":[{\"name\":\"on\",\"type\":\"BOOL\",\"value\":\"TRUE\"},";
    assert!(lines[0].starts_with(first), "{}", lines[0]);
    has(lines[1], &["\"stop\":2,\"scan\":2,\"time_ns\":10000000"]);
    has(lines[2], &["{\"reason\":\"note\",\"message\":\"the run ends with scan 2, after 2 stops"]);
    has(lines[3], &["{\"reason\":\"run\""]);
    // A trace on standard output stays one.
    let ran = run(&folder, "--break 16 --message-format json --trace - --vars i");
    has(&ran.err, &["{\"reason\":\"stop\""]);
    assert_eq!(ran.out(0), "scan,time_ms,i\n1,0,3\n");
}

/// What a run shows of each command: the place of each stop, and the answers.
fn session(folder: &Folder, at: &str, commands: &str) -> Vec<String> {
    let ran = folder.with_input(&format!("run plant.st -q -A warnings --break {at} --commands - --scans 3"), commands);
    let err = ran.err(0);
    let is_shown = |it: &&str| it.contains("--> ") || !it.starts_with([' ', '1', '2']) && it.contains(" = ");
    err.lines().filter(is_shown).map(|it| it.trim().trim_start_matches("--> ").to_owned()).collect()
}

#[test]
fn commands_step_into_over_and_out_of_calls() {
    let folder = plant("debug_commands");
    let places = session(&folder, "29", "c\ns\ns\nn\n\n\n");
    // The second turn; its block, whose IF is one line; over the call of Step; the next scan's first statement.
    assert_eq!(
        places,
        [
            "plant.st:29:5",
            "plant.st:29:5",
            "plant.st:18:1",
            "plant.st:19:1",
            "plant.st:19:12",
            "plant.st:19:26",
            "plant.st:25:1"
        ]
    );
    // Nothing follows in the callers, so the next statement is one of the next scan; in that, the breakpoint comes first.
    let out = session(&folder, "15", "s\no\no\nq\n");
    assert_eq!(out, ["plant.st:15:1", "plant.st:16:1", "plant.st:25:1", "plant.st:15:1"]);
    let into_function = session(&folder, "19", "c\ns\ns\ns\no\no\n");
    assert_eq!(
        into_function[2..],
        ["plant.st:19:12", "plant.st:19:26", "plant.st:4:1", "plant.st:15:1", "plant.st:25:1"]
    );
}

#[test]
fn values_are_printed_in_the_scope_of_the_stop() {
    let folder = plant("debug_print");
    let commands = "p speed\np THIS^.t\np t.PT\np speed * 10 + amount\np mode = Fast\np motors[2].t.ET\np CONCAT('a', 'b')\np Main.sum\n";
    assert_eq!(
        session(&folder, "16", commands)[1..],
        [
            "speed : INT = 2",
            "THIS^.t : TON = (IN := TRUE, PT := T#1s500ms, Q := FALSE, ET := T#0s)",
            "t.PT : TIME = T#1s500ms",
            "speed * 10 + amount : INT = 22",
            "mode = Fast : BOOL = TRUE",
            "motors[2].t.ET : TIME = T#0s",
            "CONCAT('a', 'b') : STRING[2] = 'ab'",
            "Main.sum : DINT = 0",
        ]
    );
    let err =
        folder.with_input("run plant.st -q -A warnings --break 16 --commands -", "p nothing\np list[7]\nxyz\n").err(0);
    has(&err, &["error[E0101]: `nothing` is not declared", " --> p:1:1", "`xyz` is not a command"]);
}

#[test]
fn the_run_ends_where_the_commands_do() {
    let folder = plant("debug_end");
    let ran = folder.with_input("run plant.st -q -A warnings --break 29 --commands - --trace - --vars i", "c\n");
    assert_eq!(ran.err.matches("stopped").count(), 2);
    assert_eq!(ran.out(0), "scan,time_ms,i\n1,0,3\n");
    folder.write("steps.txt", "c\nq\n");
    let ran = run(&folder, "--break 29 --commands steps.txt");
    assert_eq!(ran.err(0).matches("stopped").count(), 2);
    has(&run(&folder, "--break 29 --commands absent.txt").err(2), &["--commands absent.txt"]);
    // Nobody can answer.
    let mut command = folder.command("run plant.st -q -A warnings --break 29");
    let ran = Ran::of(command.stdin(Stdio::null()).output().unwrap());
    has(&ran.err(0), &["after 1 stop"]);
}

#[test]
fn a_fault_after_a_stop_is_reported_as_ever() {
    let text =
        "PROGRAM Main\nVAR a : ARRAY[0..1] OF INT; i : INT := 1; END_VAR\ni := i + 1;\na[i] := 1;\nEND_PROGRAM\n";
    let folder = Folder::with("debug_fault", &[("main.st", text)]);
    let err = folder.staunch("run main.st -q --break 4").err(3);
    has(
        &err,
        &["--> main.st:4:1", "i : INT = 2", "error: main.st:4:3: fault: index out of range (scan 1, program Main)"],
    );
    has(&folder.staunch("run main.st -q --break 3").err(3), &["i : INT = 1", "fault: index out of range"]);
}

#[test]
fn actions_temporaries_and_in_outs_have_stops() {
    let text = "FUNCTION_BLOCK Tick
VAR_IN_OUT io : INT; END_VAR
VAR n : INT; END_VAR
ACTION Act:
    n := n + 1;
END_ACTION
io := io + 1;
Act();
END_FUNCTION_BLOCK
FUNCTION Deep : INT
VAR k : TON; left : INT := 3; END_VAR
WHILE left > 0 DO left := left - 1; END_WHILE
Deep := left;
END_FUNCTION
PROGRAM Main
VAR tick : Tick; count : INT := 5; END_VAR
VAR_TEMP x : INT; END_VAR
tick(io := count);
x := Deep();
END_PROGRAM
";
    let folder = Folder::with("debug_routines", &[("main.st", text)]);
    let at = |line: u32| folder.staunch(&format!("run main.st -q -A warnings --break {line}")).err(0);
    has(&at(5), &["Main > tick > Act\n", "io : INT = 6\n", "n  : INT = 0\n"]);
    has(&at(13), &["Main > Deep\n", "k    : TON = (IN := FALSE", "left : INT = 0\n"]);
    has(&at(19), &["x     : INT = 0\n", "tick  : Tick = (n := 1)\n"]);
}

#[test]
fn each_program_of_a_configuration_has_its_path() {
    let text = "FUNCTION_BLOCK Cell VAR n : INT; END_VAR
n := n + 1;
END_FUNCTION_BLOCK
PROGRAM A VAR c : Cell; END_VAR c(); END_PROGRAM
CONFIGURATION C
RESOURCE R ON PLC
TASK fast(INTERVAL := T#10ms, PRIORITY := 1);
PROGRAM a1 WITH fast : A;
PROGRAM a2 WITH fast : A;
END_RESOURCE
END_CONFIGURATION
";
    let folder = Folder::with("debug_configuration", &[("main.st", text)]);
    let err = folder.staunch("run main.st -q --break 2 --stops 3").err(0);
    has(
        &err,
        &[
            "\na1 > c\n  n : INT = 0\n",
            "\na2 > c\n  n : INT = 0\n",
            "in scan 2, at T#10ms",
            "\na1 > c\n  n : INT = 1\n",
        ],
    );
}

#[test]
fn a_path_leads_through_methods_of_other_instances_and_of_base_classes() {
    let text = "INTERFACE I_Node
METHOD Go : INT VAR_INPUT depth : INT; END_VAR END_METHOD
END_INTERFACE
FUNCTION_BLOCK Base
VAR v : INT; END_VAR
METHOD PROTECTED Note VAR_INPUT depth : INT; END_VAR
v := depth;
END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Node EXTENDS Base IMPLEMENTS I_Node
VAR next : I_Node; has : BOOL; END_VAR
METHOD PUBLIC Link VAR_INPUT n : I_Node; END_VAR
next := n; has := TRUE;
END_METHOD
METHOD PROTECTED OVERRIDE Note VAR_INPUT depth : INT; END_VAR
SUPER.Note(depth);
END_METHOD
METHOD PUBLIC Go : INT VAR_INPUT depth : INT; END_VAR
Note(depth);
IF has THEN Go := next.Go(depth + 1) + 1; ELSE Go := 0; END_IF
END_METHOD
END_FUNCTION_BLOCK
PROGRAM Main
VAR a, b : Node; r : INT; END_VAR
a.Link(b);
r := a.Go(1);
END_PROGRAM
";
    let folder = Folder::with("debug_methods", &[("plant.st", text)]);
    let err = run_when(&folder, "--break 7", "depth = 2").err(0);
    has(&err, &["\nMain > a > Go > Main.b > Go > Note > Note\n", "depth : INT = 2\n", "v     : INT = 0\n"]);
}

#[test]
fn lines_are_those_of_a_vendors_file() {
    let main = "<?xml version=\"1.0\" encoding=\"utf-8\"?>
<TcPlcObject Version=\"1.1.0.1\">
  <POU Name=\"MAIN\" Id=\"{1}\" SpecialFunc=\"None\">
    <Declaration><![CDATA[PROGRAM MAIN
VAR
    n : INT;
END_VAR
]]></Declaration>
    <Implementation>
      <ST><![CDATA[n := n + 1;
Act();
]]></ST>
    </Implementation>
    <Action Name=\"Act\" Id=\"{2}\">
      <Implementation>
        <ST><![CDATA[n := n + 10;]]></ST>
      </Implementation>
    </Action>
  </POU>
</TcPlcObject>
";
    let folder = Folder::with("debug_twincat", &[("MAIN.TcPOU", main)]);
    let at = |arguments: &str| folder.staunch(&format!("run MAIN.TcPOU -q {arguments}")).err(0);
    has(&at("--break 10"), &["--> MAIN.TcPOU:10:20", "10 |       <ST><![CDATA[n := n + 1;", "n : INT = 0"]);
    has(
        &at("--break MAIN.TcPOU:16 --when n>11"),
        &["--> MAIN.TcPOU:16:22", "MAIN > Act\n", "n : INT = 12", "in scan 2"],
    );
    has(&at("--break 5"), &["the breakpoint is at line 10"]);
}

#[test]
fn names_in_a_condition_mean_what_they_mean_at_the_line() {
    let text = "NAMESPACE Plant
VAR_GLOBAL CONSTANT top : INT := 2; END_VAR
FUNCTION_BLOCK Cell
VAR n : INT; END_VAR
n := n + 1;
END_FUNCTION_BLOCK
END_NAMESPACE
VAR_GLOBAL total : INT; END_VAR
PROGRAM Main
VAR_EXTERNAL total : INT; END_VAR
VAR c : Plant.Cell; END_VAR
c();
total := total + 2;
END_PROGRAM
";
    let folder = Folder::with("debug_names", &[("plant.st", text)]);
    has(&run_when(&folder, "--break 5", "n >= top").err(0), &["in scan 3"]);
    has(&run_when(&folder, "--break 13", "total = 4").err(0), &["in scan 3", "total : INT = 4"]);
    has(&run_when(&folder, "--break 13", "n = 4").err(2), &["`n` is not declared"]);
}

#[test]
fn compiled_code_does_not_stop() {
    let folder = plant("debug_usage");
    for backend in ["native", "rust"] {
        has(&run(&folder, &format!("--break 29 --backend {backend}")).err(2), &["--break is for --backend interpret"]);
    }
    run(&folder, "--break 29 --backend interpret").err(0);
    has(&run(&folder, "--when TRUE").err(2), &["--break"]);
    has(&run(&folder, "--stops 2").err(2), &["--break"]);
    has(&run(&folder, "--break 29 --stops 2 --commands -").err(2), &["cannot be used with"]);
    has(&run(&folder, "--break 29 --realtime").err(2), &["cannot be used with"]);
}
