//! An editor's requests, one kind each.

mod support;

use serde_json::{Value as Json, json};
use staunch_frontend::{Dialect, Options, check};
use staunch_lsp::Choice;
use support::{Editor, cursor, edited, place, uri};

const PUMP: &str = "\
(* A pump with its hours. *)
FUNCTION_BLOCK Pump
VAR_INPUT run : BOOL; limit : INT := 5; END_VAR
VAR_OUTPUT
starts : INT; (* how often it started *)
END_VAR
VAR edge : R_TRIG; END_VAR
edge(CLK := run);
IF edge.Q AND starts < limit THEN starts := starts + 1; END_IF
END_FUNCTION_BLOCK

FUNCTION Scale : REAL
VAR_INPUT x : REAL; factor : REAL; END_VAR
Scale := x * factor;
END_FUNCTION
";

const MAIN: &str = "\
TYPE State : (Idle, Running, Faulted); END_TYPE
PROGRAM Main
VAR first : Pump; state : State; level : REAL; count : CTU; END_VAR
first(run := level > 1.0, limit := 3);
level := Scale(level, 2.0);
count(CU := first.starts > 2, PV := 10);
IF state = Running THEN state := State.Idle; END_IF
END_PROGRAM
";

fn both() -> Editor {
    Editor::open(Dialect::Iec, &[("pump.st", PUMP), ("main.st", MAIN)])
}

/// Where a word is in a text: the `number`th time, from 0.
fn of(text: &str, word: &str, number: usize) -> (u32, u32) {
    let (at, _) = text.match_indices(word).nth(number).expect("the word is in the text");
    let line = text[..at].matches('\n').count();
    let column = at - text[..at].rfind('\n').map_or(0, |it| it + 1);
    (line as u32, column as u32)
}

fn start(it: &Json) -> (u64, u64) {
    let start = &it["range"]["start"];
    (start["line"].as_u64().expect("a line"), start["character"].as_u64().expect("a character"))
}

#[test]
fn hover_shows_a_declaration_and_its_comment() {
    let mut editor = both();
    let shown = editor.at("hover", "main.st", of(MAIN, "first(run", 0));
    assert_eq!(shown["contents"]["value"], json!("```iecst\nVAR first : Pump\n```"));
    let shown = editor.at("hover", "main.st", of(MAIN, "Pump", 0));
    let text = shown["contents"]["value"].as_str().expect("a text");
    assert!(text.starts_with("```iecst\nFUNCTION_BLOCK Pump\nVAR_INPUT\n    run : BOOL;"), "{text}");
    assert!(text.ends_with("A pump with its hours."), "{text}");
    let shown = editor.at("hover", "main.st", of(MAIN, "starts", 0));
    assert_eq!(shown["contents"]["value"], json!("```iecst\nVAR_OUTPUT starts : INT\n```\n\nhow often it started"));
    let shown = editor.at("hover", "main.st", of(MAIN, "CTU", 0));
    let text = shown["contents"]["value"].as_str().expect("a text");
    assert!(text.contains("FUNCTION_BLOCK IEC.CTU") && text.contains("- CODESYS:"), "{text}");
    assert_eq!(editor.at("hover", "main.st", of(MAIN, "END_PROGRAM", 0)), Json::Null);
    editor.close();
}

#[test]
fn a_name_leads_to_its_declaration_and_back() {
    let mut editor = both();
    let found = editor.at("definition", "main.st", of(MAIN, "Scale", 0));
    assert_eq!(found["uri"], json!(uri("pump.st")));
    assert_eq!(start(&found), (11, 9));
    // The pin of a call, and an enumerator.
    assert_eq!(start(&editor.at("definition", "main.st", of(MAIN, "limit", 0))), (2, 22));
    assert_eq!(start(&editor.at("definition", "main.st", of(MAIN, "Running", 1))), (0, 20));
    let ty = editor.at("typeDefinition", "main.st", of(MAIN, "first", 1));
    assert_eq!((ty["uri"].clone(), start(&ty)), (json!(uri("pump.st")), (1, 15)));
    let mut params = place("pump.st", of(PUMP, "starts", 0));
    params["context"] = json!({ "includeDeclaration": true });
    let all = editor.ask("textDocument/references", params.clone());
    assert_eq!(all.as_array().expect("a list").len(), 5);
    params["context"] = json!({ "includeDeclaration": false });
    assert_eq!(editor.ask("textDocument/references", params).as_array().expect("a list").len(), 4);
    let near = editor.at("documentHighlight", "main.st", of(MAIN, "level", 0));
    assert_eq!(near.as_array().expect("a list").len(), 4);
    editor.close();
}

#[test]
fn diagnostics_come_as_one_types_and_go() {
    let mut editor = both();
    assert_eq!(editor.problems("main.st"), Vec::<Json>::new());
    let (line, column) = of(MAIN, "level := Scale", 0);
    editor.edit("main.st", (line, column), 5, "levle");
    let found = editor.problems("main.st");
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0]["code"], json!("E0101"));
    assert_eq!(start(&found[0]), (line.into(), column.into()));
    let range = found[0]["range"].clone();
    let params = json!({ "textDocument": { "uri": uri("main.st") }, "range": range, "context": { "diagnostics": [] } });
    let actions = editor.ask("textDocument/codeAction", params);
    assert_eq!(actions[0]["title"], json!("Write `level`"));
    let edits = &actions[0]["edit"]["changes"][uri("main.st")];
    assert_eq!(edited(&MAIN.replacen("level := Scale", "levle := Scale", 1), edits), MAIN);
    editor.edit("main.st", (line, column), 5, "level");
    assert_eq!(editor.problems("main.st"), Vec::<Json>::new());
    // The same, when it is asked for.
    let report = editor.ask("textDocument/diagnostic", json!({ "textDocument": { "uri": uri("main.st") } }));
    assert_eq!(report, json!({ "kind": "full", "items": [] }));
    // A change in one file is a mistake in another.
    editor.write("pump.st", &PUMP.replace("starts", "begins"));
    let found = editor.problems("main.st");
    assert!(found.iter().any(|it| it["code"] == json!("E0107")), "{found:?}");
    editor.close();
}

fn labels(items: &Json) -> Vec<&str> {
    items.as_array().expect("a list").iter().map(|it| it["label"].as_str().expect("a label")).collect()
}

/// What is offered at the `|` of the program's last line.
fn offered(editor: &mut Editor, line: &str) -> Vec<String> {
    let (text, at) = cursor(&MAIN.replace("END_PROGRAM", &format!("{line}\nEND_PROGRAM")));
    editor.write("main.st", &text);
    labels(&editor.at("completion", "main.st", at)).into_iter().map(str::to_owned).collect()
}

#[test]
fn completion_offers_what_could_be_there() {
    let mut editor = both();
    let has = |all: &[String], wanted: &[&str]| wanted.iter().all(|it| all.iter().any(|known| known == it));
    let members = offered(&mut editor, "first.|");
    assert_eq!(members, ["run", "limit", "starts"]);
    assert_eq!(offered(&mut editor, "level := first.st|"), ["run", "limit", "starts"]);
    let values = offered(&mut editor, "level := |");
    assert!(has(&values, &["level", "first", "state", "Scale", "Idle", "ABS", "TRUE"]), "{values:?}");
    assert!(!has(&values, &["edge"]), "a variable of another POU");
    let statement = offered(&mut editor, "l|");
    assert!(has(&statement, &["level", "first"]), "{statement:?}");
    let pins = offered(&mut editor, "first(run := TRUE, |");
    assert!(has(&pins, &["limit", "starts", "level"]) && !has(&pins, &["run"]), "{pins:?}");
    let pins = offered(&mut editor, "count(|);");
    assert!(has(&pins, &["CU", "R", "PV", "Q", "CV"]), "{pins:?}");
    let enumerators = offered(&mut editor, "state := |;");
    assert!(has(&enumerators[..3], &["Idle", "Running", "Faulted"]), "{enumerators:?}");
    assert_eq!(offered(&mut editor, "state := State.|;"), ["Idle", "Running", "Faulted"]);
    let labels_of_case = offered(&mut editor, "CASE state OF\n    |\n    Idle: level := 1.0;\nEND_CASE");
    assert!(has(&labels_of_case[..3], &["Idle", "Running", "Faulted"]), "{labels_of_case:?}");
    let either = offered(&mut editor, "CASE state OF\n    Idle: level := 1.0;\n    |\nEND_CASE");
    assert!(has(&either, &["Idle", "Running", "level", "first"]), "{either:?}");
    let (text, at) = cursor(&MAIN.replace("level : REAL;", "level : REAL; other : |;"));
    editor.write("main.st", &text);
    let types = editor.at("completion", "main.st", at);
    let types = labels(&types);
    assert!(["Pump", "State", "INT", "TON", "CTU"].iter().all(|it| types.contains(it)), "{types:?}");
    assert!(!types.contains(&"level"));
    for aside in ["(* le| *)", "// n|", "text := 'n|"] {
        assert_eq!(offered(&mut editor, aside), Vec::<String>::new(), "{aside}");
    }
    editor.close();
}

#[test]
fn a_call_shows_its_signature() {
    let mut editor = both();
    let (text, at) = cursor(&MAIN.replace("Scale(level, 2.0)", "Scale(level, |2.0)"));
    editor.write("main.st", &text);
    let shown = editor.at("signatureHelp", "main.st", at);
    assert_eq!(shown["signatures"][0]["label"], json!("Scale(x : REAL, factor : REAL) : REAL"));
    assert_eq!(shown["signatures"][0]["activeParameter"], json!(1));
    let (text, at) = cursor(&MAIN.replace("limit := 3", "limit := |"));
    editor.write("main.st", &text);
    let shown = editor.at("signatureHelp", "main.st", at);
    assert_eq!(shown["signatures"][0]["label"], json!("first(run : BOOL, limit : INT, starts : INT)"));
    assert_eq!(shown["signatures"][0]["activeParameter"], json!(1));
    editor.write("main.st", MAIN);
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 20, "character": 0 } });
    let params = json!({ "textDocument": { "uri": uri("main.st") }, "range": range });
    let hints = editor.ask("textDocument/inlayHint", params);
    let shown: Vec<_> = hints.as_array().expect("a list").iter().map(|it| it["label"].as_str().expect("one")).collect();
    assert_eq!(shown, ["x:", "factor:", "= 0", "= 1", "= 2"]);
    editor.close();
}

#[test]
fn rename_changes_all_files_or_nothing() {
    let mut editor = both();
    let at = of(MAIN, "starts", 0);
    let range = editor.at("prepareRename", "main.st", at);
    assert_eq!(range["start"], json!({ "line": at.0, "character": at.1 }));
    let mut params = place("main.st", at);
    params["newName"] = json!("cycles");
    let changes = editor.ask("textDocument/rename", params.clone())["changes"].clone();
    assert_eq!(edited(PUMP, &changes[uri("pump.st")]), PUMP.replace("starts", "cycles"));
    assert_eq!(edited(MAIN, &changes[uri("main.st")]), MAIN.replace("starts", "cycles"));
    // Another variable has the name; it is not a name; it is a word of the language.
    for (new, why) in [("edge", "cannot be called"), ("2nd", "is not a name"), ("IF", "is not a name")] {
        params["newName"] = json!(new);
        let error = editor.try_ask("textDocument/rename", params.clone()).expect_err(new);
        assert!(error.contains(why), "{error}");
    }
    let error = editor.try_ask("textDocument/prepareRename", place("main.st", of(MAIN, "CTU", 0)));
    assert!(error.expect_err("a library's").contains("is not declared in a source"));
    // A local variable that would hide a global one's use.
    let text = "VAR_GLOBAL far : INT; END_VAR\nPROGRAM P VAR near : INT; END_VAR\nnear := far;\nEND_PROGRAM\n";
    editor.write("main.st", text);
    let mut params = place("main.st", of(text, "near", 0));
    params["newName"] = json!("far");
    let error = editor.try_ask("textDocument/rename", params).expect_err("capture");
    assert!(error.contains("means something else"), "{error}");
    editor.close();
}

#[test]
fn a_method_is_renamed_with_those_that_override_it() {
    let text = "\
INTERFACE I_Step METHOD Step : INT END_METHOD END_INTERFACE
FUNCTION_BLOCK Base IMPLEMENTS I_Step
METHOD Step : INT Step := 1; END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Heir EXTENDS Base
METHOD Step : INT Step := SUPER^.Step() + 1; END_METHOD
END_FUNCTION_BLOCK
PROGRAM Main VAR h : Heir; n : INT; END_VAR n := h.Step(); END_PROGRAM
";
    let mut editor = Editor::open(Dialect::Codesys, &[("main.st", text)]);
    let mut params = place("main.st", of(text, "Step()", 1));
    params["newName"] = json!("Next");
    let changes = editor.ask("textDocument/rename", params)["changes"].clone();
    assert_eq!(edited(text, &changes[uri("main.st")]), text.replace(" Step", " Next").replace(".Step", ".Next"));
    let found = editor.at("implementation", "main.st", of(text, "Step", 1));
    assert_eq!(found.as_array().expect("a list").len(), 2);
    let classes = editor.at("implementation", "main.st", of(text, "I_Step", 0));
    assert_eq!(classes.as_array().expect("a list").len(), 2);
    let item = editor.at("prepareTypeHierarchy", "main.st", of(text, "Base", 0))[0].clone();
    let heirs = editor.ask("typeHierarchy/subtypes", json!({ "item": item }));
    assert_eq!(heirs[0]["name"], json!("Heir"));
    let bases = editor.ask("typeHierarchy/supertypes", json!({ "item": item }));
    assert_eq!(bases[0]["name"], json!("I_Step"));
    editor.close();
}

#[test]
fn calls_are_followed_in_both_directions() {
    let mut editor = both();
    let item = editor.at("prepareCallHierarchy", "main.st", of(MAIN, "first(", 0))[0].clone();
    assert_eq!(item["name"], json!("Pump"));
    let callers = editor.ask("callHierarchy/incomingCalls", json!({ "item": item }));
    assert_eq!(callers[0]["from"]["name"], json!("Main"));
    let main = callers[0]["from"].clone();
    let called = editor.ask("callHierarchy/outgoingCalls", json!({ "item": main }));
    let names: Vec<_> = called.as_array().expect("a list").iter().map(|it| it["to"]["name"].clone()).collect();
    assert_eq!(names, [json!("Pump"), json!("Scale")]);
    editor.close();
}

#[test]
fn calls_of_elements_references_and_bases_are_followed() {
    let text = "FUNCTION_BLOCK Base\nEND_FUNCTION_BLOCK\nFUNCTION_BLOCK Heir EXTENDS Base\nSUPER^();\nEND_FUNCTION_BLOCK\nPROGRAM Main\nVAR all : ARRAY[0..2] OF Heir; base : POINTER TO Base; i : INT; END_VAR\nall[i]();\nbase^();\nEND_PROGRAM\n";
    let mut editor = Editor::open(Dialect::Codesys, &[("main.st", text)]);
    let item = editor.at("prepareCallHierarchy", "main.st", (0, 16))[0].clone();
    let callers = editor.ask("callHierarchy/incomingCalls", json!({ "item": item }));
    let names: Vec<_> = callers.as_array().expect("a list").iter().map(|it| it["from"]["name"].clone()).collect();
    assert_eq!(names, [json!("Heir"), json!("Main")]);
    let called = editor.ask("callHierarchy/outgoingCalls", json!({ "item": callers[1]["from"] }));
    let names: Vec<_> = called.as_array().expect("a list").iter().map(|it| it["to"]["name"].clone()).collect();
    assert_eq!(names, [json!("Heir"), json!("Base")]);
    editor.close();
}

#[test]
fn a_document_has_an_outline_folds_and_colours() {
    let mut editor = both();
    let document = json!({ "textDocument": { "uri": uri("pump.st") } });
    let outline = editor.ask("textDocument/documentSymbol", document.clone());
    assert_eq!(labels_of(&outline, "name"), ["Pump", "Scale"]);
    assert_eq!(labels_of(&outline[0]["children"], "name"), ["run", "limit", "starts", "edge"]);
    let folds = editor.ask("textDocument/foldingRange", document.clone());
    let lines: Vec<_> = folds.as_array().expect("a list").iter().map(|it| it["startLine"].as_u64()).collect();
    assert_eq!(lines, [Some(1), Some(3), Some(11)]);
    let colours = editor.ask("textDocument/semanticTokens/full", document);
    let data = colours["data"].as_array().expect("numbers");
    assert_eq!(data.len() % 5, 0);
    assert!(data.len() > 50);
    let symbols = editor.ask("workspace/symbol", json!({ "query": "sca" }));
    assert_eq!(labels_of(&symbols, "name"), ["Scale"]);
    let mut params = place("pump.st", (0, 0));
    params["positions"] = json!([{ "line": 8, "character": 4 }]);
    let selection = editor.ask("textDocument/selectionRange", params);
    let widths = std::iter::successors(Some(&selection[0]), |it| it.get("parent"));
    assert!(widths.count() >= 4, "{selection}");
    editor.close();
}

fn labels_of<'a>(list: &'a Json, key: &str) -> Vec<&'a str> {
    list.as_array().expect("a list").iter().map(|it| it[key].as_str().expect("a text")).collect()
}

#[test]
fn formatting_is_that_of_the_command() {
    let text = "program main\nvar x:int; end_var\nif x>1 then\nx:=x+1;\nend_if\nend_program\n";
    let mut editor = Editor::open(Dialect::Iec, &[("main.st", text)]);
    let document =
        json!({ "textDocument": { "uri": uri("main.st") }, "options": { "tabSize": 4, "insertSpaces": true } });
    let edits = editor.ask("textDocument/formatting", document.clone());
    let after = edited(text, &edits);
    assert!(after.contains("IF x > 1 THEN\n    x := x + 1;\nEND_IF"), "{after}");
    editor.write("main.st", &after);
    assert_eq!(editor.ask("textDocument/formatting", document), json!([]));
    editor.close();
}

#[test]
fn mistakes_of_the_editor_end_nothing() {
    let mut editor = both();
    assert!(editor.try_ask("textDocument/hover", json!({})).is_err());
    assert!(editor.try_ask("textDocument/nonsense", json!({})).is_err());
    assert!(
        editor
            .try_ask(
                "textDocument/hover",
                json!({ "textDocument": { "uri": "untitled:1" }, "position": { "line": 0, "character": 0 } })
            )
            .is_err()
    );
    assert_eq!(editor.at("hover", "main.st", (900, 900)), Json::Null);
    // The settings of a project may be wrong.
    editor.open_one("broken.st", "PROGRAM P END_PROGRAM");
    let found = editor.problems("broken.st");
    assert_eq!(found[0]["message"], json!("staunch.toml: `dialect` is not one"));
    // A request that is not wanted any more.
    editor.tell("$/cancelRequest", json!({ "id": 4711 }));
    editor.tell("textDocument/didChange", json!({ "nonsense": 1 }));
    assert_ne!(editor.at("hover", "main.st", of(MAIN, "level", 0)), Json::Null);
    editor.tell("textDocument/didClose", json!({ "textDocument": { "uri": uri("main.st") } }));
    assert!(editor.problems("main.st").is_empty());
    editor.close();
}

/// Key by key: whatever is half written, every request has an answer, and the last one is of the last text.
#[test]
fn typing_key_by_key_never_stops_it() {
    let mut editor = Editor::open(Dialect::Codesys, &[("main.st", "")]);
    let text = "FUNCTION_BLOCK Motor EXTENDS Base\nVAR_INPUT on : BOOL; END_VAR\nMETHOD Go : INT\nGo := SEL(on, 'ü', 2);\nEND_METHOD\n\
                END_FUNCTION_BLOCK\nPROGRAM P VAR m : Motor; a : ARRAY[0..3] OF INT; END_VAR\nm(on := TRUE); a[m.Go()] := 3;\n\
                FOR i := 0 TO 3 DO a[i] := T#1s; END_FOR\nEND_PROGRAM";
    let (mut line, mut column) = (0, 0);
    for character in text.chars() {
        editor.edit("main.st", (line, column), 0, &character.to_string());
        match character {
            '\n' => (line, column) = (line + 1, 0),
            _ => column += character.len_utf16() as u32,
        }
        if column % 3 == 0 {
            for method in ["hover", "completion", "signatureHelp", "definition"] {
                editor.at(method, "main.st", (line, column));
            }
        }
        if column == 1 {
            let document = json!({ "textDocument": { "uri": uri("main.st") } });
            for method in ["documentSymbol", "semanticTokens/full", "foldingRange"] {
                editor.ask(&format!("textDocument/{method}"), document.clone());
            }
        }
    }
    let found = editor.ask("textDocument/diagnostic", json!({ "textDocument": { "uri": uri("main.st") } }));
    let mut fresh = Editor::open(Dialect::Codesys, &[("main.st", text)]);
    let same = fresh.ask("textDocument/diagnostic", json!({ "textDocument": { "uri": uri("main.st") } }));
    assert_eq!(found, same);
    assert!(!found["items"].as_array().expect("a list").is_empty());
    fresh.close();
    editor.close();
}

#[test]
fn a_dialect_that_accepts_the_sources_is_offered() {
    const TEXT: &str = "PROGRAM Main VAR c : CTU; w : WORD; END_VAR c(RESET := FALSE); w := c.CV; END_PROGRAM\n";
    let choice = Choice {
        accepting: |sources, options, _| {
            let accepts =
                |dialect: &Dialect| check(sources, &Options { dialect: *dialect, ..options.clone() }).is_empty();
            [Dialect::Siemens, Dialect::Codesys].into_iter().filter(accepts).collect()
        },
        settings: "/plc/staunch.toml".into(),
        has_settings: false,
    };
    let mut editor = Editor::open_with(Dialect::Iec, &[("main.st", TEXT)], Some(choice));
    let hints = |all: &[Json]| -> Vec<_> {
        let all = all.iter().filter(|it| it["severity"] == json!(3));
        all.map(|it| it["message"].as_str().expect("a text").to_owned()).collect()
    };
    assert!(hints(&editor.problems("main.st")).is_empty(), "the errors are shown first");
    let found = editor.problems("main.st");
    assert_eq!(hints(&found), ["accepted with the dialect `codesys`"]);
    let params = json!({
        "textDocument": { "uri": uri("main.st") }, "range": found[0]["range"], "context": { "diagnostics": [] },
    });
    let actions = editor.ask("textDocument/codeAction", params);
    let all = actions.as_array().expect("a list");
    let action = all.iter().find(|it| it["edit"]["documentChanges"].is_array()).expect("one for the dialect");
    let changes = &action["edit"]["documentChanges"];
    assert_eq!((&changes[0]["kind"], &changes[0]["uri"]), (&json!("create"), &json!(uri("staunch.toml"))));
    assert_eq!(changes[1]["edits"][0]["newText"], json!("dialect = \"codesys\"\n"));
    // It is not offered where there is no error any more.
    editor.write("main.st", "PROGRAM Main END_PROGRAM\n");
    assert!(hints(&editor.problems("main.st")).is_empty());
    editor.close();
}

/// All code actions of a file.
fn all_actions(editor: &mut Editor, name: &str, text: &str) -> Vec<Json> {
    let end = json!({ "line": text.lines().count(), "character": 0 });
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": end });
    let params = json!({ "textDocument": { "uri": uri(name) }, "range": range, "context": { "diagnostics": [] } });
    editor.ask("textDocument/codeAction", params).as_array().expect("a list").clone()
}

#[test]
fn what_is_missing_is_declared_by_an_action() {
    let text = "\
INTERFACE I_Station
METHOD Go : BOOL
VAR_INPUT speed : INT; END_VAR
END_METHOD
PROPERTY Speed : INT
GET
END_GET
END_PROPERTY
END_INTERFACE
FUNCTION_BLOCK Belt IMPLEMENTS I_Station
VAR n : INT; END_VAR
n := n + 1;
END_FUNCTION_BLOCK
PROGRAM Main
VAR
    b : Belt;
    r : REAL;
END_VAR
b();
fast := b.Go(3) AND r > 2.0;
kept := r;
wait := T#3s;
IF ready THEN count := 70000; END_IF
END_PROGRAM
";
    let mut text = text.to_owned();
    for title in [
        "Implement 2 METHODs and PROPERTYs",
        "Declare `fast : BOOL`",
        "Declare `kept : REAL`",
        "Declare `wait : TIME`",
        "Declare `ready : BOOL`",
        "Declare `count : DINT`",
    ] {
        let mut editor = Editor::open(Dialect::Codesys, &[("main.st", &text)]);
        let actions = all_actions(&mut editor, "main.st", &text);
        let action = actions.iter().find(|it| it["title"] == title);
        let action = action.unwrap_or_else(|| panic!("{title} is not among {actions:#?}"));
        text = edited(&text, &action["edit"]["changes"][uri("main.st")]);
    }
    let mut sources = staunch_frontend::Sources::default();
    sources.add(staunch_frontend::Source::new("main.st", text.clone()));
    let found = check(&sources, &Options { dialect: Dialect::Codesys, ..Options::default() });
    let errors: Vec<_> = found.iter().filter(|it| it.severity == staunch_frontend::Severity::Error).collect();
    assert!(errors.is_empty(), "{text}\n{errors:#?}");
}

#[test]
fn a_call_that_is_typed_has_its_signature() {
    for (typed, parameters) in [("first(", "run"), ("level := Scale(level, ", "factor"), ("level := LIMIT(1.0, ", "MN")]
    {
        let text = MAIN.replace("first(run := level > 1.0, limit := 3);", typed);
        let mut editor = Editor::open(Dialect::Iec, &[("pump.st", PUMP), ("main.st", &text)]);
        let (line, column) = of(&text, typed, 0);
        let shown = editor.at("signatureHelp", "main.st", (line, column + typed.len() as u32));
        let label = shown["signatures"][0]["label"].as_str().unwrap_or_default().to_owned();
        assert!(label.contains(parameters), "{typed}: {shown}");
    }
}

#[test]
fn addresses_and_values_of_enumerators_are_shown() {
    let text = "TYPE Mode : (Idle, Run := 5, Hold); END_TYPE\nPROGRAM Main\nVAR x AT %IW4 : INT; m : Mode; END_VAR\nx;\nEND_PROGRAM\n";
    let mut editor = Editor::open(Dialect::Iec, &[("main.st", text)]);
    let shown = editor.at("hover", "main.st", of(text, "x AT", 0));
    assert_eq!(shown["contents"]["value"], json!("```iecst\nVAR x AT %IW4 : INT\n```"));
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 9, "character": 0 } });
    let hints =
        editor.ask("textDocument/inlayHint", json!({ "textDocument": { "uri": uri("main.st") }, "range": range }));
    let labels: Vec<_> =
        hints.as_array().expect("a list").iter().map(|it| it["label"].as_str().unwrap_or_default()).collect();
    assert_eq!(labels, ["= 0", "= 6"]);
}

#[test]
fn a_comment_that_ends_with_a_point_is_no_member_access() {
    let text = MAIN.replace("level := Scale", "// It is scaled.\nlev := Scale");
    let mut editor = Editor::open(Dialect::Iec, &[("pump.st", PUMP), ("main.st", &text)]);
    let (line, column) = of(&text, "lev :=", 0);
    let shown = editor.at("completion", "main.st", (line, column + 3));
    assert!(shown.to_string().contains("\"level\""), "{shown}");
}

#[test]
fn a_file_that_cannot_be_read_leaves_the_others_answered() {
    let broken =
        "<?xml version=\"1.0\"?><TcPlcObject><POU Name=\"FB\"><Declaration><![CDATA[FUNCTION_BLOCK FB]]></Declaration>";
    let mut editor = Editor::open(Dialect::Codesys, &[("pump.st", PUMP), ("main.st", MAIN), ("FB.TcPOU", broken)]);
    let shown = editor.at("hover", "main.st", of(MAIN, "first(run", 0));
    assert_eq!(shown["contents"]["value"], json!("```iecst\nVAR first : Pump\n```"));
    let said = editor.ask("textDocument/diagnostic", json!({ "textDocument": { "uri": uri("main.st") } }));
    assert!(said.to_string().contains("FB.TcPOU"), "{said}");
}

#[test]
fn functions_of_one_name_are_renamed_together() {
    let text = "\
FUNCTION K : DINT
VAR_INPUT x : INT; END_VAR
K := 1;
END_FUNCTION
FUNCTION K : DINT
VAR_INPUT x : LINT; END_VAR
K := 2;
END_FUNCTION
PROGRAM Main
VAR u : UDINT; i : INT; a, b : DINT; END_VAR
a := K(i);
b := K(u);
END_PROGRAM
";
    let mut editor = Editor::open(Dialect::Iec, &[("main.st", text)]);
    let mut params = place("main.st", of(text, "K :", 1));
    params["newName"] = json!("Scaled");
    let edit = editor.ask("textDocument/rename", params);
    let renamed = edited(text, &edit["changes"][uri("main.st")]);
    assert!(renamed.contains("a := Scaled(i);\nb := Scaled(u);") && !renamed.contains("K"), "{renamed}");
}
