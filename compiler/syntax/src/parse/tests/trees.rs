//! The trees of what is written correctly.

use super::shape::{body, correct, initial_of};
use crate::ast::{Item, PouKind};

#[track_caller]
fn trees(cases: &[(&str, &str)]) {
    for (text, tree) in cases {
        assert_eq!(body(text), *tree, "{text}");
    }
}

#[test]
fn operators_bind_as_the_standard_says() {
    trees(&[
        ("x := a OR b XOR c AND d;", "x:=(a OR (b XOR (c AND d)))"),
        ("x := a & b = c < d;", "x:=(a AND (b = (c < d)))"),
        ("x := a OR_ELSE b AND_THEN c;", "x:=(a OR_ELSE (b AND_THEN c))"),
        ("x := 1 + 2 * 3 - 4 MOD 5 / 6;", "x:=((1 + (2 * 3)) - ((4 MOD 5) / 6))"),
        ("x := -2.0 ** 2.0;", "x:=(Neg(2.0) ** 2.0)"),
        ("x := 2 ** -3 ** 4;", "x:=((2 ** Neg(3)) ** 4)"),
        ("x := NOT a AND NOT b.c;", "x:=(Not(a) AND Not(b.c))"),
        ("x := a <> b >= c <= d > e;", "x:=(a <> (((b >= c) <= d) > e))"),
        ("x := (a - (b - c)) - d;", "x:=(<(a - <(b - c)>)> - d)"),
        ("x := - - + 1;", "x:=Neg(Neg(Plus(1)))"),
        ("X := a or b Xor c and d MoD e;", "X:=(a OR (b XOR (c AND (d MOD e))))"),
    ]);
}

#[test]
fn literals_have_their_values() {
    trees(&[
        ("x := 1_000 + 2#1010_1010 + 8#17 + 16#Ff;", "x:=(((1000 + 170) + 15) + 255)"),
        ("x := INT#5 + WORD#16#FF + bool#1 + BOOL#TRUE;", "x:=(((INT#5 + WORD#255) + bool#1) + BOOL#true)"),
        ("x := INT#-5;", "x:=Neg(INT#5)"),
        ("x := 18446744073709551615;", "x:=18446744073709551615"),
        ("x := 1.0 + 1_0.5e-3 + REAL#2.5E+2 + 1e5;", "x:=(((1.0 + 10.5e-3) + REAL#2.5E+2) + 1e5)"),
        (
            "x := T#1h30m + t#1.5s + TIME#-2s500ms;",
            "x:=((5400000000000ns:TIME + 1500000000ns:TIME) + -2500000000ns:TIME)",
        ),
        ("x := LTIME#1s500us7ns + LT#1d_2h + T#0s;", "x:=((1000500007ns:LTIME + 93600000000000ns:LTIME) + 0ns:TIME)"),
        ("x := T#1_000ms + T#0.000001ms;", "x:=(1000000000ns:TIME + 1ns:TIME)"),
        ("x := 'a$N$'$$$0A$t\"';", "x:=\"a\\n'$\\n\\t\\\"\""),
        ("x := \"ä$00E4$\"'\";", "x:=\"ää\\\"'\""),
        ("x := Color#Red;", "x:=Color#Red"),
        (
            "x := D#2024-01-31; y := LTOD#12:30:00.5; z := date_and_time#2024-01-01-12:00:00;",
            "x:=1706659200000000000ns:DATE y:=45000500000000ns:LTOD z:=1704110400000000000ns:DT",
        ),
        ("x := %IX0.0 AND %qw10 = %MD48;", "x:=(%IX0.0 AND (%qw10 = %MD48))"),
    ]);
}

#[test]
fn operands_have_members_and_arguments() {
    trees(&[
        ("a.b[1, i + 1].c^.d := w.3 + w.%X3 + w.%B1;", "a.b[1,(i + 1)].c^.d:=((w.3 + w.%X3) + w.%B1)"),
        ("f(); g(1, A := 2, B => c, NOT D => e, F => );", "f() g(1,A:=2,B=>c,not D=>e,F=>)"),
        ("t(IN := , PT := T#1s, Q => );", "t(PT:=1000000000ns:TIME,Q=>)"),
        ("c[i](CU := x = 1);", "c[i](CU:=(x = 1))"),
        ("f(NOT a, (b), g(h(1)));", "f(Not(a),<b>,g(h(1)))"),
    ]);
}

#[test]
fn statements_nest() {
    trees(&[
        (";;;x:=1;;", "; x:=1 ;"),
        ("IF a THEN b:=1; ELSIF c THEN d:=1; ELSE e:=1; END_IF", "if a?{b:=1}c?{d:=1}else{e:=1}"),
        ("IF a THEN ELSE IF b THEN c:=1; END_IF END_IF;", "if a?{}else{if b?{c:=1}}"),
        (
            "CASE x OF 1, 2..5: a:=1; b:=2; Color#Red, E.m: f(); -3: ; ELSE c:=1; END_CASE;",
            "case x 1,2..5:{a:=1 b:=2} Color#Red,E.m:{f()} Neg(3):{;} else{c:=1}",
        ),
        ("CASE x OF 'a': s.t := 1; N+1..N+3: END_CASE", "case x \"a\":{s.t:=1} (N + 1)..(N + 3):{}"),
        ("FOR i := 1 TO n BY -1 DO EXIT; CONTINUE; END_FOR", "for i:=1 to n by Neg(1){exit continue}"),
        ("WHILE a DO REPEAT b:=1; UNTIL c END_REPEAT END_WHILE;", "while a{repeat{b:=1}until c}"),
        ("RETURN;", "return"),
    ]);
}

#[test]
fn words_with_a_meaning_in_places_are_names_elsewhere() {
    trees(&[
        ("IF S=1 AND R=2 THEN x S= a; x R= b; END_IF", "if ((S = 1) AND (R = 2))?{x S=a x R=b}"),
        ("S := R; P := ST; LD := N; end := x; R_edge := F_EDGE;", "S:=R P:=ST LD:=N end:=x R_edge:=F_EDGE"),
        ("method := action; task := on; with(property);", "method:=action task:=on with(property)"),
        ("INT := STRING; T := D; TON(); ref := union;", "INT:=STRING T:=D TON() ref:=union"),
    ]);
}

#[test]
fn declarations_keep_their_parts() {
    let cases = [
        ("a, b AT %IX0.0 : BOOL R_EDGE := TRUE;", "a,b at %IX0.0: BOOL Rising := true;"),
        ("a : ARRAY[1..3, 0..N-1] OF ARRAY[*] OF INT;", "a: array[1..3,0..(N - 1)] array[*] INT;"),
        ("a : STRING; b : STRING[80]; c : wstring(5) := \"x\";", "a: string; b: string[80]; c: wstring[5] := \"x\";"),
        ("a : INT (-5..5) := 3; b : CODESYS.CTU := (PV := 5);", "a: INT(Neg(5)..5) := 3; b: CODESYS.CTU := (PV=5);"),
        ("a : (Red, Green := 5) INT := Green; b : INT (X, Y);", "a: enum(Red,Green=5)INT := Green; b: enum(X,Y)INT;"),
        (
            "a : STRUCT x : INT := 1; y, z : REAL; END_STRUCT := (x := 1, y := 2.0);",
            "a: {x: INT := 1; y,z: REAL;} := (x=1,y=2.0);",
        ),
        ("a : T := [4(0), 1, 2((x := 1)), 3()];", "a: T := [4x(0),1,2x((x=1)),3x()];"),
        (
            "a : T := [[1, 2], [3, 4]]; b : T := (c := [1], d := (e := 2));",
            "a: T := [[1,2],[3,4]]; b: T := (c=[1],d=(e=2));",
        ),
        ("a : T := 1, 2, 3(0);", "a: T := [1,2,3x(0)];"),
        ("a : INT := (1 + 2) * 3;", "a: INT := (<(1 + 2)> * 3);"),
    ];
    for (text, tree) in cases {
        assert_eq!(initial_of(text), tree, "{text}");
    }
}

#[test]
fn units_of_all_kinds() {
    let file = correct(
        "FUNCTION f : INT VAR_INPUT RETAIN x : INT; END_VAR; f := x; END_FUNCTION
         FUNCTION g END_FUNCTION FUNCTION_BLOCK b; END_FUNCTION_BLOCK;
         TYPE A : INT; B : STRUCT x : INT; END_STRUCT; C : STRUCT END_STRUCT END_TYPE
         {attribute 'x'} VAR_GLOBAL CONSTANT PERSISTENT c : INT := 1; END_VAR
         CONFIGURATION conf
           VAR_GLOBAL d : INT; END_VAR
           TASK fast (INTERVAL := T#1ms, PRIORITY := 1);
           PROGRAM one WITH fast : p;
           RESOURCE r ON cpu TASK slow; PROGRAM two : p; END_RESOURCE
         END_CONFIGURATION // at the end of the file",
    );
    assert_eq!(file.pragmas[0].text, "attribute 'x'");
    let Item::Pou(f) = &file.items[0] else { panic!() };
    assert_eq!((f.kind, f.name.text, f.blocks.len()), (PouKind::Function, "f", 1));
    assert!(f.result.is_some() && f.blocks[0].retain.is_some());
    let Item::Types(types) = &file.items[3] else { panic!() };
    assert_eq!(types.len(), 3);
    let Item::Globals(globals) = &file.items[4] else { panic!() };
    assert!(globals.constant.is_some() && globals.persistent.is_some());
    let Item::Configuration(it) = &file.items[5] else { panic!() };
    assert_eq!((it.globals.len(), it.resources.len()), (1, 2));
    let direct = &it.resources[1];
    assert_eq!((direct.tasks[0].name.text, direct.tasks[0].properties.len()), ("fast", 2));
    assert_eq!(direct.programs[0].task.map(|it| it.text), Some("fast"));
    assert_eq!(it.resources[0].programs[0].program.text, "p");
}

#[test]
fn comments_document_what_they_stand_beside() {
    let file = correct(
        "(* Counts cars. (* Nested. *)
          * Two lines. *)
         PROGRAM p
         VAR
           a : INT; // of a
           // before b
           // too
           b : INT;

           // far away

           c : INT; (* of c *) d : INT; /* of d */
           (* ===== *)
           e : (Red, // of Red
                Green);
         END_VAR
         END_PROGRAM",
    );
    let Item::Pou(pou) = &file.items[0] else { panic!() };
    assert_eq!(pou.doc.as_deref(), Some("Counts cars. (* Nested. *)\nTwo lines."));
    let docs: Vec<_> = pou.blocks[0].vars.iter().map(|it| it.doc.as_deref()).collect();
    assert_eq!(docs, [Some("of a"), Some("before b\ntoo"), None, Some("of d"), None]);
}
