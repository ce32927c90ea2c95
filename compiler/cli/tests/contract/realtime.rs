//! Runs in real time: figures, overruns, watchdog, priority.

use super::{COUNTER, Folder, Ran, has};
use serde_json::Value;
use std::io::{BufRead as _, BufReader};
use std::os::unix::net::UnixDatagram;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Duration;

/// A scan of some milliseconds, whatever the machine.
const LONG: &str = "PROGRAM Main
VAR n, i : DINT; END_VAR
FOR i := 1 TO 8000000 DO n := n * 3 + i; END_FOR
END_PROGRAM
";

fn figures(folder: &Folder, arguments: &str) -> Value {
    let out = folder.staunch(&format!("run main.st --realtime --message-format json {arguments}")).out(0);
    serde_json::from_str(out.lines().last().unwrap()).unwrap()
}

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn a_scan_sees_when_it_begins_and_figures_say_how_late() {
    let folder = Folder::with("late", &[("main.st", COUNTER)]);
    let run = figures(&folder, "--cycle 2ms --scans 20 --trace t.csv --vars full");
    let program = &run["programs"][0];
    assert_eq!((program["name"].as_str(), number(&program["period_ns"])), (Some("Main"), 2_000_000));
    assert_eq!((number(&run["scans"]), number(&program["scans"])), (20, 20));
    for figure in ["late_ns", "scan_ns", "jitter_ns"] {
        let distribution = ["min", "p50", "p99", "p99.9", "max"].map(|it| number(&program[figure][it]));
        assert!(distribution.is_sorted() && distribution[4] > 0, "{figure}: {distribution:?}");
    }
    // No clock wakes a process in no time.
    assert!(number(&program["late_ns"]["min"]) > 0);
    let trace = folder.read("t.csv");
    let times: Vec<f64> = trace.lines().skip(1).map(|it| it.split(',').nth(1).unwrap().parse().unwrap()).collect();
    assert_eq!(times.len(), 20);
    let is_late = |(at, time): (usize, &f64)| at as f64 * 2.0 < *time;
    assert!(times.iter().enumerate().all(is_late), "{times:?}");
    let text = folder.staunch("run main.st --realtime --cycle 1ms --scans 5").out(0);
    has(&text, &["5 scans of Main", "in real time", "Main: every 1.00 ms, 5 scans", "p99.9", "jitter"]);
}

#[test]
fn programs_have_figures_of_their_own() {
    let source = "PROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
TASK fast(INTERVAL := T#1ms, PRIORITY := 1);
TASK slow(INTERVAL := T#10ms, PRIORITY := 2);
PROGRAM a WITH slow : P;
PROGRAM b WITH fast : P;
END_RESOURCE END_CONFIGURATION
";
    let folder = Folder::with("two", &[("main.st", source)]);
    let run = figures(&folder, "--scans 110");
    let programs = run["programs"].as_array().unwrap();
    let names: Vec<_> = programs.iter().map(|it| it["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["b", "a"]);
    let [fast, slow] = [0, 1].map(|at| number(&programs[at]["scans"]));
    assert_eq!(fast + slow, 110);
    assert!((5..=60).contains(&slow), "{run}");
}

#[test]
fn an_overrun_is_counted_and_followed_by_what_was_asked_for() {
    let folder = Folder::with("overrun", &[("main.st", LONG)]);
    let skipped = figures(&folder, "--cycle 1ms --scans 5");
    let program = &skipped["programs"][0];
    assert_eq!((number(&skipped["overruns"]), number(&program["overruns"])), (5, 5));
    assert!(number(&program["missed"]) > 4, "{skipped}");
    let caught_up = figures(&folder, "--cycle 1ms --scans 5 --overrun catch-up");
    let program = &caught_up["programs"][0];
    assert_eq!((number(&program["overruns"]), number(&program["missed"])), (5, 0));
    // Those that follow are later and later.
    assert!(number(&program["late_ns"]["max"]) > number(&program["scan_ns"]["max"]), "{caught_up}");
    for backend in ["native", "rust"] {
        let ended = folder.staunch(&format!(
            "run main.st --realtime --cycle 1ms --scans 5 --overrun fault --backend {backend} --retain r"
        ));
        has(&ended.err(3), &["overrun: a scan took ", " of 1.00 ms (scan 1, program Main, --overrun fault)"]);
    }
    let again = folder.staunch("run main.st --scans 1 --retain r");
    has(&again.err, &["overrun: a scan took"]);
    let json = folder.staunch("run main.st --realtime --cycle 1ms --overrun fault --message-format json");
    assert_eq!(json.code, 3);
    has(&json.out, &["\"reason\":\"fault\"", "\"kind\":\"overrun\"", "\"late_ns\":", "\"took_ns\":"]);
}

#[test]
fn a_watchdog_ends_a_scan_that_does_not() {
    let endless = "PROGRAM Main VAR n : DINT; END_VAR WHILE TRUE DO n := n + 1; END_WHILE END_PROGRAM";
    let folder = Folder::with("endless", &[("main.st", COUNTER), ("endless.st", endless)]);
    let call = "run endless.st --realtime --watchdog 100ms --loop-budget 1000000000000000";
    has(&folder.staunch(call).err(3), &["error: watchdog: no scan has ended for 100 ms"]);
    folder.staunch("run main.st --realtime --watchdog 10s --scans 30 --cycle 5ms -q").out(0);
    let short = folder.staunch("run main.st --realtime --watchdog 5ms --cycle 10ms");
    has(&short.err(2), &["--watchdog 5.00 ms is not longer than 10.0 ms"]);
    // A watchdog of the machine: what it is shown, and that it is put off at the end.
    folder.write("device", "");
    folder.staunch("run main.st --realtime --watchdog-device device --scans 300 --cycle 5ms -q").out(0);
    let shown = folder.read("device");
    assert!(shown.starts_with('1') && shown.ends_with("1V"), "{shown}");
    let missing = folder.staunch("run main.st --realtime --watchdog-device missing");
    has(&missing.err(2), &["cannot open missing"]);
}

#[test]
fn a_service_manager_is_told_of_the_start_of_scans_and_of_the_end() {
    let folder = Folder::with("notify", &[("main.st", COUNTER)]);
    let socket = UnixDatagram::bind(folder.0.join("socket")).unwrap();
    socket.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    let mut command = folder.command("run main.st --realtime --scans 60 --cycle 5ms -q");
    command.env("NOTIFY_SOCKET", folder.0.join("socket")).env("WATCHDOG_USEC", "100000").env_remove("WATCHDOG_PID");
    let mut child = command.spawn().unwrap();
    let mut told = Vec::new();
    while told.last().is_none_or(|it| it != "STOPPING=1") {
        let mut bytes = [0; 64];
        let length = socket.recv(&mut bytes).unwrap();
        told.push(String::from_utf8_lossy(&bytes[..length]).into_owned());
    }
    assert!(child.wait().unwrap().success());
    assert_eq!(told[0], "READY=1");
    assert!(told.len() > 3 && told[1..told.len() - 1].iter().all(|it| it == "WATCHDOG=1"), "{told:?}");
}

#[test]
fn signals_ask_for_figures_and_for_an_end() {
    let source = "PROGRAM Main VAR RETAIN n : DINT; END_VAR n := n + 1; END_PROGRAM";
    let folder = Folder::with("signals", &[("main.st", source)]);
    folder.staunch("build main.st -o plant -q").out(0);
    let mut command = Command::new(folder.0.join("plant"));
    command.args(["--retain", "kept", "--cycle", "2ms"]).current_dir(&folder.0);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while !folder.0.join("kept").exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    let process = child.id().to_string();
    let signal = |name: &str| assert!(Command::new("kill").args([name, &process]).status().unwrap().success());
    signal("-USR1");
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    has(&lines.next().unwrap().unwrap(), &["Main: every 2.00 ms"]);
    signal("-HUP");
    let ended = Ran::of(child.wait_with_output().unwrap());
    has(&ended.out(0), &["in real time", "p99.9"]);
    assert!(lines.map(Result::unwrap).any(|it| it.contains("jitter")));
}

/// Where the system refuses it, what to type is said.
#[test]
#[cfg(target_os = "linux")]
fn a_priority_is_taken_or_refused_with_a_way() {
    let folder = Folder::with("priority", &[("main.st", COUNTER)]);
    let mut child = folder
        .command("run main.st --realtime --priority 10 --trace t.csv")
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let ended = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break Some(status);
        }
        if std::fs::read_to_string(folder.0.join("t.csv")).is_ok_and(|it| it.lines().count() > 3) {
            break None;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    if let Some(status) = ended {
        assert_eq!(status.code(), Some(2));
        let text = Ran::of(child.wait_with_output().unwrap()).err;
        has(&text, &["(--priority)", "setcap", "limits.conf", "--emit systemd"]);
        return;
    }
    let process = PathBuf::from(format!("/proc/{}", child.id()));
    // Fields 40 and 41 of `stat` are the priority and the policy, which is 1 for SCHED_FIFO.
    let is_urgent = |thread: PathBuf| {
        let stat = std::fs::read_to_string(thread.join("stat")).unwrap_or_default();
        let fields: Vec<_> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
        fields.get(37..39) == Some(&["10", "1"])
    };
    let threads = std::fs::read_dir(process.join("task")).unwrap().map(|it| it.unwrap().path());
    let urgent = threads.filter(|it| is_urgent(it.clone())).count();
    let status = std::fs::read_to_string(process.join("status")).unwrap();
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(urgent, 1, "the thread of the scans alone");
    let locked = status.lines().find_map(|it| it.strip_prefix("VmLck:")).unwrap();
    assert!(!locked.trim().starts_with("0 "), "{locked}");
}

#[test]
fn what_is_for_real_time_alone_is_refused_elsewhere() {
    let folder = Folder::with("virtual", &[("main.st", COUNTER)]);
    folder.staunch("build main.st -o plant -q").out(0);
    for argument in ["--priority 5", "--overrun fault", "--watchdog 1s", "--cpu 0"] {
        has(&folder.staunch(&format!("run main.st --scans 1 {argument}")).err(2), &["--realtime"]);
        let mut plant = Command::new(folder.0.join("plant"));
        let ran = plant.args(["--scans", "1"]).args(argument.split(' ')).output().unwrap();
        has(&Ran::of(ran).err(2), &["are for a run in real time: add --realtime"]);
    }
    has(&folder.staunch("run main.st --realtime --priority 99").err(2), &["write a number from 1 to 98"]);
    has(&folder.staunch("run main.st --realtime --overrun stop").err(2), &["write skip, catch-up or fault"]);
    let refused = folder.staunch("run main.st --realtime --cpu 5000");
    has(&refused.err, &["processor 5000"]);
    // A run that has not begun has no figures.
    assert_eq!((refused.code, refused.out.as_str()), (2, ""));
}

#[test]
fn a_unit_for_systemd_is_written() {
    let source = "PROGRAM Main VAR RETAIN n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu TASK t(INTERVAL := T#500ms, PRIORITY := 1); PROGRAM Press WITH t : Main; END_RESOURCE END_CONFIGURATION
";
    let folder = Folder::with("unit", &[("main.st", COUNTER), ("press.st", source)]);
    folder.staunch("build main.st --emit systemd -o plant.service -q").out(0);
    let unit = folder.read("plant.service");
    has(&unit, &["ExecStart=/usr/local/bin/plant --realtime --quiet --priority 50 --watchdog 1s\n", "Type=notify"]);
    has(&unit, &["LimitRTPRIO=51", "LimitMEMLOCK=infinity", "RestartPreventExitStatus=3"]);
    folder.staunch("build press.st --emit systemd -q").out(0);
    let unit = folder.read("press.service");
    has(&unit, &["--watchdog 5s --retain /var/lib/press/retained\n", "StateDirectory=press", "WatchdogSec=10"]);
    has(&unit, &["Description=Press"]);
    folder.write("staunch.toml", "cycle = \"500ms\"\n");
    let written = folder.command("build main.st --emit systemd -q -o").arg("my plant.service").status().unwrap();
    assert!(written.success());
    let unit = folder.read("my plant.service");
    has(&unit, &["ExecStart=/usr/local/bin/my_plant --realtime --quiet --cycle 500000000ns ", "--watchdog 5s\n"]);
    has(&unit, &["StateDirectory=my_plant\n", "DynamicUser=yes\nStateDirectory"]);
    let devices = "[[modbus]]\nport = \"/dev/ttyUSB0\"\n[modbus.map]\n\"%IW0\" = \"input-register 0\"\n
[[gpio]]\nvariable = \"%QX0.0\"\nchip = \"gpiochip0\"\nline = 4\n";
    folder.write("staunch.toml", devices);
    folder.write("lines.st", "PROGRAM Main VAR a AT %IW0 : INT; b AT %QX0.0 : BOOL; END_VAR b := a > 3; END_PROGRAM");
    folder.staunch("build lines.st --emit systemd -q").out(0);
    has(&folder.read("lines.service"), &["\nSupplementaryGroups=dialout gpio\n"]);
}
