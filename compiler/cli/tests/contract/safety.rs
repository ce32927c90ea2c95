//! Nothing is torn: retained data after a fault, outputs that cannot be written, and files that are inputs.

use super::{COUNTER, Folder, Ran, has};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

/// `a` and `b` are the same after each whole scan; the fifth has no end.
const TORN: &str = "PROGRAM Main
VAR RETAIN a, b : DINT; END_VAR
VAR z : DINT := 1; t : DINT; END_VAR
a := a + 1;
IF a = 5 THEN z := 0; END_IF;
t := 100 / z;
b := b + 1;
END_PROGRAM
";

/// The same without a fault, and without a change.
const READER: &str = "PROGRAM Main VAR RETAIN a, b : DINT; END_VAR END_PROGRAM";

const FAULT: &str = "main.st:6:10: fault: division by zero (scan 5, program Main)";

#[test]
fn what_is_retained_after_a_fault_is_of_the_last_whole_scan() {
    let folder = Folder::with("torn", &[("main.st", TORN), ("reader.st", READER)]);
    folder.staunch("build main.st -o plant").out(0);
    folder.staunch("build main.st --backend rust -o plant_rust").out(0);
    let executable = |name: &str| {
        let mut command = Command::new(folder.0.join(name));
        command.args("--realtime --cycle 1ms --retain plant.retain".split(' ')).current_dir(&folder.0);
        Ran::of(command.output().unwrap())
    };
    let runs: [(&str, &dyn Fn() -> Ran); 7] = [
        ("native", &|| folder.staunch("run main.st --retain plant.retain -q")),
        ("interpret", &|| folder.staunch("run main.st --retain plant.retain -q --backend interpret")),
        ("rust", &|| folder.staunch("run main.st --retain plant.retain -q --backend rust")),
        ("realtime", &|| folder.staunch("run main.st --retain plant.retain -q --realtime --cycle 1ms")),
        ("scan", &|| {
            folder.staunch("run main.st --retain plant.retain -q --realtime --cycle 1ms --retain-within scan")
        }),
        ("executable", &|| executable("plant")),
        ("executable of Rust", &|| executable("plant_rust")),
    ];
    let read = || folder.staunch("run reader.st -A warnings --scans 1 --retain plant.retain --trace - --vars a,b");
    for (name, run) in runs {
        let _ = fs::remove_file(folder.0.join("plant.retain"));
        has(&run().err(3), &[FAULT]);
        let read_first = read();
        has(&read_first.err, &["note: plant.retain: a run ended with a fault", FAULT]);
        assert_eq!(read_first.out(0), "scan,time_ms,a,b\n1,0,4,4\n", "{name}");
        // A run that ended well has taken the note away.
        assert_eq!(read().err, "", "{name}");
    }
}

/// Of several programs in one scan, what ran whole before the fault is not kept either: a scan is kept as one.
#[test]
fn a_scan_of_several_programs_is_kept_as_one() {
    let text = "CONFIGURATION c VAR_GLOBAL RETAIN a, b : DINT; END_VAR
TASK t(INTERVAL := T#10ms, PRIORITY := 1);
PROGRAM one WITH t : First; PROGRAM two WITH t : Second; END_CONFIGURATION
PROGRAM First VAR_EXTERNAL a : DINT; END_VAR a := a + 1; END_PROGRAM
PROGRAM Second VAR_EXTERNAL a, b : DINT; END_VAR VAR t : DINT; END_VAR t := 1 / (5 - a); b := a; END_PROGRAM";
    let folder = Folder::with("torn-tasks", &[("main.st", text)]);
    folder.staunch("run main.st --retain plant.retain -q").err(3);
    folder.write("main.st", text.replace("a := a + 1;", ";"));
    let out = folder.staunch("run main.st --scans 1 --retain plant.retain --trace - --vars a,b").out(0);
    assert_eq!(out, "scan,time_ms,a,b\n1,0,4,4\n");
}

#[test]
fn a_run_in_real_time_goes_on_without_a_trace() {
    let folder = Folder::with("lost", &[("main.st", COUNTER)]);
    folder.staunch("build main.st -o plant").out(0);
    let run = "--realtime --scans 3 --cycle 1ms --vars full --trace";
    for trace in ["/dev/full", "missing/t.csv", "pipe", "full.svg", "full.html"] {
        match trace {
            "pipe" => assert!(Command::new("mkfifo").arg(folder.0.join("pipe")).status().unwrap().success()),
            // All of a picture is written at the end.
            "full.svg" | "full.html" => symlink("/dev/full", folder.0.join(trace)).unwrap(),
            _ => {}
        }
        let executable = Command::new(folder.0.join("plant"))
            .args(format!("{run} {trace}").split(' '))
            .current_dir(&folder.0)
            .output()
            .unwrap();
        for ran in [folder.staunch(&format!("run main.st {run} {trace}")), Ran::of(executable)] {
            has(&ran.err, &["warning: cannot write", "continues without it", "3 rows could not be written"]);
            assert_eq!(ran.code, 0, "{trace}: {ran:?}");
        }
    }
    let json = folder.staunch(&format!("run main.st {run} missing/t.csv --message-format json"));
    has(&json.out(0), &["\"scans\":3", "\"rows_lost\":3"]);
    // Standard output that nobody reads.
    let line = format!("{run} -");
    let plant = folder.0.join("plant");
    let programs = [(Path::new(env!("CARGO_BIN_EXE_staunch")), format!("run main.st {line}")), (plant.as_path(), line)];
    for (program, line) in programs {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = Command::new(program);
        command.args(line.split(' ')).current_dir(&folder.0).stdout(writer).stderr(Stdio::piped());
        let ran = command.spawn().unwrap().wait_with_output().unwrap();
        let err = String::from_utf8(ran.stderr).unwrap();
        assert_eq!(ran.status.code(), Some(0), "{err}");
        has(&err, &["continues without it", "rows could not be written"]);
    }
    for trace in ["/dev/full", "missing/t.csv"] {
        has(&folder.staunch(&format!("run main.st --scans 3 --trace {trace}")).err(2), &["cannot write"]);
    }
}

/// Every kind of output, by every way to a file that the call reads.
#[test]
fn an_output_does_not_replace_an_input() {
    let test = "TEST 'it' ASSERT_TRUE(TRUE); END_TEST\n";
    let files = [
        ("main.st", COUNTER),
        ("t.st", test),
        ("staunch.toml", "loop-budget = 1000\n"),
        ("in.csv", "scan,pulse\n1,TRUE\n"),
    ];
    let folder = Folder::with("replaces", &files);
    symlink("main.st", folder.0.join("link.csv")).unwrap();
    fs::hard_link(folder.0.join("main.st"), folder.0.join("hard.html")).unwrap();
    symlink("t.st", folder.0.join("t.info")).unwrap();
    fs::hard_link(folder.0.join("in.csv"), folder.0.join("in.vcd")).unwrap();
    for call in [
        "build main.st -o main.st",
        "build main.st -o ./link.csv",
        "build main.st --emit rust -o hard.html",
        "build main.st --emit map -o staunch.toml",
        "run main.st --trace link.csv",
        "run main.st --trace hard.html --backend rust",
        "run main.st --retain link.csv",
        "run main.st --stimulus in.csv --trace in.csv",
        "run main.st --stimulus in.csv --trace in.vcd",
        "run main.st --stimulus in.csv --retain in.vcd",
        "test t.st --junit t.st",
        "test t.st --coverage t.info",
        "compare main.st --from iec --to logix --write main.st",
        "compare main.st --from iec --to logix --stimulus in.csv --save-stimulus in.csv",
        "compare main.st --from iec --to logix --save-stimulus link.csv",
    ] {
        has(&folder.staunch(call).err(2), &["would replace", "write to another file"]);
    }
    has(&folder.staunch("run main.st --retain new.csv --trace ./new.csv").err(2), &["are the same file"]);
    for (name, text) in files {
        assert_eq!(folder.read(name), text);
    }
    folder.staunch("build main.st -o plant").out(0);
    let ran = Command::new(folder.0.join("plant"))
        .args("--stimulus in.csv --trace in.vcd".split(' '))
        .current_dir(&folder.0)
        .output();
    has(&Ran::of(ran.unwrap()).err(2), &["would replace --stimulus in.csv"]);
    // Standard input may be a file as well.
    for (call, what) in [
        ("build - --emit map -o main.st < main.st", "the source"),
        ("build /dev/stdin --emit map -o main.st < main.st", "the source"),
        ("run main.st --stimulus /dev/stdin --trace in.csv < in.csv", "--stimulus"),
    ] {
        let line = format!("{} {call}", env!("CARGO_BIN_EXE_staunch"));
        let ran = Command::new("sh").args(["-c", &line]).current_dir(&folder.0).output().unwrap();
        has(&Ran::of(ran).err(2), &[&format!("would replace {what}")]);
        assert_eq!((folder.read("main.st").as_str(), folder.read("in.csv").as_str()), (files[0].1, files[3].1));
    }
    // What may be read and written by several.
    folder.staunch("run main.st --scans 1 --stimulus /dev/null --trace /dev/null").err(2);
    folder.staunch("run main.st --scans 1 --retain keep --trace /dev/null").out(0);
}

#[test]
fn an_output_that_fails_leaves_the_file_before_it() {
    let folder = Folder::with("whole", &[("main.st", TORN), ("out.csv", "before")]);
    symlink("out.csv", folder.0.join("link.csv")).unwrap();
    let limited = format!(
        "ulimit -f 1; trap '' XFSZ; exec {} run main.st --scans 4000 --trace out.csv",
        env!("CARGO_BIN_EXE_staunch")
    );
    folder.write("main.st", COUNTER);
    let ran = Command::new("bash").args(["-c", &limited]).current_dir(&folder.0).output().unwrap();
    has(&Ran::of(ran).err(2), &["cannot write out.csv"]);
    assert_eq!(folder.read("out.csv"), "before");
    folder.staunch("run main.st --scans 1 --trace link.csv --vars full").out(0);
    assert_eq!(folder.read("out.csv"), "scan,time_ms,full\n1,0,FALSE\n");
    assert!(fs::symlink_metadata(folder.0.join("link.csv")).unwrap().is_symlink());
    let mut names: Vec<_> = fs::read_dir(&folder.0).unwrap().map(|it| it.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["link.csv", "main.st", "out.csv"]);
    // What is not a file is written straight.
    assert_eq!(folder.staunch("run main.st --scans 1 --trace /dev/stdout --vars full").out(0).lines().count(), 2);
}

#[test]
fn a_file_of_retained_variables_keeps_its_link_and_has_one_owner() {
    let folder = Folder::with("owned", &[("main.st", COUNTER)]);
    fs::create_dir(folder.0.join("data")).unwrap();
    symlink("data/p.ret", folder.0.join("l.ret")).unwrap();
    let texts = ["VAR RETAIN a : DINT; END_VAR", "VAR RETAIN n, a : DINT; END_VAR"];
    for (text, last) in texts.iter().zip(["2,10,2", "2,10,4"]) {
        folder.write("main.st", format!("PROGRAM Main {text} a := a + 1; END_PROGRAM"));
        let out = folder.staunch("run main.st -A warnings --scans 2 --retain l.ret --trace - --vars a").out(0);
        assert_eq!(out.lines().last(), Some(last));
    }
    assert!(fs::symlink_metadata(folder.0.join("l.ret")).unwrap().is_symlink());
    assert!(fs::symlink_metadata(folder.0.join("data/p.ret")).unwrap().is_file());
    let mut first = folder.command("run main.st --realtime --retain data/p.ret --trace t.csv").spawn().unwrap();
    while !folder.0.join("t.csv").exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    fs::hard_link(folder.0.join("data/p.ret"), folder.0.join("h.ret")).unwrap();
    let others = ["l.ret", "h.ret"].map(|it| (it, folder.staunch(&format!("run main.st --scans 1 --retain {it}"))));
    first.kill().unwrap();
    first.wait().unwrap();
    for (name, second) in others {
        has(&second.err(2), &[name, "another process keeps its retained variables there"]);
    }
    folder.staunch("run main.st --scans 1 --retain l.ret -q").out(0);
    // A file that the run itself has made.
    let mut first = folder.command("run main.st --realtime --retain new.ret").spawn().unwrap();
    while fs::hard_link(folder.0.join("new.ret"), folder.0.join("other.ret")).is_err() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let second = folder.staunch("run main.st --scans 1 --retain other.ret");
    first.kill().unwrap();
    first.wait().unwrap();
    has(&second.err(2), &["another process keeps its retained variables there"]);
}

/// A pipe is said to be waited for; what has no end, and what leads nowhere, is refused.
#[test]
fn what_is_no_file_is_a_message() {
    let folder = Folder::with("no-file", &[("main.st", COUNTER)]);
    fs::create_dir(folder.0.join("dir")).unwrap();
    symlink("loop.csv", folder.0.join("loop.csv")).unwrap();
    for name in ["a", "b"] {
        symlink(".", folder.0.join("dir").join(name)).unwrap();
    }
    for call in [
        "check dir",
        "check loop.csv",
        "check /dev/zero",
        "run main.st --stimulus dir",
        "run main.st --stimulus /dev/zero",
        "run main.st --stimulus loop.csv",
        "run main.st --trace dir",
        "run main.st --trace loop.csv",
        "run main.st --retain dir",
        "run main.st --retain /dev/null",
        "run main.st --retain loop.csv",
        "build main.st -o dir",
        "build main.st -o loop.csv",
    ] {
        assert!(folder.staunch(call).err(2).contains("error: "), "{call}");
    }
    assert!(Command::new("mkfifo").arg(folder.0.join("pipe")).status().unwrap().success());
    for call in ["run main.st --stimulus pipe", "run main.st --trace pipe", "check pipe"] {
        let line = format!("timeout 1 {} {call}", env!("CARGO_BIN_EXE_staunch"));
        let ran = Command::new("sh").args(["-c", &line]).current_dir(&folder.0).output().unwrap();
        has(&Ran::of(ran).err(124), &["note: pipe is a pipe: waiting until it is"]);
    }
    has(&folder.staunch("run main.st --retain pipe").err(2), &["need a file"]);
    // In a folder nobody asked for it.
    assert!(Command::new("mkfifo").arg(folder.0.join("dir/pipe.st")).status().unwrap().success());
    has(&folder.staunch("check dir").err(2), &["dir/pipe.st: this is not a file, but a pipe or a device"]);
}

#[test]
fn assumptions_may_come_from_a_pipe() {
    let folder = Folder::with("assumed", &[("main.st", COUNTER)]);
    let line = format!(
        "{} compare main.st --from iec --to codesys --assume <(printf 'no run\\nnobody 1..2\\n')",
        env!("CARGO_BIN_EXE_staunch")
    );
    let ran = Command::new("bash").args(["-c", &line]).current_dir(&folder.0).output().unwrap();
    has(&Ran::of(ran).err(2), &[":2: ", "`nobody`"]);
}
