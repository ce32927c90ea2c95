//! Diagnostics as they are written for a reader.

use super::{Format, Style, render};
use crate::{
    diagnostic::{Code, Diagnostic},
    source::{Source, Sources, Span},
};

fn sources(bytes: &[u8]) -> Sources {
    let mut sources = Sources::default();
    sources.add(Source::decode("a.st", bytes));
    sources
}

fn at(start: u32, end: u32) -> Span {
    Span { file: 0, start, end }
}

#[test]
fn a_person_sees_the_place_and_the_fix() {
    let sources = sources(b"PROGRAM p\r\n\tx = 1;\r\n");
    let it = Diagnostic::new(Code::E0008, at(14, 15), "`=` compares")
        .label("expected `:=`")
        .other(at(0, 7), "in here")
        .help("write `:=`")
        .fix(at(14, 15), ":=");
    let text = render(&it, &sources, Format::Human, Style::default());
    let expected = "\
error[E0008]: `=` compares
 --> a.st:2:4
  |
1 | PROGRAM p
  | ------- in here
2 |     x = 1;
  |       ^ expected `:=`
  |
help: write `:=`
  |
2 |     x := 1;
  |       +
";
    assert_eq!(text, expected);
}

#[test]
fn short_and_json_count_lines_and_characters_from_one() {
    // Windows-1252, so that the umlaut has two bytes only after decoding.
    let sources = sources(b"(* \xe4 *) x\n\"\t");
    let it = Diagnostic::new(Code::E0001, at(9, 10), "no \"x\"\n");
    assert_eq!(render(&it, &sources, Format::Short, Style::default()), "a.st:1:9: error[E0001]: no \"x\"\n\n");
    let json = render(&it, &sources, Format::Json, Style::default());
    let expected = r#"{"reason":"diagnostic","code":"E0001","severity":"error","message":"no \"x\"\n","spans":[{"file":"a.st","byte_start":8,"byte_end":9,"line_start":1,"column_start":9,"line_end":1,"column_end":10,"is_primary":true,"label":null}],"notes":[],"help":null,"fix":null,"rendered":""#;
    assert!(json.starts_with(expected) && json.ends_with("\"}\n"), "{json}");
    assert_eq!(json.lines().count(), 1);
}

#[test]
fn a_long_line_is_shown_around_the_mark() {
    let sources = sources(format!("{}=1;{}", "ä".repeat(500), "b".repeat(500)).as_bytes());
    let it = Diagnostic::new(Code::E0008, at(1000, 1001), "`=` compares").label("expected `:=`");
    for style in [Style { color: false }, Style { color: true }] {
        let text = render(&it, &sources, Format::Human, style);
        assert!(text.contains("a.st:1:501") && text.contains("expected `:=`"), "{text}");
        assert!(!text.contains(":::") && text.chars().count() < 500, "{text}");
    }
}

#[test]
fn spans_at_the_edges_do_not_panic() {
    for text in ["", "\n", "a", "ä\r\n\r\nb\n", "\t\t"] {
        let sources = sources(text.as_bytes());
        for (start, end) in [(0, 0), (0, 99), (1, 1), (3, 4), (99, 99), (2, 1)] {
            let it = Diagnostic::new(Code::E0001, at(start, end), "x")
                .other(at(end, start), "y")
                .help("z")
                .fix(at(start, end), "w");
            for format in [Format::Human, Format::Short, Format::Json] {
                render(&it, &sources, format, Style { color: true });
            }
        }
    }
}
