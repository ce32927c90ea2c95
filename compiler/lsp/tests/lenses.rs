//! What can be run from above a declaration, and when its result is out of date.

mod support;

use serde_json::{Value as Json, json};
use staunch_frontend::Dialect;
use support::{Editor, uri};

const TEXT: &str = "\
PROGRAM Main
VAR n : INT; END_VAR
n := 1;
END_PROGRAM
TEST 'is one'
ASSERT_EQ(1, 1);
END_TEST
TEST \"ends early\"
ASSERT_EQ(1, 1);
END_TEST
";

fn titles(editor: &mut Editor) -> Vec<String> {
    let found = editor.ask("textDocument/codeLens", json!({ "textDocument": { "uri": uri("main.st") } }));
    let title = |it: &Json| it["command"]["title"].as_str().expect("a title").to_owned();
    found.as_array().expect("lenses").iter().map(title).collect()
}

/// The titles when nothing runs any more.
fn ended(editor: &mut Editor) -> Vec<String> {
    loop {
        let titles = titles(editor);
        if !titles.iter().any(|it| it.ends_with("(running)")) {
            return titles;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
}

fn execute(editor: &mut Editor, command: &str, argument: &str) -> Result<Json, String> {
    let params = json!({ "command": command, "arguments": [uri("main.st"), argument] });
    editor.try_ask("workspace/executeCommand", params)
}

#[test]
fn results_are_shown_until_a_text_changes() {
    let mut editor = Editor::open(Dialect::Codesys, &[("main.st", TEXT)]);
    assert_eq!(titles(&mut editor), ["Compare with iec", "Run test", "Run test"]);
    execute(&mut editor, "staunch.test", "is one").expect("it begins");
    execute(&mut editor, "staunch.test", "ends early").expect("it begins");
    execute(&mut editor, "staunch.compare", "iec").expect("it begins");
    assert_eq!(
        ended(&mut editor),
        ["Compare with iec (codesys and iec are two)", "Run test (passed)", "Run test (it did not run)"]
    );
    // At each beginning and each end.
    assert_eq!(editor.wanted, ["workspace/codeLens/refresh"; 6]);
    editor.edit("main.st", (2, 5), 1, "2");
    assert_eq!(titles(&mut editor), ["Compare with iec", "Run test", "Run test"]);
    // What would run is not what is shown.
    let refused = execute(&mut editor, "staunch.test", "is one");
    assert_eq!(refused, Err("save main.st first: files run as they are on disk".to_owned()));
    editor.tell("textDocument/didSave", json!({ "textDocument": { "uri": uri("main.st") } }));
    execute(&mut editor, "staunch.test", "is one").expect("it begins");
    assert_eq!(ended(&mut editor)[1], "Run test (passed)");
    editor.close();
}

#[test]
fn a_program_of_iec_is_not_compared_with_itself() {
    let mut editor = Editor::open(Dialect::Iec, &[("main.st", TEXT)]);
    assert_eq!(titles(&mut editor), ["Run test", "Run test"]);
    assert_eq!(execute(&mut editor, "staunch.test", "refused"), Err("there is no command".to_owned()));
    assert_eq!(execute(&mut editor, "staunch.build", "x"), Err("there is no command `staunch.build`".to_owned()));
    assert_eq!(execute(&mut editor, "staunch.compare", "iecc"), Err("there is no dialect `iecc`".to_owned()));
    editor.close();
}
