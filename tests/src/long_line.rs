//! A program whose declarations are beyond the columns that a place has: all of a line are at one place there, and each keeps
//! its own value, path and storage.

/// Its name among the generated modules.
pub const MODULE: &str = "long_line";

/// What its variables are after the first scan, by their paths in a trace.
pub const VALUES: [(&str, &str); 16] = [
    ("Main.first", "7"),
    ("Main.second", "9"),
    ("Main.kept", "11"),
    ("Main.anew", "13"),
    ("Main.one.n", "1"),
    ("Main.two.n", "2"),
    ("Main.three.n", "0"),
    ("Main.pair.left.n", "3"),
    ("Main.pair.right.n", "4"),
    ("Main.pair.bare", "15"),
    ("Main.of_one", "Main.one/other"),
    ("Main.of_two", "Main.two/other"),
    ("Main.of_left", "Main.pair.left/other"),
    ("Main.of_global", "GVL.g_first/other"),
    ("Main.globals", "56"),
    ("Main.counted", "5"),
];

pub fn program() -> String {
    let far = " ".repeat(66_000);
    format!(
        "{{dialect 'codesys'}}
FUNCTION_BLOCK Part
VAR {far}{{attribute 'instance-path'}} path : STRING[40]; other : STRING[40] := 'other'; END_VAR VAR_OUTPUT n : INT; END_VAR
METHOD FB_init : BOOL
VAR_INPUT bInitRetains, bInCopyCode : BOOL; first : INT; END_VAR
n := first;
END_METHOD
METHOD Text : STRING[80]
Text := CONCAT(CONCAT(path, '/'), other);
END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Plain VAR_OUTPUT n : INT; END_VAR END_FUNCTION_BLOCK
TYPE Pair : STRUCT {far}left : Part(3); right : Part(4); bare : INT := 15; END_STRUCT END_TYPE
{{gvl 'GVL'}}
VAR_GLOBAL {far}g_first : Part(5); g_second : Part(6); END_VAR
FUNCTION_BLOCK Counter
VAR_OUTPUT n : INT; END_VAR
VAR_STAT {far}step : INT := 2; more : INT := 3; END_VAR
n := n + step + more;
END_FUNCTION_BLOCK
PROGRAM Main
VAR {far}one : Part(1); two : Part(2); three : Plain; pair : Pair; first : INT := 7; second : INT := 9; END_VAR VAR RETAIN kept : \
         INT := 11; END_VAR VAR anew : INT := 13; END_VAR
VAR of_one, of_two, of_left, of_global : STRING[80]; globals, counted : INT; counter : Counter; END_VAR
of_one := one.Text(); of_two := two.Text(); of_left := pair.left.Text(); of_global := GVL.g_first.Text();
globals := 10 * GVL.g_first.n + GVL.g_second.n;
counter(n => counted);
END_PROGRAM
"
    )
}
