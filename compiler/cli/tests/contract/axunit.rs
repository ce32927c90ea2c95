//! `staunch test` on fixtures of AxUnit.

use super::{Folder, has};

const FIXTURE: &str = "USING AxUnit.Assert;
USING AxUnit.ResultFunctions;
NAMESPACE Line
    TYPE Mode : (Idle, Busy) := Idle; END_TYPE
    CLASS Counter
        VAR n : INT; END_VAR
        METHOD PUBLIC Add VAR_INPUT step : INT; END_VAR
            n := n + step;
        END_METHOD
        METHOD PUBLIC Count : INT
            Count := n;
        END_METHOD
    END_CLASS
END_NAMESPACE
NAMESPACE AxUnit.Assert
    FUNCTION Equal
    VAR_INPUT expected, actual : Line.Mode; {CallerFilePath} file : WSTRING[1024]; {CallerLineNumber} line : INT; END_VAR
        IF expected = actual THEN
            axunit_Succeed();
        ELSE
            axunit_Fail('other modes', file, line);
        END_IF;
    END_FUNCTION
END_NAMESPACE
NAMESPACE Line.Tests
    {TestFixture}
    CLASS CounterTest
        VAR c : Counter; setups, fixtures, torn : INT; few : ARRAY[0..1] OF INT; m : Mode; END_VAR
        {FixtureSetup} METHOD PUBLIC Once fixtures := fixtures + 1; END_METHOD
        {TestSetup} METHOD PUBLIC Before setups := setups + 1; END_METHOD
        {TestTearDown} METHOD PUBLIC After torn := torn + 1; END_METHOD
        {Test} METHOD PUBLIC B_sees_what_A_left
            Equal(expected := 3, actual := c.Count());
            NotEqual(expected := 2, actual := c.Count());
        END_METHOD
        {Test} METHOD PUBLIC A_passes
            c.Add(2);
            Equal(expected := 2, actual := c.Count());
            AxUnit.Assert.Equal(expected := 0, actual := torn);
            Equal(expected := 'ab', actual := CONCAT('a', 'b'));
        END_METHOD
        {Test} METHOD PUBLIC C_faults
            few[fixtures + 4] := 1;
        END_METHOD
        {Test} METHOD PUBLIC D_begins_anew
            Equal(0, c.Count());
            Equal(expected := 1, actual := setups);
            Equal(expected := 1, actual := fixtures);
        END_METHOD
        {Test} METHOD PUBLIC E_of_its_own
            m := Mode#Busy;
            Equal(expected := Mode#Idle, actual := m);
        END_METHOD
        {Test(a := 1, b := 2, sum := 3)}
        {Test(a := -1, b := 2,
              sum := 2)}
        METHOD PUBLIC F_adds
        VAR_INPUT a, b, sum : INT; END_VAR
            Equal(expected := sum, actual := a + b);
            GreaterOrEqual(left := b, right := a);
        END_METHOD
        {FixtureTearDown} METHOD PUBLIC Last LessThan(left := torn, right := 4); END_METHOD
    END_CLASS
    {Test(x := 1.0)}
    {Test(x := 2.5)}
    FUNCTION Halves
    VAR_INPUT x : REAL; END_VAR
        LessOrEqual(left := x / 2.0, right := 1.0);
    END_FUNCTION
END_NAMESPACE
";

const WANTED: [&str; 18] = [
    "  ok      Line.Tests.CounterTest.A_passes",
    "  FAILED  Line.Tests.CounterTest.B_sees_what_A_left",
    "33:13: Equal(expected := 3, actual := c.Count())",
    "expected to be 3, found 2",
    "  FAILED  Line.Tests.CounterTest.C_faults",
    "43:17: index out of range",
    "  ok      Line.Tests.CounterTest.D_begins_anew",
    "  FAILED  Line.Tests.CounterTest.E_of_its_own",
    "axunit_Fail('other modes', file, line)",
    "expected to succeed, where line 52 calls it",
    "other modes",
    "  ok      Line.Tests.CounterTest.F_adds(a := 1, b := 2, sum := 3)",
    "  FAILED  Line.Tests.CounterTest.F_adds(a := -1, b := 2, sum := 2)",
    "expected to be 2, found 1",
    "  ok      Line.Tests.Halves(x := 1.0)",
    "  FAILED  Line.Tests.Halves(x := 2.5)",
    "expected to be at most 1.0, found 1.25",
    "4 passed, 5 failed",
];

#[test]
fn fixtures_run_as_they_are_on_every_back_end() {
    let folder = Folder::new("an_axunit_fixture");
    folder.write("counter.st", FIXTURE);
    for backend in ["interpret", "native", "rust", "interpret --dialect siemens"] {
        let ran = folder.staunch(&format!("test counter.st --junit junit.xml --backend {backend}"));
        assert_eq!(ran.code, 1, "{}", ran.err);
        let mut rest = ran.out.as_str();
        for line in WANTED {
            let at = rest.find(line).unwrap_or_else(|| panic!("{backend}: no `{line}` in\n{rest}"));
            rest = &rest[at + line.len()..];
        }
        let junit = folder.read("junit.xml");
        has(
            &junit,
            &["tests=\"9\" failures=\"5\"", "name=\"Line.Tests.CounterTest.F_adds(a := 1, b := 2, sum := 3)\""],
        );
    }
}

#[test]
fn a_filter_chooses_among_the_tests_of_a_fixture() {
    let folder = Folder::new("a_filtered_axunit_fixture");
    folder.write("counter.st", FIXTURE);
    let ran = folder.staunch("test counter.st --filter begins_anew");
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    has(&ran.out, &["1 passed, 0 failed"]);
}

#[test]
fn fixtures_are_no_part_of_the_program() {
    let folder = Folder::new("an_axunit_fixture_left_out");
    folder.write("counter.st", FIXTURE);
    assert_eq!(folder.staunch("build counter.st --emit rust -o out.rs").code, 0);
    let emitted = folder.read("out.rs");
    assert!(!emitted.contains("CounterTest") && emitted.contains("Counter"), "{emitted}");
    // Mistakes in them are reported anyway.
    folder.write("counter.st", FIXTURE.replace("Equal(0, c.Count());", "Equal(0, c.Total());"));
    let checked = folder.staunch("check counter.st");
    assert_eq!(checked.code, 1);
    has(&checked.err, &["Total"]);
}

#[test]
fn fixtures_are_neither_covered_nor_changed() {
    let folder = Folder::new("an_axunit_fixture_measured");
    folder.write("counter.st", &FIXTURE[..FIXTURE.find("NAMESPACE AxUnit").unwrap_or(0)]);
    let test = "USING AxUnit.Assert;
NAMESPACE Line.Tests
    {TestFixture}
    CLASS CounterTest
        VAR c : Counter; END_VAR
        {Test} METHOD PUBLIC Adds
            c.Add(2);
            Equal(expected := 2, actual := c.Count());
        END_METHOD
    END_CLASS
END_NAMESPACE
";
    folder.write("test.st", test);
    let ran = folder.staunch("test counter.st test.st --coverage table --mutants");
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    has(&ran.out, &["2 of 2 100 %", "3 mutants killed, 0 survived"]);
}

/// After Siemens' introduction to mocks: `GetANumber` calls `GetNumber1`, which gives 1.
const MOCKS: &str = "USING AxUnit;
USING AxUnit.Assert;
USING System.Timer;
NAMESPACE UserLibrary
    FUNCTION GetANumber : INT
        GetANumber := GetNumber1();
    END_FUNCTION
    FUNCTION GetNumber1 : INT
        GetNumber1 := 1;
    END_FUNCTION
    FUNCTION Split
    VAR_INPUT total : INT; END_VAR
    VAR_OUTPUT half : INT; END_VAR
    VAR_IN_OUT sum : INT; END_VAR
        half := total / 2;
        sum := sum + total;
    END_FUNCTION
    CLASS Waits
        VAR timer : OnDelay; END_VAR
        METHOD PUBLIC Done : BOOL
            timer(signal := TRUE, duration := LT#5s);
            Done := timer.output;
        END_METHOD
    END_CLASS
END_NAMESPACE
NAMESPACE MyTest
    USING UserLibrary;
    FUNCTION GetNumber2_Mock : INT
        GetNumber2_Mock := 2;
    END_FUNCTION
    FUNCTION FromPayload : INT
    VAR_TEMP p : REF_TO Numbers; END_VAR
        p ?= AxUnit.Mocking.GetPayload();
        IF p <> NULL THEN
            p^.calls := p^.calls + 1;
            FromPayload := p^.value;
        END_IF;
    END_FUNCTION
    FUNCTION SplitMock
    VAR_INPUT total : INT; END_VAR
    VAR_OUTPUT half : INT; END_VAR
    VAR_IN_OUT sum : INT; END_VAR
        half := total - GetNumber1();
        sum := 0;
    END_FUNCTION
    FUNCTION_BLOCK IsDone
    VAR_INPUT signal : BOOL; duration : LTIME; END_VAR
    VAR_OUTPUT output : BOOL; elapsedTime : LTIME; END_VAR
    VAR calls : INT; END_VAR
        calls := calls + 1;
        output := signal AND calls > 1;
    END_FUNCTION_BLOCK
    CLASS Numbers IMPLEMENTS AxUnit.Mocking.IPayload
        VAR PUBLIC value, calls : INT; END_VAR
    END_CLASS
    {TestFixture}
    CLASS MyFixture
        VAR numbers, others : Numbers; waits : Waits; END_VAR
        {Test}
        METHOD PUBLIC A_runs_another_function
            Equal(1, GetANumber());
            Mocking.Mock(NAME_OF(GetNumber1), NAME_OF(GetNumber2_Mock));
            Equal(2, GetANumber());
        END_METHOD
        {Test}
        METHOD PUBLIC B_begins_anew
            Equal(1, GetANumber());
        END_METHOD
        {Test}
        METHOD PUBLIC C_has_payloads
            numbers.value := 123;
            others.value := 456;
            AxUnit.Mocking.Mock(NAME_OF(GetNumber1), NAME_OF(FromPayload), numbers);
            Equal(123, GetANumber());
            AxUnit.Mocking.Mock(payload := others, mockFn := NAME_OF(FromPayload), mockeeFn := 'UserLibrary.GetNumber1');
            Equal(456, GetANumber());
            Equal(456, GetANumber());
            Equal(1, numbers.calls);
            Equal(2, others.calls);
            AxUnit.Mocking.Mock(NAME_OF(GetNumber1), NAME_OF(FromPayload));
            Equal(0, GetANumber());
        END_METHOD
        {Test}
        METHOD PUBLIC D_passes_all_parameters
        VAR_TEMP half, sum : INT; END_VAR
            sum := 5;
            AxUnit.Mocking.Mock(NAME_OF(Split), NAME_OF(SplitMock));
            AxUnit.Mocking.Mock(NAME_OF(GetNumber1), NAME_OF(GetNumber2_Mock));
            Split(total := 10, half => half, sum := sum);
            Equal(8, half);
            Equal(0, sum);
        END_METHOD
        {Test}
        METHOD PUBLIC E_runs_another_block
            Equal(FALSE, waits.Done());
            AxUnit.Mocking.Mock(NAME_OF(OnDelay), NAME_OF(IsDone));
            Equal(FALSE, waits.Done());
            Equal(TRUE, waits.Done());
        END_METHOD
    END_CLASS
END_NAMESPACE
";

#[test]
fn mocks_run_in_place_of_functions_and_blocks() {
    let folder = Folder::new("axunit_mocks");
    folder.write("mocks.st", MOCKS);
    for backend in ["interpret", "native", "rust"] {
        let ran = folder.staunch(&format!("test mocks.st --dialect siemens --backend {backend}"));
        assert_eq!(ran.code, 0, "{backend}: {}{}", ran.out, ran.err);
        has(&ran.out, &["5 passed, 0 failed"]);
    }
    // One that does not come is found.
    let none =
        MOCKS.replace("Mocking.Mock(NAME_OF(GetNumber1), NAME_OF(GetNumber2_Mock));\n            Equal", "Equal");
    folder.write("mocks.st", none);
    has(&folder.staunch("test mocks.st --dialect siemens").out, &["expected to be 2, found 1"]);
    // What the program itself is has none of it.
    folder.write(
        "mocks.st",
        format!("{MOCKS}PROGRAM Main VAR x : INT; END_VAR x := UserLibrary.GetANumber(); END_PROGRAM"),
    );
    assert_eq!(folder.staunch("build mocks.st --dialect siemens --emit rust -o out.rs").code, 0);
    assert!(!folder.read("out.rs").contains("__kept_payload"));
}

/// A fault ends the run of a fixture's tests, and the others are another run: what each executes counts. Neither a fixture's base
/// nor what a mock adds is the program's.
#[test]
fn what_the_tests_of_a_fixture_execute() {
    let source = "FUNCTION Twice : INT VAR_INPUT a : INT; END_VAR
    Twice := a * 2;
END_FUNCTION
FUNCTION Ratio : INT VAR_INPUT a, b : INT; END_VAR
    Ratio := a / b;
END_FUNCTION
FUNCTION Half : INT VAR_INPUT a : INT; END_VAR
    Half := a / 2;
END_FUNCTION
FUNCTION Raw : INT VAR_INPUT a : INT; END_VAR
    Raw := a * 2;
END_FUNCTION
";
    let tests = "FUNCTION Fake : INT VAR_INPUT a : INT; END_VAR
    Fake := 7;
END_FUNCTION
NAMESPACE My.Tests
    USING AxUnit.Assert;
    {TestFixture}
    CLASS ABSTRACT Base
        {Test}
        METHOD PUBLIC A_Twice
            Equal(expected := 4, actual := Twice(2));
        END_METHOD
    END_CLASS
    {TestFixture}
    CLASS Fix EXTENDS Base
        {Test}
        METHOD PUBLIC B_Ratio
            Equal(expected := 0, actual := Ratio(1, 0));
        END_METHOD
        {Test}
        METHOD PUBLIC C_Half
            Equal(expected := 2, actual := Half(4));
        END_METHOD
        {Test}
        METHOD PUBLIC D_Raw
            AxUnit.Mocking.Mock(NAME_OF(Raw), NAME_OF(Fake));
            Equal(expected := 7, actual := Raw(3));
        END_METHOD
    END_CLASS
END_NAMESPACE
";
    let folder = Folder::with("axunit_coverage", &[("f.st", source), ("f_test.st", tests)]);
    for backend in ["native", "interpret"] {
        let out = folder.staunch(&format!("test . --coverage table --backend {backend}")).out(1);
        has(
            &out,
            &["\nf.st           3 of 4  75 %              none              none\n", "\nf.st:11:5: not executed\n"],
        );
        has(&out, &["\nf_test.st      1 of 1 100 %              none              none\n", "3 passed, 1 failed"]);
    }
    // In f.st four statements, four operators, and three numbers up and down; in `Fake` a statement and a number.
    let passing = tests.replace("Ratio(1, 0)", "Ratio(0, 1)");
    folder.write("f_test.st", &passing);
    let out = folder.staunch("test . --mutants --message-format json").out;
    assert_eq!(figure(&out, "killed") + figure(&out, "survived"), 4 + 4 + 6 + 3, "{out}");
}

/// The number after a word in what is written for machines.
fn figure(text: &str, word: &str) -> u32 {
    let (_, rest) = text.split_once(&format!("\"{word}\":")).unwrap();
    rest.split([',', '}']).next().unwrap().parse().unwrap()
}
