//! Inputs and outputs of a running program: Modbus, lines, and a process image in shared memory (`docs/io.md`).

mod client;
mod emitted;
mod gpio;
mod layout;
mod modbus;
mod safe;
mod serial;
mod shared_memory;

use super::{COUNTER, Folder, Ran, has, has_tool};
use std::io::{BufRead as _, BufReader, Read as _};
use std::net::TcpListener;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::{Duration, Instant};

/// `first` and `last` are of one scan, and `torn` says that `left` and `right` were once not written together.
const PLANT: &str = "PROGRAM Main
VAR
    start AT %IX0.0 : BOOL; level AT %IW3 : INT;
    wish AT %QX0.0 : BOOL; motor AT %QX1.1 : BOOL; speed AT %QW2 : INT;
    first AT %QW20 : UINT; last AT %QW40 : UINT;
    limit AT %MW4 : INT := 50; over AT %QX2.0 : BOOL;
    left AT %MD500 : DINT; right AT %MD520 : DINT; torn AT %QX3.0 : BOOL;
    total AT %ML1000 : LINT; divisor AT %MW900 : INT := 1; n : INT;
END_VAR
motor := start OR wish;
speed := level;
first := first + 1;
last := first;
over := level > limit;
torn := torn OR left <> right;
total := total + 1;
n := 100 / divisor;
END_PROGRAM
";

/// A program that runs until it is asked to end.
struct Plant {
    child: Child,
    /// Where its server listens.
    port: u16,
    err: Option<BufReader<ChildStderr>>,
}

impl Drop for Plant {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Plant {
    /// An executable in the folder.
    fn start(folder: &Folder, name: &str, arguments: &str) -> Self {
        let mut command = Command::new(folder.0.join(name));
        command.args(arguments.split_whitespace()).current_dir(&folder.0);
        Self::spawn(command)
    }

    fn spawn(mut command: Command) -> Self {
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let err = Some(BufReader::new(child.stderr.take().unwrap()));
        Self { child, port: 0, err }
    }

    /// Waits until its server listens.
    fn listening(mut self) -> Self {
        let mut line = String::new();
        self.err.as_mut().unwrap().read_line(&mut line).unwrap();
        let address = line.trim_end().strip_prefix("note: modbus: listening on 127.0.0.1:");
        self.port = address.unwrap_or_else(|| panic!("{line}")).parse().unwrap();
        self
    }

    fn signal(&self, name: &str) {
        let process = self.child.id().to_string();
        assert!(Command::new("kill").args([name, &process]).status().unwrap().success());
    }

    /// Waits for the end, and returns what is on standard error.
    fn ended(mut self, code: i32) -> String {
        let mut text = String::new();
        self.err.take().unwrap().read_to_string(&mut text).unwrap();
        assert_eq!(self.child.wait().unwrap().code(), Some(code), "{text}");
        text
    }
}

fn built(name: &str, source: &str) -> Folder {
    let folder = Folder::with(name, &[("main.st", source)]);
    folder.staunch("build main.st -o plant -q").out(0);
    folder
}

/// Waits until something holds.
#[track_caller]
fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let limit = Instant::now() + Duration::from_secs(30);
    while !holds() {
        assert!(Instant::now() < limit, "never: {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// `mbpoll` with a program's server; `None` where it is not installed.
fn mbpoll(plant: &Plant) -> Option<impl Fn(&str) -> String + use<>> {
    if !has_tool(Command::new("mbpoll").arg("-h"), "mbpoll") {
        return None;
    }
    let port = plant.port.to_string();
    Some(move |arguments: &str| {
        let mut command = Command::new("mbpoll");
        let output = command.args(["-m", "tcp", "-0", "-1", "-p", &port]).args(arguments.split(' ')).output().unwrap();
        assert!(output.status.success(), "{arguments}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    })
}

#[test]
fn what_cannot_be_connected_is_refused() {
    let folder = Folder::with("io_refused", &[("main.st", COUNTER)]);
    folder.staunch("build main.st -o plant -q").out(0);
    let plant = |arguments: &str| {
        let mut command = Command::new(folder.0.join("plant"));
        Ran::of(command.args(arguments.split(' ')).output().unwrap()).err(2)
    };
    let run = |arguments: &str| folder.staunch(&format!("run main.st --realtime {arguments}")).err(2);
    has(&plant("--scans 1 --io modbus:127.0.0.1:0"), &["--io are for a run in real time: add --realtime"]);
    has(&folder.staunch("run main.st --scans 1 --io shm:x").err(2), &["--realtime"]);
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap();
    let answers: [&dyn Fn(&str) -> String; 2] = [&plant, &run];
    for answer in answers {
        has(&answer("--io opcua:x"), &["`opcua:x`", "write shm:NAME, modbus:ADDRESS:PORT or modbus-rtu:PORT"]);
        has(&answer("--io shm:a/b"), &["`a/b` is not a name in /dev/shm"]);
        has(&answer("--io modbus:502"), &["modbus:127.0.0.1:502"]);
        has(&answer("--io shm:x --io-stop keep"), &["write zero or hold"]);
        has(&answer("--io-stop hold"), &["--io"]);
        let text = answer(&format!("--io modbus:{address}"));
        has(&text, &["cannot listen on 127.0.0.1:", "another program listens there"]);
    }
}
