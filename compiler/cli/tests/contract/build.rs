//! What `build` makes.

use super::{COUNTER, Folder, Ran, has};
use std::process::{Command, Stdio};

#[test]
fn every_kind_is_made_where_it_is_asked_for() {
    let folder = Folder::with("kinds", &[("main.st", COUNTER)]);
    for (kind, file, part) in
        [("rust", "out.rs", "forbid(unsafe_code)"), ("header", "out.h", "staunch_scan"), ("map", "out.map", "parts")]
    {
        folder.staunch(&format!("build main.st --emit {kind} -o {file} -q")).out(0);
        has(&folder.read(file), &[part]);
    }
    for (kind, file) in [("obj", "out.o"), ("lib", "libout.a"), ("exe", "out")] {
        folder.staunch(&format!("build main.st --emit {kind} -o {file} -q")).out(0);
        assert!(folder.0.join(file).metadata().unwrap().len() > 100, "{file}");
    }
    folder.staunch("build main.st --emit nonsense").err(2);
    folder.staunch("build main.st --emit rust --names -o named.rs -q").out(0);
    has(&folder.read("named.rs"), &["pub const NAMES", "Main.parts.CV"]);
    has(&folder.staunch("build main.st --emit map --names").err(2), &["--emit rust"]);
}

/// A hundred groups of eight blocks: most of their code is steps of blocks, which are called where size counts.
#[test]
fn code_for_size_is_smaller_and_does_the_same() {
    let source = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/perf/programs/mixed.st"));
    let folder = Folder::with("sizes", &[("mixed.st", &source.unwrap())]);
    for backend in ["native", "rust"] {
        let [speed, size] = ["speed", "size"].map(|opt| {
            folder.staunch(&format!("build mixed.st --emit obj --backend {backend} --opt {opt} -o made.o -q")).out(0);
            folder.0.join("made.o").metadata().unwrap().len()
        });
        // The table of variables is some 75 kB of both.
        assert!(size + 30_000 < speed, "{backend}: {size} and {speed} bytes");
        folder.staunch(&format!("build mixed.st --backend {backend} --opt size -o plant -q")).out(0);
        let mut plant = Command::new(folder.0.join("plant"));
        let ran = Ran::of(plant.args(["--scans", "200", "--trace", "-"]).output().unwrap()).out(0);
        assert_eq!(ran, folder.staunch("run mixed.st --scans 200 --trace - --backend interpret").out(0), "{backend}");
    }
    has(&folder.staunch("build mixed.st --emit rust --opt size").err(2), &["`--opt` is for compiled code"]);
}

/// Heirs of one base have its METHODs in one function each.
#[test]
fn code_of_inherited_methods_is_there_once() {
    let method = |at: usize| {
        format!(
            "METHOD PUBLIC M{at} : DINT\nVAR_INPUT x : DINT; END_VAR\nVAR i : DINT; END_VAR\nFOR i := 0 TO 9 DO a[i] := a[i] + x * {at}; \
             IF a[i] > 1000 THEN a[i] := a[i] / (x + {at}); n := n + 1; END_IF; END_FOR; M{at} := n;\nEND_METHOD\n"
        )
    };
    let methods: String = (0..50).map(method).collect();
    let heir = |at: usize| {
        format!("FUNCTION_BLOCK H{at} EXTENDS Base\nVAR own : DINT; END_VAR\nown := own + {at};\nEND_FUNCTION_BLOCK\n")
    };
    let heirs: String = (0..100).map(heir).collect();
    let instances: String = (0..100).map(|at| format!("h{at} : H{at};\n")).collect();
    let calls: String = (0..100).map(|at| format!("h{at}(); r := r + h{at}.M{}(x := {at});\n", at % 50)).collect();
    let source = format!(
        "FUNCTION_BLOCK Base\nVAR n : DINT; a : ARRAY[0..9] OF DINT; END_VAR\n{methods}END_FUNCTION_BLOCK\n{heirs}\
         PROGRAM Main\nVAR {instances} r : DINT; END_VAR\n{calls}END_PROGRAM\n"
    );
    let folder = Folder::with("heirs", &[("main.st", &source)]);
    folder.staunch("build main.st --emit obj -o made.o -q").out(0);
    let size = folder.0.join("made.o").metadata().unwrap().len();
    assert!(size < 80_000, "{size} bytes");
    let run = |backend| folder.staunch(&format!("run main.st --scans 5 --vars r --trace - --backend {backend}")).out(0);
    assert_eq!(run("native"), run("interpret"));
}

#[test]
fn output_is_the_same_byte_for_byte() {
    let folder = Folder::with("same", &[("main.st", COUNTER)]);
    for kind in ["rust", "map", "header", "obj"] {
        let build = || {
            folder.staunch(&format!("build main.st --emit {kind} -o made -q")).out(0);
            std::fs::read(folder.0.join("made")).unwrap()
        };
        assert_eq!(build(), build(), "{kind}");
    }
}

#[test]
fn an_executable_takes_the_flags_of_run() {
    let folder = Folder::with("exe", &[("main.st", COUNTER), ("in.csv", "scan,pulse\n1,TRUE\n2,FALSE\n3,TRUE\n")]);
    folder.staunch("build main.st -o plant -q").out(0);
    let plant = |arguments: &str| {
        let mut command = Command::new(folder.0.join("plant"));
        Ran::of(command.args(arguments.split_whitespace()).current_dir(&folder.0).output().unwrap())
    };
    let expected = folder.staunch("run main.st --stimulus in.csv --trace -").out(0);
    assert_eq!(plant("--stimulus in.csv --trace -").out(0), expected);
    plant("--nonsense").err(2);
    let version = format!("Main (main.st), compiled by Staunch {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(plant("--version").out(0), version);
    has(&plant("--help").out(0), &["--from", "--message-format", ".html"]);
    plant("--to 3 --trace out.html").out(0);
    has(&folder.read("out.html"), &["<!doctype html>", "\"name\":\"parts.CV\""]);
}

#[test]
#[cfg(unix)]
fn an_executable_runs_until_it_is_stopped() {
    let folder = Folder::with("stopped", &[("main.st", COUNTER)]);
    folder.staunch("build main.st -o plant -q").out(0);
    let mut command = Command::new(folder.0.join("plant"));
    let child = command.arg("--cycle").arg("5ms").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(300));
    let stop = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(stop.success());
    let ran = Ran::of(child.wait_with_output().unwrap());
    has(&format!("{}{}", ran.out, ran.err), &["scans"]);
    assert_eq!(ran.code, 0);
}

/// A command that interrupts end, also where the tests run in the background of a shell, which ignores them.
#[cfg(unix)]
fn heeding_interrupts(command: &Command) -> Command {
    let mut heeding = Command::new("env");
    heeding.arg("--default-signal=INT").arg(command.get_program()).args(command.get_args());
    heeding.envs(command.get_envs().filter_map(|it| Some((it.0, it.1?))));
    if let Some(folder) = command.get_current_dir() {
        heeding.current_dir(folder);
    }
    heeding
}

/// A scan that would take hours: Ctrl-C still ends it.
#[test]
#[cfg(unix)]
fn an_interrupt_ends_a_scan_that_does_not_end() {
    use std::os::unix::process::ExitStatusExt;
    use std::time::{Duration, Instant};
    let endless = "PROGRAM Main VAR n : LINT; END_VAR WHILE n >= 0 DO n := (n + 1) MOD 1000; END_WHILE END_PROGRAM";
    let folder = Folder::with("endless", &[("main.st", endless)]);
    folder.staunch("build main.st -o native -q").out(0);
    folder.staunch("build main.st -o rust --backend rust -q").out(0);
    let budget = format!("--loop-budget {}", u64::MAX);
    let built = |name: &str| {
        let mut command = Command::new(folder.0.join(name));
        command.args(budget.split(' '));
        command
    };
    let run = |more: &str| folder.command(&format!("run main.st -q {budget} {more}"));
    let commands = [
        ("native executable", built("native")),
        ("rust executable", built("rust")),
        ("native", run("--realtime")),
        ("interpret", run("--realtime --backend interpret")),
        ("native, virtual", run("")),
        ("interpret, virtual", run("--backend interpret")),
    ];
    for (name, command) in commands {
        let mut command = heeding_interrupts(&command);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(700));
        assert!(child.try_wait().unwrap().is_none(), "{name} ended too early");
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        let asked = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            if asked.elapsed() > Duration::from_secs(20) {
                child.kill().unwrap();
                panic!("{name} does not end");
            }
            std::thread::sleep(Duration::from_millis(50));
        };
        assert_eq!(status.signal(), Some(2), "{name}");
    }
}

#[test]
fn what_cannot_be_built_is_refused_with_the_way_to_go() {
    let folder = Folder::with("refused", &[("main.st", COUNTER)]);
    let narrow = folder.staunch("build main.st --emit obj --target thumbv7em-none-eabihf").err(2);
    has(&narrow, &["64-bit", "--backend rust"]);
    folder.staunch("build main.st --emit obj --target nowhere").err(2);
    for (arguments, way) in [
        ("--emit rust -g", "`--emit obj`, `lib` or `exe`"),
        ("--debug --backend rust", "`--backend native`"),
        ("-g --opt size", "does not go with `--opt`"),
        ("-g --target x86_64-pc-windows-gnu --emit obj", "`--debug` makes DWARF for Linux"),
    ] {
        has(&folder.staunch(&format!("build main.st {arguments} -o made")).err(2), &[way]);
        assert!(!folder.0.join("made").exists(), "{arguments}");
    }
    folder.write("fb.st", "FUNCTION_BLOCK F VAR a : INT; END_VAR a := 1; END_FUNCTION_BLOCK");
    has(&folder.staunch("run fb.st").err(2), &["PROGRAM"]);
}

/// A project in a folder of the machine's: its output does not show where the folder is.
#[test]
fn two_folders_make_the_same_bytes() {
    let project = |name: &str| {
        let folder = Folder::new(name);
        std::fs::create_dir_all(folder.0.join("src")).unwrap();
        folder.write("staunch.toml", "files = [\"src\"]\n");
        folder.write("src/main.st", COUNTER.replace("full := parts.Q;", "full := 6 / parts.CV > 0;"));
        folder
    };
    let folders = [project("one"), project("other_place")];
    let made = |folder: &Folder, arguments: &str| {
        folder.staunch(&format!("build {arguments} -q -A warnings -o made")).out(0);
        std::fs::read(folder.0.join("made")).unwrap()
    };
    let native =
        ["rust", "map", "header", "systemd", "obj", "lib", "exe", "obj -g", "lib -g", "exe -g", "obj --opt size"];
    let rust = ["obj --backend rust", "lib --backend rust", "exe --backend rust"];
    let others = ["obj --target aarch64", "obj --target riscv64", "obj --target x86_64-pc-windows-gnu"];
    for kind in native.into_iter().chain(rust).chain(others) {
        let arguments = format!("--emit {kind}");
        let [one, other] = folders.each_ref().map(|it| made(it, &arguments));
        assert!(one == other, "{kind} differs");
    }
    let absolute = format!("{}/src/main.st --emit map", folders[0].0.display());
    assert_eq!(made(&folders[0], &absolute), made(&folders[1], "--emit map"));
    let map = String::from_utf8(made(&folders[0], "--emit map")).unwrap();
    has(&map, &["\tsrc/main.st\n"]);
    for folder in &folders {
        has(&folder.staunch("run -q -A warnings").err(3), &["error: src/main.st:6:"]);
    }
    // From inside of it, sources are named from there.
    let inside = Folder(folders[0].0.join("src"));
    has(&inside.staunch("run -q -A warnings").err(3), &["error: main.st:6:"]);
}

/// A controller's tags are thousands of global variables, more than rustc compares in one expression.
#[test]
fn thousands_of_variables_are_compiled_as_rust() {
    let globals: String = (0..8000).map(|it| format!("    x{it} : INT;\n")).collect();
    let program = "PROGRAM Main\nx7999 := x4 + 1;\nEND_PROGRAM\n";
    let text = format!("VAR_GLOBAL\n{globals}END_VAR\n{program}");
    let folder = Folder::with("thousands_of_variables", &[("main.st", &text)]);
    has(&folder.staunch("run main.st --backend rust --scans 1 --trace -").out(0), &["x7999"]);
}
