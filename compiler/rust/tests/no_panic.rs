//! No emitted function can panic, whatever its subscripts.

mod support;

use support::{cannot_panic, cannot_panic_in};

#[test]
fn counters_in_arrays() {
    cannot_panic(
        "counters",
        "
VAR_GLOBAL lines : ARRAY[-1..2, 0..9] OF CTU; names : ARRAY[1..4] OF STRING[20]; END_VAR
FUNCTION Sum : DINT
VAR_IN_OUT values : ARRAY[0..99] OF INT; total : INT; END_VAR
VAR_INPUT from, to_ : INT; END_VAR
VAR i : INT; END_VAR
FOR i := from TO to_ DO Sum := Sum + values[i]; END_FOR;
total := total + values[from];
END_FUNCTION
PROGRAM Main
VAR_EXTERNAL lines : ARRAY[-1..2, 0..9] OF CTU; names : ARRAY[1..4] OF STRING[20]; END_VAR
VAR
    c : ARRAY[1..1000] OF CTU; inputs : ARRAY[1..1000] OF BOOL;
    values : ARRAY[0..99] OF INT; i, j, k : INT; all : DINT; r : REAL; text : STRING[12];
    u : USINT;
END_VAR
FOR i := 1 TO 1000 DO
    c[i](CU := inputs[i], R := FALSE, PV := 10);
END_FOR;
lines[j, k](CU := TRUE, R := lines[k, j].Q, PV := values[j]);
all := Sum(values, values[k], j, k) / k;
r := INT_TO_REAL(j) / 3.0;
i := REAL_TO_INT(r) MOD j;
names[j] := CONCAT(names[k], LEFT(text, values[i]));
text := MID(names[j], values[i], k);
text := REPLACE(text, INSERT(names[1], names[i], j), k, i);
u := u + 1;
END_PROGRAM
",
    );
}

/// The bytes come from outside, and an area may be shorter than a place in it.
const IMAGE: &str = r#"
use staunch_runtime::firmware::Areas;

static mut GLOBALS: code::Globals = code::Globals::new();
static mut BYTES: [[u8; 20_000]; 3] = [[0; 20_000]; 3];

#[unsafe(no_mangle)]
extern "C" fn main(count: i32) -> i32 {
    let (globals, bytes) = unsafe { (&mut *(&raw mut GLOBALS), &mut *(&raw mut BYTES)) };
    let [inputs, outputs, memory] = bytes;
    let Some(inputs) = inputs.get(..count.unsigned_abs() as usize) else { return 1 };
    let mut image = Areas { inputs, outputs, memory };
    globals.read_image(&image);
    globals.write_image(&mut image);
    i32::from(outputs[0])
}
"#;

#[test]
fn a_process_image() {
    let st = "
TYPE Mode : (Off, Auto := 5); END_TYPE
VAR_GLOBAL
    raw AT %IW10 : ARRAY[1..2, 0..1, 3..9] OF INT; start AT %IX0.0 : BOOL; clock AT %IL16 : TOD; level AT %ID60 : REAL;
    lamps AT %QX0.0 : ARRAY[0..90] OF BOOL; modes AT %QW80 : ARRAY[0..1] OF Mode; grid AT %MW10 : ARRAY[0..99] OF INT(1..7);
    part AT %MB3 : BYTE; flag AT %MX2.7 : BOOL; text AT %QB100 : STRING[4];
END_VAR
PROGRAM Main
lamps[3] := start OR flag; grid[1] := raw[1, 1, 4]; IF clock > TOD#1:00:00 AND level > 1.0 AND part > 3 THEN modes[1] := Auto; END_IF;
END_PROGRAM
";
    cannot_panic_in("process_image", st, IMAGE);
}
