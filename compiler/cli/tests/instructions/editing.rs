//! What `staunch lsp` takes while one types: a document is opened, and three letters are typed, each with the completion and the
//! hover that an editor asks for.

use crate::editor::{Editor, position};
use serde_json::json;
use std::path::Path;
use std::process::Command;

const TYPED: &str = "tot";

/// Runs the command, which is `lsp`, on the last line but one of a document. Gives what it wrote on standard error.
pub fn session(command: &mut Command, document: &Path, text: &str) -> String {
    let mut editor = Editor::open(command, document, text);
    let line = text.lines().count() - 1;
    for (column, letter) in TYPED.chars().enumerate() {
        let (place, after) = ((line, column), (line, column + 1));
        let written = if column == 0 { "t\n".to_owned() } else { letter.to_string() };
        let change = json!({ "range": { "start": position(place), "end": position(place) }, "text": written });
        let changed = json!({ "uri": editor.uri, "version": column + 2 });
        editor.tell("textDocument/didChange", json!({ "textDocument": changed, "contentChanges": [change] }));
        let offered = editor.ask_at("textDocument/completion", after);
        let items = offered.as_array().or(offered["items"].as_array()).unwrap();
        assert!(items.iter().any(|it| it["label"] == "total"), "{offered}");
        editor.ask_at("textDocument/hover", (line - 1, 1));
    }
    editor.close()
}
