//! `staunch test`.

use super::{Folder, has};

const SOURCE: &str = "FUNCTION Sum : INT
VAR_INPUT a, b : INT; END_VAR
    Sum := a + b;
END_FUNCTION
FUNCTION_BLOCK Sensor
VAR_INPUT channel : INT; END_VAR
VAR_OUTPUT value : REAL := 1.5; END_VAR
END_FUNCTION_BLOCK
FUNCTION_BLOCK Motor
VAR_INPUT setpoint : REAL; END_VAR
VAR_OUTPUT speed : REAL; END_VAR
VAR sensor : Sensor; calls : INT; END_VAR
    sensor(channel := Sum(1, 2));
    speed := setpoint - sensor.value;
    calls := calls + 1;
END_FUNCTION_BLOCK
PROGRAM Main
VAR motor : Motor; speed : REAL; END_VAR
    motor(setpoint := 3.0);
    speed := motor.speed;
END_PROGRAM
";

const TESTS: &str = "SETUP
VAR motor : Motor; delay : TON; END_VAR
    motor(setpoint := 2.0);
END_SETUP
TEARDOWN
    ASSERT_LT(motor.calls, 4, 'too many calls');
END_TEARDOWN
TEST 'setup runs before each test'
    ASSERT_EQ(motor.calls, 1);
    ASSERT_NEAR(motor.speed, 0.5, 0.001);
END_TEST
TEST \"state is fresh, and time is virtual\"
    ASSERT_EQ(motor.calls, 1);
    delay(IN := TRUE, PT := T#100ms);
    ADVANCE_TIME(T#99ms);
    delay(IN := TRUE, PT := T#100ms);
    ASSERT_FALSE(delay.Q);
    ADVANCE_TIME(1000000); (* nanoseconds *)
    delay(IN := TRUE, PT := T#100ms);
    ASSERT_TRUE(delay.Q);
END_TEST
TEST 'mocks'
    MOCK motor.sensor;
    MOCK_FUNCTION Sum RETURNS 7;
    motor.sensor.value := 25.0;
    motor(setpoint := 100.0);
    ASSERT_NEAR(motor.speed, 75.0, 0.001);
    ASSERT_EQ(motor.sensor.channel, 7);
    MOCK_VERIFY_CALLED(motor.sensor);
    MOCK_VERIFY_CALL_COUNT(motor.sensor, 1);
END_TEST
TEST 'a mock is of its own test'
    ASSERT_EQ(Sum(1, 2), 3);
    motor(setpoint := 100.0);
    ASSERT_NEAR(motor.speed, 98.5, 0.001);
END_TEST
TEST 'a program is an instance too'
VAR main : Main; END_VAR
    main();
    ASSERT_GE(main.speed, 1.5);
    ASSERT_LE(main.speed, 1.5);
END_TEST
";

pub const BACKENDS: [&str; 3] = ["native", "interpret", "rust"];

#[test]
fn tests_pass() {
    let folder = Folder::with("tests_pass", &[("motor.st", SOURCE), ("motor_test.st", TESTS)]);
    folder.staunch("check . -D warnings").out(0);
    for backend in BACKENDS {
        let out = folder.staunch(&format!("test . --backend {backend}")).out(0);
        has(&out, &["motor_test.st\n  ok      setup runs before each test\n", "\n5 passed, 0 failed\n"]);
    }
    // They are not part of what is built or run.
    assert!(!folder.staunch("run . --scans 1 --trace -").out(0).contains("test"));
    assert!(!folder.staunch("build . --emit map -o -").out(0).contains("mocked"));
}

#[test]
fn failures_say_what_was_expected() {
    let tests = "TEST 'a number'
        ASSERT_EQ(Sum(1, 2), 4, 'one and two');
        ASSERT_TRUE(FALSE);
    END_TEST
    TEST 'a text'
    VAR name : STRING := 'fan'; END_VAR
        ASSERT_EQ(name, 'pump');
    END_TEST
    TEST 'a condition'
        ASSERT_FALSE(Sum(1, 2) = 3);
    END_TEST
    TEST 'calls'
    VAR motor : Motor; END_VAR
        MOCK motor.sensor;
        MOCK_VERIFY_CALL_COUNT(motor.sensor, 2);
    END_TEST
    TEST 'a fault'
    VAR i : INT := 7; list : ARRAY[0..3] OF INT; END_VAR
        list[i] := 1;
    END_TEST
    TEST 'a loop without an end'
    VAR n : INT; END_VAR
        WHILE n < 10 DO n := 0; END_WHILE
    END_TEST
    ";
    let folder = Folder::with("tests_fail", &[("motor.st", SOURCE), ("motor_test.st", tests)]);
    let expected = "motor_test.st
  FAILED  a number
          motor_test.st:2:9: ASSERT_EQ(Sum(1, 2), 4, 'one and two')
          expected to be 4, found 3
          one and two
  FAILED  a text
          motor_test.st:7:9: ASSERT_EQ(name, 'pump')
          expected to be 'pump', found 'fan'
  FAILED  a condition
          motor_test.st:10:9: ASSERT_FALSE(Sum(1, 2) = 3)
          expected to be FALSE
  FAILED  calls
          motor_test.st:15:9: MOCK_VERIFY_CALL_COUNT(motor.sensor, 2)
          expected 2 calls, found 0
  FAILED  a fault
          motor_test.st:19:14: index out of range
          list[i] := 1;
  FAILED  a loop without an end
          motor_test.st:23:9: a loop went on past the scan's budget of turns
          WHILE n < 10 DO n := 0; END_WHILE
          `--loop-budget N` gives a test more turns

0 passed, 6 failed
";
    for backend in BACKENDS {
        let out = folder.staunch(&format!("test . --loop-budget 1000 --backend {backend}")).out(1);
        assert_eq!(out, expected, "{backend}");
    }
}

#[test]
fn loops_have_more_turns_where_they_are_compiled() {
    let tests = "TEST 'ten million' VAR i, n : DINT := 10_000_000; END_VAR FOR i := 1 TO n DO END_FOR END_TEST
TEST 'more' VAR i, n : DINT := 10_000_001; END_VAR FOR i := 1 TO n DO END_FOR END_TEST
";
    let most = "TEST 'most' VAR i, n : DINT := 1_000_000_000; END_VAR FOR i := 1 TO n DO END_FOR END_TEST
TEST 'too many' VAR i, n : DINT := 1_000_000_001; END_VAR FOR i := 1 TO n DO END_FOR END_TEST
";
    let folder = Folder::with("tests_turns", &[("tests.st", tests), ("most.st", most)]);
    for backend in ["native", "rust"] {
        has(&folder.staunch(&format!("test tests.st --backend {backend}")).out(0), &["2 passed"]);
        has(
            &folder.staunch(&format!("test most.st --backend {backend}")).out(1),
            &["FAILED  too many", "1 passed, 1 failed"],
        );
    }
    let out = folder.staunch("test tests.st --backend interpret").out(1);
    has(&out, &["FAILED  more", "a loop went on past the scan's budget of turns", "1 passed, 1 failed"]);
}

#[test]
fn constants_are_shown_too() {
    let tests = "TEST 'integers' ASSERT_EQ(3, 4); END_TEST
TEST 'times' ASSERT_GT(T#1s, T#2s); END_TEST
TEST 'reals' ASSERT_NEAR(1.0, 1.5, 0.1); END_TEST
TEST 'near' ASSERT_NEAR(1.0, 1.5, 0.5); END_TEST
TEST 'equal' ASSERT_EQ(3, 3); END_TEST
";
    let folder = Folder::with("tests_constants", &[("tests.st", tests)]);
    for backend in BACKENDS {
        let out = folder.staunch(&format!("test tests.st --backend {backend}")).out(1);
        has(&out, &["expected to be 4, found 3\n", "expected to be greater than T#2s, found T#1s\n"]);
        has(&out, &["expected to be within 0.1 of 1.5, found 1.0\n", "\n2 passed, 3 failed\n"]);
    }
}

#[test]
fn threads_keep_the_order() {
    let sum = |number: usize| if number.is_multiple_of(10) { number + 1 } else { 0 };
    let test = |number| format!("TEST 'number {number}' ASSERT_EQ(Sum({number}, 1), {}); END_TEST\n", sum(number));
    let tests: String = (0..60).map(test).collect();
    let folder = Folder::with("tests_threads", &[("motor.st", SOURCE), ("motor_test.st", &tests)]);
    for backend in ["native", "interpret"] {
        let alone = folder.staunch(&format!("test . --jobs 1 --backend {backend}")).out(1);
        assert!(alone.find("number 9\n").unwrap() < alone.find("number 59\n").unwrap());
        has(&alone, &["\n6 passed, 54 failed\n"]);
        for jobs in [2, 7, 100] {
            assert_eq!(folder.staunch(&format!("test . -j {jobs} --backend {backend}")).out(1), alone);
        }
    }
    folder.staunch("test . --jobs 0").err(2);
}

#[test]
fn results_for_machines() {
    let tests = "TEST 'good & <short>' ASSERT_EQ(Sum(1, 2), 3); END_TEST
TEST 'bad' ASSERT_EQ(Sum(1, 2), 4); END_TEST
";
    let folder = Folder::with("tests_junit", &[("motor.st", SOURCE), ("motor_test.st", tests)]);
    let out = folder.staunch("test . --message-format json --junit out.xml").out(1);
    has(
        &out,
        &["{\"reason\":\"test\",\"title\":\"good & \\u003cshort>\",", "\"result\":\"passed\"", "\"result\":\"failed\""],
    );
    has(&out, &["{\"reason\":\"tests\",\"passed\":1,\"failed\":1}\n"]);
    let xml = folder.read("out.xml");
    has(&xml, &["<testsuite name=\"motor_test.st\" tests=\"2\" failures=\"1\">", "name=\"good &amp; &lt;short&gt;\""]);
    has(&xml, &["<failure type=\"assertion\" message=\"expected to be 4, found 3\">"]);
    let filtered = folder.staunch("test . --filter GOOD").out(0);
    has(&filtered, &["1 passed, 0 failed"]);
    has(&folder.staunch("test . --filter other").err(2), &["no test has `other` in its title"]);
    has(&folder.staunch("test motor.st").err(2), &["the sources have no TEST"]);
}

#[test]
fn a_fault_says_which_one_for_machines() {
    let tests = "TEST 'halves' VAR none : INT; END_VAR\nnone := 1 / none;\nEND_TEST\n";
    let folder = Folder::with("tests_junit_fault", &[("halves.st", tests)]);
    folder.staunch("test . --junit out.xml").out(1);
    has(&folder.read("out.xml"), &["<failure type=\"fault\" message=\"halves.st:2:11: division by zero\">"]);
}

#[test]
fn tests_of_one_title_are_two_for_machines() {
    let tests = "TEST 'same' ASSERT_TRUE(TRUE); END_TEST
TEST 'same' ASSERT_TRUE(FALSE); END_TEST
";
    let folder = Folder::with("tests_junit_title", &[("same.st", tests)]);
    folder.staunch("test . --junit out.xml --backend interpret").out(1);
    has(&folder.read("out.xml"), &["<testcase name=\"same\"", "<testcase name=\"same (2)\""]);
}

const CHAIN: &str = "INTERFACE IStep
METHOD Go : INT
END_METHOD
END_INTERFACE
CLASS Last IMPLEMENTS IStep
METHOD PUBLIC Go : INT
    Go := 1;
END_METHOD
END_CLASS
CLASS Step IMPLEMENTS IStep
VAR PUBLIC next : IStep; END_VAR
METHOD PUBLIC Go : INT
    Go := next.Go();
END_METHOD
END_CLASS
PROGRAM Main
VAR last : Last; step : Step; n : INT; END_VAR
    step.next := last;
    n := step.Go();
END_PROGRAM
";

#[test]
fn recursion_of_a_test_is_not_the_programs() {
    let tests = |steps: u32| {
        format!(
            "TEST 'two steps'
VAR steps : ARRAY[1..{steps}] OF Step; last : Last; END_VAR
    steps[2].next := last;
    steps[1].next := steps[2];
    ASSERT_EQ(steps[1].Go(), 1);
END_TEST
"
        )
    };
    // A chain of few instances has an end.
    let folder = Folder::with("tests_chain", &[("chain.st", CHAIN), ("chain_test.st", &tests(2))]);
    has(&folder.staunch("test . --backend interpret").out(0), &["1 passed, 0 failed"]);
    let folder = Folder::with("tests_recursion", &[("chain.st", CHAIN), ("chain_test.st", &tests(501))]);
    folder.staunch("run . --scans 1 --backend interpret").out(0);
    has(&folder.staunch("test . --backend interpret").err(1), &["error[E0310]: `Step.Go` calls itself"]);
    has(&folder.staunch("check .").err(1), &["error[E0310]: `Step.Go` calls itself"]);
}

#[test]
fn a_function_of_the_users_keeps_its_name() {
    let tests = "VAR_GLOBAL calls : INT; END_VAR
FUNCTION ASSERT_EQ : BOOL
VAR_INPUT a, b : INT; END_VAR
VAR_EXTERNAL calls : INT; END_VAR
    calls := calls + 1;
    ASSERT_EQ := a = b;
END_FUNCTION
TEST 'it is called' ASSERT_EQ(1, 2); ASSERT_TRUE(calls = 1); END_TEST
";
    let folder = Folder::with("tests_shadowed", &[("own.st", tests)]);
    has(&folder.staunch("test own.st").out(0), &["1 passed, 0 failed"]);
}

#[test]
fn mistakes_in_tests_are_told_once() {
    let tests = "SETUP
VAR delay : TON; END_VAR
    delay.Z := TRUE;
END_SETUP
TEST 'one' ASSERT_EQ(1); END_TEST
TEST 'two' MOCK delay; END_TEST
FUNCTION_BLOCK Other
    MOCK delay;
END_FUNCTION_BLOCK
";
    let folder = Folder::with("tests_wrong", &[("wrong.st", tests)]);
    let expected = "wrong.st:3:11: error[E0301]: `TON` has no pin `Z`
wrong.st:5:12: error[E0302]: wrong number of arguments for `ASSERT_EQ`
wrong.st:6:17: error[E0316]: `delay` cannot be replaced by a mock
wrong.st:8:5: error[E0305]: `MOCK` belongs to a unit test
";
    assert_eq!(folder.staunch("check wrong.st --message-format short").err(1), expected);
    assert_eq!(folder.staunch("test wrong.st --message-format short").err(1), expected);
}

#[test]
fn functions_in_namespaces_and_of_one_name_can_be_mocked() {
    let folder = Folder::new("mocks_by_their_paths");
    let source = "NAMESPACE Plant
FUNCTION Twice : INT VAR_INPUT x : INT; END_VAR Twice := x * 2; END_FUNCTION
FUNCTION Scale : INT VAR_INPUT x : INT; END_VAR Scale := x; END_FUNCTION
FUNCTION Scale : LREAL VAR_INPUT x : LREAL; END_VAR Scale := x; END_FUNCTION
END_NAMESPACE
FUNCTION Twice : INT VAR_INPUT x : INT; END_VAR Twice := x + x; END_FUNCTION
TEST 'by its path'
    MOCK_FUNCTION Plant.Twice RETURNS 7;
    ASSERT_EQ(Plant.Twice(1), 7);
    ASSERT_EQ(Twice(1), 2);
END_TEST
TEST 'by USING'
    USING Plant;
    VAR x : LREAL := 1.5; END_VAR
    MOCK_FUNCTION Scale RETURNS 3;
    ASSERT_EQ(Scale(1), 3);
    ASSERT_EQ(Scale(x), 3.0);
END_TEST
";
    folder.write("mocks.st", source);
    for backend in ["interpret", "native", "rust"] {
        let ran = folder.staunch(&format!("test mocks.st --backend {backend} -A W0503"));
        assert_eq!(ran.code, 0, "{backend}: {}{}", ran.out, ran.err);
        has(&ran.out, &["2 passed, 0 failed"]);
    }
}

#[test]
fn time_does_not_go_back_and_references_have_no_numbers() {
    let folder = Folder::new("negative_time");
    let source = "FUNCTION_BLOCK A END_FUNCTION_BLOCK
TEST 'back'
VAR n : LINT; t : TIME; END_VAR
    ADVANCE_TIME(t);
    ADVANCE_TIME(n - 1);
END_TEST
TEST 'references'
VAR a, b : A; x, y : REF_TO A; END_VAR
    x := REF(a);
    y := REF(a);
    ASSERT_EQ(x, y);
    ASSERT_NEQ(x, y);
END_TEST
";
    folder.write("back.st", source);
    let ran = folder.staunch("test back.st");
    assert_eq!(ran.code, 1, "{}", ran.err);
    has(&ran.out, &["back.st:5:18: n - 1", "since time cannot go backwards, found T#-1ns"]);
    has(&ran.out, &["ASSERT_NEQ(x, y)", "expected to refer to another object\n"]);
    folder.write("back.st", "TEST 'constant' ADVANCE_TIME(T#-3s); END_TEST");
    let ran = folder.staunch("test back.st");
    assert_eq!(ran.code, 1);
    has(&ran.err, &["time cannot go backwards"]);
}

#[test]
fn what_a_library_only_declares_is_mocked_or_fails_the_test() {
    let folder = Folder::with("mocked_stubs", &[("staunch.toml", "dialect = \"codesys\"\nlibraries = [\"lib.st\"]\n")]);
    let library = "FUNCTION Level : INT VAR_INPUT x : INT; END_VAR END_FUNCTION
FUNCTION_BLOCK Drive
VAR_INPUT speed : INT; END_VAR
VAR_OUTPUT actual : INT; END_VAR
METHOD FB_init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR END_METHOD
METHOD Stop : INT VAR_INPUT z : INT; END_VAR END_METHOD
PROPERTY Mode : INT GET END_GET SET END_SET END_PROPERTY
END_FUNCTION_BLOCK";
    let source = "FUNCTION_BLOCK Own EXTENDS Drive
VAR_OUTPUT n : INT; END_VAR
    n := speed * 2 + Stop(1);
END_FUNCTION_BLOCK
PROGRAM Main
VAR d : Drive; r : INT; END_VAR
    d(speed := 1);
    r := Level(d.actual) + d.Stop(2) + d.Mode;
    d.Mode := 3;
END_PROGRAM
TEST 'mocked'
VAR m : Main; END_VAR
    MOCK m.d; m.d.actual := 5;
    MOCK_FUNCTION Level RETURNS 12;
    m(); m();
    ASSERT_EQ(m.d.speed, 1);
    ASSERT_EQ(m.r, 12);
    MOCK_VERIFY_CALL_COUNT(m.d, 2); MOCK_VERIFY_CALL_COUNT(Level, 2); MOCK_VERIFY_CALLED(Level);
END_TEST
TEST 'count' MOCK_FUNCTION Level RETURNS 1; MOCK_VERIFY_CALL_COUNT(Level, 2); END_TEST
TEST 'block' VAR d : Drive; END_VAR d(speed := 1); END_TEST
TEST 'function' VAR x : INT; END_VAR x := Level(1); END_TEST
TEST 'method' VAR own : Own; END_VAR own(speed := 3); END_TEST
TEST 'heir' VAR own : Own; END_VAR MOCK own; own(speed := 3); ASSERT_EQ(own.n, 0); END_TEST
";
    folder.write("lib.st", library);
    folder.write("t.st", source);
    for backend in ["interpret", "native"] {
        let ran = folder.staunch(&format!("test t.st --backend {backend}"));
        assert_eq!(ran.code, 1, "{backend}: {}{}", ran.out, ran.err);
        has(&ran.out, &["2 passed, 4 failed", "expected 2 calls, found 0"]);
        for name in ["FUNCTION_BLOCK Drive", "FUNCTION Level", "METHOD Stop"] {
            has(&ran.out, &[&format!("what is called is not implemented here\n          {name}")]);
        }
    }
    // What is built has no mocks.
    let refused = folder.staunch("build t.st").err(1);
    has(&refused, &["`Drive` has no implementation", "`Drive.FB_init` has no implementation", "`RETURN;`"]);
    assert_eq!(refused.matches("or `{external}` before it").count(), 1, "{refused}");
    folder.write("t.st", "FUNCTION F : INT F := 1; END_FUNCTION TEST 'a' MOCK_VERIFY_CALL_COUNT(F, 1); END_TEST");
    let refused = folder.staunch("test t.st").err(1);
    has(&refused, &["calls of the FUNCTION `F` are not counted", "`MOCK_FUNCTION F RETURNS value;`"]);
}

/// A variable at an address is a member of its PROGRAM, in every dialect: a test sets and reads it.
#[test]
fn a_test_sees_what_lies_at_an_address() {
    let source = "PROGRAM Main
VAR i AT %IX0.0 : BOOL; o AT %QW2 : INT; b AT %IB4 : BYTE; n : INT; list : ARRAY[0..3] OF INT; END_VAR
    IF i THEN n := n + 1; END_IF
    o := n;
    IF b.3 THEN list[2] := 7; END_IF
END_PROGRAM
TEST 'located'
VAR m : Main; END_VAR
    m.i := TRUE;
    m.b := 8;
    m();
    ASSERT_EQ(m.o, 1);
    ASSERT_EQ(%QW2, 1);
    ASSERT_EQ(m.list[2], 7);
    %IX0.0 := FALSE;
    m();
    ASSERT_EQ(m.n, 1);
    ASSERT_FALSE(m.i);
END_TEST
";
    for dialect in ["iec", "codesys"] {
        let text = source.replace("m.b := 8", if dialect == "iec" { "m.b := BYTE#8" } else { "m.b := 8" });
        let folder = Folder::with(&format!("tests_located_{dialect}"), &[("m.st", &text)]);
        for backend in BACKENDS {
            let ran = folder.staunch(&format!("test . --dialect {dialect} --backend {backend}"));
            assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{dialect} {backend} {}", ran.out);
        }
    }
}

#[test]
fn what_there_is_to_run_is_said() {
    let suites = "{dialect 'codesys'}
FUNCTION_BLOCK Good EXTENDS TcUnit.FB_TestSuite
    TEST('adds'); AssertEquals_INT(2, 2, ''); TEST_FINISHED();
END_FUNCTION_BLOCK
FUNCTION_BLOCK Bad EXTENDS TcUnit.FB_TestSuite
VAR z : INT; s : STRING := 'divides'; END_VAR
    TEST(s); z := 5 / z; TEST_FINISHED();
END_FUNCTION_BLOCK
";
    let folder = Folder::with("tests_to_run", &[("s.st", suites)]);
    assert_eq!(folder.staunch("test s.st --filter adds").out(0), "s.st\n  ok      Good.adds\n\n1 passed, 0 failed\n");
    has(&folder.staunch("test s.st --filter divides").out(1), &["FAILED  Bad.divides\n", "0 passed, 1 failed"]);
    has(&folder.staunch("test s.st --filter none").err(2), &["no test has `none` in its title; there are 2 suites\n"]);
    let empty = "{dialect 'codesys'}\nFUNCTION_BLOCK Empty EXTENDS TcUnit.FB_TestSuite\n;\nEND_FUNCTION_BLOCK\n";
    folder.write("e.st", empty);
    has(&folder.staunch("test e.st").err(2), &["no test to run"]);
    folder.write("f.st", "{TestFixture}\nCLASS Fixture\nEND_CLASS\n");
    has(&folder.staunch("test f.st").err(2), &["no test to run"]);
    folder.write("one.st", "TEST \"a $\"quoted$\" one, $$5\" ASSERT_TRUE(FALSE); END_TEST\n");
    has(&folder.staunch("test one.st --filter none").err(2), &["there is 1 test\n"]);
    let ran = folder.staunch("test one.st --mutants");
    has(&ran.out, &["FAILED  a \"quoted\" one, $5\n"]);
    has(&ran.err(1), &["the mutants: they are tried only if all tests pass"]);
    folder.write("one.csv", "n,|,n\n");
    has(
        &folder.staunch("test one.csv").err(2),
        &["one.csv is a table, not a source: name the source next to it, one.st"],
    );
}
