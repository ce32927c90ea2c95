//! OpenPLC's compilers bind and order the arguments of some calls otherwise: a program with one is never called equal.

use super::programs::Folder;

const OWN: Folder = Folder("calls");

const POUS: &str = "FUNCTION_BLOCK Two
VAR_INPUT a : INT; b : INT; END_VAR
VAR_OUTPUT o, p : INT; END_VAR
METHOD PUBLIC Read : INT
Read := a + p;
END_METHOD
METHOD PUBLIC Next : INT
p := (p + 1) MOD 8; Next := p;
END_METHOD
o := a + b; p := a;
END_FUNCTION_BLOCK
FUNCTION Bump : INT
VAR_IN_OUT g : INT; END_VAR
g := (g + 1) MOD 2; Bump := g;
END_FUNCTION
FUNCTION_BLOCK Inout
VAR_INPUT a : INT; END_VAR
VAR_IN_OUT v : INT; END_VAR
VAR_OUTPUT o : INT; END_VAR
METHOD M : INT
VAR_INPUT c, d : INT; END_VAR
M := c - 2 * d;
END_METHOD
v := v + a; o := v;
END_FUNCTION_BLOCK
";

/// With a VAR_OUTPUT, which is another rule that OpenPLC4 has and that is not followed.
const BOTH: &str = "FUNCTION Both : INT
VAR_IN_OUT v, w : INT; END_VAR
VAR_OUTPUT o : INT; END_VAR
v := v + 1; Both := v + w; o := w;
END_FUNCTION
";

fn program(body: &str) -> String {
    let both = if body.contains("Both") { BOTH } else { "" };
    format!(
        "{POUS}{both}PROGRAM p
VAR_INPUT n : INT(0..3); on : BOOL; END_VAR
VAR_OUTPUT q : INT; END_VAR
VAR x : Two; y : Inout; c : CTU; d : TON; i, j : INT; t : ARRAY[0..9] OF INT; m : ARRAY[0..1, 0..1] OF INT; s : STRING; END_VAR
{body}
END_PROGRAM
"
    )
}

#[test]
fn what_a_call_is_on_openplc_is_not_equal() {
    let one_by_one = "inputs are assigned one by one";
    let right_first = "the right operand and the last argument are evaluated first";
    let asked = [
        ("read", "openplc", "x(a := n, b := x.a); q := x.o;", one_by_one),
        ("read", "openplc4", "x(a := n, b := x.a); q := x.o;", one_by_one),
        ("before", "openplc", "x(b := x.a, a := n); q := x.o;", one_by_one),
        ("by_method", "openplc4", "x(a := n, b := x.Read()); q := x.o;", one_by_one),
        ("target_by_method", "openplc4", "x(p => t[x.Read() MOD 10]); q := t[1];", "it is looked up after the call"),
        ("pin", "openplc4", "d(PT := T#20ms, IN := d.PT = T#20ms); IF d.Q THEN q := n; END_IF;", one_by_one),
        (
            "target",
            "openplc4",
            "i := 1; x(a := n, p => i, o => t[i MOD 10]); q := t[1];",
            "it is looked up after the call",
        ),
        (
            "target",
            "openplc",
            "i := 1; x(a := n, p => i, o => t[i MOD 10]); q := t[1];",
            "it is looked up after the call",
        ),
        ("operands", "openplc4", "q := x.Next() - 2 * x.Next();", right_first),
        ("compared", "openplc4", "IF x.Next() > x.Next() THEN q := n; END_IF;", right_first),
        ("arguments", "openplc4", "q := y.M(x.Next(), x.Next());", right_first),
        ("chosen", "openplc4", "q := MAX(x.Next(), 7 - x.Next());", right_first),
        ("later_argument", "openplc4", "i := n; q := MAX(Bump(i), i);", right_first),
        ("indices", "openplc4", "i := 0; m[Bump(i), i] := 7; q := m[1, 1];", right_first),
        ("index", "openplc4", "t[x.Next()] := x.Next(); q := t[1];", right_first),
        (
            "time",
            "openplc4",
            "d(IN := on, PT := T#1s); IF d.ET / 3.0 * 3.0 = d.ET THEN q := n; END_IF;",
            "it is a double",
        ),
        ("named", "openplc4", "i := n; y(a := 1, v := i); q := y.M(d := 1, c := n);", "the names are ignored"),
        ("left_out", "openplc4", "i := n; y(a := 1, v := i); q := y.M(d := 1);", "the names are ignored"),
        ("position", "openplc4", "i := n; y(1, i); q := i;", "only inputs are counted"),
        ("literals", "openplc4", "IF 'ab' < 'abc' THEN q := n; END_IF;", "C++ compares addresses"),
        ("twice", "openplc", "i := n; q := Both(i, i);", "it is copied in before the call"),
        ("of_block", "openplc4", "i := n; y(a := 1, v := i, o => i); q := i;", "it is copied in before the call"),
        ("output", "openplc", "i := n; j := n; q := Both(i, j, o => i);", "it is copied in before the call"),
    ];
    for (name, to, body, why) in asked {
        let arguments = ["--from", "iec", "--to", to, "-A", "warnings", "--budget", "20000"];
        let (code, text) = OWN.compare(name, &program(body), &arguments);
        assert!(code == Some(4) && text.contains(why), "{name}: {text}");
    }
    let same = [
        ("openplc", "x(a := n, b := x.p); q := x.o;"),
        ("openplc4", "x(a := n, b := n); q := x.p;"),
        ("openplc4", "q := x.Read() - 2 * x.Read();"),
        ("openplc4", "q := x.Next() - 2 * n;"),
        ("openplc4", "d(IN := on, PT := T#1s); IF d.ET * 3 = T#30ms THEN q := n; END_IF;"),
        ("openplc4", "c(CU := on, R := c.Q, PV := 2); q := n;"),
        ("openplc4", "i := n; x(a := i, o => t[i], p => j); q := t[1];"),
        ("openplc4", "i := n; y(a := 1, v := i); q := y.M(c := 1, d := n);"),
        ("openplc4", "i := n; y(a := 1, v := i); q := y.M(n, 2);"),
        ("openplc4", "s := 'ab'; IF s < 'abc' THEN q := n; END_IF;"),
        ("openplc", "i := n; j := n; q := Both(i, j);"),
    ];
    for (to, body) in same {
        let (code, text) = OWN.compare("same", &program(body), &["--from", "iec", "--to", to, "-A", "warnings"]);
        assert!(code == Some(0), "{to}, {body}: {text}");
    }
}

#[test]
fn a_program_without_a_task_is_not_equal() {
    let source = |task: &str| {
        format!(
            "PROGRAM p\nVAR_OUTPUT n : INT; END_VAR\nn := n + 1;\nEND_PROGRAM
CONFIGURATION c\nRESOURCE r ON plc\nTASK fast(INTERVAL := T#10ms, PRIORITY := 1);
PROGRAM a WITH fast : p;\nPROGRAM b {task} : p;\nEND_RESOURCE\nEND_CONFIGURATION\n"
        )
    };
    let arguments = ["--from", "iec", "--to", "openplc4", "--program", "b"];
    let (_, text) = OWN.compare("no_task", &source(""), &arguments);
    assert!(text.contains("it runs in the first TASK"), "{text}");
    let (_, text) = OWN.compare("with_task", &source("WITH fast"), &arguments);
    assert!(!text.contains("it runs in the first TASK"), "{text}");
}
