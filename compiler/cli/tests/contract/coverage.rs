//! `staunch test --coverage`: the numbers are worked out by hand.

use super::{COUNTER, Folder, has};

/// In the first call a is TRUE and n 5, in the second a is FALSE and n 1; b and c are FALSE.
const SOURCE: &str = "FUNCTION_BLOCK F
VAR_INPUT a, b, c : BOOL; m : INT; END_VAR
VAR_OUTPUT x, y : BOOL; END_VAR
VAR t : CTU; n : INT; END_VAR
n := m;
x := a AND NOT b;
t(CU := a OR c, PV := 2);
y := (a XOR b) = c;
IF a AND_THEN n > 0 THEN x := FALSE; END_IF
WHILE n > 3 AND NOT c DO n := n - 1; END_WHILE
CASE n OF 1: x := TRUE; 2, 3: y := TRUE; ELSE n := 0; END_CASE
CASE n OF 5: n := 6; END_CASE
x S= a AND b;
REPEAT n := n + 1; UNTIL n > 2 END_REPEAT
END_FUNCTION_BLOCK
";
const TESTS: &str = "TEST 'two calls'
VAR f : F; END_VAR
f(a := TRUE, m := 5);
f(a := FALSE, m := 1);
END_TEST
";

/// What the two calls leave open. The WHILE takes two turns in the first call and none in the second; it leaves 3
/// and 1 in n. In line 6 `b` would decide in the first call, but is FALSE in both; line 8 has a decision inside
/// of a comparison; the operands of `AND_THEN` are a decision each. The REPEAT takes one turn, and two.
const TABLE: &str = "
coverage        statements          branches        conditions
f.st        15 of 17  88 %    10 of 13  76 %     6 of 13  46 %
total       15 of 17  88 %    10 of 13  76 %     6 of 13  46 %

f.st:6:16: not shown to decide: b
f.st:7:14: not shown to decide: c
f.st:8:13: not shown to decide: b
f.st:9:15: not shown to decide: n > 0
f.st:10:21: not shown to decide: c
f.st:11:1: never without a label that fits
f.st:11:47: not executed
f.st:12:11: never chosen: 5
f.st:12:14: not executed
f.st:13:6: never TRUE: a AND b
f.st:13:6: not shown to decide: a
f.st:13:12: not shown to decide: b

1 passed, 0 failed
";

#[test]
fn statements_branches_and_conditions() {
    let folder = Folder::with("coverage", &[("f.st", SOURCE), ("f_test.st", TESTS)]);
    for backend in ["native", "interpret"] {
        let out = folder.staunch(&format!("test . -q -A warnings --coverage table --backend {backend}")).out(0);
        assert_eq!(out, TABLE, "{backend}");
    }
    let all = "test . -q -A warnings --coverage out.info --coverage out.txt --coverage out.html";
    folder.staunch(all).out(0);
    let lcov = folder.read("out.info");
    // A line counts as its statement that was executed most: two and two turns of the loops, two calls.
    has(&lcov, &["SF:f.st\n", "DA:5,2\n", "DA:10,2\n", "DA:14,3\n", "LF:10\nLH:10\n", "BRF:13\nBRH:10\n"]);
    has(&lcov, &["BRDA:9,0,0,1\nBRDA:9,0,1,1\n", "BRDA:10,1,0,2\nBRDA:10,1,1,2\n", "BRDA:11,"]);
    has(&lcov, &["MCDC:6,2,t,1,0,a\nMCDC:6,2,f,1,0,a\nMCDC:6,2,t,0,1,b\nMCDC:6,2,f,1,1,b\n", "MCF:26\n"]);
    let annotated = folder.read("out.txt");
    has(&annotated, &["       2 |    12 | CASE n OF 5: n := 6; END_CASE\n         |       | ^ never chosen: 5\n"]);
    has(&annotated, &["         |     1 | FUNCTION_BLOCK F\n"]);
    has(&folder.read("out.html"), &["<td class=\"code\">IF a AND_THEN n &gt; 0 THEN", "15 of 17 statements"]);
    let json = folder.staunch("test . -q -A warnings --coverage table --message-format json").out(0);
    has(
        &json,
        &[
            "{\"reason\":\"coverage\",\"file\":\"f.st\",\"statements\":[15,17],\"branches\":[10,13],\"conditions\":[6,13],",
        ],
    );
    has(&json, &["{\"line\":6,\"column\":16,\"message\":\"not shown to decide: b\"}"]);
}

/// Threads, tests of several instances, a table and its power cycle sum up.
/// lcov 2 refuses a file that gives a line two decisions of as many conditions, or a decision's conditions on several
/// lines, or a line that was executed none of whose branches was.
#[test]
fn what_lcov_takes() {
    let source = "FUNCTION F : BOOL
VAR_INPUT a, b, c : BOOL; n : INT; END_VAR
F := a AND
    b;
F := a XOR (b AND_THEN c);
CASE n OF
    1: F := TRUE;
    2: CASE n OF 3: ; END_CASE
END_CASE
END_FUNCTION
";
    let test = "TEST 'one'\nASSERT_TRUE(F(TRUE, TRUE, FALSE, 1));\nEND_TEST\n";
    let folder = Folder::with("coverage_lcov", &[("f.st", source), ("f_test.st", test)]);
    folder.staunch("test . -q -A warnings --coverage out.info").out(0);
    let lcov = folder.read("out.info");
    has(&lcov, &["MCDC:3,2,t,1,0,a\nMCDC:3,2,f,0,0,a\nMCDC:3,2,t,1,1,b\nMCDC:3,2,f,0,1,b\n"]);
    let [second, operands] = ["MCDC:5,4,t,0,1,b AND_THEN c\nMCDC:5,4,f,1,1,b AND_THEN c\n", "MCDC:5,4,t,1,2,b\n"];
    has(&lcov, &["MCDC:5,4,t,1,0,a\nMCDC:5,4,f,0,0,a\n", second, operands, "MCDC:5,4,f,1,3,c\n"]);
    has(&lcov, &["BRDA:6,0,0,0\nBRDA:6,0,1,1\nBRDA:6,0,2,0\nBRDA:8,1,0,-\nBRDA:8,1,1,-\nBRF:5\nBRH:1\n"]);
    let table = folder.staunch("test . -q -A warnings --coverage table").out(0);
    has(&table, &["f.st:5:13: not shown to decide: b AND_THEN c\n", "f.st:5:13: not shown to decide: b\n"]);
}

#[test]
fn counts_are_those_of_all_tests() {
    let tests: String =
        (0..9).map(|it| format!("TEST 'number {it}' VAR m : Main; END_VAR m(); m(); END_TEST\n")).collect();
    let table = "pulse,@event,|,parts.CV\nTRUE,,|,1\nFALSE,restart,|,0\nTRUE,,|,1\n";
    let folder = Folder::with("coverage_sum", &[("c.st", COUNTER), ("c.csv", table), ("c_test.st", &tests)]);
    for jobs in [1, 4] {
        folder.staunch(&format!("test . -q --coverage out.info --jobs {jobs}")).out(0);
        // Nine tests with two calls each, and three scans.
        has(&folder.read("out.info"), &["DA:5,21\nDA:6,21\n", "LF:2\nLH:2\n"]);
    }
}

#[test]
fn what_is_no_program_under_test_is_not_counted() {
    let tests =
        "TEST 'a mock' VAR b : Outer; END_VAR MOCK b.inner; b(); IF b.on AND b.off THEN b.on := TRUE; END_IF END_TEST
";
    let source = "FUNCTION_BLOCK Inner VAR n : INT; END_VAR
n := n + 1;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Outer VAR inner : Inner; on, off : BOOL; clock : RTC; END_VAR
inner();
clock();
END_FUNCTION_BLOCK
";
    let folder = Folder::with("coverage_own", &[("o.st", source), ("o_test.st", tests)]);
    let out = folder.staunch("test . -q -A warnings --coverage table").out(0);
    has(&out, &["\no.st          2 of 3  66 %              none              none\n", "\no.st:2:1: not executed\n"]);
    assert!(!out.contains("o_test.st") && !out.contains("library"), "{out}");
}

/// What the first call alone does is written by nobody; what is after it is counted.
#[test]
fn what_starts_variables_is_not_counted() {
    let source = "FUNCTION Second : INT
VAR_INPUT a : INT; END_VAR
VAR_STAT x : INT; p : POINTER TO INT := ADR(x); END_VAR
p^ := a;
IF a > 8 THEN x := 0; END_IF
Second := x + 1;
END_FUNCTION
TEST 'once' ASSERT_EQ(Second(7), 8); END_TEST
";
    let folder = Folder::with("coverage_started", &[("s.st", source)]);
    let out = folder.staunch("test . -q -A warnings --dialect codesys --coverage table").out(0);
    has(&out, &["\ns.st          3 of 4  75 %      1 of 2  50 %      0 of 1   0 %\n", "\ns.st:5:15: not executed\n"]);
}

#[test]
fn wrong_usage() {
    let folder = Folder::with("coverage_usage", &[("f.st", SOURCE), ("f_test.st", TESTS)]);
    has(&folder.staunch("test . -A warnings --coverage out.pdf").err(2), &["`table`, or a file .info, .html or .txt"]);
    has(
        &folder.staunch("test . -A warnings --coverage table --backend rust").err(2),
        &["--backend native or interpret"],
    );
    // What cannot be written after the tests is said before them.
    for wanted in ["--coverage out.pdf", "--coverage none/out.html", "--junit none/out.xml"] {
        let ran = folder.staunch(&format!("test . -A warnings {wanted}"));
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{wanted}");
    }
}

#[test]
fn a_condition_is_shown_from_its_start() {
    let folder = Folder::new("a_negated_condition");
    let source = "FUNCTION_BLOCK F
VAR_INPUT a, b : BOOL; END_VAR
VAR_OUTPUT q : BOOL; END_VAR
    IF NOT (a AND b) THEN q := TRUE; END_IF
END_FUNCTION_BLOCK
TEST 't'
VAR f : F; END_VAR
    f(a := TRUE, b := FALSE);
END_TEST
";
    folder.write("f.st", source);
    let ran = folder.staunch("test f.st --coverage table");
    has(&ran.out, &["f.st:4:8: never FALSE: NOT (a AND b)", "f.st:4:13: not shown to decide: a"]);
}

/// What may fault is evaluated before a call that is written after it; that makes no other decision of the same text.
#[test]
fn a_decision_is_one_however_it_is_evaluated() {
    let source = "FUNCTION InBand : BOOL
VAR_INPUT v : INT; END_VAR
    InBand := v > 10;
END_FUNCTION
FUNCTION_BLOCK Gate
VAR_INPUT ch : INT := 1; key : BOOL; level, total, parts : INT; END_VAR
VAR_OUTPUT q : BOOL; END_VAR
VAR sensor : ARRAY[1..4] OF BOOL; END_VAR
    q := InBand(level) OR (sensor[ch] AND key);
    q := (sensor[ch] AND key) OR InBand(level);
    q := (total / parts > 3 AND key) OR InBand(level);
    q := (sensor[ch] OR_ELSE key) AND NOT (key OR sensor[ch]) OR InBand(level);
END_FUNCTION_BLOCK
TEST 'InBand is TRUE in all calls, so nothing beside it decides'
VAR g : Gate; END_VAR
    g.sensor[1] := TRUE;
    g(key := TRUE, level := 15, total := 8, parts := 2);
    g(key := FALSE, level := 15);
    g.sensor[1] := FALSE;
    g(key := TRUE, level := 15, total := 4);
END_TEST
";
    let folder = Folder::with("coverage_order", &[("g.st", source)]);
    let out = folder.staunch("test . -q --coverage table").out(0);
    // In line 12 `sensor[ch]` is a decision of its own before OR_ELSE, and is both TRUE and FALSE; `key` after it is evaluated once.
    let open = "g.st:9:10: not shown to decide: InBand(level)
g.st:9:28: not shown to decide: sensor[ch]
g.st:9:43: not shown to decide: key
g.st:10:11: not shown to decide: sensor[ch]
g.st:10:26: not shown to decide: key
g.st:10:34: not shown to decide: InBand(level)
g.st:11:11: not shown to decide: total / parts > 3
g.st:11:33: not shown to decide: key
g.st:11:41: not shown to decide: InBand(level)
g.st:12:11: not shown to decide: sensor[ch] OR_ELSE key
g.st:12:30: not shown to decide: key
g.st:12:44: not shown to decide: key
g.st:12:51: not shown to decide: sensor[ch]
g.st:12:66: not shown to decide: InBand(level)
";
    has(&out, &[open]);
}

#[test]
fn a_decision_of_more_than_ten_conditions_is_one() {
    let source = "FUNCTION Ready : BOOL
VAR_INPUT a, b, c, d, e, f, g, h, i, j, k : BOOL; END_VAR
    Ready := a AND b AND c AND d AND e AND f AND g AND h AND i AND j AND k;
    IF (a OR b OR c OR d OR e OR f OR g OR h OR i OR j) AND (k AND b) = a THEN Ready := FALSE; END_IF
END_FUNCTION
TEST 'k is FALSE in both'
    ASSERT_FALSE(Ready(TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, FALSE));
    ASSERT_FALSE(Ready(FALSE, TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, TRUE, FALSE));
END_TEST
";
    let folder = Folder::with("coverage_many", &[("f.st", source)]);
    let out = folder.staunch("test . -q --coverage table").out(0);
    has(&out, &["f.st:3:14: not shown to decide: a AND b AND c AND d AND e AND f AND g AND h AND i AND j AND k\n"]);
    // The decision of line 3, that of line 4, which is TRUE once and FALSE once, and the two conditions of the one in it.
    has(
        &out,
        &[
            "2 of 2 100 %      1 of 4  25 %\n",
            "f.st:4:62: not shown to decide: k\n",
            "f.st:4:68: not shown to decide: b\n",
        ],
    );
}

#[test]
fn a_condition_is_shown_as_it_is_written() {
    let source = "FUNCTION F : BOOL VAR_INPUT x, y : INT; END_VAR F := x > y; END_FUNCTION
FUNCTION_BLOCK L
VAR_INPUT a, b, c : BOOL; x, y : INT; w : WORD; END_VAR
VAR_OUTPUT q : BOOL; END_VAR
    q := a AND (w AND 16#1) <> 0;
    q := (a OR b) = c AND BOOL_TO_INT(a OR b) + x > 1;
    q := a AND (x + 1) * 2 > 3;
    IF a AND
       F(x, (* first, second *)
         y) // and a text
       OR w = 16#2
    THEN q := TRUE; END_IF
END_FUNCTION_BLOCK
TEST 'v' VAR l : L; END_VAR l(x := 1); END_TEST
";
    let folder = Folder::with("coverage_written", &[("l.st", source)]);
    let out = folder.staunch("test . -q --coverage table").out(0);
    let open = "
l.st:5:10: not shown to decide: a
l.st:5:16: not shown to decide: (w AND 16#1) <> 0
l.st:6:10: not shown to decide: (a OR b) = c
l.st:6:11: not shown to decide: a
l.st:6:16: not shown to decide: b
l.st:6:27: not shown to decide: BOOL_TO_INT(a OR b) + x > 1
l.st:6:39: not shown to decide: a
l.st:6:44: not shown to decide: b
l.st:7:10: not shown to decide: a
l.st:7:16: not shown to decide: (x + 1) * 2 > 3
l.st:8:8: never TRUE: a AND F(x, y) OR w = 16#2
l.st:8:8: not shown to decide: a
l.st:9:8: not shown to decide: F(x, y)
l.st:11:11: not shown to decide: w = 16#2
";
    has(&out, &[open]);
}

/// Both conditions decide in both calls, but the result is the same: lcov shows what the table does.
#[test]
fn lcov_has_what_the_table_has() {
    let source = "FUNCTION Differ : BOOL
VAR_INPUT a, b : BOOL; END_VAR
    Differ := a XOR b;
END_FUNCTION
TEST 'never TRUE'
    ASSERT_FALSE(Differ(FALSE, FALSE));
    ASSERT_FALSE(Differ(TRUE, TRUE));
END_TEST
";
    let folder = Folder::with("coverage_xor", &[("x.st", source)]);
    has(&folder.staunch("test . -q --coverage table --coverage x.info").out(0), &["0 of 2   0 %"]);
    let lcov = folder.read("x.info");
    has(&lcov, &["MCDC:3,2,t,1,0,a\nMCDC:3,2,f,0,0,a\nMCDC:3,2,t,1,1,b\nMCDC:3,2,f,0,1,b\nMCF:4\nMCH:2\n"]);
}
