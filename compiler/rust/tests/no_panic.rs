//! No emitted function can panic, whatever its subscripts.

mod support;

use support::cannot_panic;

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
