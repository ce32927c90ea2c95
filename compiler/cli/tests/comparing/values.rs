//! Values that are not numbers: strings as inputs, references, and instances that a PROGRAM is given.

use super::programs::{self, Folder};

const OWN: Folder = Folder("values");

fn compare(path: &str, (from, to): (&str, &str), more: &[&str]) -> (Option<i32>, String) {
    let arguments = [path, "--from", from, "--to", to, "-A", "warnings", "--budget", "400000"];
    programs::compare(&[&arguments[..], more].concat())
}

fn order(name: &str, declared: &str, condition: &str) -> String {
    let body = format!("IF {condition} THEN c(CU := part, PV := 3); END_IF\nn := c.CV;");
    let text = format!(
        "PROGRAM p\nVAR_INPUT part : BOOL; END_VAR\nVAR_OUTPUT n : INT; END_VAR\nVAR c : CTU; END_VAR\n{declared}\n{body}\nEND_PROGRAM\n"
    );
    OWN.written(name, &text)
}

/// A counter that only a text lets count: trap 1 shows in its second scan.
#[test]
fn a_text_is_one_that_the_program_compares_it_with() {
    let asked = [
        ("literal.st", "VAR_INPUT code : STRING[20]; END_VAR", "code = 'START'"),
        ("wide.st", "VAR_INPUT code : WSTRING[20]; END_VAR", "\"START\" = code"),
        ("other.st", "VAR_INPUT code : STRING[20] := 'STOP'; END_VAR", "code <> 'STOP'"),
        ("none.st", "VAR_INPUT code : STRING[20] := 'STOP'; END_VAR", "code = ''"),
        ("ordered.st", "VAR_INPUT code : STRING[20]; END_VAR", "code > 'M'"),
        ("length.st", "VAR_INPUT code : STRING[20]; END_VAR", "LEN(code) > 15"),
        (
            "constant.st",
            "VAR_INPUT code : STRING[20]; END_VAR VAR wanted : STRING[20] := 'GO'; END_VAR",
            "code = wanted",
        ),
        ("outside.st", "VAR code : STRING[20]; END_VAR", "code = 'START'"),
    ];
    for (name, declared, condition) in asked {
        let assumed = OWN.written("input.txt", "input code\n");
        let (code, text) = compare(&order(name, declared, condition), ("iec", "cscape"), &["--assume", &assumed]);
        assert!(code == Some(1) && text.contains("differ after 2 scans"), "{name}: {text}");
    }
}

/// A text that decides is found through what is computed of the input, and a character is shown as one.
#[test]
fn a_text_is_followed_back_to_the_input() {
    let asked = [
        ("cut.st", "STRING[20]", "s10 := code;", "s10 = 'START'", "START"),
        ("part.st", "STRING[20]", "", "MID(code, 2, 3) = 'AB'", "xxAB"),
        ("sought.st", "STRING[20]", "", "FIND(code, 'AB') > 0", "AB"),
        ("function.st", "STRING[20]", "", "Is(code)", "ABC"),
        ("in_out.st", "STRING[20]", "s20 := code; f(t := s20);", "f.q", "DEF"),
        ("computed.st", "STRING[20]", "s10 := LEFT(code, 5);", "s10 = 'START'", "START"),
        ("widened.st", "STRING[20]", "w := STRING_TO_WSTRING(code);", "w = \"START\"", "START"),
        ("first.st", "STRING[20]", "ch := STRING_TO_CHAR(code);", "ch = 'Q'", "Q"),
        ("character.st", "CHAR", "ch := code;", "ch = 'Q'", "Q"),
        ("unseen.st", "CHAR", "ch := code;", "ch = '$N'", "$0A"),
        ("text_of_it.st", "CHAR", "s10 := CHAR_TO_STRING(code);", "s10 = ','", ","),
    ];
    for (name, ty, before, condition, value) in asked {
        let text = format!(
            "FUNCTION Is : BOOL VAR_INPUT t : STRING; END_VAR Is := t = 'ABC'; END_FUNCTION
FUNCTION_BLOCK FB VAR_IN_OUT t : STRING[20]; END_VAR VAR_OUTPUT q : BOOL; END_VAR q := t = 'DEF'; END_FUNCTION_BLOCK
PROGRAM p
VAR_INPUT code : {ty}; END_VAR VAR_OUTPUT n : INT; END_VAR
VAR c : CTU; s10 : STRING[10]; s20 : STRING[20]; ch : CHAR; w : WSTRING[10]; f : FB; END_VAR
{before}
IF {condition} THEN c(CU := TRUE, PV := 3); END_IF
n := c.CV;
END_PROGRAM
"
        );
        let path = OWN.written(name, &text);
        let saved = OWN.path().join("followed.csv").display().to_string();
        let (code, text) = compare(&path, ("iec", "cscape"), &["--vars", "n", "--save-stimulus", &saved]);
        assert!(code == Some(1) && text.contains("differ after 2 scans"), "{name}: {text}");
        assert!(text.lines().any(|it| it.split_whitespace().eq(["1", value, "1", "1"])), "{name}: {text}");
        let (code, again) = compare(&path, ("iec", "cscape"), &["--stimulus", &saved]);
        assert!(code == Some(1) && again.contains("differ after 2 scans"), "{name}: {again}");
    }
}

/// Texts among bits that others share have their own names: as what differs, as inputs, and in a stimulus.
#[test]
fn a_text_among_shared_bits_is_one() {
    let path = OWN.written(
        "shared_text.st",
        "PROGRAM p
VAR last AT %IB3 : BYTE; code AT %IB0 : STRING[4]; shown AT %QB0 : STRING[5]; bit AT %QX2.0 : BOOL; c : CTU; END_VAR
c(code = 'GO', FALSE, 2);
shown := CONCAT(INT_TO_STRING(c.CV), code);
END_PROGRAM
",
    );
    let saved = OWN.path().join("shared_text.csv").display().to_string();
    let (code, text) = compare(&path, ("iec", "cscape"), &["--vars", "shown", "--save-stimulus", &saved]);
    assert!(code == Some(1) && !text.contains("bits_of"), "{text}");
    for line in ["  scan  code  last  shown iec  shown cscape", "     2    GO     0        1GO           2GO ◀"] {
        assert!(text.contains(line), "{text}");
    }
    assert_eq!(std::fs::read_to_string(&saved).ok().as_deref(), Some("scan,code,last\n1,\"GO\",0\n2,\"GO\",0\n"));
    let (code, again) = compare(&path, ("iec", "cscape"), &["--stimulus", &saved]);
    assert!(code == Some(1) && again.contains("differ after 2 scans"), "{again}");
}

/// Where it is only asked whether a text is equal to some, one that is none of them stands for all.
#[test]
fn texts_that_are_compared_alone_are_covered() {
    let with = |name: &str, condition: &str, line: &str, systems| {
        let source = order(name, "VAR_INPUT code : STRING[20]; END_VAR", condition);
        compare(&source, systems, &["--assume", &OWN.written("assumed.txt", line)])
    };
    let (code, text) = with("equal.st", "code = 'START'", "code <> 'START'\n", ("iec", "cscape"));
    assert!(code == Some(0) && text.contains("that the program compares code with"), "{text}");
    let (code, text) = with("parts.st", "LEFT(code, 2) = 'ST'", "not part\n", ("iec", "cscape"));
    assert!(code == Some(4) && text.contains("values of code other than the"), "{text}");
    let (code, text) = with("unknown.st", "code = 'START'", "code = 'STOP'\n", ("iec", "cscape"));
    assert!(code == Some(2) && text.contains("the search does not try 'STOP', but only"), "{text}");
    let (_, text) = with("order.st", "code = 'START'", "code < 'START'\n", ("iec", "cscape"));
    assert!(text.contains("`code` is a string: compare it with `=` or `<>`"), "{text}");
    let (_, text) = with("range.st", "code = 'START'", "code 'A'..'B'\n", ("iec", "cscape"));
    assert!(text.contains("`code` is a string, which has no range"), "{text}");
    let (_, text) = with("open.st", "code = 'START'", "code = 'START\n", ("iec", "cscape"));
    assert!(text.contains("a ' that closes the text is missing"), "{text}");
}

/// The same trace comes back from a file: a text with all that a cell may hold.
#[test]
fn a_text_goes_through_a_stimulus() {
    let source = order("saved.st", "VAR_INPUT code : STRING[20]; END_VAR", "code = 'a,\"b\"; c'");
    let saved = OWN.path().join("saved.csv").display().to_string();
    let (_, first) = compare(&source, ("iec", "cscape"), &["--save-stimulus", &saved]);
    assert_eq!(
        std::fs::read_to_string(&saved).ok().as_deref(),
        Some("scan,part,code\n1,TRUE,\"a,\"\"b\"\"; c\"\n2,TRUE,\"a,\"\"b\"\"; c\"\n"),
        "{first}"
    );
    let (code, again) = compare(&source, ("iec", "cscape"), &["--stimulus", &saved]);
    assert!(code == Some(1) && again.contains("differ after 2 scans"), "{again}");
}

/// A text that one system's type is too short for may differ: only what both hold is tried.
#[test]
fn texts_of_two_lengths_are_not_covered_where_they_are_handed_on() {
    let with = |name: &str, declared: &str, condition: &str| {
        let source = order(name, declared, condition);
        compare(&source, ("iec", "cscape"), &["--assume", &OWN.written("no_part.txt", "not part\n")])
    };
    let (code, text) = with("asked.st", "VAR_INPUT code : STRING; END_VAR", "code = 'START'");
    assert_eq!(code, Some(0), "{text}");
    let declared = "VAR_INPUT code : STRING; END_VAR VAR last : STRING; END_VAR\nlast := code;";
    let (code, text) = with("handed_on.st", declared, "last = 'START'");
    assert!(code == Some(4) && text.contains("values of code other than the"), "{text}");
}

const REFERRING: &str = "PROGRAM p
VAR_INPUT left : BOOL; END_VAR
VAR_OUTPUT n : INT; END_VAR
VAR DECLARED END_VAR
IF left THEN lead := ADR(a); ELSE lead := ADR(b); END_IF
lead^ := (lead^ + 1) MOD 3;
n := a;
END_PROGRAM
";

/// Where variables are is each program's own; what a pointer leads to is compared.
#[test]
fn references_are_compared_by_what_they_lead_to() {
    let first = "lead : POINTER TO INT; a, b : INT;";
    let of = |name: &str, declared: &str| OWN.written(name, &REFERRING.replace("DECLARED", declared));
    let systems = ("codesys", "codesys");
    let original = of("here.st", first);
    let moved = of("there.st", "more : LREAL; b, a : INT; lead : POINTER TO INT;");
    let (code, text) = compare(&original, systems, &["--against", &moved]);
    assert_eq!(code, Some(0), "{text}");
    let turned = OWN.written("turned.st", &REFERRING.replace("DECLARED", first).replace("IF left", "IF NOT left"));
    let (code, text) = compare(&original, systems, &["--against", &turned, "--vars", "lead"]);
    assert!(code == Some(1) && text.contains("FALSE             b             a ◀"), "{text}");
    let long = of("long.st", "s : STRING; lead : POINTER TO INT; a, b : INT;");
    let (code, text) = compare(&long, ("codesys", "iec"), &["--assume", &OWN.written("no_run.txt", "no run\n")]);
    assert!(code == Some(0) && !text.contains("`lead`"), "{text}");
}

/// The world outside has no address to give: such an input is said to be untried.
#[test]
fn a_reference_as_input_is_not_tried() {
    let text = "PROGRAM p\nVAR_INPUT lead : POINTER TO INT; END_VAR\nVAR_OUTPUT n : BOOL; END_VAR\nVAR i, s : INT := 1; END_VAR\nFOR i := 0 TO 2 BY s DO n := lead <> 0; END_FOR\nEND_PROGRAM\n";
    let (code, text) =
        compare(&OWN.written("given.st", text), ("codesys", "iec"), &["--assume", &OWN.written("r.txt", "no run\n")]);
    assert!(
        code == Some(4) && text.contains("inputs that are references, or have another type on the other system: lead"),
        "{text}"
    );
}

/// Of an instance that a PROGRAM is given, the inputs and outputs come from outside, and its memory does not.
#[test]
fn the_memory_of_an_instance_is_no_input() {
    let text = "FUNCTION_BLOCK Station
VAR_INPUT start : BOOL; END_VAR
VAR_OUTPUT n : INT; END_VAR
VAR c : CTU; armed : BOOL; END_VAR
c(CU := start AND armed, PV := 3);
n := c.CV;
END_FUNCTION_BLOCK
PROGRAM p
VAR_INPUT s : Station; part : BOOL; END_VAR
VAR_OUTPUT total : INT; END_VAR
s(start := part);
total := s.n;
END_PROGRAM
";
    let (code, found) = compare(&OWN.written("station.st", text), ("iec", "cscape"), &[]);
    assert_eq!(code, Some(0), "{found}");
    let armed = OWN.written("armed.st", &text.replace("armed : BOOL", "armed : BOOL := TRUE"));
    let (code, found) = compare(&armed, ("iec", "cscape"), &[]);
    assert!(code == Some(1) && !found.contains("s.armed"), "{found}");
    let reads = text
        .replace("s(start := part);\n", "")
        .replace("total := s.n", "IF s.start AND part THEN total := s.n; END_IF");
    let (_, found) = compare(&OWN.written("reads.st", &reads), ("iec", "openplc"), &[]);
    assert!(found.contains("compares s.n with; nothing writes s.armed (FALSE)"), "{found}");
}

/// A member of an element of an array is named by its own declaration, as any variable.
#[test]
fn a_member_of_an_element_is_a_finding_of_its_own() {
    let text = "TYPE Row : STRUCT sum : DINT; END_STRUCT END_TYPE
PROGRAM p
VAR_INPUT a, b : INT; END_VAR
VAR rows : ARRAY[1..2] OF Row; END_VAR
rows[1].sum := a + b;
END_PROGRAM
";
    let (code, text) =
        compare(&OWN.written("rows.st", text), ("iec", "codesys"), &["--assume", &OWN.written("n.txt", "no run\n")]);
    assert!(code == Some(1) && text.contains("`rows[1].sum` (width, ") && !text.contains("(variable, "), "{text}");
}

/// Two texts stand for all that nothing names: no assumption may leave both out, and take the rest with them.
#[test]
fn texts_that_stand_for_others_are_not_assumed_away() {
    let source = order("stand_in.st", "VAR_INPUT code : STRING[8]; END_VAR", "code <> 'STOP' AND code <> ''");
    let assumed = OWN.written("stand_in.txt", "code <> 'a'\ncode <> 'xxxxxxxx'\n");
    let (code, text) = compare(&source, ("iec", "openplc"), &["--assume", &assumed]);
    assert!(code == Some(2) && text.contains("the search does not try 'a', but only"), "{text}");
}

/// A standard block that is an input is given what its input pins take; what else might be written to it is not ruled out.
#[test]
fn standard_blocks_that_are_inputs_are_given_their_pins() {
    let timed = OWN.written(
        "given_timer.st",
        "PROGRAM P\nVAR_INPUT t : TON; b : BOOL; END_VAR\nVAR_OUTPUT o : BOOL; END_VAR\nVAR k : CTU; END_VAR\n\
         k(CU := b AND t.PT = T#5s, PV := 1);\no := k.CV > 1;\nEND_PROGRAM\n",
    );
    let (code, text) = compare(&timed, ("iec", "openplc"), &["--vars", "o"]);
    assert!(code == Some(1) && text.contains("differ after 3 scans"), "{text}");
    let counted = OWN.written(
        "given_counters.st",
        "PROGRAM P\nVAR_INPUT c : ARRAY[1..2] OF CTU; END_VAR\nVAR_OUTPUT n : INT; END_VAR\nc[2]();\nn := c[2].CV;\nEND_PROGRAM\n",
    );
    let (code, text) = compare(&counted, ("iec", "cscape"), &[]);
    assert!(code == Some(1) && text.contains("differ after"), "{text}");
    let latched = OWN.written(
        "given_latch.st",
        "PROGRAM P\nVAR_INPUT s : SR; b : BOOL; END_VAR\nVAR_OUTPUT o : BOOL; END_VAR\nVAR c : CTU; END_VAR\n\
         c(CU := s.Q1, PV := 2);\no := c.CV > 2;\nEND_PROGRAM\n",
    );
    let (code, text) = compare(&latched, ("iec", "cscape"), &[]);
    assert!(code == Some(4) && text.contains("outputs of blocks that are inputs: s.Q1"), "{text}");
}

/// A run that connects its PROGRAM with global variables has the PROGRAM's variables by their names.
#[test]
fn variables_of_a_connected_run_are_named() {
    let source = OWN.written(
        "connected.st",
        "VAR_GLOBAL g : BOOL; END_VAR\nPROGRAM Pa\nVAR_INPUT b : BOOL; END_VAR\nVAR_OUTPUT o : BOOL; END_VAR\nVAR c : CTU; END_VAR\n\
         c(CU := b, PV := 3);\no := c.CV = 4;\nEND_PROGRAM\n\
         CONFIGURATION C\nRESOURCE R ON PLC\nTASK t1(INTERVAL := T#10ms, PRIORITY := 1);\nPROGRAM i1 WITH t1 : Pa(b := g);\n\
         END_RESOURCE\nEND_CONFIGURATION\n",
    );
    let (code, text) = compare(&source, ("iec", "openplc"), &["--vars", "o"]);
    assert!(code == Some(1) && text.contains("o openplc") && !text.contains("PROGRAM."), "{text}");
}

/// An output that shares its bits on one system, and is written by another name, is one of its own on the other.
#[test]
fn an_output_that_one_system_alone_has_is_not_passed_over() {
    let source = OWN.written(
        "overlapping_outputs.st",
        "PROGRAM P\nVAR_INPUT k : BOOL; END_VAR\nVAR w AT %QW0 : WORD; b AT %QX0.0 : BOOL; END_VAR\n\
         IF k THEN w := WORD#1; ELSE w := WORD#0; END_IF\nEND_PROGRAM\n",
    );
    let (code, text) = compare(&source, ("iec", "openplc"), &[]);
    assert!(code != Some(0) && !text.contains("are equal"), "{text}");
}

/// Where systems round in different ways, halves show it; where a number is made a text, the texts of the program do.
#[test]
fn conversions_are_tried_where_they_differ() {
    let asked = [
        ("rounded.st", "x : REAL", "n : INT", "n := REAL_TO_INT(x);", "openplc4"),
        ("cut.st", "x : LREAL", "n : INT", "n := LREAL_TO_INT(x);", "logix"),
        ("written.st", "x : INT", "b : BOOL", "b := INT_TO_STRING(x) = '5';", "siemens"),
    ];
    for (name, input, output, statement, to) in asked {
        let text =
            format!("PROGRAM p\nVAR_INPUT {input}; END_VAR\nVAR_OUTPUT {output}; END_VAR\n{statement}\nEND_PROGRAM\n");
        let (code, text) = compare(&OWN.written(name, &text), ("iec", to), &[]);
        assert!(code == Some(1) && text.contains("differ after 1 scan"), "{name}: {text}");
    }
}
