//! The small changes that a program's tests should notice.

use staunch_frontend::{Source, Sources, mutants};

#[test]
fn each_change_is_of_the_program_under_test() {
    let text = "FUNCTION_BLOCK F VAR_INPUT a : BOOL; END_VAR VAR c : CTU; n : INT; END_VAR
c(CU := a, PV := 10);
IF NOT a THEN n := n + INT#0; END_IF
END_FUNCTION_BLOCK
TEST 'x' ASSERT_TRUE(1 < 2); END_TEST";
    let mut sources = Sources::default();
    sources.add(Source::new("f.st", text.to_owned()));
    let all = mutants(&sources);
    let changed: Vec<_> = all.iter().map(|it| it.lines(&sources)[1].clone()).collect();
    assert_eq!(
        changed,
        [
            ";",
            "c(CU := NOT (a), PV := 10);",
            "c(CU := a, PV := 11);",
            "c(CU := a, PV := 9);",
            "IF (a) THEN n := n + INT#0; END_IF",
            "IF NOT a THEN ; END_IF",
            "IF NOT a THEN n := n - INT#0; END_IF",
            "IF NOT a THEN n := n + INT#1; END_IF",
        ]
    );
    assert_eq!(all[1].apply(&sources).files()[0].text, text.replacen(":= a", ":= NOT (a)", 1));
}
