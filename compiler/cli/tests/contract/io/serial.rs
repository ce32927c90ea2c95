//! Modbus RTU: programs on a line, which is a pair of pseudo terminals, with units that pymodbus plays.

mod answers;
mod server;

use super::modbus::{Client, DISCRETE, INPUT};
use super::{Plant, has_tool, until};
use crate::{Folder, has};
use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// `strange` says that it once saw what no unit has had.
const PLANT: &str = "PROGRAM Main
VAR
    go AT %IX0.0 : BOOL; level AT %IW10 : INT; levels AT %IW20 : ARRAY[0..2] OF INT; other AT %IW30 : INT;
    motor AT %QX0.0 : BOOL; speed AT %QW10 : INT; sum AT %QW20 : INT; strange AT %QX9.0 : BOOL;
END_VAR
motor := go;
speed := level + levels[0] + levels[1] + levels[2];
sum := other + 1;
strange := strange OR level <> 0 AND level <> 1234 OR other <> 0 AND other <> 4321;
END_PROGRAM
";

/// Units on a port that take other values, and show what was written to them: `UNIT set TABLE NUMBER VALUE`, `UNIT get TABLE NUMBER`.
const UNITS: &str = r#"
import sys, threading
from pymodbus.server import StartSerialServer
from pymodbus.transaction import ModbusRtuFramer
from pymodbus.datastore import ModbusSequentialDataBlock, ModbusSlaveContext, ModbusServerContext
block = lambda: ModbusSequentialDataBlock(0, [0] * 200)
unit = lambda: ModbusSlaveContext(di=block(), co=block(), hr=block(), ir=block(), zero_mode=True)
units = {int(it): unit() for it in sys.argv[2:]}
functions = {"co": 1, "di": 2, "hr": 3, "ir": 4}
def listen():
    context = ModbusServerContext(slaves=units, single=False)
    StartSerialServer(context=context, framer=ModbusRtuFramer, port=sys.argv[1], baudrate=19200, ignore_missing_slaves=True)
threading.Thread(target=listen, daemon=True).start()
for line in sys.stdin:
    number, word, table, first, *values = line.split()
    unit = units[int(number)]
    if word == "set":
        unit.setValues(functions[table], int(first), [int(it) for it in values])
    print(*(int(it) for it in unit.getValues(functions[table], int(first), 2)), flush=True)
"#;

/// A line from `a` in a folder, where a program is, to `b`, where its units are.
struct Line {
    socat: Child,
    /// Held open, so that the line stays when a program or a unit leaves it.
    ends: [File; 2],
}

fn opened(path: &Path) -> Option<File> {
    const NO_TERMINAL: i32 = 0o400;
    const NO_WAITING: i32 = 0o4000;
    File::options().read(true).write(true).custom_flags(NO_TERMINAL | NO_WAITING).open(path).ok()
}

impl Line {
    /// `None` where a tool is not installed.
    fn start(folder: &Folder) -> Option<Self> {
        let mut python = Command::new("/usr/bin/python3");
        python.args(["-c", "import pymodbus.server, serial_asyncio"]);
        if !has_tool(Command::new("socat").arg("-V"), "socat")
            || !has_tool(&mut python, "python3-pymodbus python3-serial-asyncio")
        {
            return None;
        }
        let paths = ["a", "b"].map(|it| folder.0.join(it));
        let end = |path: &Path| format!("PTY,raw,echo=0,link={}", path.display());
        let socat = Command::new("socat").args(paths.each_ref().map(|it| end(it))).spawn().unwrap();
        let mut found = Vec::new();
        until("the line exists", || {
            found = paths.iter().filter_map(|it| opened(it)).collect();
            found.len() == 2
        });
        Some(Self { socat, ends: found.try_into().unwrap() })
    }

    /// Sends from `b`, also where a unit just does so.
    fn send(&mut self, bytes: &[u8]) {
        let mut left = bytes;
        until("the line takes bytes", || {
            left = &left[self.ends[1].write(left).unwrap_or(0)..];
            left.is_empty()
        });
    }

    /// What has come to `b`.
    fn receive(&mut self) -> Vec<u8> {
        let mut bytes = [0; 64];
        let count = self.ends[1].read(&mut bytes).unwrap_or(0);
        bytes[..count].to_vec()
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        let _ = self.socat.kill();
        let _ = self.socat.wait();
    }
}

fn crc(bytes: &[u8]) -> u16 {
    let shifted = |crc: u16| if crc & 1 == 0 { crc >> 1 } else { crc >> 1 ^ 0xA001 };
    bytes.iter().fold(0xFFFF, |crc, byte| (0..8).fold(crc ^ u16::from(*byte), |crc, _| shifted(crc)))
}

/// With its CRC.
fn framed(body: &[u8]) -> Vec<u8> {
    [body, &crc(body).to_le_bytes()].concat()
}

fn is_framed(bytes: &[u8]) -> bool {
    bytes.len() > 3 && crc(bytes) == 0
}

/// Units of pymodbus.
struct Units {
    child: Child,
    asks: ChildStdin,
    says: BufReader<ChildStdout>,
}

impl Units {
    fn start(folder: &Folder, numbers: &[&str]) -> Self {
        let mut command = Command::new("/usr/bin/python3");
        command.args(["-c", UNITS]).arg(folder.0.join("b")).args(numbers);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let (asks, says) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
        Self { child, asks, says }
    }

    /// Two values of a table of a unit.
    fn ask(&mut self, line: &str) -> Vec<u16> {
        writeln!(self.asks, "{line}").unwrap();
        let mut answer = String::new();
        self.says.read_line(&mut answer).unwrap();
        answer.split_whitespace().map(|it| it.parse().unwrap()).collect()
    }
}

impl Drop for Units {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Two units on a line, the second of which keeps its inputs when it is lost.
fn built(name: &str, timeout: &str) -> Folder {
    let folder = Folder::with(name, &[("main.st", PLANT)]);
    let port = folder.0.join("a").display().to_string();
    let pump = format!(
        "name = \"pump\"\nport = \"{port}\"\nunit = 3\nperiod = \"5ms\"\ntimeout = \"{timeout}\"\non-loss = \"safe\""
    );
    let meter = format!("port = \"{port}\"\nunit = 5\nperiod = \"20ms\"\ntimeout = \"{timeout}\"");
    folder.write(
        "staunch.toml",
        format!(
            "[[modbus]]\n{pump}\n[modbus.map]\ngo = \"discrete-input 7\"\nlevel = \"input-register 3\"\n\
             levels = \"holding-register 20\"\nmotor = \"coil 1\"\nspeed = \"holding-register 30\"\n\
             [[modbus]]\n{meter}\n[modbus.map]\nother = \"input-register 3\"\nsum = \"holding-register 30\"\n"
        ),
    );
    folder.staunch("build main.st -o plant -q").out(0);
    folder
}

/// Values that the program is to have: of unit 3, and of unit 5.
fn set(units: &mut Units) {
    units.ask("3 set di 7 1");
    units.ask("3 set ir 3 1234");
    units.ask("3 set hr 20 1 2");
    units.ask("3 set hr 22 65535");
    units.ask("5 set ir 3 4321");
}

fn run(folder: &Folder) -> Plant {
    Plant::start(folder, "plant", "--cycle 2ms --io modbus:127.0.0.1:0").listening()
}

/// How many requests were not answered, as the notes at the end say.
fn unanswered(said: &str) -> usize {
    let counts = said.lines().filter_map(|it| it.strip_suffix(" not")?.rsplit(' ').next()?.parse::<usize>().ok());
    counts.sum()
}

#[test]
fn units_on_one_line_are_read_and_written() {
    let folder = built("io_serial", "1s");
    let Some(_line) = Line::start(&folder) else { return };
    let mut units = Units::start(&folder, &["3", "5"]);
    set(&mut units);
    let plant = run(&folder);
    let mut client = Client::of(&plant);
    until("unit 3 is written", || units.ask("3 get co 1")[0] == 1 && units.ask("3 get hr 30")[0] == 1236);
    until("unit 5 is written", || units.ask("5 get hr 30")[0] == 4322);
    // Each unit has only its own.
    assert_eq!((units.ask("5 get co 1"), units.ask("3 get hr 31")), (vec![0, 0], vec![0, 0]));
    units.ask("3 set hr 20 11 2");
    until("a register follows", || units.ask("3 get hr 30")[0] == 1246);
    drop(units);
    until("inputs of unit 3 are safe", || client.words(INPUT, 10, 1) == [0] && !client.bit(DISCRETE, 0));
    assert_eq!(client.words(INPUT, 30, 1), [4321]);
    let mut units = Units::start(&folder, &["3", "5"]);
    set(&mut units);
    until("unit 3 is written again", || units.ask("3 get hr 30")[0] == 1236);
    until("unit 5 is written again", || units.ask("5 get hr 30")[0] == 4322);
    plant.signal("-TERM");
    let said = plant.ended(0);
    let place = folder.0.join("a").display().to_string();
    let (pump, meter) = (format!("modbus pump ({place} unit 3): "), format!("modbus {place} unit 5: "));
    has(
        &said,
        &["warning: ", "no answer in time; inputs are 0 and FALSE", "no answer in time; inputs stay as they are"],
    );
    has(&said, &[&format!("{pump}it answers again, after "), &format!("{meter}it answers again, after ")]);
    has(&said, &[&format!("note: {pump}"), &format!("note: {meter}")]);
    // Outputs are safe at the end.
    assert_eq!((units.ask("3 get co 1")[0], units.ask("3 get hr 30")[0], units.ask("5 get hr 30")[0]), (0, 0, 0));
}

/// One unit does not answer: the other one is still read and written.
#[test]
fn a_unit_that_is_silent_leaves_the_line_to_others() {
    let folder = built("io_serial_silent", "1s");
    let Some(_line) = Line::start(&folder) else { return };
    let mut units = Units::start(&folder, &["5"]);
    let plant = run(&folder);
    for level in [4000_u16, 4100, 4200] {
        units.ask(&format!("5 set ir 3 {level}"));
        until("unit 5 follows", || units.ask("5 get hr 30")[0] == level + 1);
    }
    plant.signal("-TERM");
    has(&plant.ended(0), &["no answer in time; inputs are 0 and FALSE"]);
}

/// Waits for a request to one of the units, and returns it.
fn asked(line: &mut Line) -> Vec<u8> {
    let mut bytes: Vec<u8> = Vec::new();
    until("the program asks", || {
        bytes.extend(line.receive());
        bytes.len() >= 8 && is_framed(&bytes[bytes.len() - 8..])
    });
    bytes.split_off(bytes.len() - 8)
}

/// Each request is answered with garbage, most of which is an answer but for the CRC; then the units are there.
#[test]
fn garbage_on_the_line_is_no_value() {
    let folder = built("io_serial_garbage", "100ms");
    let Some(mut line) = Line::start(&folder) else { return };
    let plant = run(&folder);
    let mut random = 1_u64;
    for turn in 0..40 {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let request = asked(&mut line);
        let noise = random.to_be_bytes();
        let mut bytes = match request[1] {
            2 => framed(&[request[0], 2, 1, noise[0]]),
            function => framed(&[request[0], function, 2, noise[0], noise[1]]),
        };
        match turn % 4 {
            0 => bytes = noise[..1 + turn / 4 % 8].to_vec(),
            at => bytes[at + 1] ^= 1 << (noise[2] % 8),
        }
        line.send(&bytes);
    }
    let mut units = Units::start(&folder, &["3", "5"]);
    set(&mut units);
    until("both are written", || units.ask("3 get hr 30")[0] == 1236 && units.ask("5 get hr 30")[0] == 4322);
    let mut client = Client::of(&plant);
    assert!(!client.bit(super::modbus::COILS, 72), "a value of no unit");
    plant.signal("-TERM");
    let said = plant.ended(0);
    assert!(unanswered(&said) > 10, "{said}");
}

#[test]
fn a_port_that_vanishes_is_opened_again() {
    let folder = built("io_serial_port", "1s");
    let Some(line) = Line::start(&folder) else { return };
    let mut units = Units::start(&folder, &["3", "5"]);
    set(&mut units);
    let plant = run(&folder);
    until("unit 3 is written", || units.ask("3 get hr 30")[0] == 1236);
    // One program at a time has a port.
    let place = folder.0.join("a").display().to_string();
    has(
        &Plant::start(&folder, "plant", "--realtime --cycle 2ms --scans 200").ended(0),
        &["another running program has the port"],
    );
    drop((units, line));
    let _ = std::fs::remove_file(&place);
    let mut client = Client::of(&plant);
    until("inputs of unit 3 are safe", || client.words(INPUT, 10, 1) == [0]);
    let Some(_line) = Line::start(&folder) else { return };
    let mut units = Units::start(&folder, &["3", "5"]);
    set(&mut units);
    until("unit 3 is written again", || units.ask("3 get hr 30")[0] == 1236);
    until("unit 5 is written again", || units.ask("5 get hr 30")[0] == 4322);
    plant.signal("-TERM");
    has(&plant.ended(0), &["no such port; inputs are 0 and FALSE", "it answers again, after "]);
}

#[test]
fn a_port_that_a_run_needs_ends_it() {
    let folder = Folder::with("io_serial_fault", &[("main.st", PLANT)]);
    for (port, expected) in [("/nowhere/tty", "no such port"), ("/dev/null", "it is not a serial port")] {
        let settings =
            format!("[[modbus]]\nport = \"{port}\"\non-loss = \"fault\"\n[modbus.map]\nlevel = \"coil 0\"\n");
        folder.write("staunch.toml", settings.replace("coil", "input-register"));
        let lost = folder.staunch("run main.st --realtime --cycle 2ms --scans 2000").err(3);
        has(&lost, &[&format!("error: connection: modbus {port} unit 1: {expected} (on-loss = \"fault\")")]);
    }
}

#[test]
fn a_wrong_line_is_reported_at_its_setting() {
    let map = "[modbus.map]\nlevel = \"input-register 3\"\n";
    let port = "port = \"/dev/ttyS0\"";
    for (settings, expected) in [
        (
            format!("{port}\nserver = \"a:1\"\n"),
            "staunch.toml:2: a server has an address or a serial port, and not both",
        ),
        ("port = \"ttyS0\"\n".to_owned(), "staunch.toml:2: `ttyS0` is not the path of a serial port"),
        (
            format!("{port}\nbaud-rate = 96\n"),
            "staunch.toml:3: `baud-rate` must be a number from 300 to 4000000, such as 9600 or 19200, not 96",
        ),
        (format!("{port}\nbaud-rate = \"fast\"\n"), "`baud-rate` must be a whole number"),
        (format!("{port}\nparity = \"mark\"\n"), "`parity` must be one of \"none\", \"even\", \"odd\""),
        (format!("{port}\nstop-bits = 3\n"), "staunch.toml:3: `stop-bits` must be 1 or 2, not 3"),
        (format!("{port}\ndata-bits = 7\n"), "staunch.toml:3: Modbus RTU has 8 data bits, not 7"),
        (format!("{port}\nunit = 0\n"), "staunch.toml:3: `unit` is a number from 1 to 247 on a serial line, not 0"),
        ("server = \"a:1\"\nparity = \"even\"\n".to_owned(), "staunch.toml:3: `parity` is a setting of a serial line"),
        (format!("{port}\nbaudrate = 9600\n"), "did you mean `baud-rate`?"),
        (
            format!("{port}\nunit = 2\n{map}[[modbus]]\nbaud-rate = 9600\nparity = \"none\"\nstop-bits = 2\n{port}\n"),
            "staunch.toml:10: `/dev/ttyS0` has 9600 baud, parity none, 2 stop bits here, and 19200 baud, parity even, 1 stop bit above",
        ),
    ] {
        let folder = Folder::with("io_serial_wrong", &[("main.st", PLANT)]);
        folder.write("staunch.toml", format!("[[modbus]]\n{settings}{map}"));
        for call in ["check main.st", "build main.st -o plant", "run main.st"] {
            has(&folder.staunch(call).err(2), &[expected]);
        }
    }
}
