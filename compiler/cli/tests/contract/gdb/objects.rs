//! What gdb shows of classes, references and bits.

use super::{has_gdb, here_in};
use crate::Folder;

/// What is inherited, passed by reference, shared or a single bit.
const OBJECTS: &str = "TYPE Pair : UNION whole : WORD; low : ARRAY[0..1] OF BYTE; END_UNION END_TYPE
TYPE Flags : STRUCT ready : BIT; open : BIT; level : INT; END_STRUCT END_TYPE
FUNCTION_BLOCK Base
VAR_INPUT step : INT; END_VAR
VAR flags : Flags; END_VAR
METHOD Run : DINT
VAR_IN_OUT list : ARRAY[*] OF INT; END_VAR
VAR n : DINT; END_VAR
FOR n := LOWER_BOUND(list, 1) TO UPPER_BOUND(list, 1) DO
    list[n] := list[n] + step;
END_FOR
flags.open := TRUE;
END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Derived EXTENDS Base
METHOD Run : DINT
VAR_IN_OUT list : ARRAY[*] OF INT; END_VAR
Run := SUPER^.Run(list);
END_METHOD
END_FUNCTION_BLOCK
PROGRAM Plc
VAR
    d : Derived; w : Pair; p : POINTER TO INT; r : REFERENCE TO INT; none : POINTER TO INT;
    n : INT := 5; list : ARRAY[-1..1] OF INT := [1, 2, 3]; lamp AT %QX0.3 : BOOL;
    tod : TOD := TOD#12:30:00;
END_VAR
p := ADR(n);
r REF= n;
w.whole := 16#4142;
lamp := TRUE;
d.Run(list);
n := n + 1;
END_PROGRAM
CONFIGURATION Cell
    RESOURCE One ON PLC
        TASK Fast(INTERVAL := T#10ms, PRIORITY := 1);
        TASK Slow(INTERVAL := T#20ms, PRIORITY := 2);
        PROGRAM Left WITH Fast : Plc;
        PROGRAM Right WITH Slow : Plc;
    END_RESOURCE
END_CONFIGURATION
";

#[test]
fn gdb_shows_objects_references_and_bits() {
    if !has_gdb() {
        return;
    }
    let folder = Folder::with("gdb_objects", &[("cell.st", OBJECTS)]);
    folder.staunch("build cell.st --dialect codesys -g -q -A warnings -o plant").out(0);
    let session = [
        ("tbreak cell.st:12", ""),
        ("tbreak cell.st:32", ""),
        ("continue", "flags.open := TRUE;"),
        ("bt 3", "#1  0x"),
        ("bt 3", " in Derived.Run (THIS=0x"),
        ("bt 3", " in Plc (THIS=0x"),
        ("print list", "= {1, 2, 3}"),
        ("info locals", "n = 2"),
        ("continue", "n := n + 1;"),
        ("print p^", "= 5"),
        ("print none", "= (^INT) 0x0"),
        ("print r", "= 5"),
        ("set var r := 8", ""),
        ("print n", "= 8"),
        ("print w", "= {whole = 16706, low = {66, 65}}"),
        ("print d.flags", "open = true"),
        ("print lamp", "= true"),
        ("print list[-1]", "= 1"),
        ("print tod", "= 45000"),
        ("print Left.n", "= 8"),
        ("print Right.n", "= 5"),
    ];
    here_in(&folder, &session.map(|(typed, printed)| (typed.to_owned(), printed)).to_vec());
}

/// What leads from an instance to others: by an INTERFACE, by a reference in a structure, in an array, and in an instance.
const LEADING: &str = "TYPE Node : STRUCT value : INT; next : REF_TO Node; END_STRUCT END_TYPE
INTERFACE IDrive METHOD Start : BOOL END_METHOD END_INTERFACE
FUNCTION_BLOCK Motor IMPLEMENTS IDrive
VAR_INPUT peer : IDrive; END_VAR VAR speed : INT := 7; END_VAR
METHOD Start : BOOL
speed := speed + 1;
END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Pump IMPLEMENTS IDrive
VAR level : REAL := 2.5; END_VAR
METHOD Start : BOOL
level := level + 1.0;
END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Line
VAR_INPUT drive : IDrive; END_VAR
VAR_INPUT first : REF_TO Node; END_VAR
drive.Start();
END_FUNCTION_BLOCK
PROGRAM Plc
VAR
    motor : Motor; pump : Pump; any, none : IDrive; line : Line;
    nodes : ARRAY[1..3] OF Node; head : REF_TO Node; all : ARRAY[1..2] OF REF_TO Node;
END_VAR
nodes[1].value := 10; nodes[2].value := 20;
nodes[1].next := REF(nodes[2]);
head := REF(nodes[1]);
all[2] := REF(nodes[2]);
line.first := head;
motor.peer := pump;
any := motor;
line(drive := pump);
any.Start();
END_PROGRAM
";

#[test]
fn gdb_follows_what_leads_to_others() {
    if !has_gdb() {
        return;
    }
    let folder = Folder::with("gdb_leading", &[("line.st", LEADING)]);
    folder.staunch("build line.st -g -q -A warnings -o plant").out(0);
    let session = [
        ("tbreak line.st:18", ""),
        ("tbreak line.st:33", ""),
        ("continue", "drive.Start();"),
        ("print drive", "= {Motor = 0x0, Pump = 0x"),
        ("print drive.Pump^", "= {level = 2.5}"),
        ("print first^.value", "= 10"),
        ("print Node__at[first^.next.at].value", "= 20"),
        ("continue", "any.Start();"),
        ("print any.Motor^.speed", "= 7"),
        ("set var any.Motor^.speed := 30", ""),
        ("print motor.speed", "= 30"),
        ("print none", "= {Motor = 0x0, Pump = 0x0}"),
        ("ptype any", "Pump : ^Pump;"),
        ("print head^", "= {value = 10, next = {at = "),
        ("print Node__at[head^.next.at]", "= {value = 20, next = {at = 0}}"),
        ("print Node__at[all[2].at].value", "= 20"),
        ("print motor.peer.is", "= Pump"),
        ("print Pump__at[motor.peer.at].level", "= 3.5"),
        ("print Node__at[line.first.at].value", "= 10"),
        ("whatis line.first", "type = REF_TO Node"),
        ("print Plc.nodes[2].value", "= 20"),
        ("print Node__at[Plc.line.first.at].next", "= {at = "),
    ];
    here_in(&folder, &session.map(|(typed, printed)| (typed.to_owned(), printed)).to_vec());
}
