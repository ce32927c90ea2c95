//! Damaged files: whatever is in one, it is read or refused, and every problem has its place in it.

use super::read;
use crate::source::{Source, Span};

const PROJECT: &str = r#"{"meta": {"type": "plc-project"}, "data": {
 "dataTypes": [{"name": "A", "derivation": "enumerated", "values": [{"description": "x"}], "initialValue": "x"},
  {"name": "B", "derivation": "structure", "variable": [{"name": "b", "type": {"value": "INT"}, "documentation": "ä"}]},
  {"name": "C", "derivation": "array", "baseType": {"value": "INT"}, "dimensions": [{"dimension": "1..2"}]}],
 "globalVariableLists": [{"name": "G", "variables": [{"name": "g", "type": {"value": "INT"}}]}],
 "pous": [{"type": "program", "data": {"name": "p", "variables": [{"name": "v", "class": "input",
  "type": {"definition": "array", "data": {"baseType": {"value": "INT"}, "dimensions": []}}, "location": "%IX0.0"}],
  "body": {"language": "st", "value": "v := 1;\n\u00e4"}}}],
 "configuration": {"resource": {"tasks": [{"name": "t", "triggering": "Cyclic", "interval": "T#1s", "priority": 1}],
  "instances": [{"name": "i", "task": "t", "program": "p"}], "globalVariables": []}}}}"#;

const PINS: &str = r#"{"Uno": [{"pin": "1", "pinType": "digitalInput", "address": "%IX0.0", "alias": "a"},
 {"pin": "2", "pinType": "digitalInput", "address": "%IX0.0", "alias": "a"}]}"#;

const BLOCK: &str =
    "(* ä *) // x\nFUNCTION F : STRING[5]\nVAR_INPUT (* END_VAR *)\n a : INT;\nEND_VAR\n#include <x.h>\n";

/// A contact that feeds a timer and a coil, as the editor saves them.
const LADDER: &str = r#"PROGRAM L
VAR go : BOOL; end : BOOL AT %QX0.0; t : TON; END_VAR
{"name": "L", "rungs": [{"id": "r", "reactFlowViewport": [9, 9.5], "nodes": [
 {"id": "l", "type": "powerRail", "position": {"x": 0, "y": 1}, "data": {"variant": "left", "numericId": "1"}},
 {"id": "c", "type": "contact", "data": {"variant": "negated", "numericId": "2", "variable": {"name": "go"}}},
 {"id": "b", "type": "block", "data": {"numericId": "3", "variant": {"name": "TON", "type": "function-block", "variables": [
   {"name": "Q", "class": "output", "type": {"definition": "base-type", "value": "BOOL"}}]}, "variable": {"name": "t"},
  "inputConnector": {"id": "IN"}, "outputConnector": {"id": "Q"}, "inputHandles": [{"id": "IN"}], "outputHandles": [{"id": "Q"}]}},
 {"id": "o", "type": "coil", "data": {"variant": "set", "numericId": "4", "variable": {"name": "end"}}}], "edges": [
 {"source": "l", "target": "c"}, {"source": "c", "target": "b", "sourceHandle": "output", "targetHandle": "IN"},
 {"source": "b", "target": "o", "sourceHandle": "Q", "targetHandle": "input"}]}]}
END_PROGRAM
"#;

const FUNCTIONS: &str = r#"PROGRAM F
VAR a, b : INT; END_VAR
{"name": "F", "rung": {"nodes": [
 {"id": "i", "type": "input-variable", "data": {"numericId": "1", "variable": {"name": "a"}}},
 {"id": "f", "type": "block", "data": {"numericId": "2", "variant": {"name": "ADD", "type": "function", "variables": []},
  "inputHandles": [{"id": "IN1"}, {"id": "IN2"}], "outputHandles": [{"id": "OUT"}]}},
 {"id": "o", "type": "output-variable", "data": {"numericId": "3", "variable": {"name": "b"}}}], "edges": [
 {"source": "i", "target": "f", "targetHandle": "IN1"}, {"source": "i", "target": "f", "targetHandle": "IN2"},
 {"source": "f", "target": "o", "sourceHandle": "OUT"}]}}
END_PROGRAM
"#;

/// Reads a text as a file, and looks up the place of each problem.
fn problems(path: &str, text: &str) -> usize {
    let source = Source::decode(path, text.as_bytes());
    let length = u32::try_from(source.file().text.len()).unwrap();
    for it in source.problems() {
        let place = source.in_file(Span { file: 0, start: it.at, end: it.at + 1 });
        assert!(place.start <= place.end && place.end <= length, "{path}, {text}: {it:?} at {place:?}");
        assert!(source.line_column(it.at).0 >= 1);
    }
    source.problems().len()
}

/// A text without one of its characters, up to it, and with others in its place.
fn damaged(text: &str) -> impl Iterator<Item = String> {
    text.char_indices().flat_map(move |(at, symbol)| {
        let (before, after) = (&text[..at], &text[at + symbol.len_utf8()..]);
        let others = ["", "\"", "{", "]", "7", "ä", "\\", ":", " null ", "[]", "{}"];
        others.map(|it| format!("{before}{it}{after}")).into_iter().chain([before.to_owned()])
    })
}

#[test]
fn damaged_files_are_read_or_refused() {
    assert_eq!(problems("project.json", PROJECT), 0);
    let count: usize = damaged(PROJECT).map(|it| problems("project.json", &it)).sum();
    assert!(count > 5_000, "{count}");
    let count: usize = damaged(PINS).map(|it| problems("devices/pin-mapping.json", &it)).sum();
    assert!(count > 500, "{count}");
    for (path, text) in [("pous/programs/L.ld", LADDER), ("pous/programs/F.fbd", FUNCTIONS)] {
        assert_eq!(problems(path, text), 0);
        let count: usize = damaged(text).map(|it| problems(path, &it)).sum();
        assert!(count > 1_000, "{path}: {count}");
    }
    let count: usize = damaged(BLOCK).map(|it| problems("pous/functions/F.cpp", &it)).sum();
    assert!(count > 500, "{count}");
}

/// What is not a value of its kind is reported, whatever it is in place of.
#[test]
fn values_of_another_kind_are_reported() {
    for value in ["5", "\"x\"", "[]", "[5]", "{}", "true"] {
        for member in
            ["data", "dataTypes", "globalVariableLists", "pous", "configuration", "resource", "tasks", "instances"]
        {
            let start = PROJECT.find(&format!("\"{member}\": ")).unwrap();
            let changed = format!(
                "{}\"{member}\": {value}, \"was\": {}",
                &PROJECT[..start],
                &PROJECT[start + member.len() + 4..]
            );
            let is_right =
                matches!((value, member), ("[]", _) if !matches!(member, "data" | "configuration" | "resource"));
            let is_empty = value == "{}" && matches!(member, "configuration" | "resource" | "data");
            let found = problems("project.json", &changed);
            assert_eq!(found > 0, !is_right && !is_empty, "{member}: {value}: {found}");
        }
    }
}

#[test]
fn files_are_known_by_their_places() {
    assert!(read("plc/devices/pin-mapping.json", "[]").is_some());
    assert!(read(r"plc\devices\remote\a.json", "{}").is_some());
    assert!(read("project.json", "{\"dependencies\": {}}").is_none());
    assert!(read("package.json", "{\"name\": \"plc-project\"}").is_some());
    assert!(read("a.py", "import x").is_none());
    assert!(read("a.st", "PROGRAM p END_PROGRAM").is_none());
}

/// Nothing that a text holds ends the declaration that it is in.
#[test]
fn names_and_comments_stay_what_they_are() {
    let wild = PROJECT.replace("\"documentation\": \"ä\"", "\"documentation\": \"*) x : INT; (*\"");
    let text = read("project.json", &wild).unwrap().text;
    assert!(text.contains("(* * ) x : INT; ( * *)"), "{text}");
    assert_eq!(problems("project.json", &PROJECT.replace("\"name\": \"b\"", "\"name\": \"b : INT; c\"")), 1);
}

/// A diagram in a file of its own is read as statements, after what the POU declares.
#[test]
fn diagrams_are_statements() {
    let text = |path: &str, text: &str| Source::decode(path, text.as_bytes()).text;
    let ladder = text("pous/programs/L.ld", LADDER);
    assert!(
        ladder.contains("END_VAR\nt(IN := NOT go);\nIF t.Q THEN\n    end := TRUE;\nEND_IF;\nEND_PROGRAM"),
        "{ladder}"
    );
    let functions = text("pous/programs/F.fbd", FUNCTIONS);
    assert!(functions.contains("_TMP_ADD2_OUT : INT;") && functions.contains("b := _TMP_ADD2_OUT;"), "{functions}");
}
