//! A program that is a unit on a line (`--io modbus-rtu`), asked by pymodbus, mbpoll and raw frames.

use super::super::modbus::{COILS, Client};
use super::super::{PLANT, Plant, built, has_tool, until};
use super::{Line, framed};
use crate::{Folder, has};
use std::process::Command;
use std::time::Duration;

/// Writes and reads each table of unit 3, until the program has followed. The unit does not answer what it should not.
const CLIENT: &str = r#"
import sys, time
from pymodbus.client import ModbusSerialClient
from pymodbus.transaction import ModbusRtuFramer
client = ModbusSerialClient(port=sys.argv[1], framer=ModbusRtuFramer, baudrate=19200, timeout=5)
assert client.connect()
def follows(what, holds):
    limit = time.time() + 30
    while not holds():
        assert time.time() < limit, what
def good(ask):
    while (answer := ask()).isError():
        assert hasattr(answer, "function_code") is False or answer.function_code < 128, answer
    return answer
assert good(lambda: client.write_coil(0, True, slave=3)).value
follows("motor", lambda: good(lambda: client.read_coils(8, 8, slave=3)).bits[:8] == [False, True] + [False] * 6)
follows("limit", lambda: good(lambda: client.read_holding_registers(1028, 1, slave=3)).registers == [50])
good(lambda: client.write_registers(1028, [70], slave=3))
follows("other limit", lambda: good(lambda: client.read_holding_registers(1028, 1, slave=3)).registers == [70])
assert good(lambda: client.read_input_registers(3, 2, slave=3)).registers == [0, 0]
assert good(lambda: client.read_discrete_inputs(0, 1, slave=3)).bits[0] is False
first = good(lambda: client.read_holding_registers(20, 21, slave=3)).registers
assert first[0] == first[20], first
refused = client.read_input_registers(1020, 9, slave=3)
assert refused.isError() and getattr(refused, "exception_code", None) == 2, refused
client.close()
client = ModbusSerialClient(port=sys.argv[1], framer=ModbusRtuFramer, baudrate=19200, timeout=0.3, retries=0)
other = client.read_coils(8, 1, slave=4)
assert other.isError() and not hasattr(other, "exception_code"), other
print("all of it")
"#;

fn start(folder: &Folder, settings: &str) -> Plant {
    let port = folder.0.join("a").display().to_string();
    let arguments = format!("--cycle 2ms --io modbus:127.0.0.1:0 --io modbus-rtu:{port},unit=3{settings}");
    Plant::start(folder, "plant", &arguments).listening()
}

/// Sends a request until it is answered: a busy machine may divide it.
fn ask(line: &mut Line, request: &[u8]) -> Vec<u8> {
    let mut received = Vec::new();
    until("the unit answers", || {
        line.send(request);
        for _ in 0..200 {
            received.extend(line.receive());
            if super::is_framed(&received) {
                return true;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        received.clear();
        false
    });
    received
}

#[test]
fn a_program_is_a_unit_of_pymodbus_and_mbpoll() {
    let folder = built("io_rtu_server", PLANT);
    let Some(line) = Line::start(&folder) else { return };
    // A pseudo terminal has no parity, which the clients' libraries report.
    let plant = start(&folder, ",parity=none");
    let mut python = Command::new("/usr/bin/python3");
    let asked = python.args(["-c", CLIENT]).arg(folder.0.join("b")).output().unwrap();
    assert!(asked.status.success() && asked.stdout == b"all of it\n", "{asked:?}");
    if has_tool(Command::new("mbpoll").arg("-h"), "mbpoll") {
        let mbpoll = |arguments: &str| {
            let mut command = Command::new("mbpoll");
            command.args("-m rtu -b 19200 -P none -a 3 -0 -1 -o 5".split(' ')).args(arguments.split(' ').take(6));
            let output = command.arg(folder.0.join("b")).args(arguments.split(' ').skip(6)).output().unwrap();
            String::from_utf8_lossy(&output.stdout).into_owned()
        };
        until("mbpoll reads", || mbpoll("-t 4 -r 1028 -c 1").contains("[1028]: \t70"));
        until("mbpoll writes", || mbpoll("-t 4 -r 1028 -q -v 71").contains("Written 1 references"));
        until("it is written", || mbpoll("-t 4 -r 1028 -c 1").contains("[1028]: \t71"));
    }
    drop(line);
    plant.signal("-TERM");
    has(&plant.ended(0), &["note: modbus-rtu: unit 3 on ", " requests answered, "]);
}

/// Garbage, frames of other units and those to all are not answered; what is written to all units is written.
#[test]
fn a_unit_answers_its_own_requests_alone() {
    let folder = built("io_rtu_server_alone", PLANT);
    let Some(mut line) = Line::start(&folder) else { return };
    let plant = start(&folder, ",baud-rate=115200,parity=none,stop-bits=2");
    let mut client = Client::of(&plant);
    let (request, answer) = (framed(&[3, 3, 4, 4, 0, 1]), framed(&[3, 3, 2, 0, 50]));
    assert_eq!(ask(&mut line, &request), answer);
    let mut with_other_crc = framed(&[3, 5, 0, 0, 0xFF, 0]);
    with_other_crc[7] ^= 1;
    let silent = [
        with_other_crc,
        framed(&[4, 5, 0, 0, 0xFF, 0]),
        framed(&[0, 3, 4, 4, 0, 1]),
        vec![0x55; 300],
        request[..7].to_vec(),
        [&request[..], &[0]].concat(),
    ];
    for bytes in &silent {
        line.send(bytes);
        // Longer than the pause that ends a frame.
        std::thread::sleep(Duration::from_millis(80));
        assert_eq!(line.receive(), Vec::<u8>::new(), "{bytes:?}");
    }
    assert!(!client.bit(COILS, 9), "nobody has written it");
    until("all units are written", || {
        line.send(&framed(&[0, 5, 0, 0, 0xFF, 0]));
        std::thread::sleep(Duration::from_millis(80));
        client.bit(COILS, 9)
    });
    assert_eq!(line.receive(), Vec::<u8>::new());
    assert_eq!(ask(&mut line, &request), answer);
    assert_eq!(ask(&mut line, &framed(&[3, 99])), framed(&[3, 99 | 0x80, 1]));
    plant.signal("-TERM");
    let said = plant.ended(0);
    let damaged = said.lines().find_map(|it| it.strip_suffix(" damaged")?.rsplit(' ').next()?.parse::<usize>().ok());
    assert!(damaged.unwrap() >= 3, "{said}");
}

#[test]
fn a_unit_whose_port_vanishes_is_back() {
    let folder = built("io_rtu_server_port", PLANT);
    let Some(mut line) = Line::start(&folder) else { return };
    let plant = start(&folder, "");
    let request = framed(&[3, 3, 4, 4, 0, 1]);
    assert_eq!(ask(&mut line, &request), framed(&[3, 3, 2, 0, 50]));
    let port = folder.0.join("a").display().to_string();
    let second = folder.staunch(&format!("run main.st --realtime --scans 1 --io modbus-rtu:{port}")).err(2);
    has(&second, &[&format!("cannot serve on {port} (--io modbus-rtu): another running program has the port")]);
    drop(line);
    let _ = std::fs::remove_file(&port);
    let Some(mut line) = Line::start(&folder) else { return };
    assert_eq!(ask(&mut line, &request), framed(&[3, 3, 2, 0, 50]));
    plant.signal("-TERM");
    has(&plant.ended(0), &["the port has gone", "the port is back"]);
}

#[test]
fn a_wrong_unit_is_refused() {
    let folder = built("io_rtu_server_wrong", PLANT);
    let run = |io: &str| folder.staunch(&format!("run main.st --realtime --scans 1 --io {io}")).err(2);
    has(&run("modbus-rtu:/dev/null"), &["cannot serve on /dev/null (--io modbus-rtu): it is not a serial port"]);
    has(&run("modbus-rtu:/nowhere/tty"), &["cannot serve on /nowhere/tty (--io modbus-rtu): no such port"]);
    has(&run("modbus-rtu:ttyS0"), &["`ttyS0` is not the path of a serial port"]);
    has(&run("modbus-rtu:/dev/ttyS0,unit=0"), &["`0` is not a unit from 1 to 247"]);
}
