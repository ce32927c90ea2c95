//! What a firmware reads of a program: its tasks, its direct addresses, and where a fault happened.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use staunch_rust::{Options, State};
use support::{output_as, output_of, output_with};

const ST: &str = "
VAR_GLOBAL
    big AT %ML2 : LINT; far AT %IW1.2.3 : WORD; start AT %IX0.3 : BOOL; speed AT %IW1 : INT; level AT %ID8 : REAL; lamp AT %QX2.0 : BOOL; control AT %QW4 : WORD;
    memory : INT;
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

fn main() {
    let (mut globals, mut line) = (code::Globals::new(), code::Main::new());
    for task in code::TASKS {
        println!("{} {} {:?} {}", task.instance, task.program, task.interval, task.priority);
    }
    for io in code::IO {
        println!("{} {} {:?} {:?} {} {}", io.address, io.variable, io.area, io.module, io.bit, io.width);
    }
    globals.read_inputs(|io| match io.width {
        32 => u64::from(1.5_f32.to_bits()),
        _ => 0xFFFF_0000_0000_FFFD,
    });
    globals.set_io(99, 1);
    line.scan(&Context::first(0), &mut globals).unwrap();
    for (number, io) in code::IO.iter().enumerate() {
        println!("{} {:x}", io.variable, globals.io(number));
    }
    globals.write_outputs(|io, bits| println!("{} := {bits}", io.address));
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
%IW1.2.3 far Input [1, 2] 48 16
%IX0.3 start Input [] 3 1
%IW1 speed Input [] 16 16
%ID8 level Input [] 256 32
%QX2.0 lamp Output [] 16 1
%QW4 control Output [] 64 16
%ML2 big Memory [] 128 64
far fffd
start 1
speed fffd
level 3fc00000
lamp 1
control 7
big ffffffffffffffff
%QX2.0 := 1
%QW4 := 7
-33 0
case.st:11:15: division by zero
";
    assert_eq!(output_of("firmware", ST, MAIN), expected);
}

const PARTS: &str = "
TYPE Mode : (Off, Auto := 5); Head : STRUCT number : INT; mode : Mode; ready : BOOL; END_STRUCT END_TYPE
VAR_GLOBAL
    raw AT %IW10 : ARRAY[1..2, 0..1] OF INT; head AT %QB1 : Head; grid AT %MW0 : ARRAY[0..99] OF INT;
    heads AT %IB40 : ARRAY[0..1] OF Head; low AT %IB41 : BYTE; text AT %QB100 : STRING[4]; flags AT %QX90.0 : ARRAY[0..1] OF BOOL;
    level AT %IW60 : INT(-4..5); clock AT %IL16 : TOD; day AT %IL17 : DATE; ok AT %IX150.1 : BOOL;
END_VAR
PROGRAM Main
VAR r : REF_TO INT; END_VAR
r := REF(grid[3]);
head.number := raw[2, 1];
IF heads[1].mode = Auto THEN head.mode := Auto; END_IF;
head.ready := heads[1].ready AND low = 2;
flags[1] := heads[0].ready;
IF ok AND clock > TOD#10:00:00 AND day = D#1970-01-02 THEN grid[1] := level; END_IF;
END_PROGRAM
";

/// Sets each input to its number in the table and one more, and prints what comes out.
const PARTS_MAIN: &str = r#"
use staunch_runtime::Context;

fn main() {
    let mut machine = code::Machine::new();
    for (number, io) in code::IO.iter().enumerate() {
        println!("{} {} {} {}", io.address, io.variable, io.bit, io.width);
        machine.globals.set_io(number, number as u64 + 1);
    }
    for (number, io) in code::IO.iter().enumerate() {
        match io.variable {
            "level" => machine.globals.set_io(number, 0xFFFF),
            "clock" | "day" => machine.globals.set_io(number, 86_400_000_000_000 + 36_000_000_000_001),
            "heads[1].ready" => machine.globals.set_io(number, 2),
            "ok" => machine.globals.set_io(number, 0xFF),
            _ => {}
        }
    }
    machine.main.scan(&Context::first(0), &machine).unwrap();
    println!("{}", machine.globals.grid[1].get());
    for number in 0..code::IO.len() {
        if code::IO[number].variable == "level" {
            machine.globals.set_io(number, 700);
            println!("{}", machine.globals.io(number));
        }
    }
    machine.globals.write_outputs(|io, bits| println!("{} := {bits}", io.variable));
    println!("{}", machine.globals.io(7));
}
"#;

/// Of arrays and structures each number is a row; the texts in them, and memory, have none.
#[test]
fn parts_of_what_is_at_addresses() {
    // `head.mode` keeps what the test gave it: `heads[1].mode` is not Auto.
    let expected = "\
%IW10 raw[1,0] 160 16
%IW11 raw[1,1] 176 16
%IW12 raw[2,0] 192 16
%IW13 raw[2,1] 208 16
%IW60 level 960 16
%IL16 clock 1024 64
%IL17 day 1088 64
%IX150.1 ok 1201 1
%IW20 heads[0].number 320 16
%IW21 heads[0].mode 336 16
%IB44 heads[0].ready 352 8
%IW23 heads[1].number 368 16
%IW24 heads[1].mode 384 16
%IB50 heads[1].ready 400 8
%IB41 low 328 8
%QB1 head.number 8 16
%QB3 head.mode 24 16
%QB5 head.ready 40 8
%QB90 flags[0] 720 8
%QB91 flags[1] 728 8
-1
5
head.number := 4
head.mode := 17
head.ready := 0
flags[0] := 1
flags[1] := 1
1
";
    assert_eq!(output_of("firmware_parts", PARTS, PARTS_MAIN), expected);
}

const RETAINING: &str = "
TYPE Color : (Red, Green := 5); Part : STRUCT number : INT; weight : REAL; END_STRUCT; END_TYPE
FUNCTION_BLOCK Station
VAR RETAIN done : INT(0..100) := 7; END_VAR
VAR plain : INT; END_VAR
done := done; plain := plain + 1;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Whole
VAR kept : LINT; t : TON; END_VAR
VAR NON_RETAIN lost : INT; END_VAR
t(IN := TRUE, PT := T#1s); kept := kept + 1; lost := lost + 1;
END_FUNCTION_BLOCK
VAR_GLOBAL RETAIN total : DINT; END_VAR
VAR_GLOBAL scrap : DINT; END_VAR
PROGRAM Main
VAR_EXTERNAL total, scrap : DINT; END_VAR
VAR RETAIN
    on : BOOL; name : STRING[5]; color : Color; colors : ARRAY[1..2] OF Color; levels : ARRAY[0..1, 0..1] OF INT(1..9);
    parts : ARRAY[1..2] OF Part; row : ARRAY[1..3] OF UINT; whole : Whole;
END_VAR
VAR stations : ARRAY[1..2] OF Station; c : CSCAPE.CTU; forgotten : INT; END_VAR
VAR RETAIN counter : CSCAPE.CTU; save_retained : INT; END_VAR
on := TRUE; name := 'abcde'; color := Green; colors[2] := Green; levels[1, 0] := 9; parts[2].weight := 1.5; row[3] := 65535;
whole(); stations[2](); total := total + 1; scrap := 4; forgotten := 3; c(CU := TRUE, PV := 3); counter(CU := TRUE, PV := 4);
save_retained := 1;
END_PROGRAM
FUNCTION load_retained : INT
load_retained := 1;
END_FUNCTION
";

/// Saves after a scan, loads into a new program, and shows the values; then what a damaged, a foreign and a
/// forged record do.
const RETAINING_MAIN: &str = r#"
use staunch_runtime::{Context, crc32};
use staunch_runtime::firmware::Stamp;

fn loaded(bytes: &[u8]) -> (code::Main, code::Globals) {
    let (mut globals, mut main) = (code::Globals::new(), code::Main::new());
    println!("{:?}", code::load_retained(bytes, &mut main, &mut globals));
    (main, globals)
}

fn main() {
    let (mut globals, mut main) = (code::Globals::new(), code::Main::new());
    main.scan(&Context::first(5), &mut globals).unwrap();
    main.stations[1].done = 50;
    let mut page = [0xFF; code::RETAINED_SIZE + 9];
    let record: &mut [u8; code::RETAINED_SIZE] = page.first_chunk_mut().unwrap();
    code::save_retained(record, Stamp { sequence: 8, now: 5 }, &mut main, &mut globals);
    println!("{:?} {}", code::retained_stamp(&page), code::RETAINED_SIZE);
    let (m, g) = loaded(&page);
    println!("{} {} {:?} {:?} {:?}", m.on, m.name, m.color, m.colors, m.levels);
    println!("{:?} {:?} {} {}", m.parts[1], m.row, m.stations[0].done, m.stations[1].done);
    println!("{} {} {} {} {}", m.whole.kept, m.whole.lost, m.whole.t.in_before, m.whole.t.start, m.stations[1].plain);
    println!("{} {} {} {} {} {}", g.total, g.scrap, m.forgotten, m.c.cv, m.counter.cv, m.counter.pv);

    println!("{:?}", loaded(&page[..20]).1.total);
    page[30] ^= 1;
    println!("{:?}", loaded(&page).1.total);
    page[5] ^= 1;
    println!("{}", code::retained_stamp(&page).unwrap_err());
    page[5] ^= 1;

    let size = code::RETAINED_SIZE;
    page[20..size - 4].fill(0xFF);
    let checksum = crc32(&page[..size - 4]).to_le_bytes();
    page[size - 4..size].copy_from_slice(&checksum);
    let (mut m, mut g) = loaded(&page);
    println!("{} {:?} {:?} {:?} {}", m.on, m.name.as_bytes(), m.color, m.levels, m.stations[0].done);
    m.scan(&Context::first(6), &mut g).unwrap();
}
"#;

#[test]
fn retained_variables_go_to_bytes_and_back() {
    // 24 in addition to the values; on, name, color, colors, levels, parts, row: 1 + 7 + 2 + 4 + 8 + 12 + 6 bytes;
    // whole: kept, and the pins of its timer: 8 + 1 + 8 + 1 + 8 + 1 + 8; of each station 2; total 4;
    // of the counter CU, RESET and PV, since the rest starts anew; and the last variable, 2.
    let counter = 1 + 1 + 2;
    let size = 24 + 40 + 35 + 4 + 4 + counter + 2;
    let expected = format!(
        "\
Ok(Stamp {{ sequence: 8, now: 5 }}) {size}
Ok(Stamp {{ sequence: 8, now: 5 }})
true abcde Color(5) [Color(0), Color(5)] [[1, 1], [9, 1]]
Part {{ number: 0, weight: 1.5 }} [0, 0, 65535] 7 50
1 0 true 5 0
1 0 0 0 0 4
Err(Missing)
0
Err(Damaged)
0
the retained variables are those of another program
Ok(Stamp {{ sequence: 8, now: 5 }})
true [255, 255, 255, 255, 255] Color(-1) [[1, 1], [1, 1]] 0
"
    );
    assert_eq!(output_of("retaining", RETAINING, RETAINING_MAIN), expected);
}

const CONSTANTS: &str = "
TYPE Point : STRUCT x, y : INT; END_STRUCT; Color : (Red, Green := 5); END_TYPE
VAR_GLOBAL CONSTANT sines : ARRAY[0..999] OF REAL := [500(0.25), 499(0.75), 1.0]; most : INT := 9; END_VAR
VAR_GLOBAL count : INT; END_VAR
FUNCTION_BLOCK Look
VAR_INPUT i : INT; END_VAR
VAR_OUTPUT y : REAL; place : Point; all : ARRAY[0..3] OF INT; END_VAR
VAR CONSTANT
    own : ARRAY[0..3] OF INT := [4, 5, 6, 7]; name : STRING[5] := 'abc'; scale : INT := 3; Scale_ : INT := 30;
    origin : Point := (x := 7, y := 8); color : Color := Green;
END_VAR
VAR text : STRING[9]; chosen : Color; long : INT; END_VAR
VAR_EXTERNAL CONSTANT sines : ARRAY[0..999] OF REAL; most : INT; END_VAR
VAR_EXTERNAL count : INT; END_VAR
y := sines[i * 100 + most * 11] + INT_TO_REAL(own[i MOD scale]);
place := origin; place.x := origin.y; all := own; text := CONCAT(name, '!'); chosen := color; long := LEN(name) + Scale_;
count := count + 1;
END_FUNCTION_BLOCK
PROGRAM Main
VAR a, b : Look; END_VAR
VAR CONSTANT c : ARRAY[1..2] OF Point := [(x := 1), (y := 2)]; END_VAR
VAR z : INT; p : Point; END_VAR
a(i := 9); b(i := 1);
z := c[b.i].x; p := c[2];
END_PROGRAM
";

const CONSTANTS_MAIN: &str = r#"
use staunch_runtime::Context;

fn main() {
    let (mut globals, mut main) = (code::Globals::new(), code::Main::new());
    main.scan(&Context::first(5), &mut globals).unwrap();
    println!("{} {} {:?} {:?}", main.a.y, main.b.y, main.a.place, main.b.all);
    println!("{} {:?} {} {} {:?} {}", main.a.text, main.a.chosen, main.a.long, main.z, main.p, globals.count);
    println!("{} {}", size_of::<code::Globals>(), size_of::<code::Look>());
    println!("{} {:?} {}", code::Globals::SINES[999], code::Look::OWN, code::Look::SCALE_2);
}
"#;

/// Constants are items: of `Globals` the count is left, of `Look` its input, outputs and three variables.
#[test]
fn constants_are_no_part_of_the_state() {
    // sines[999] + own[0], and sines[199] + own[1].
    let look = 2 + 2 + 4 + 4 + 8 + 12 + 2 + 2;
    let expected = format!(
        "\
5 5.25 Point {{ x: 8, y: 8 }} [4, 5, 6, 7]
abc! Color(5) 33 1 Point {{ x: 0, y: 2 }} 2
2 {look}
1 [4, 5, 6, 7] 30
"
    );
    assert_eq!(output_with("constants", CONSTANTS, CONSTANTS_MAIN, State::Lean), expected);
    // Where a host finds them by the map, they are fields: the table, the number, and the count.
    let mapped = output_with("constants-mapped", CONSTANTS, MAPPED_MAIN, State::Mapped);
    assert_eq!(mapped, format!("{}\n", 4000 + 2 + 2));
}

const MAPPED_MAIN: &str = "fn main() { println!(\"{}\", size_of::<code::Globals>()); }";

const NAMED: &str = "
TYPE Color : (Red, Green := 5); Part : STRUCT number : UINT; row : ARRAY[1..3] OF INT; END_STRUCT; END_TYPE
VAR_GLOBAL total : LINT := -9; END_VAR
FUNCTION_BLOCK Station
VAR_INPUT go : BOOL; END_VAR
VAR c : CTU; END_VAR
VAR CONSTANT limit : INT := 3; END_VAR
c(CU := go, PV := limit);
END_FUNCTION_BLOCK
PROGRAM Main
VAR
    on : BOOL := TRUE; name : STRING[7] := 'it$'s'; color : Color := Green; level : REAL := 0.1; wait : TIME := T#2ms;
    parts : ARRAY[0..1] OF Part := [(number := 7), (row := [4, 5, 6])]; stations : ARRAY[1..2] OF Station;
    matrix : ARRAY[0..1, 1..2] OF SINT := [1, 2, 3, -4];
END_VAR
VAR_EXTERNAL total : LINT; END_VAR
stations[2](go := on); total := total + 0;
END_PROGRAM
";

/// Prints every value with its name, as a console of a firmware would.
const NAMED_MAIN: &str = r#"
use staunch_runtime::Context;

fn main() {
    let (mut globals, mut main) = (code::Globals::new(), code::Main::new());
    main.scan(&Context::first(0), &mut globals).unwrap();
    for (number, name) in code::NAMES.iter().enumerate() {
        print!("{} {}:", name.path, name.ty);
        for element in 0..name.elements + 1 {
            code::named(number, element, &main, &globals, &mut |value| print!(" {value}"));
        }
        println!();
    }
    code::named(99, 0, &main, &globals, &mut |_| print!("nothing has this number"));
}
"#;

#[test]
fn names_are_there_at_run_time_when_asked_for() {
    let expected = "\
Main.on BOOL: TRUE
Main.name STRING[7]: 'it\\'s'
Main.color Color: 5
Main.level REAL: 0.1
Main.wait TIME: 2000000
Main.parts[0..1].number UINT: 7 0
Main.parts[0..1].row[1..3] INT: 0 0 0 4 5 6
Main.stations[1..2].go BOOL: FALSE TRUE
Main.stations[1..2].c.CU BOOL: FALSE TRUE
Main.stations[1..2].c.R BOOL: FALSE FALSE
Main.stations[1..2].c.PV INT: 0 3
Main.stations[1..2].c.Q BOOL: FALSE FALSE
Main.stations[1..2].c.CV INT: 0 1
Main.matrix[0..1][1..2] SINT: 1 2 3 -4
total LINT: -9
";
    for (folder, state) in [("named", State::Lean), ("named-mapped", State::Mapped)] {
        let options = Options { state, names: true, ..Options::default() };
        assert_eq!(output_as(folder, NAMED, NAMED_MAIN, &options), expected);
    }
    // Variables in cells are read from them; without a request for names the text has none.
    let options = Options { names: true, ..Options::default() };
    let referred = format!("{NAMED}\n{REFERRED}");
    let main = NAMED_MAIN.replace(
        "let (mut globals, mut main) = (code::Globals::new(), code::Main::new());",
        "let machine = code::Machine::new();\n    let (main, globals) = (&machine.main, &machine.globals);",
    );
    let main = main.replace("&mut globals)", "&machine)").replace("&main, &globals", "main, globals");
    assert_eq!(output_as("named-shared", &referred, &main, &options), expected);
    assert!(!staunch_rust::emit(&support::program(NAMED), &Options::default()).contains("NAMES"));
}

/// Turns the program's variables into cells.
const REFERRED: &str = "
FUNCTION_BLOCK Refer
VAR x : INT; p : REF_TO INT; END_VAR
p := REF(x);
p^ := 1;
END_FUNCTION_BLOCK
";
