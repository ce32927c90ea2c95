//! What `staunch lsp` takes while one types: a document is opened, and three letters are typed, each with the completion and the
//! hover that an editor asks for.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{ChildStdin, ChildStdout, Command, Stdio};

const TYPED: &str = "tot";

/// Runs the command, which is `lsp`, on the last line but one of a document. Gives what it wrote on standard error.
pub fn session(command: &mut Command, document: &Path, text: &str) -> String {
    let pipes = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = pipes.spawn().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let mut editor = Editor {
        to: child.stdin.take().unwrap(),
        from: BufReader::new(child.stdout.take().unwrap()),
        uri: format!("file://{}", document.display()),
        asked: 0,
    };
    editor.ask("initialize", json!({ "capabilities": {} }));
    editor.tell("initialized", json!({}));
    let opened = json!({ "uri": editor.uri, "languageId": "iecst", "version": 1, "text": text });
    editor.tell("textDocument/didOpen", json!({ "textDocument": opened }));
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
    editor.ask("shutdown", Value::Null);
    editor.tell("exit", Value::Null);
    drop(editor);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stderr).unwrap()
}

fn position((line, character): (usize, usize)) -> Value {
    json!({ "line": line, "character": character })
}

struct Editor {
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    uri: String,
    asked: u32,
}

impl Editor {
    fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.asked += 1;
        self.send(&json!({ "jsonrpc": "2.0", "id": self.asked, "method": method, "params": params }));
        loop {
            let answer = self.read();
            if answer["id"] == self.asked {
                return answer["result"].clone();
            }
        }
    }

    fn ask_at(&mut self, method: &str, at: (usize, usize)) -> Value {
        self.ask(method, json!({ "textDocument": { "uri": self.uri }, "position": position(at) }))
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        write!(self.to, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.to.flush().unwrap();
    }

    fn read(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.from.read_line(&mut line).unwrap() > 0, "the server ended");
            match line.trim().split_once(": ") {
                Some(("Content-Length", it)) => length = it.parse().unwrap(),
                Some(_) => {}
                None => break,
            }
        }
        let mut text = vec![0; length];
        self.from.read_exact(&mut text).unwrap();
        serde_json::from_slice(&text).unwrap()
    }
}
