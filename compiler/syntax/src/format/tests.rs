//! Layouts of small texts.

use super::{Indent, Letters, Style, part, whole};

/// Twice is as once.
fn laid_out(text: &str, style: &Style) -> String {
    let once = whole(text, style).expect("all tokens are kept");
    assert_eq!(whole(&once, style).as_deref(), Some(&*once), "it changes when it is laid out again");
    once
}

fn usual(text: &str) -> String {
    laid_out(text, &Style::default())
}

#[test]
fn a_file_is_laid_out() {
    assert_eq!(usual(include_str!("sample.st")), include_str!("sample.laid_out.st"));
}

#[test]
fn what_is_on_one_line_stays_there_if_it_fits() {
    let text = "IF a THEN b := 1; END_IF;\n";
    assert_eq!(usual(text), text);
    let long = format!("IF a THEN {} END_IF;", "b := 1; ".repeat(12));
    assert_eq!(usual(&long).lines().count(), 14);
    assert_eq!(usual("a := 1; b := 2;"), "a := 1;\nb := 2;\n");
}

#[test]
fn mistakes_do_not_stop_it() {
    assert_eq!(
        usual("IF a THEN\nFOR i := 1 TO 3 DO\nx:=(1;\nEND_FOR\ny:=2"),
        "IF a THEN\nFOR i := 1 TO 3 DO\n    x := (1;\nEND_FOR\ny := 2\n"
    );
    assert_eq!(usual("x := 'open\ny:=( *p) ;"), "x := 'open\n    y := ( * p);\n");
    assert_eq!(usual(""), "");
}

#[test]
fn line_ends_and_the_end_of_a_part_stay() {
    let style = Style::default();
    assert_eq!(usual("a:=1;\r\n(* x\r\n y *)\r\nb:=2;"), "a := 1;\r\n(* x\r\n y *)\r\nb := 2;\r\n");
    assert_eq!(part("a:=1;", &style).as_deref(), Some("a := 1;"));
    assert_eq!(part("a:=1;\n\n\n", &style).as_deref(), Some("a := 1;\n"));
}

#[test]
fn words_of_a_configuration_are_keywords() {
    let text = "configuration Plant\nresource Cpu on Plc\ntask fast(interval := T#10ms);\nprogram on with fast : Main;\n\
                program with with fast : Main;\nend_resource\nend_configuration\non := task + with;\n";
    let expected = "CONFIGURATION Plant\n    RESOURCE Cpu ON Plc\n        TASK fast(interval := T#10ms);\n        \
                    PROGRAM on WITH fast : Main;\n        PROGRAM with WITH fast : Main;\n    END_RESOURCE\n\
                    END_CONFIGURATION\non := task + with;\n";
    assert_eq!(usual(text), expected);
}

#[test]
fn the_style_decides() {
    let style = Style { indent: Indent::Tab, keywords: Letters::Lower, indents_pous: true, ..Style::default() };
    let text = "PROGRAM Main\nVAR\na : INT;\nEND_VAR\na := 1;\nEND_PROGRAM\n";
    let expected = "program Main\n\tvar\n\t\ta : int;\n\tend_var\n\ta := 1;\nend_program\n";
    assert_eq!(laid_out(text, &style), expected);
    let as_written = Style { keywords: Letters::AsWritten, ..Style::default() };
    assert_eq!(laid_out("If a Then b(); End_If;\n", &as_written), "If a Then b(); End_If;\n");
    let narrow = Style { width: 40, ..Style::default() };
    assert_eq!(
        laid_out("total := first_part(a) + second_part(b) + c;\n", &narrow),
        "total := first_part(a)\n    + second_part(b)\n    + c;\n"
    );
}

#[test]
fn signs_of_other_languages_stay_where_they_are() {
    let text = "#x := #y + \"DB\".z;\nREGION What's & that\n    a(b[1], -c, NOT d);\nEND_REGION\n";
    assert_eq!(usual(text), text);
}
