//! What a firmware reads of a program: its tasks, its direct addresses, and where a fault happened.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use support::output_of;

const ST: &str = "
VAR_GLOBAL
    start AT %IX0.3 : BOOL; speed AT %IW1 : INT; level AT %ID8 : REAL; lamp AT %QX2.0 : BOOL; control AT %QW4 : WORD;
    big AT %ML2 : LINT; memory : INT;
END_VAR
PROGRAM Main
VAR_EXTERNAL start, lamp : BOOL; speed : INT; level : REAL; control : WORD; big : LINT; memory : INT; END_VAR
lamp := start;
control := INT_TO_WORD(speed);
big := big - 1;
memory := 100 / speed;
IF level > 1.0 THEN control := 7; END_IF;
END_PROGRAM
CONFIGURATION Plant
RESOURCE Cpu ON Board
TASK Fast(INTERVAL := T#5ms, PRIORITY := 2);
TASK Slow(PRIORITY := 9);
PROGRAM Line1 WITH Fast : Main;
PROGRAM Line2 WITH Slow : Main;
END_RESOURCE
END_CONFIGURATION
";

/// Sets each input by its address, scans by the table of tasks, and prints each output.
const MAIN: &str = r#"
use staunch_runtime::Context;
use staunch_runtime::firmware::Area;

fn main() {
    let (mut globals, mut line) = (code::Globals::new(), code::Main::new());
    for task in code::TASKS {
        println!("{} {} {:?} {}", task.instance, task.program, task.interval, task.priority);
    }
    for (number, io) in code::IO.iter().enumerate() {
        println!("{} {} {} {}", io.address, io.variable, io.bit, io.width);
        if io.area == Area::Input {
            globals.set_io(number, u64::from(1.5_f32.to_bits()) * u64::from(io.width == 32) + 0xFFFF_0000_0000_FFFD * u64::from(io.width < 32));
        }
    }
    globals.set_io(99, 1);
    line.scan(&Context::first(0), &mut globals).unwrap();
    for (number, io) in code::IO.iter().enumerate() {
        println!("{} {:x}", io.variable, globals.io(number));
    }
    println!("{} {}", globals.memory, globals.io(99));
    globals.speed = 0;
    println!("{}", line.scan(&Context::at(1), &mut globals).unwrap_err().of(code::FILES));
}
"#;

#[test]
fn tasks_addresses_and_faults() {
    let expected = "\
Line1 Main Some(5000000) 2
Line2 Main None 9
%IX0.3 start 3 1
%IW1 speed 16 16
%ID8 level 256 32
%QX2.0 lamp 16 1
%QW4 control 64 16
%ML2 big 128 64
start 1
speed fffd
level 3fc00000
lamp 1
control 7
big ffffffffffffffff
-33 0
case.st:11:15: division by zero
";
    assert_eq!(output_of("firmware", ST, MAIN), expected);
}
