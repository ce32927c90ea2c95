//! What gdb shows of a program that is made for it, `build --debug`: on this machine, and on aarch64 through QEMU.

mod objects;

use super::vendor::project;
use super::{Folder, has_tool};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Stdio};

const AARCH64: &str = "aarch64-unknown-linux-gnu";
const LIBRARIES: &str = "/usr/aarch64-linux-gnu";

/// The statements that gdb stops at are marked by the comments after them.
const PLANT: &str = "TYPE
    Mode   : (Idle, Filling, Jammed);
    Recipe : STRUCT
        Name  : STRING[20];
        Steps : ARRAY[1..3] OF INT;
        Ratio : LREAL;
    END_STRUCT;
END_TYPE

VAR_GLOBAL
    Shared : CTU;
    Active : Recipe;
END_VAR

FUNCTION Scaled : DINT
VAR_INPUT
    Raw    : INT;
    Factor : DINT;
END_VAR
VAR
    Wide : DINT;
END_VAR
Wide := INT_TO_DINT(Raw);
Wide := Wide * Factor;              (* function *)
Scaled := Wide + 1;
END_FUNCTION

FUNCTION_BLOCK Station
VAR_INPUT
    Bottle : BOOL;
END_VAR
VAR_IN_OUT
    Count : DINT;
END_VAR
VAR
    Delay : TON;
    State : Mode;
END_VAR
METHOD Add : DINT
VAR_INPUT
    Amount : DINT;
END_VAR
VAR
    Before : DINT;
END_VAR
Before := Amount * 2;
Add := Before + 1;                  (* method *)
END_METHOD

Delay(IN := Bottle, PT := T#1s500ms);
IF Bottle THEN
    State := Filling;
    Count := Count + Add(20);       (* block *)
ELSE
    State := Idle;
END_IF;
END_FUNCTION_BLOCK

PROGRAM Main
VAR
    Tracker : CTUD;
    First   : Station;
    Second  : Station;
    Total   : DINT;
    Label   : STRING := 'it works';
    Wide    : WSTRING[10] := \"wide\";
    Pause   : TIME := T#1m2s500ms;
    Limited : INT(0..10) := 7;
    Grid    : ARRAY[0..1, 1..2] OF SINT := [1, -2, 3, 4];
    Lamp    : BOOL := TRUE;
    Level   : REF_TO DINT;
    i, Sum  : INT;
END_VAR
VAR_TEMP
    Turn : INT;
END_VAR
VAR_EXTERNAL
    Shared : CTU;
    Active : Recipe;
END_VAR
Tracker(CU := TRUE, PV := 3);       (* begin *)
First(Bottle := TRUE, Count := Total);
Turn := 41;
Level := REF(Total);
FOR i := 1 TO 3 DO                  (* loop *)
    Sum := Sum + i;
    Active.Steps[i] := Sum;
END_FOR;
Turn := Turn + 1;                   (* after *)
Total := Total + Scaled(Sum, 10);
Active.Name := CONCAT('mix', ' A');
Shared(CU := TRUE, PV := 2);
WHILE Turn > 0 DO
    Turn := Turn - 1;
    IF Turn = 40 THEN
        EXIT;                       (* leave *)
    END_IF;
END_WHILE;
Tracker(CU := FALSE, LD := TRUE);   (* end *)
END_PROGRAM
";

/// The line with a mark.
fn line(mark: &str) -> String {
    let mark = format!("(* {mark} *)");
    let at = PLANT.lines().position(|it| it.contains(&mark)).unwrap();
    (at + 1).to_string()
}

/// What is typed, and what gdb prints for it, up to spaces at the ends of lines.
type Session = Vec<(String, &'static str)>;

fn session(of: &[(&str, &'static str)]) -> Session {
    let at = |it: &str| match it.split_once('@') {
        Some((command, mark)) => format!("{command}plant.st:{}", line(mark)),
        None => it.to_owned(),
    };
    of.iter().map(|(command, printed)| (at(command), *printed)).collect()
}

/// From one mark to the next, what each kind of routine sees, and what its callers are.
fn plant() -> Session {
    session(&[
        ("tbreak @method", ""),
        ("tbreak @function", ""),
        ("continue", "Add := Before + 1;"),
        ("info args", "Amount = 20"),
        ("print Before", "= 40"),
        ("print Add", "= 0"),
        ("print State", "= Filling"),
        ("print THIS^.Delay.PT", "= 1.5"),
        ("print Main.First.State", "= Filling"),
        ("print Main.Tracker.CV", "= 1"),
        ("bt 3", "#0  Station.Add (THIS=0x"),
        ("bt 3", ", Amount=20) at plant.st:"),
        ("bt 3", " in Station (THIS=0x"),
        ("bt 3", " in Main ("),
        ("up", "Count := Count + Add(20);"),
        ("print Count", "= 0"),
        ("print Delay", "= {IN = true, PT = 1.5, Q = false, ET = 0"),
        ("up", "First(Bottle := TRUE, Count := Total);"),
        ("print Tracker.CV", "= 1"),
        ("print Main.Second.State", "= Idle"),
        ("continue", "Wide := Wide * Factor;"),
        ("info args", "Raw = 6\nFactor = 10"),
        ("info locals", "Scaled = 0"),
        ("print Wide", "= 6"),
        ("next", "Scaled := Wide + 1;"),
        ("print Wide", "= 60"),
        ("print Active.Steps", "= {1, 3, 6}"),
        ("tbreak @leave", ""),
        ("continue", "EXIT;"),
        ("print Turn", "= 40"),
        ("next", "Tracker(CU := FALSE, LD := TRUE);"),
        ("print Tracker.CV", "= 1"),
        ("print Total", "= 102"),
        ("print Level^", "= 102"),
        ("print Label", "= 'it works'"),
        ("print Wide", "= 'wide'"),
        ("print Pause", "= 62.5"),
        ("print Limited", "= 7"),
        ("print Grid", "= {{1, -2}, {3, 4}}"),
        ("print Grid[1][2]", "= 4"),
        ("print Lamp", "= true"),
        ("print Shared.CV", "= 1"),
        ("print Active.Name", "= 'mix A'"),
        ("print First.State = Filling", "= true"),
        ("set var Second.Delay.PT := 2.5", ""),
        ("print Second.Delay.PT", "= 2.5"),
        ("whatis Pause", "type = TIME"),
        ("ptype Tracker", "CV : INT;"),
        ("ptype Mode", "(Idle, Filling, Jammed)"),
        ("ptype Recipe", "Ratio : LREAL;"),
        ("whatis Active", "type = Recipe"),
        ("ptype TON", "PT : TIME;"),
    ])
}

/// Statement after statement, also into a block and around a loop.
fn steps() -> Session {
    session(&[
        ("tbreak @begin", ""),
        ("continue", "Tracker(CU := TRUE, PV := 3);"),
        ("next", "First(Bottle := TRUE, Count := Total);"),
        ("step", "Delay(IN := Bottle, PT := T#1s500ms);"),
        ("next", "IF Bottle THEN"),
        ("next", "State := Filling;"),
        ("next", "Count := Count + Add(20);"),
        ("next", "Turn := 41;"),
        ("next", "Level := REF(Total);"),
        ("next", "FOR i := 1 TO 3 DO"),
        ("next", "Sum := Sum + i;"),
        ("next", "Active.Steps[i] := Sum;"),
        ("next", "FOR i := 1 TO 3 DO"),
        ("print i", "= 1"),
        ("next", "Sum := Sum + i;"),
        ("print i", "= 2"),
        ("tbreak @after", ""),
        ("continue", "Turn := Turn + 1;"),
        ("print Sum", "= 6"),
        ("tbreak Scaled", ""),
        ("continue", "Wide := INT_TO_DINT(Raw);"),
        ("finish", "Total := Total + Scaled(Sum, 10);"),
    ])
}

/// An executable with debug information.
fn built(name: &str, arguments: &str) -> Folder {
    let folder = Folder::with(name, &[("plant.st", PLANT)]);
    folder.staunch(&format!("build plant.st -g -q -A warnings -o plant {arguments}")).out(0);
    folder
}

/// What a debugger prints for each of its commands, after others.
fn printed(debugger: &str, folder: &Folder, before: &[String], session: &Session) -> Vec<String> {
    let mut command = Command::new(debugger);
    command.args(["-nx", "-q", "-batch", "-ex", "set pagination off", "-ex", "set width 0"]).current_dir(&folder.0);
    for it in before {
        command.arg("-ex").arg(it);
    }
    for (at, (typed, _)) in session.iter().enumerate() {
        command.arg("-ex").arg(format!("echo \\n@@{at}\\n")).arg("-ex").arg(typed);
    }
    let output = command.arg("plant").stdin(Stdio::null()).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let part = |at: usize| {
        let (_, rest) = text.split_once(&format!("\n@@{at}\n")).unwrap_or_else(|| panic!("{at}: {output:?}"));
        rest.split("\n@@").next().unwrap_or_default().to_owned()
    };
    (0..session.len()).map(part).collect()
}

fn holds(printed: &[String], session: &Session) {
    let mut said = String::new();
    for (text, (typed, expected)) in printed.iter().zip(session) {
        said.push_str(&format!("(gdb) {typed}\n{text}\n"));
        assert!(text.contains(expected), "{said}\nwhere `{expected}` is expected");
    }
}

fn has_gdb() -> bool {
    has_tool(Command::new("gdb").arg("--version"), "gdb")
}

/// gdb starts the program, which stops before its first instruction.
fn here(name: &str, session: &Session) {
    here_in(&built(name, ""), session);
}

fn here_in(folder: &Folder, session: &Session) {
    let before = ["set args --scans 2 -q".to_owned(), "starti".to_owned()];
    holds(&printed("gdb", folder, &before, session), session);
}

/// Whether programs for aarch64 can be made, run and looked at.
fn has_aarch64() -> bool {
    let tools = [
        ("aarch64-linux-gnu-gcc", "gcc-aarch64-linux-gnu libc6-dev-arm64-cross"),
        ("qemu-aarch64", "qemu-user"),
        ("gdb-multiarch", "gdb-multiarch"),
    ];
    let rustc = Command::new("rustc").args(["--print", "target-libdir", "--target", AARCH64]).output();
    let has_library = rustc.is_ok_and(|it| Path::new(String::from_utf8_lossy(&it.stdout).trim()).is_dir());
    assert!(has_library || std::env::var_os("CI").is_none(), "rustup target add {AARCH64}");
    has_library && tools.iter().all(|(tool, package)| has_tool(Command::new(tool).arg("--version"), package))
}

/// gdb connects to QEMU, which waits for it.
fn on_aarch64(name: &str, session: &Session) {
    let folder = built(name, &format!("--target {AARCH64}"));
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port().to_string();
    let mut emulator = Command::new("qemu-aarch64");
    emulator.args(["-g", &port, "-L", LIBRARIES, "plant", "--scans", "2", "-q"]).current_dir(&folder.0);
    let mut emulator = emulator.stdout(Stdio::null()).spawn().unwrap();
    let before = [format!("set sysroot {LIBRARIES}"), format!("target remote 127.0.0.1:{port}")];
    let printed = printed("gdb-multiarch", &folder, &before, session);
    // It has ended, unless gdb could not connect.
    let _ = emulator.kill();
    emulator.wait().unwrap();
    holds(&printed, session);
}

#[test]
fn gdb_shows_variables_by_their_names() {
    if has_gdb() {
        here("gdb_variables", &plant());
    }
}

#[test]
fn gdb_steps_by_statements() {
    if has_gdb() {
        here("gdb_steps", &steps());
    }
}

/// Lines are those of the files as they are, and lists of global variables have their names.
#[test]
fn gdb_stops_in_files_of_another_system() {
    if !has_gdb() {
        return;
    }
    let folder = project("gdb_twincat");
    folder.staunch("build Line.plcproj -g -q -o plant").out(0);
    let session = [
        ("tbreak MAIN.TcPOU:15", "file POUs/MAIN.TcPOU, line 15."),
        ("tbreak FB_Station.Count", "file POUs/FB_Station.TcPOU, line 6."),
        ("continue", "GVL_Line.parts := station.Count() / divisor;"),
        ("set var MAIN.station.parts.CV := 12", ""),
        ("print divisor", "= 1"),
        ("continue", "FB_Station.Count (THIS=0x"),
        ("print parts.CV", "= 12"),
        ("tbreak MAIN.TcPOU:14", ""),
        ("continue", "station(go := pulse);"),
        ("print GVL_Line.parts", "= 12"),
        ("print GVL_Line", "= {parts = 12}"),
    ];
    here_in(&folder, &session.map(|(typed, printed)| (typed.to_owned(), printed)).to_vec());
}

#[test]
fn gdb_shows_and_steps_on_aarch64() {
    if has_aarch64() {
        on_aarch64("gdb_aarch64_variables", &plant());
        on_aarch64("gdb_aarch64_steps", &steps());
    }
}
