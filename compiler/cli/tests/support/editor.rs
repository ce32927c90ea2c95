//! An editor that speaks to `staunch lsp` by its pipes.
#![allow(dead_code, reason = "each test takes a part of it")]

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

pub fn position((line, character): (usize, usize)) -> Value {
    json!({ "line": line, "character": character })
}

pub struct Editor {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    pub uri: String,
    asked: u32,
}

impl Editor {
    /// Starts the command, which is `lsp`, and opens a document.
    pub fn open(command: &mut Command, document: &Path, text: &str) -> Self {
        let pipes = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = pipes.spawn().unwrap_or_else(|error| panic!("{command:?}: {error}"));
        let (to, from) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
        let mut editor = Self { child, to, from, uri: format!("file://{}", document.display()), asked: 0 };
        editor.ask("initialize", json!({ "capabilities": {} }));
        editor.tell("initialized", json!({}));
        let opened = json!({ "uri": editor.uri, "languageId": "iecst", "version": 1, "text": text });
        editor.tell("textDocument/didOpen", json!({ "textDocument": opened }));
        editor
    }

    /// What the server wrote on standard error.
    pub fn close(mut self) -> String {
        self.ask("shutdown", Value::Null);
        self.tell("exit", Value::Null);
        drop((self.to, self.from));
        let output = self.child.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    }

    pub fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        self.asked += 1;
        self.send(&json!({ "jsonrpc": "2.0", "id": self.asked, "method": method, "params": params }));
        loop {
            let answer = self.read();
            if answer["id"] == self.asked {
                return answer["result"].clone();
            }
        }
    }

    pub fn ask_at(&mut self, method: &str, at: (usize, usize)) -> Value {
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
