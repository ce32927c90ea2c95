//! What an editor's lenses run: tests, and the comparison with IEC, by the command itself.

use crate::Folder;
use crate::editor::Editor;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

const MAIN: &str = "\
PROGRAM Main
VAR up AT %IX0.0 : BOOL; full AT %QX0.0 : BOOL; c : CTU; END_VAR
c(CU := up, PV := 2);
full := c.CV > 2;
END_PROGRAM
FUNCTION Twice : INT
VAR_INPUT a : INT; END_VAR
Twice := a * 2;
END_FUNCTION
TEST 'doubles'
ASSERT_EQ(Twice(2), 4);
END_TEST
TEST 'is wrong'
ASSERT_EQ(Twice(2), 5);
END_TEST
";

/// The titles of the document's lenses, with what they run.
fn lenses(editor: &mut Editor) -> Vec<(String, Value)> {
    let found = editor.ask("textDocument/codeLens", json!({ "textDocument": { "uri": editor.uri } }));
    let command = |it: &Value| (it["command"]["title"].as_str().unwrap().to_owned(), it["command"].clone());
    found.as_array().unwrap().iter().map(command).collect()
}

/// The title of a lens when what it runs has ended.
fn ran(editor: &mut Editor, at: usize) -> String {
    let command = lenses(editor)[at].1.clone();
    editor.ask("workspace/executeCommand", json!({ "command": command["command"], "arguments": command["arguments"] }));
    let start = Instant::now();
    loop {
        let title = lenses(editor).swap_remove(at).0;
        if title.ends_with(')') && !title.ends_with("(running)") {
            return title;
        }
        assert!(start.elapsed() < Duration::from_secs(120), "{title}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn lenses_run_tests_and_the_comparison_of_files_on_disk() {
    let folder = Folder::with("lenses", &[("main.st", MAIN)]);
    let document = folder.0.join("main.st").canonicalize().unwrap();
    let mut editor = Editor::open(&mut folder.command("lsp --dialect openplc"), &document, MAIN);
    let titles: Vec<_> = lenses(&mut editor).into_iter().map(|it| it.0).collect();
    assert_eq!(titles, ["Compare with iec", "Run test", "Run test"]);
    assert_eq!(ran(&mut editor, 1), "Run test (passed)");
    assert_eq!(ran(&mut editor, 2), "Run test (failed: expected to be 5, found 4)");
    let differs = ran(&mut editor, 0);
    assert!(differs.starts_with("Compare with iec (differs after 5 scans: OPENPLC, "), "{differs}");
    editor.close();
}

#[test]
fn a_program_that_is_rejected_says_why_it_did_not_run() {
    let text = "TEST 'a'\nASSERT_EQ(x, 1);\nEND_TEST\n";
    let folder = Folder::with("lenses_rejected", &[("main.st", text)]);
    let document = folder.0.join("main.st").canonicalize().unwrap();
    let mut editor = Editor::open(&mut folder.command("lsp"), &document, text);
    assert_eq!(ran(&mut editor, 0), "Run test (it did not run: `x` is not declared)");
    editor.close();
}
