//! Emitted Rust does what the interpreter does, compiles without a warning, and reads well.
#![allow(clippy::unwrap_used)]

mod support;

use support::agree;

#[test]
fn garage() {
    agree(
        "garage",
        "
TYPE Mode : (Idle, Running := 5, Blocked); END_TYPE
(* Counts the cars of a garage. *)
PROGRAM ParkingGarage
VAR
    entry : BOOL := TRUE; (* Car entering the garage *)
    exitSensor : BOOL;
    exit_sensor_2 : BOOL;
    tracker : CTUD;
    full : BOOL;
    mode : Mode := Running;
    delay : TON;
    level : REAL := 0.5;
    bits : WORD := 16#FF;
    i, total : DINT;
    table : ARRAY[1..200] OF INT := [150(0), 50(7)];
    matrix : ARRAY[0..1, -1..1] OF INT := [1, 2, 3, 4, 5, 6];
    name : STRING[10] := 'abc';
    self : INT;
    type_ : INT;
END_VAR
tracker(CU := entry, CD := exitSensor, R := FALSE, LD := FALSE, PV := 2);
full := tracker.QU;
delay(IN := entry, PT := T#15ms);
IF full AND NOT exitSensor OR delay.Q THEN
    mode := Mode#Blocked;
ELSIF tracker.CV > 1 THEN
    mode := Idle;
ELSE
    mode := Running;
END_IF;
CASE mode OF
    Idle: total := total + 1;
    Running: total := total + 10;
ELSE
    total := total + 100;
END_CASE;
CASE total OF
    1..5, 7: level := level * 2.0;
    10: level := level / 3.0;
END_CASE;
FOR i := 1 TO 10 DO
    IF i = 5 THEN CONTINUE; END_IF;
    IF i = 9 THEN EXIT; END_IF;
    table[i] := table[i] + DINT_TO_INT(i);
END_FOR;
WHILE self < 3 DO
    self := self + 1;
END_WHILE;
REPEAT
    type_ := type_ + matrix[1, 0];
UNTIL type_ > 20
END_REPEAT;
bits := (bits AND 16#0F) OR SHL(bits, 1);
name := CONCAT(LEFT(name, 2), 'xyz');
entry := NOT entry;
END_PROGRAM
",
    );
}

#[test]
fn aliases() {
    agree(
        "aliases",
        "
TYPE Pair : STRUCT x, y : INT; END_STRUCT; END_TYPE
VAR_GLOBAL total : INT := 3; pump, spare : Motor; pumps : ARRAY[1..3] OF Motor; END_VAR
FUNCTION Swap : BOOL
VAR_IN_OUT a, b : INT; END_VAR
VAR t : INT; END_VAR
t := a; a := b; b := t; a := a + 1;
Swap := a > b;
END_FUNCTION
FUNCTION AddTotal : INT
VAR_INPUT step : INT; END_VAR
VAR_IN_OUT v : INT; END_VAR
VAR_EXTERNAL total : INT; END_VAR
total := total + step;
v := v + total;
AddTotal := v;
END_FUNCTION
FUNCTION Touch : INT
VAR_IN_OUT all : ARRAY[1..4] OF INT; one : INT; END_VAR
VAR i : INT; END_VAR
FOR i := 1 TO 4 DO all[i] := all[i] + one; END_FOR;
one := one * 2;
Touch := all[4];
END_FUNCTION
FUNCTION_BLOCK Motor
VAR_INPUT run : BOOL; END_VAR
VAR_OUTPUT starts : INT; END_VAR
VAR_EXTERNAL total : INT; END_VAR
IF run THEN starts := starts + 1; total := total + starts; END_IF;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Mix
VAR_IN_OUT io : INT; END_VAR
VAR_INPUT x : INT := 2; END_VAR VAR y : INT; END_VAR
io := io + x; y := io * 2 + x;
END_FUNCTION_BLOCK
PROGRAM Main
VAR
    a : ARRAY[1..4] OF INT := [1, 2, 3, 4];
    i : INT := 1; j : INT := 2;
    x : INT := 9; r : INT; p : Pair; mix : Mix; ok : BOOL; own : Motor;
END_VAR
VAR_EXTERNAL total : INT; pump : Motor; pumps : ARRAY[1..3] OF Motor; END_VAR
ok := Swap(a := x, b := x);
ok := Swap(a := a[i], b := a[j]);
ok := Swap(a := p.x, b := p.y);
r := Touch(a, a[j]);
r := r + AddTotal(step := total, v := total);
r := r + AddTotal(step := x, v := x);
pump(run := TRUE);
pumps[j](run := i < 3);
own(run := TRUE);
mix(io := mix.x);
mix(io := x);
i := i + 1; j := j + 1;
END_PROGRAM
",
    );
}

#[test]
fn faults_come_in_order() {
    agree(
        "faults",
        "
FUNCTION Swap : BOOL
VAR_IN_OUT a, b : INT; END_VAR
VAR_INPUT q : INT; END_VAR
VAR t : INT; END_VAR
t := a; a := b; b := t;
END_FUNCTION
PROGRAM Main
VAR a : ARRAY[1..2] OF INT; i, n : INT; ok : BOOL; END_VAR
n := n + 1;
CASE n OF
    1: a[i] := 1 / i;
    2: ok := Swap(a[1], a[n + 1], 1 / i);
    3: ok := Swap(q := 1 / i, a := a[1], b := a[n + 1]);
    4: a[n] := a[i] / i;
END_CASE
END_PROGRAM
",
    );
}

#[test]
fn statements_and_types() {
    agree(
        "statements",
        "
{dialect 'logix'}
TYPE
    Color : (Red, Green, Blue) := Green;
    Wide : DINT (Small := -5, Large := 100000);
    Point : STRUCT x : INT := 1; y : REAL := -0.5; c : Color; name : STRING[5] := 'p$'q'; END_STRUCT;
    Line : STRUCT a : Point := (x := 7); b : ARRAY[0..2] OF Point := [2((y := 2.5)), (x := 9)]; END_STRUCT;
END_TYPE
FUNCTION Scale : LREAL
VAR_INPUT v : INT; k : LREAL := 2.0; END_VAR
VAR_OUTPUT high : BOOL; END_VAR
IF v > 3 THEN high := TRUE; Scale := k; RETURN; END_IF;
Scale := INT_TO_LREAL(v) * k;
END_FUNCTION
FUNCTION Name : STRING[8]
VAR_INPUT n : STRING[8]; END_VAR
Name := CONCAT(n, '!');
END_FUNCTION
FUNCTION_BLOCK Station
VAR_INPUT go : BOOL; END_VAR
VAR_OUTPUT n : DINT; END_VAR
VAR parts : COUNTER; END_VAR
VAR_IN_OUT log : ARRAY[1..3] OF DINT; END_VAR
CTU(Counter := parts, RungIn := go);
n := parts.ACC;
log[2] := n;
END_FUNCTION_BLOCK
PROGRAM Main
VAR
    line : Line; other : Line; c : Color; w : Wide := Large; n : INT; u : USINT := 250; s : SINT := -128;
    r : REAL; l : LREAL; high : BOOL; t : TIME := T#1s500ms; lt : LTIME := LTIME#7ns; text : STRING[20];
    stations : ARRAY[1..2] OF Station; log : ARRAY[1..3] OF DINT; on_ : BOOL := TRUE; d : DWORD := 16#DEADBEEF;
    shared : COUNTER; matrix : ARRAY[1..2, 1..2] OF ARRAY[0..1] OF INT; lw : LWORD; flag : BOOL; i, j : DINT;
END_VAR
n := n + 1;
stations[1](go := on_, log := log);
stations[n](go := n > 1, log := log);
CTU(Counter := shared, RungIn := on_);
l := Scale(n, high => high) + Scale(v := 1, k := 0.5, high => flag);
text := Name(Name(line.a.name));
other := line;
other.b[n - 1].x := line.b[2].x + n;
CASE other.b[0].c OF Red: c := Blue; Green, Blue: c := Red; END_CASE;
CASE w OF Wide#Small: w := Large; ELSE w := Small; END_CASE;
CASE u OF 0..9: u := 100; 10..249: u := 255; 250..255: u := u + 10; END_CASE;
CASE n OF 2: s := -s; END_CASE;
CASE n OF 1, 3..4: s := s / 2; ELSE s := ABS(s) MOD 7; END_CASE;
r := SQRT(ABS(line.a.y)) ** 2.0; r := -r + MAX(r, 1.0) * (2.0 - r / 4.0);
t := t * 2; t := t + T#3ms; lt := lt + LTIME#1us;
d := ROL(d, 4) XOR NOT d; d := d AND (d OR 16#F0);
lw := DWORD_TO_LWORD(d);
flag := (n > 1) = (u < 200) AND NOT (r > 0.5);
u := DINT_TO_USINT(REAL_TO_DINT(r)); s := LIMIT(-5, s, 5); n := SEL(flag, n, n);
flag := text <> 'p$'q!!' OR LEN(text) > n;
FOR i := 1 TO 2 DO
    FOR j := 2 TO 1 BY -1 DO
        IF matrix[i, j][0] > 20 THEN CONTINUE; END_IF;
        matrix[i, j][n - 1 - n / 2] := matrix[i, j][0] + DINT_TO_INT(i * 10 + j);
    END_FOR;
END_FOR;
FOR i := 2147483645 TO 2147483647 DO log[3] := log[3] + 1; IF log[3] > 4 THEN EXIT; END_IF; END_FOR;
END_PROGRAM
",
    );
}

#[test]
fn copies_of_copies() {
    agree(
        "copies",
        "
{dialect 'logix'}
VAR_GLOBAL shared : COUNTER; cells : ARRAY[0..1] OF Cell; table : ARRAY[1..3] OF INT := [1, 2, 3]; END_VAR
FUNCTION_BLOCK Inner
VAR_INPUT go : BOOL; END_VAR
VAR_IN_OUT io, other : INT; END_VAR
VAR_EXTERNAL table : ARRAY[1..3] OF INT; shared : COUNTER; END_VAR
VAR own : COUNTER; n : INT; t : TON; END_VAR
CTU(Counter := own, RungIn := go);
CTU(Counter := shared, RungIn := go);
t(IN := go, PT := T#5ms);
n := n + io;
other := other + n;
io := io + table[2] + Deep(io, other);
IF io > 1000 THEN RETURN; END_IF;
io := io + 1;
END_FUNCTION_BLOCK
FUNCTION Deep : INT
VAR_IN_OUT a, b : INT; END_VAR
a := a + b; b := b + 1;
Deep := Deeper(a, a) + Deeper(a, b);
END_FUNCTION
FUNCTION Deeper : INT
VAR_IN_OUT a, b : INT; END_VAR
a := a + 1; b := b * 2; Deeper := a;
END_FUNCTION
FUNCTION_BLOCK Cell
VAR_INPUT k : INT; END_VAR
VAR inner : Inner; pair : ARRAY[0..1] OF INT; END_VAR
VAR_EXTERNAL table : ARRAY[1..3] OF INT; END_VAR
inner(go := TRUE, io := pair[k], other := pair[1 - k]);
inner(go := FALSE, io := table[k + 1], other := table[k + 2]);
inner(go := TRUE, io := pair[0], other := table[1]);
END_FUNCTION_BLOCK
PROGRAM Main
VAR own : Cell; i : INT; x : INT; lin : Inner; END_VAR
VAR_EXTERNAL cells : ARRAY[0..1] OF Cell; table : ARRAY[1..3] OF INT; END_VAR
own(k := i);
cells[i](k := 1 - i);
lin(go := TRUE, io := x, other := x);
i := 1 - i;
x := x + Deep(table[1], table[1]);
END_PROGRAM
",
    );
}

/// What is legal, if odd, in Structured Text stays free of warnings in Rust.
#[test]
fn oddities() {
    let st = "
FUNCTION spot : INT VAR_INPUT ops, cx, globals, out, index : INT; unused : INT; END_VAR
spot := ops + cx + globals + out + index;
END_FUNCTION
FUNCTION drop : BOOL VAR_INPUT a : STRING[3]; END_VAR VAR spot, result, operand : INT; END_VAR
spot := 5; spot := LEN(a); result := spot; operand := result;
IF operand > 2 THEN RETURN; END_IF;
drop := TRUE;
END_FUNCTION
FUNCTION_BLOCK Text VAR_INPUT Fault, Context : INT; END_VAR VAR Time_ : TIME; END_VAR
RETURN;
END_FUNCTION_BLOCK
PROGRAM Vec
VAR
    fooBar, foo_bar, fn, match : INT; pi : REAL := 3.14; u : USINT; b, new : BOOL; option : Text; none : LREAL;
    big : ARRAY[0..5000] OF INT := [5001(3)]; s : STRING[10] := 'aab'; k : ARRAY[1..2] OF STRING[4];
END_VAR
fooBar := fooBar; foo_bar := foo_bar - foo_bar;
fooBar := foo_bar; foo_bar := fooBar;
IF b = TRUE THEN IF new THEN fn := 0 * fn; END_IF; END_IF;
IF u >= 0 AND fn = fn THEN match := match + 0; END_IF;
WHILE TRUE DO EXIT; END_WHILE;
REPEAT match := match + 1; IF match > 3 THEN CONTINUE; END_IF; new := NOT new; UNTIL match > 5 END_REPEAT;
option(Fault := spot(1, 2, 3, 4, 5, 6), Context := fn);
b := drop(a := 'abc') OR drop('a');
none := 1.0E30 * none - -2.5;
IF b THEN ; ELSIF b THEN fn := 1; ELSE ; END_IF;
s := CONCAT(k[match - 4], MID(k[fn + 1], 1, match));
b := NOT (pi < 3.0) XOR (s > 'a');
RETURN;
END_PROGRAM
";
    assert_eq!(agree("oddities", st), agree("oddities", st));
}
