//! `staunch test` on suites of TcUnit.

use super::{Folder, has};

/// What a test is expected to do is in its title.
const SUITE: &str = "{dialect 'codesys'}
FUNCTION_BLOCK Parts
VAR_INPUT part : BOOL; END_VAR
VAR_OUTPUT count : INT; level : LREAL; END_VAR
    IF part THEN count := count + 1; level := level + 0.5; END_IF
END_FUNCTION_BLOCK
FUNCTION_BLOCK PartsTest EXTENDS TcUnit.FB_TestSuite
VAR delay : TON; parts : Parts; END_VAR
    One(); Arrays(); Later(); Never(); Disabled(); Twice();
    METHOD PRIVATE One
        TEST('passes');
        parts(part := TRUE);
        AssertEquals_INT(Expected := 1, Actual := parts.count, Message := 'one');
        AssertEquals(parts.count, 1, 'any');
        AssertEquals_LREAL(0.4, parts.level, 0.11, 'near');
        TEST_FINISHED();
        Check('first of two', 3);
        Check('second of two', 5);
    END_METHOD
    METHOD PRIVATE Check
    VAR_INPUT title : STRING; wanted : INT; END_VAR
    VAR i : INT; END_VAR
        TEST(title);
        FOR i := 1 TO wanted DO
            AssertTrue(i < wanted, Message := 'a message');
            AssertEquals_INT(wanted, i + 1, title);
        END_FOR
        TEST_FINISHED();
    END_METHOD
    METHOD PRIVATE Arrays
    VAR a : ARRAY[1..3] OF INT := [1, 2, 3]; b : ARRAY[0..2] OF INT := [1, 2, 4]; END_VAR
        TEST('arrays');
        AssertArrayEquals_INT(a, b, 'differ');
        TEST_FINISHED();
    END_METHOD
    METHOD PRIVATE Later
        TEST('after a second');
        delay(IN := TRUE, PT := T#1s);
        IF delay.Q THEN
            AssertEquals_TIME(T#1s, delay.ET, 'exactly');
            TEST_FINISHED();
        END_IF
    END_METHOD
    METHOD PRIVATE Never
        TEST('never ends');
    END_METHOD
    METHOD PRIVATE Disabled
        TEST('disabled_off');
        AssertTrue(FALSE, 'not counted');
        TEST_FINISHED();
    END_METHOD
    METHOD PRIVATE Twice
        TEST('twice'); TEST_FINISHED();
        TEST('twice'); TEST_FINISHED();
    END_METHOD
    METHOD PRIVATE Forgotten
        TEST('forgotten'); TEST_FINISHED();
    END_METHOD
END_FUNCTION_BLOCK
PROGRAM Main
VAR tests : PartsTest; END_VAR
    TcUnit.RUN();
END_PROGRAM
";

const WANTED: [&str; 19] = [
    "  ok      PartsTest.passes",
    "  FAILED  PartsTest.first of two",
    "26:13: AssertEquals_INT(wanted, i + 1, title)",
    "expected to be 3, found 2",
    "          first of two",
    "  FAILED  PartsTest.second of two",
    "expected to be 5, found 2",
    "  FAILED  PartsTest.arrays",
    "expected [3] = 3, found [2] = 4",
    "  ok      PartsTest.after a second",
    "  FAILED  PartsTest.never ends",
    "not finished within 200 scans (T#2s)",
    "a test ends with TEST_FINISHED()",
    "  skipped PartsTest.off: it is disabled",
    "  FAILED  PartsTest.twice",
    "begins a test with this title twice",
    "  skipped PartsTest.forgotten: the suite never begins it",
    "2 passed, 5 failed, 2 skipped",
    "",
];

#[test]
fn a_suite_runs_as_it_is_on_every_back_end() {
    let folder = Folder::new("a_tcunit_suite");
    folder.write("parts.st", SUITE);
    for backend in ["interpret", "native", "rust"] {
        let ran = folder.staunch(&format!("test parts.st --scans 200 --junit junit.xml --backend {backend}"));
        assert_eq!(ran.code, 1, "{}", ran.err);
        let mut rest = ran.out.as_str();
        for line in WANTED {
            let at = rest.find(line).unwrap_or_else(|| panic!("{backend}: no `{line}` in\n{rest}"));
            rest = &rest[at + line.len()..];
        }
        let junit = folder.read("junit.xml");
        has(&junit, &["tests=\"9\" failures=\"5\""]);
        has(&junit, &["name=\"PartsTest.off\""]);
        has(&junit, &["<skipped message=\"it is disabled\"/>"]);
        assert!(!ran.err.contains("never used"), "{}", ran.err);
    }
}

/// What is not a number is within no distance of anything; infinity is at no distance of itself.
#[test]
fn what_is_not_a_number_is_near_nothing() {
    let folder = Folder::new("tcunit_and_nan");
    let source = "{dialect 'twincat'}
FUNCTION_BLOCK T EXTENDS TcUnit.FB_TestSuite
VAR n, z, i : REAL; a, b : ARRAY[0..1] OF LREAL; END_VAR
    n := z / z; i := 1.0 / z; b[1] := n;
    TEST('found'); AssertEquals_REAL(1.0, n, 0.1, 'x'); TEST_FINISHED();
    TEST('expected'); AssertEquals_LREAL(n, 1.0, 0.1, 'x'); TEST_FINISHED();
    TEST('element'); AssertArrayEquals_LREAL(a, b, 0.1, 'x'); TEST_FINISHED();
    TEST('far'); AssertEquals_REAL(1.0, i, 0.1, 'x'); TEST_FINISHED();
    TEST('the same'); AssertEquals_REAL(i, i, 0.1, 'x'); TEST_FINISHED();
END_FUNCTION_BLOCK
PROGRAM Main
VAR t : T; END_VAR
    TcUnit.RUN();
END_PROGRAM
";
    folder.write("t.st", source);
    let ran = folder.staunch("test t.st");
    assert_eq!(ran.code, 1, "{}", ran.err);
    has(
        &ran.out,
        &["FAILED  T.found", "FAILED  T.expected", "FAILED  T.element", "FAILED  T.far", "ok      T.the same"],
    );
}

#[test]
fn a_filter_chooses_among_the_tests_of_a_suite() {
    let folder = Folder::new("a_filtered_tcunit_suite");
    folder.write("parts.st", SUITE);
    let ran = folder.staunch("test parts.st --scans 200 --filter partstest.after");
    assert_eq!(ran.code, 0, "{}", ran.err);
    has(&ran.out, &["1 passed, 0 failed"]);
}

#[test]
fn a_fault_is_of_the_tests_that_it_ends() {
    let folder = Folder::new("a_faulting_tcunit_suite");
    let source = "{dialect 'codesys'}
FUNCTION_BLOCK T EXTENDS FB_TestSuite
VAR zero : INT; END_VAR
    TEST('before'); TEST_FINISHED();
    TEST('in it'); zero := 1 / zero; TEST_FINISHED();
    TEST('after'); TEST_FINISHED();
END_FUNCTION_BLOCK
FUNCTION_BLOCK U EXTENDS T
    SUPER^();
END_FUNCTION_BLOCK
";
    folder.write("t.st", source);
    let ran = folder.staunch("test t.st");
    assert_eq!(ran.code, 1, "{}", ran.err);
    // U extends T.
    for line in
        ["ok      U.before", "FAILED  U.in it", "t.st:5:30: division by zero", "FAILED  U.after", "1 passed, 2 failed"]
    {
        has(&ran.out, &[line]);
    }
}

#[test]
fn a_suite_tells_mutants_apart_and_is_not_changed_itself() {
    let folder = Folder::new("mutants_of_a_tcunit_suite");
    let source = "{dialect 'codesys'}
FUNCTION Twice : INT
VAR_INPUT x : INT; END_VAR
    Twice := x * 2;
END_FUNCTION
FUNCTION_BLOCK T EXTENDS TcUnit.FB_TestSuite
    TEST('twice');
    AssertEquals_INT(6, Twice(3), '');
    TEST_FINISHED();
END_FUNCTION_BLOCK
PROGRAM MAIN
VAR t : T; END_VAR
    TcUnit.RUN();
END_PROGRAM
";
    folder.write("t.st", source);
    // What runs the suites elsewhere is not counted.
    let ran = folder.staunch("test t.st --mutants --coverage table");
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    has(&ran.out, &["1 of 1 100 %"]);
    has(&ran.out, &[", 0 survived"]);
}

#[test]
fn two_classes_of_types_are_not_equal() {
    let folder = Folder::new("type_classes_in_a_tcunit_suite");
    let source = "{dialect 'codesys'}
FUNCTION_BLOCK T EXTENDS FB_TestSuite
VAR i : INT := 1; d : DINT := 1; s : STRING; END_VAR
    TEST('sizes'); AssertEquals(Expected := i, Actual := d, Message := 'm'); TEST_FINISHED();
    TEST('kinds'); AssertEquals(s, TRUE, ''); TEST_FINISHED();
    TEST('literals'); AssertEquals(1, d, ''); AssertEquals(d, 16#01, ''); TEST_FINISHED();
END_FUNCTION_BLOCK
";
    folder.write("t.st", source);
    for backend in ["interpret", "native", "rust"] {
        let ran = folder.staunch(&format!("test t.st --backend {backend}"));
        assert_eq!(ran.code, 1, "{}", ran.err);
        has(&ran.out, &["expected (Type class = INT), found (Type class = DINT)"]);
        has(&ran.out, &["expected (Type class = STRING), found (Type class = BOOL)"]);
        has(&ran.out, &["ok      T.literals", "1 passed, 2 failed"]);
    }
}

/// By its address a suite writes what others may only read.
#[test]
fn suites_write_what_is_protected() {
    let source = "FUNCTION_BLOCK Part
VAR x : INT; END_VAR
END_FUNCTION_BLOCK
FUNCTION_BLOCK Machine
VAR_INPUT go : BOOL; name : STRING; END_VAR
VAR_OUTPUT done : BOOL; END_VAR
VAR count : INT := 3; part : Part; sensor AT %I* : INT; wait : TIME; since : DT; share : LREAL; END_VAR
    count := count + 1;
    done := count > 10 AND go;
END_FUNCTION_BLOCK
FUNCTION_BLOCK MachineTest EXTENDS TcUnit.FB_TestSuite
VAR machine : Machine; END_VAR
    TEST('writes');
    WRITE_PROTECTED_INT(Ptr := ADR(machine.count), Value := 20);
    WRITE_PROTECTED_INT(ADR(machine.part.x), 21);
    WRITE_PROTECTED_INT(ADR(machine.sensor), 22);
    TcUnit.WRITE_PROTECTED_BOOL(ADR(machine.go), TRUE);
    WRITE_PROTECTED_STRING(ADR(machine.name), 'abc');
    WRITE_PROTECTED_TIME(ADR(machine.wait), T#3S);
    WRITE_PROTECTED_DATE_AND_TIME(ADR(machine.since), DT#2024-01-01-00:00:00);
    write_protected_lreal(ADR(machine.share), 0.5);
    TCUNIT_ADSLOGSTR(ADSLOG_MSGTYPE_HINT, 'machine %s', 'A');
    machine();
    AssertTrue(machine.done, 'done');
    AssertEquals_INT(21, machine.count, 'count');
    AssertEquals_INT(21, machine.part.x, 'part');
    AssertEquals_INT(22, machine.sensor, 'sensor');
    AssertEquals_STRING('abc', machine.name, 'name');
    AssertEquals_TIME(T#3S, machine.wait, 'wait');
    AssertEquals_DATE_AND_TIME(DT#2024-01-01-00:00:00, machine.since, 'since');
    AssertEquals_LREAL(0.5, machine.share, 0.0, 'share');
    TEST_FINISHED();
END_FUNCTION_BLOCK
";
    let folder = Folder::with("tcunit_protected", &[("m.st", source)]);
    for backend in ["native", "interpret", "rust"] {
        let ran = folder.staunch(&format!("test . --dialect codesys --backend {backend}"));
        has(&ran.out(0), &["ok      MachineTest.writes\n", "1 passed, 0 failed"]);
    }
}

/// Member by member: what is after the end of a text, and between members, does not count.
#[test]
fn structures_and_arrays_are_compared() {
    let source = "TYPE
    Part : STRUCT b : BYTE; x : LREAL; s : STRING(10); END_STRUCT
    Whole : STRUCT flag : BOOL; code : INT; list : ARRAY[1..3, 0..1] OF Part; END_STRUCT
END_TYPE
FUNCTION Made : Whole
VAR_INPUT code : INT; END_VAR
    Made.code := code;
END_FUNCTION
FUNCTION_BLOCK Wholes EXTENDS TcUnit.FB_TestSuite
VAR all : ARRAY[0..3] OF Whole; i : INT; c, d, none : Whole; big, big2 : ARRAY[0..20000] OF INT; END_VAR
    TEST('same');
    i := 2;
    all[2].list[2, 1].s := 'abc$00xyz';
    all[2].list[2, 1].s := 'abc';
    c.list[2, 1].s := 'abc';
    all[2].list[3, 0].x := 0.5;
    c.list[3, 0].x := 0.5;
    AssertEquals(Expected := c, Actual := all[i], Message := 'elements');
    AssertEquals(big, big2, 'arrays');
    AssertEquals(Made(7), Made(7), 'results');
    TEST_FINISHED();
    TEST('a member'); d := none; d.code := 5; AssertEquals(none, d, ''); TEST_FINISHED();
    TEST('an element'); d := none; d.list[3, 1].b := 1; AssertEquals(none, d, ''); TEST_FINISHED();
    TEST('a text'); d := none; d.list[1, 1].s := 'a'; AssertEquals(none, d, ''); TEST_FINISHED();
    TEST('a result'); AssertEquals(Made(8), none, ''); TEST_FINISHED();
    TEST('an array'); big2[20000] := 1; AssertEquals(big, big2, ''); TEST_FINISHED();
END_FUNCTION_BLOCK
";
    let folder = Folder::with("tcunit_wholes", &[("w.st", source)]);
    for backend in ["native", "interpret", "rust"] {
        let out = folder.staunch(&format!("test . --dialect codesys --backend {backend}")).out(1);
        has(&out, &["ok      Wholes.same\n", "1 passed, 5 failed"]);
        has(&out, &["AssertEquals(none, d, '')\n          expected to be the same, code differs\n"]);
        has(&out, &["expected to be the same, list[…][…].b differs\n"]);
        has(&out, &["expected to be the same, list[…][…].s differs\n", "expected to be the same, […] differs\n"]);
    }
}

/// TcUnit passes over a name that no test has.
#[test]
fn a_test_that_is_finished_by_another_name_is_told() {
    let source = "FUNCTION_BLOCK Starts EXTENDS TcUnit.FB_TestSuite
    TEST('starts'); TEST_FINISHED_NAMED('strats');
END_FUNCTION_BLOCK
FUNCTION_BLOCK Ends EXTENDS TcUnit.FB_TestSuite
    TEST('  one '); TEST_FINISHED_NAMED('typo'); TEST_FINISHED_NAMED('one');
END_FUNCTION_BLOCK
";
    let folder = Folder::with("tcunit_finished", &[("s.st", source)]);
    let out = folder.staunch("test . --dialect codesys --scans 3").out(1);
    has(&out, &["FAILED  Starts.starts\n", "ok      Ends.one\n", "1 passed, 1 failed, 2 skipped\n"]);
    for title in ["Starts.strats", "Ends.typo"] {
        has(&out, &[&format!("skipped {title}: TEST_FINISHED_NAMED names it, but the suite never begins it\n")]);
    }
}
