//! Each mistake is reported once, where it is, and the rest is read as if it did not exist.

use super::shape::parsed;
use crate::{lex::index, source::Source};

/// Lines end in `// E0000` for each code that is expected there.
#[track_caller]
fn expect(text: &str) {
    let (_, diagnostics) = parsed(text);
    let source = Source::new("", text.to_owned());
    let mut found: Vec<(u32, &str)> =
        diagnostics.iter().map(|it| (source.line_column(it.span.start).0, it.code.name())).collect();
    found.sort_unstable();
    let mut expected = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        let marks = line.rsplit_once("// ").map_or("", |(_, marks)| marks);
        expected.extend(marks.split(' ').filter(|it| it.starts_with('E')).map(|it| (number, it)));
    }
    expected.sort_unstable();
    let messages: Vec<_> = diagnostics.iter().map(|it| &it.message).collect();
    assert_eq!(found, expected, "{messages:#?}\n{text}");
}

#[test]
fn declarations() {
    expect(
        "PROGRAM p
         VAR
           a : INT // E0012
           b : INT;
           c := INT; // E0001
           to : INT; // E0016
           d : ARRAY[1..3 OF INT; // E0001
           e : ARRAY[1..3] INT; // E0013
           f, : INT; // E0001
           g INT; // E0001
           h : INT = 1; // E0008
           h : INT;
         END_VAR
           h := ; // E0001
         END_PROGRAM
         FUNCTION_BLOCK b
         VAR x : INT; ENDVAR // E0018
         VAR x : INT;
           x := 1; // E0014
         VAR y : INT; END_VAR // E0017
         END_FUNCTION // E0014
         TYPE
           A : INT // E0012
           B : STRUCT x : INT; y : ; END_STRUCT; // E0001
           C : (Red, 5); // E0001
         END_TYPE",
    );
}

#[test]
fn statements() {
    expect(
        "PROGRAM p
           x = 1; // E0008
           IF x := 1 THEN y := 2; END_IF
           IF x == 1 && y != 2 || !z THEN y := 2; END_IF // E0010 E0010 E0010 E0010 E0010
           x++; // E0010
           x := 5 % 2; // E0010
           IF (x => 1) THEN ; END_IF // E0010
           IF x // E0013
             y := 2;
           END_IF
           WHILE x DO y := 1 END_WHILE // E0012
           WHILE x THEN y := 1; END_WHILE // E0013
           FOR i = 1 TO 3 DO ; END_FOR // E0008
           FOR i := 1 TO DO ; END_FOR // E0001
           CASE x 1: ; END_CASE // E0013
           CASE x OF
             1: y := ; // E0001
             2 y := 1; // E0001
             , 3: y := 1; // E0001
             4: y := 1;
           END_CASE
           x := 1 // E0012
           y := 2;
           x := (1 + 2; // E0001
           f(1, ); // E0001
           x : = 1; // E0008
           RETURN x; // E0019
           a + b; // E0001
           x := 1 2; // E0001
           x := 'abc; // E0004
           x := §; // E0002
           x := 16#FG + T#5x + T#5 + '$q'; // E0005 E0006 E0006 E0007
           x := 3;
         END_PROGRAM",
    );
}

#[test]
fn ends_of_blocks() {
    expect(
        "PROGRAM p
           FOR i := 1 TO 3 DO
             x := 1;
         END_PROGRAM // E0014
         PROGRAM q
           IF a THEN
             WHILE b DO
               x := 1;
           END_IF // E0014
           END_IF
           END_IF // E0015
           ELSE // E0015
           UNTIL // E0015
           x := ; // E0001
         END_PROGRAM
         PROGRAM r
           IF a THEN x := 1;
           ELSE IF b THEN x := 2; // E0011
           END_IF
         END_PROGRAM
         PROGRAM s
           IF a THEN x := 1; ELSEIF b THEN x := 2; ENDIF // E0018 E0018
           IF a THEN x := 1; END IF // E0018
           IF a THEN ELSE ELSE END_IF // E0015
           IF a THEN ELSE ELSIF b THEN END_IF // E0015
           REPEAT x := 1; END_REPEAT // E0001
           REPEAT x := 1; UNTIL END_REPEAT // E0001
         FUNCTION f : INT // E0014
           x := 1;
         END_FUNCTION
         END_FUNCTION // E0015
         garbage // E0001
         TYPE A : INT; END_TYPE",
    );
}

#[test]
fn wrong_names_are_told_where_they_are_declared() {
    expect(
        "PROGRAM p
         VAR
           by, a : BYTE; // E0016
           if : INT; // E0016
           type AT %MW0 : INT; // E0016
           my-var : INT; // E0001
           2nd : INT; // E0001
           my other : INT; // E0001
           größe : INT; // E0002
         END_VAR
           by := a + by;
           IF by = 3 AND if > 2 THEN f(by, if, x := by); END_IF
           if := if + type;
           my-var := my-var - 2nd;
           größe := by;
           FOR a := by TO by BY by DO ; END_FOR
         END_PROGRAM
         FUNCTION repeat : INT // E0016
           repeat := 1;
         END_FUNCTION
         TYPE to : INT; case : (A, B); END_TYPE // E0016 E0016
         PROGRAM q VAR x : to; y : case; END_VAR
           REPEAT x := repeat(); UNTIL x = 1 END_REPEAT
           CASE y OF A: ; END_CASE
         END_PROGRAM",
    );
}

#[test]
fn closing_words_are_weighed_against_what_follows() {
    expect(
        "PROGRAM p
           WHILE a DO
             x := 1;
           END_IF // E0014
           FOR i := 1 TO 3 DO
             IF a THEN x := 1; END_FOR // E0014
           END_FOR
           IF a THEN
             x := 1;
             END_WHILE // E0015
           END_IF
           IF a THEN
             FOR i := 1 TO 3 DO
               x := 1;
           END_IF // E0014
           CASE x OF 1: y := 1; END_IF // E0014
           REPEAT x := 1; UNTIL x > 3 END_WHILE // E0014
           IF a THEN b := 1; END; // E0018
           IF a THEN b := 1; END_FI // E0018
           FOR i := 1 TO 3 DO b := 1; NEXT // E0018
         END_PROGRAM
         TYPE S : STRUCT a : INT; END_TYPE // E0014
         TYPE T : STRUCT a : INT; END_VAR; END_TYPE // E0014
         VAR_GLOBAL g : INT; END_STRUCT // E0014",
    );
}

#[test]
fn the_end_of_the_file_is_told_once() {
    expect("PROGRAM p IF a THEN\n x := 1; // E0014");
    expect("PROGRAM p VAR a : INT; b : ARR // E0014");
    expect("PROGRAM p IF a THEN x := 3 + // E0001");
    expect("PROGRAM p IF a THEN f(1, // E0001");
    expect("TYPE A : STRUCT a : INT // E0014");
}

#[test]
fn habits_of_other_languages() {
    expect(
        "PROGRAM p
           if (a) { // E0020
             x = 1;
           } else {
             x = 2;
           }
           for (i = 0; i < 10; i++) { // E0020
             x += 1;
           }
           if a then begin // E0020
             x := 1;
           end else begin // E0020
             x := 2;
           end;
           FOR i := 10 DOWNTO 1 DO ; END_FOR // E0020
           FOR i := 1 TO 9 STEP 2 DO ; END_FOR // E0018
           IF a THEN x := 1; ELSE: x := 2; END_IF // E0001
           IF a; THEN x := 1; END_IF // E0013
           IF (a)) THEN x := 1; END_IF // E0001
           x := a << 2; // E0010
           x := a =< b; // E0010
           x := a >< b; // E0010
           x := a ^ 2; // E0010
           x := a div b; // E0010
           x := a->b; // E0010
           x := 0xFF + 1.5f + 12abc; // E0005 E0005 E0005
           x := .5 + 5.; // E0005 E0005
           x := 1,5; // E0005
           x := 5s + T#5 s; // E0006 E0006
           x =: 4; // E0008
           x := MAX(1 2); // E0001
           t(IN := x PT := y); // E0001
           t(IN := x, PT := y; // E0001
           x := a + 1); // E0001
           x := IF a THEN 1 ELSE 2 END_IF; // E0001
           SWITCH x OF 1: ; END_CASE // E0018
           WHLIE x DO ; END_WHILE // E0018
           s := 'it's late'; // E0004
           x := 1, // E0012
           x := 3. // E0012
           y := x: // E0012
           IF a b THEN x := 1; END_IF // E0001
           IF a THEN BEGIN x := 1; END; END_IF // E0020
           WHILE a DO x := 1; WEND // E0018
           FOR i := 1 TO 3 DO x := 1; NEXT i // E0018
           x := [1, 2]; // E0001
           t(IN: x, PT: y); // E0008 E0008
           t(IN x, PT := y); // E0001
           t(IN := x; PT := y); // E0001
           IF a ADN b THEN x := 1; END_IF // E0010
           IF a > 1 AND < 5 THEN x := 1; END_IF // E0001
           a // E0001
           IF a THEN x := 1; END_IF;
           ELSE x := 2; END_IF // E0015
           s := ‘x’; // E0002
         END_PROGRAM
         FUNCTION f(x : INT; y : REAL) : INT // E0020
         END_FUNCTION
         FUNCTION g INT // E0001
         END_FUNCTION
         FUNCTION INT g2 // E0001
         VAR a : INT, b : INT; END_VAR // E0012
         END_FUNCTION
         PROGRAM g3() // E0020
         END_PROGRAM
         FUNCTION_BLOCK h : INT // E0001
         VAR a AT IX0.0 : BOOL; b : BOOL AT %QX0.0; c; d, e; END_VAR // E0409 E0001 E0001
         VAR f : {A, B}; g : ARRAY[1..2] OF INT := {1, 2}; END_VAR // E0020 E0020
         TYPE T : INT; END_TYPE // E0001
         VAR_RETAIN i : INT; END_VAR // E0018
         FUNCTION j : INT // E0001
         END_FUNCTION
           x := 1;
         END_FUNCTION_BLOCK
         STRUCT S // E0001
           a : INT;
         END_STRUCT
         PROGRM q // E0018
         VAR INPUT x : INT; END_VAR // E0018
         VAROUTPUT x : INT; END_VAR // E0018
         VAR a : ARRAY[10] OF INT; b : ARRAY[1:3] OF INT; c : INT[3]; d : ARRAY(1..2) OF INT; END_VAR // E0001 E0001 E0001 E0001
         VAR INT e; f INT; g = INT; END_VAR // E0001 E0001 E0001
         END_PROGRAM
         VAR x : INT; END_VAR // E0001
         x := 1;
         END_PROGRAM
         PROGRAM r
           a : INT; // E0017
           b : BOOL;
           a := 1;
           c : INT; END_VAR // E0017
         END_PROGRAM",
    );
}

#[test]
fn what_is_not_supported_is_named() {
    expect(
        "FUNCTION_BLOCK ABSTRACT b EXTENDS c IMPLEMENTS d, e
         VAR x : POINTER TO INT; y : REFERENCE TO INT; z : REF_TO INT; END_VAR
         VAR_CONFIG x.z : y; END_VAR // E0403
           x := y := 1;
           x REF= y;
           x ?= y;
           JMP there;
           there:
           nowhere:
           METHOD PUBLIC m : INT
             VAR x : INT; END_VAR
             x := 1;
           END_METHOD
           x = 1; // E0008
         END_FUNCTION_BLOCK
         INTERFACE i EXTENDS a, b
           METHOD m END_METHOD
         END_INTERFACE
         TYPE U : UNION a : INT; END_UNION; V EXTENDS W : STRUCT END_STRUCT; END_TYPE
         PROGRAM p x := ; END_PROGRAM // E0001",
    );
}

#[test]
fn fixes_make_the_text_right() {
    let cases = [
        ("x = 1;", "x := 1;"),
        ("x : = 1;", "x := 1;"),
        ("x := a&&b;", "x := a AND b;"),
        ("x := a || b;", "x := a OR b;"),
        ("x := a%b;", "x := a MOD b;"),
        ("x := !a;", "x := NOT a;"),
        ("x--;", "x := x - 1;"),
        ("x := 1\n y := 2;", "x := 1;\n y := 2;"),
        ("IF a\n x := 1; END_IF", "IF a THEN\n x := 1; END_IF"),
        ("FOR i := 1 TO 3 THEN ; END_FOR", "FOR i := 1 TO 3 DO ; END_FOR"),
        ("IF a THEN ; ELSE  IF b THEN ; END_IF", "IF a THEN ; ELSIF b THEN ; END_IF"),
        ("IF a THEN ; ELSEIF b THEN ; END IF", "IF a THEN ; ELSIF b THEN ; END_IF"),
        ("CASE x OF 1 y := 1; END_CASE", "CASE x OF 1: y := 1; END_CASE"),
        ("WHILE x DO ; END_IF", "WHILE x DO ; END_WHILE"),
        ("IF x; THEN ; END_IF", "IF x THEN ; END_IF"),
        ("IF x:y := 1; END_IF", "IF x THEN y := 1; END_IF"),
        ("x := y + 1);", "x := y + 1;"),
        ("x := f(1 2);", "x := f(1, 2);"),
        ("x := (y + 1;", "x := (y + 1);"),
        ("x =: 1;", "x := 1;"),
        ("x := a =< b;", "x := a <= b;"),
        ("x := 0xFF;", "x := 16#FF;"),
        ("x := 5s;", "x := T#5s;"),
        ("x := T#5 s;", "x := T#5s;"),
        ("x := 1,5;", "x := 1.5;"),
        ("x := .5;", "x := 0.5;"),
        ("x := a->b;", "x := a^.b;"),
        ("t(IN: x);", "t(IN := x);"),
        ("t(IN x);", "t(IN := x);"),
        ("x := a ADN b;", "x := a AND b;"),
        ("s := “x”;", "s := 'x';"),
        ("FOR i := 1 TO 9 STEP 2 DO ; END_FOR", "FOR i := 1 TO 9 BY 2 DO ; END_FOR"),
        ("IF a THNE x := 1; END_IF", "IF a THEN x := 1; END_IF"),
        ("IF a THE\n x := 1; END_IF", "IF a THEN\n x := 1; END_IF"),
        ("x := S5T#5s;", "x := T#5s;"),
        ("x := s5time#1h30m;", "x := T#1h30m;"),
        ("CASE x OF 0; y := 1; 1: y := 2; END_CASE", "CASE x OF 0: y := 1; 1: y := 2; END_CASE"),
        ("VAR a : ARRAY[1-10] OF INT; END_VAR", "VAR a : ARRAY[1..10] OF INT; END_VAR"),
        ("VAR a : ARRAY[0 - N] OF INT; END_VAR", "VAR a : ARRAY[0..N] OF INT; END_VAR"),
    ];
    for (wrong, right) in cases {
        let (before, after) = ("PROGRAM p ", " END_PROGRAM");
        let text = format!("{before}{wrong}{after}");
        let (_, diagnostics) = parsed(&text);
        let mut fixed = text.clone();
        for it in diagnostics.iter().rev() {
            let fix = it.fix.as_ref().unwrap_or_else(|| panic!("{wrong}: {}", it.message));
            let range = index(fix.span.start)..index(fix.span.end);
            fixed.replace_range(range, &fix.replacement);
        }
        assert_eq!(fixed, format!("{before}{right}{after}"));
        super::shape::correct(&fixed);
    }
}
