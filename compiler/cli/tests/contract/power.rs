//! Retained variables of programs that run when the power goes: here, that are killed.

use super::{Folder, Ran, has};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// All of `a`, `list` and `b` are the same after each scan.
const PROGRAM: &str = "PROGRAM Main
VAR RETAIN a : ULINT; list : ARRAY[0..999] OF ULINT; b : ULINT; END_VAR
VAR i : INT; same : BOOL; END_VAR
a := a + 1;
FOR i := 0 TO 999 DO list[i] := a; END_FOR;
b := a;
END_PROGRAM
";

/// Reads what was kept without changing it: all of the state, and whether it is of one scan.
const READER: &str = "PROGRAM Main
VAR RETAIN a : ULINT; list : ARRAY[0..999] OF ULINT; b : ULINT; END_VAR
VAR i : INT; same : BOOL; END_VAR
same := a = b;
FOR i := 0 TO 999 DO same := same AND list[i] = a; END_FOR;
END_PROGRAM
";

/// What counts up in each scan from the fifth on, and what counts once.
const ONCE: &str = "PROGRAM Main
VAR RETAIN once : INT; END_VAR
VAR scans : INT; END_VAR
scans := scans + 1;
IF scans = 5 THEN once := once + 1; END_IF;
END_PROGRAM
";

/// Ends with the test, also if that fails.
struct Running(Child);

impl Running {
    fn of(command: &mut Command) -> Self {
        Self(command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap())
    }

    /// As a power cut does: without a word.
    fn kill(&mut self) {
        assert!(self.0.try_wait().unwrap().is_none(), "it has ended by itself");
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn executable(folder: &Folder, source: &str) {
    folder.staunch(&format!("build {source} --emit exe -o plant")).out(0);
}

fn plant(folder: &Folder, arguments: &str) -> Command {
    let mut command = Command::new(folder.0.join("plant"));
    command.args(arguments.split_whitespace()).current_dir(&folder.0);
    command
}

/// The state that the next start finds.
fn kept(folder: &Folder) -> u64 {
    let out = folder.staunch("run reader.st --scans 1 --retain plant.retain --trace - --vars same,a").out(0);
    let row = out.lines().nth(1).unwrap().strip_prefix("1,0,TRUE,");
    row.unwrap_or_else(|| panic!("a state in parts: {out}")).parse().unwrap()
}

/// How often programs are killed: a few times here, and as often as `STAUNCH_KILLS` says.
fn kills() -> u64 {
    std::env::var("STAUNCH_KILLS").map_or(12, |it| it.parse().unwrap())
}

/// The last whole row that a process got to its trace: what `a` was after that scan.
fn last_traced(folder: &Folder) -> u64 {
    let trace = std::fs::read_to_string(folder.0.join("scans.csv")).unwrap_or_default();
    let whole = trace.rsplit_once('\n').map_or("", |it| it.0);
    whole.lines().last().and_then(|it| it.rsplit(',').next()?.parse().ok()).unwrap_or(0)
}

/// Kills a program many times over. Each start continues from what the one before left, and no state is from a scan that was not
/// due yet. The trace does not show that: a thread writes it, later than the scans.
fn is_killed(folder: &Folder, cycle: Duration, mut run: impl FnMut() -> Command) {
    let (mut before, mut later) = (0, 0);
    for number in 0..kills() {
        let _ = std::fs::remove_file(folder.0.join("scans.csv"));
        let began = Instant::now();
        let mut running = Running::of(run().args("--trace scans.csv --vars a".split(' ')));
        until(|| last_traced(folder) > 0);
        sleep(Duration::from_micros(number.wrapping_mul(7_919) % 40_000));
        running.kill();
        let due = 1 + u64::try_from(began.elapsed().as_nanos() / cycle.as_nanos()).unwrap();
        // It may be killed before it wrote the first file.
        let now = if folder.0.join("plant.retain").exists() { kept(folder) } else { 0 };
        assert!((before..=before + due).contains(&now), "kill {number}: {now} after {before}, with {due} scans due");
        later += u64::from(now > before);
        before = now;
    }
    assert!(later > kills() / 4, "{later} of {} starts left something", kills());
    println!("{} kills, {before} scans that were kept", kills());
}

fn until(mut is_so: impl FnMut() -> bool) {
    let began = Instant::now();
    while !is_so() {
        assert!(began.elapsed() < Duration::from_secs(60), "it does not come");
        sleep(Duration::from_millis(2));
    }
}

#[test]
fn an_executable_may_be_killed_at_any_moment() {
    let folder = Folder::with("killed", &[("main.st", PROGRAM), ("reader.st", READER)]);
    executable(&folder, "main.st");
    let arguments = "--realtime --retain plant.retain --retain-within scan --cycle 200us";
    is_killed(&folder, Duration::from_micros(200), || plant(&folder, arguments));
}

#[test]
fn a_run_may_be_killed_at_any_moment() {
    let folder = Folder::with("killed-run", &[("main.st", PROGRAM), ("reader.st", READER)]);
    let run = "run main.st --realtime --retain plant.retain --retain-within 10ms --cycle 1ms";
    is_killed(&folder, Duration::from_millis(1), || folder.command(run));
}

/// Waits until a start would find `once` counted so often.
fn until_kept(folder: &Folder, count: u32) {
    until(|| {
        std::fs::copy(folder.0.join("plant.retain"), folder.0.join("copy")).is_ok()
            && (folder.staunch("run main.st --scans 0 --retain copy --trace - --vars once").out(0))
                .ends_with(&format!("\n0,0,{count}\n"))
    });
}

#[test]
fn a_change_is_kept_while_the_program_runs_and_no_change_is_not_written() {
    let folder = Folder::with("kept", &[("main.st", ONCE)]);
    executable(&folder, "main.st");
    for count in 1..=3 {
        let mut running = Running::of(&mut plant(&folder, "--retain plant.retain --retain-within 50ms --cycle 5ms"));
        until_kept(&folder, count);
        let written = std::fs::read(folder.0.join("plant.retain")).unwrap();
        sleep(Duration::from_millis(200));
        assert_eq!(std::fs::read(folder.0.join("plant.retain")).unwrap(), written);
        running.kill();
    }
}

#[test]
fn what_cannot_be_kept_is_said_at_once_and_at_the_end() {
    let folder = Folder::with("nowhere", &[("main.st", ONCE)]);
    let ran =
        folder.staunch("run main.st --realtime --scans 30 --cycle 10ms --retain no/plant.retain --retain-within scan");
    let err = ran.err(2);
    has(
        &err,
        &["warning: no/plant.retain: retained variables cannot be saved: ", "error: cannot write no/plant.retain: "],
    );
    has(&folder.staunch("run main.st --retain-within 1s").err(2), &["--retain"]);
    has(&folder.staunch("run main.st --retain x --retain-within never").err(2), &["or `scan` for every scan"]);
}

/// A family's variables, and what a process that is started again has of them.
struct Family {
    dialect: &'static str,
    declarations: &'static str,
    /// After the third scan of a process, and after the first scan of the next one.
    before: &'static str,
    after: &'static str,
}

/// Each variable starts at 5 and counts up in each scan; docs/dialects.md, "A power cycle".
const FAMILIES: [Family; 5] = [
    Family {
        dialect: "iec",
        declarations: "VAR plain : INT := 5; END_VAR VAR RETAIN kept : INT := 5; END_VAR",
        before: "8,8",
        after: "6,9",
    },
    Family {
        dialect: "openplc",
        declarations: "VAR plain : INT := 5; END_VAR VAR RETAIN kept : INT := 5; END_VAR",
        before: "8,8",
        after: "6,9",
    },
    Family {
        dialect: "cscape",
        declarations: "VAR plain : INT := 5; END_VAR VAR RETAIN kept : INT := 5; END_VAR",
        before: "8,8",
        after: "6,9",
    },
    Family {
        dialect: "codesys",
        declarations: "VAR plain : INT := 5; END_VAR VAR RETAIN kept : INT := 5; END_VAR \
                       VAR PERSISTENT lasting : INT := 5; END_VAR VAR RETAIN PERSISTENT both : INT := 5; END_VAR",
        before: "8,8,8,8",
        after: "6,9,9,9",
    },
    Family {
        dialect: "logix",
        declarations: "VAR plain : INT := 5; END_VAR VAR RETAIN kept : INT := 5; END_VAR",
        before: "8,8",
        after: "9,9",
    },
];

#[test]
fn a_process_that_starts_again_keeps_what_its_family_keeps() {
    for Family { dialect, declarations, before, after } in FAMILIES {
        let names: Vec<&str> =
            ["plain", "kept", "lasting", "both"].into_iter().take(before.split(',').count()).collect();
        let counts: String = names.iter().map(|it| format!("{it} := {it} + 1;\n")).collect();
        let source = format!("PROGRAM Main\n{declarations}\n{counts}END_PROGRAM\n");
        let folder = Folder::with(&format!("started-again-{dialect}"), &[("main.st", &source)]);
        folder.staunch(&format!("build main.st --dialect {dialect} --emit exe -o plant")).out(0);
        let options = format!("--cycle 1ms --trace - --vars {}", names.join(","));
        let run = format!("run main.st --dialect {dialect} {options}");
        let staunch = |more: &str| folder.staunch(&format!("{run} {more}"));
        let executable = |more: &str| Ran::of(plant(&folder, &format!("{options} {more}")).output().unwrap());
        // A scan in real time may come late.
        let row = |out: &str, at: usize| out.lines().nth(at).unwrap().splitn(3, ',').nth(2).unwrap().to_owned();
        for (realtime, of_command) in [("", true), ("--realtime", true), ("", false), ("--realtime", false)] {
            let start = |more: &str| match of_command {
                true => staunch(&format!("{realtime} {more}")).out(0),
                false => executable(&format!("{realtime} {more}")).out(0),
            };
            let way = format!("{dialect} {realtime}, of the command: {of_command}");
            let _ = std::fs::remove_file(folder.0.join("plant.retain"));
            assert_eq!(row(&start("--scans 3 --retain plant.retain"), 3), before, "{way}");
            assert_eq!(row(&start("--scans 1 --retain plant.retain"), 1), after, "{way}");
            assert!(row(&start("--scans 1"), 1).split(',').all(|it| it == "6"), "{way}");
        }
    }
}
