//! A program that reads from and writes to servers, as `[[modbus]]` of staunch.toml says: other programs, and pymodbus.

use super::{PLANT, Plant, built, until};
use crate::{Folder, has};
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicU16, Ordering};

/// What it reads is copied to what it writes; `lost` is what it reads where nobody answers.
const REMOTE: &str = "PROGRAM Main
VAR
    go AT %IX0.0 : BOOL; flag AT %IX0.1 : BOOL; level AT %IW10 : INT; levels AT %IW20 : ARRAY[0..2] OF INT; total AT %ID20 : REAL;
    motor AT %QX0.0 : BOOL; valve AT %QX0.1 : BOOL; speed AT %QW10 : INT; sum AT %QD20 : REAL;
END_VAR
motor := go;
valve := flag;
speed := level + levels[0] + levels[1] + levels[2];
sum := total * 2.0;
END_PROGRAM
";

/// A server that says what is written to it, and takes other values: `set TABLE NUMBER VALUE`, `get TABLE NUMBER`.
const SERVER: &str = r#"
import sys, threading
from pymodbus.server import StartTcpServer
from pymodbus.datastore import ModbusSequentialDataBlock, ModbusSlaveContext, ModbusServerContext
block = lambda: ModbusSequentialDataBlock(0, [0] * 200)
slave = ModbusSlaveContext(di=block(), co=block(), hr=block(), ir=block(), zero_mode=True)
functions = {"co": 1, "di": 2, "hr": 3, "ir": 4}
def listen():
    StartTcpServer(context=ModbusServerContext(slaves={9: slave}, single=False), address=("127.0.0.1", int(sys.argv[1])))
threading.Thread(target=listen, daemon=True).start()
for line in sys.stdin:
    word, table, number, *values = line.split()
    if word == "set":
        slave.setValues(functions[table], int(number), [int(it) for it in values])
    print(*(int(it) for it in slave.getValues(functions[table], int(number), 2)), flush=True)
"#;

/// A port where nobody listens. It lies below those that the system gives to connections (from 32768), of which one could take
/// it before the server does.
fn free_port() -> u16 {
    static NEXT: AtomicU16 = AtomicU16::new(0);
    let first = 10_000 + u16::try_from(std::process::id() % 20_000).unwrap();
    (0..1000)
        .map(|_| first + NEXT.fetch_add(1, Ordering::Relaxed))
        .find(|it| TcpListener::bind(("127.0.0.1", *it)).is_ok())
        .expect("a free port")
}

/// A server of pymodbus.
struct Server {
    child: Child,
    asks: ChildStdin,
    says: BufReader<ChildStdout>,
}

impl Server {
    /// `None` where pymodbus is not installed, which is allowed.
    fn start(port: u16) -> Option<Self> {
        let python = |script: &str| {
            let mut command = Command::new("/usr/bin/python3");
            command.args(["-c", script, &port.to_string()]).stderr(Stdio::null());
            command
        };
        if !super::has_tool(&mut python("import pymodbus.server"), "python3-pymodbus python3-serial-asyncio") {
            return None;
        }
        let mut child = python(SERVER).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let (asks, says) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
        until("pymodbus listens", || TcpStream::connect(("127.0.0.1", port)).is_ok());
        Some(Self { child, asks, says })
    }

    /// Two values of a table.
    fn ask(&mut self, line: &str) -> Vec<u16> {
        writeln!(self.asks, "{line}").unwrap();
        let mut answer = String::new();
        self.says.read_line(&mut answer).unwrap();
        answer.split_whitespace().map(|it| it.parse().unwrap()).collect()
    }

    fn end(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

/// A folder with a program whose project has this table.
fn project(name: &str, settings: &str, map: &str) -> Folder {
    let folder = Folder::with(name, &[("main.st", REMOTE)]);
    folder.write("staunch.toml", format!("[[modbus]]\n{settings}\n[modbus.map]\n{map}"));
    folder
}

const MAP: &str = "go = \"discrete-input 7\"
flag = \"input-register 2.15\"
level = \"input-register 3\"
levels = \"holding-register 20\"
total = \"input-register 4\"
\"%QX0.0\" = \"coil 1\"
valve = \"coil 2\"
speed = \"holding-register 30\"
sum = \"holding-register 31\"
";

#[test]
fn a_server_is_read_and_written() {
    let port = free_port();
    let Some(mut server) = Server::start(port) else { return };
    let settings = format!(
        "name = \"pump\"\nserver = \"127.0.0.1:{port}\"\nunit = 9\nperiod = \"5ms\"\nword-order = \"low-first\"\non-loss = \"safe\""
    );
    let folder = project("io_client", &settings, MAP);
    folder.staunch("build main.st -o plant -q").out(0);
    server.ask("set di 7 1");
    server.ask("set ir 2 32768 40");
    // 2.5 is 16#40200000.
    server.ask("set ir 4 0 16416");
    server.ask("set hr 20 1 2");
    server.ask("set hr 22 65535");
    let plant = Plant::start(&folder, "plant", "--cycle 2ms");
    until("coils are written", || server.ask("get co 1") == [1, 1]);
    until("a register is written", || server.ask("get hr 30")[0] == 42);
    // 5.0 is 16#40A00000.
    assert_eq!(server.ask("get hr 31"), [0, 0x40A0]);
    server.ask("set ir 3 65526");
    until("a register follows", || server.ask("get hr 30")[0] == 0xFFFF - 7);
    server.end();
    // What it writes while nobody answers is written to who answers then; its inputs are safe meanwhile.
    std::thread::sleep(std::time::Duration::from_millis(100));
    let mut server = Server::start(port).unwrap();
    until("the new server is found", || server.ask("get co 1") == [0, 0] && server.ask("get hr 40") == [0, 0]);
    server.ask("set di 7 1");
    until("the new server is read", || server.ask("get co 1") == [1, 0]);
    plant.signal("-TERM");
    let said = plant.ended(0);
    has(
        &said,
        &[
            "warning: modbus pump (127.0.0.1:",
            "; inputs are 0 and FALSE",
            "it answers again, after ",
            "note: modbus pump (",
        ],
    );
    // Outputs are safe at the end.
    assert_eq!(server.ask("get co 1"), [0, 0]);
    server.end();
}

/// Both sides are programs of ours; the second reads what the first writes.
#[test]
fn one_program_reads_another() {
    let first = built("io_client_first", PLANT);
    let server = Plant::start(&first, "plant", "--cycle 2ms --io modbus:127.0.0.1:0").listening();
    let settings = format!("server = \"127.0.0.1:{}\"\nperiod = \"2ms\"", server.port);
    let map =
        "level = \"holding-register 1028\"\nmotor = \"coil 0\"\ngo = \"coil 16\"\nspeed = \"holding-register 600\"\n";
    let folder = project("io_client_second", &settings, map);
    let trace = "--realtime --cycle 2ms --scans 400 --io-stop hold --trace - --vars go,level,speed";
    let out = folder.staunch(&format!("run main.st {trace}")).out(0);
    // The limit of the first.
    has(&out, &[",50,50\n"]);
    server.signal("-TERM");
    server.ended(0);
}

#[test]
fn a_server_that_does_not_answer_ends_a_run_that_needs_it() {
    let port = free_port();
    let settings = |loss: &str| format!("name = \"pump\"\nserver = \"127.0.0.1:{port}\"\non-loss = \"{loss}\"");
    let folder = project("io_client_lost", &settings("fault"), "level = \"input-register 3\"\n");
    let run = "run main.st --realtime --cycle 2ms";
    let lost = folder.staunch(&format!("{run} --scans 2000")).err(3);
    has(&lost, &["error: connection: modbus pump (127.0.0.1:", "nobody listens there (on-loss = \"fault\")"]);
    let lost = folder.staunch(&format!("{run} --scans 2000 --message-format json")).out(3);
    has(&lost, &["\"kind\":\"connection\",\"connection\":\"modbus pump ("]);
    folder.write(
        "staunch.toml",
        format!("[[modbus]]\n{}\n[modbus.map]\nspeed = \"holding-register 3\"\n", settings("hold")),
    );
    has(&folder.staunch(&format!("{run} --scans 100")).err(0), &["inputs stay as they are"]);
    // The virtual clock reads and writes nothing outside of the program.
    assert!(!folder.staunch("run main.st --scans 2").err(0).contains("pump"));
}

/// A server that refuses what is written to it is lost, too: inputs that are to be safe then do not come and go.
#[test]
fn a_refused_request_is_a_loss() {
    let port = free_port();
    let Some(mut server) = Server::start(port) else { return };
    server.ask("set ir 3 7");
    let settings = format!("server = \"127.0.0.1:{port}\"\nunit = 9\nperiod = \"2ms\"\non-loss = \"safe\"");
    let folder =
        project("io_client_refused", &settings, "level = \"input-register 3\"\nspeed = \"holding-register 300\"\n");
    let run = "run main.st --realtime --cycle 2ms --scans 400 --trace trace.csv --vars level";
    let said = folder.staunch(run).err(0);
    has(&said, &["the server refuses holding-register 300 to 300: illegal data address (2); inputs are 0 and FALSE"]);
    let trace = folder.read("trace.csv");
    let last: Vec<&str> = trace.lines().rev().take(200).collect();
    assert!(last.iter().all(|it| it.ends_with(",0")), "{last:?}");
    server.end();
}

#[test]
fn a_wrong_mapping_is_reported_at_its_line() {
    let server = "server = \"10.0.0.1:502\"";
    for (settings, map, expected) in [
        (server, "levle = \"input-register 3\"\n", "staunch.toml:4: `levle`: "),
        (server, "go = \"coil 1\"\nlevel = \"coil 3\"\n", "staunch.toml:5: `level`: it has more bits than one"),
        (server, "total = \"input-register 3\"\n", "say which comes first, word-order"),
        ("server = \"10.0.0.1\"", "", "staunch.toml:2: `10.0.0.1` is not an address and port"),
        (server, "", "no variable is read or written there"),
        ("server = \"a:1\"\nunit = 300", "", "staunch.toml:3: `unit` is a number from 0 to 255"),
        ("server = \"a:1\"\nperiod = \"fast\"", "", "staunch.toml:3: `period`"),
        ("servre = \"a:1\"", "", "did you mean `server`?"),
        ("unit = 1", "", "needs a server"),
        ("server = \"a:1\"\non-loss = \"stop\"", "", "`on-loss` must be one of \"hold\", \"safe\", \"fault\""),
    ] {
        let folder = project("io_client_wrong", settings, map);
        for call in ["check main.st", "build main.st -o plant", "run main.st"] {
            has(&folder.staunch(call).err(2), &[expected]);
        }
    }
}

/// What is a slave to us is one to a master that others have written.
#[test]
fn mbpoll_reads_and_writes_a_program() {
    let folder = built("io_mbpoll", PLANT);
    let plant = Plant::start(&folder, "plant", "--cycle 2ms --io modbus:127.0.0.1:0").listening();
    let Some(mbpoll) = super::mbpoll(&plant) else { return };
    mbpoll("-t 4 -r 1028 127.0.0.1 -- 70");
    has(&mbpoll("-t 4 -r 1028 127.0.0.1"), &["[1028]: \t70"]);
    mbpoll("-t 0 -r 0 127.0.0.1 -- 1");
    until("the output follows", || mbpoll("-t 0 -r 9 127.0.0.1").contains("[9]: \t1"));
    plant.signal("-TERM");
    plant.ended(0);
}
