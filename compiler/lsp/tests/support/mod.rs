//! An editor in a test: it opens documents, types, and asks.
#![allow(dead_code, reason = "each test takes a part of it")]

#[allow(dead_code, reason = "each test takes a part of it")]
pub mod programs;

use lsp_server::{Connection, Message, Notification, Request, RequestId};
use serde_json::{Value as Json, json};
use staunch_frontend::{Dialect, Options, Source, Sources, format::Style};
use staunch_lsp::{Choice, Host, TestResult, Unit, Work, serve};
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::Duration;

/// A folder of texts: all of its files are one program.
pub struct Folder {
    pub files: Vec<(&'static str, String)>,
    pub dialect: Dialect,
    /// Where the dialect may be another one.
    pub choice: Option<Choice>,
}

pub const ROOT: &str = "/plc";

impl Host for Folder {
    fn unit(&self, path: &Path) -> Result<Unit, String> {
        if path.ends_with("broken.st") {
            return Err("staunch.toml: `dialect` is not one".to_owned());
        }
        let (mut sources, mut paths) = (Sources::default(), Vec::new());
        for (name, text) in &self.files {
            sources.add(Source::decode(*name, text.as_bytes()));
            paths.push(PathBuf::from(format!("{ROOT}/{name}")));
        }
        if !paths.contains(&path.to_owned()) {
            sources.add(Source::decode(path.display().to_string(), &[]));
            paths.push(path.to_owned());
        }
        let options = Options { dialect: self.dialect, ..Options::default() };
        Ok(Unit {
            sources,
            paths,
            options,
            levels: Default::default(),
            layout: Style::default(),
            choice: self.choice.clone(),
            problem: None,
        })
    }

    /// Each test passes at once, but for those that have no work, and no result.
    fn test(&self, _: &Path, title: &str) -> Result<Work<Vec<TestResult>>, String> {
        let result = TestResult { title: title.to_owned(), outcome: "passed".to_owned() };
        match title {
            "refused" => Err("there is no command".to_owned()),
            "ends early" => Ok(Box::new(|| Ok(Vec::new()))),
            _ => Ok(Box::new(|| Ok(vec![result]))),
        }
    }

    fn compare(&self, _: &Path, from: Dialect, to: Dialect) -> Result<Work<String>, String> {
        Ok(Box::new(move || Err(format!("{} and {} are two", from.name(), to.name()))))
    }
}

pub struct Editor {
    connection: Connection,
    server: Option<JoinHandle<Result<(), String>>>,
    next: i32,
    version: i32,
    /// What was said of each document last.
    pub said: Vec<(String, Vec<Json>)>,
    /// What the server has asked for.
    pub wanted: Vec<String>,
}

impl Editor {
    /// With `|` in a text as the place that [`at`] finds.
    pub fn open(dialect: Dialect, files: &[(&'static str, &str)]) -> Self {
        Self::open_with(dialect, files, None)
    }

    pub fn open_with(dialect: Dialect, files: &[(&'static str, &str)], choice: Option<Choice>) -> Self {
        let (server, connection) = Connection::memory();
        let files: Vec<_> = files.iter().map(|(name, text)| (*name, (*text).to_owned())).collect();
        let folder = Folder { files: files.clone(), dialect, choice };
        let server = std::thread::Builder::new()
            .stack_size(64 << 20)
            .spawn(move || serve(&server, &folder))
            .expect("a thread for the server");
        let mut editor =
            Self { connection, server: Some(server), next: 0, version: 1, said: Vec::new(), wanted: Vec::new() };
        let capabilities =
            editor.ask("initialize", json!({ "processId": null, "rootUri": null, "capabilities": capabilities() }));
        assert_eq!(capabilities["capabilities"]["hoverProvider"], json!(true));
        editor.tell("initialized", json!({}));
        for (name, text) in files {
            editor.open_one(name, &text);
        }
        editor
    }

    pub fn open_one(&mut self, name: &str, text: &str) {
        let document = json!({ "uri": uri(name), "languageId": "iecst", "version": self.version, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    pub fn tell(&mut self, method: &str, params: Json) {
        let message = Notification::new(method.to_owned(), params);
        self.connection.sender.send(Message::Notification(message)).expect("the server listens");
    }

    /// The result of a request.
    pub fn ask(&mut self, method: &str, params: Json) -> Json {
        self.try_ask(method, params).unwrap_or_else(|it| panic!("{method}: {it}"))
    }

    pub fn try_ask(&mut self, method: &str, params: Json) -> Result<Json, String> {
        self.next += 1;
        let id = RequestId::from(self.next);
        let request = Request::new(id.clone(), method.to_owned(), params);
        self.connection.sender.send(Message::Request(request)).expect("the server listens");
        loop {
            match self.receive() {
                Message::Response(it) if it.id == id => {
                    return it.response_result.map_err(|it| it.message);
                }
                Message::Notification(it) => self.noted(&it),
                Message::Request(it) => self.wanted.push(it.method),
                other => panic!("{other:?}"),
            }
        }
    }

    fn receive(&self) -> Message {
        self.connection.receiver.recv_timeout(Duration::from_secs(120)).expect("an answer")
    }

    fn noted(&mut self, it: &Notification) {
        assert_eq!(it.method, "textDocument/publishDiagnostics");
        let uri = it.params["uri"].as_str().unwrap_or_default().to_owned();
        let all = it.params["diagnostics"].as_array().cloned().unwrap_or_default();
        self.said.retain(|it| it.0 != uri);
        self.said.push((uri, all));
    }

    /// What is said of a document when nothing is typed any more.
    pub fn problems(&mut self, name: &str) -> Vec<Json> {
        loop {
            match self.receive() {
                Message::Notification(it) => {
                    self.noted(&it);
                    if it.params["uri"] == json!(uri(name)) {
                        return self.said.last().map(|it| it.1.clone()).unwrap_or_default();
                    }
                }
                other => panic!("{other:?}"),
            }
        }
    }

    /// The result of a request about a place.
    pub fn at(&mut self, method: &str, name: &str, position: (u32, u32)) -> Json {
        self.ask(&format!("textDocument/{method}"), place(name, position))
    }

    /// Replaces the whole of a document.
    pub fn write(&mut self, name: &str, text: &str) {
        self.version += 1;
        let document = json!({ "uri": uri(name), "version": self.version });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": [{ "text": text }] }));
    }

    /// Types at a place, in place of `length` characters of its line.
    pub fn edit(&mut self, name: &str, (line, character): (u32, u32), length: u32, text: &str) {
        self.version += 1;
        let document = json!({ "uri": uri(name), "version": self.version });
        let end = json!({ "line": line, "character": character + length });
        let range = json!({ "start": { "line": line, "character": character }, "end": end });
        let change = json!({ "range": range, "text": text });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": [change] }));
    }

    pub fn close(mut self) {
        assert_eq!(self.ask("shutdown", Json::Null), Json::Null);
        self.tell("exit", Json::Null);
        let server = self.server.take().expect("it runs");
        server.join().expect("no panic").expect("it ended when it was asked to");
    }
}

/// Of an editor that makes files.
fn capabilities() -> Json {
    let edits = json!({ "documentChanges": true, "resourceOperations": ["create"] });
    json!({ "workspace": { "workspaceEdit": edits, "codeLens": { "refreshSupport": true } } })
}

pub fn uri(name: &str) -> String {
    format!("file://{ROOT}/{name}")
}

pub fn place(name: &str, (line, character): (u32, u32)) -> Json {
    json!({ "textDocument": { "uri": uri(name) }, "position": { "line": line, "character": character } })
}

/// The place of the `|` in a text, and the text without it.
pub fn cursor(text: &str) -> (String, (u32, u32)) {
    let at = text.find('|').expect("a cursor");
    let (before, after) = (&text[..at], &text[at + 1..]);
    let line = before.matches('\n').count();
    let column = before.rsplit('\n').next().unwrap_or_default().encode_utf16().count();
    (format!("{before}{after}"), (line as u32, column as u32))
}

/// A document after edits of the protocol.
pub fn edited(text: &str, edits: &Json) -> String {
    let document = Source::new("", text.to_owned());
    let offset = |it: &Json| {
        let line = it["line"].as_u64().expect("a line") as u32 + 1;
        let range = document.line_range(line);
        let mut words = it["character"].as_u64().expect("a character") as usize;
        let rest = &text[range.start..];
        let mut at = range.start;
        for character in rest.chars() {
            if words == 0 {
                break;
            }
            words -= character.len_utf16();
            at += character.len_utf8();
        }
        at
    };
    let mut all: Vec<_> = edits
        .as_array()
        .expect("edits")
        .iter()
        .map(|it| (offset(&it["range"]["start"]), offset(&it["range"]["end"]), it["newText"].as_str().expect("a text")))
        .collect();
    all.sort_unstable();
    let mut text = text.to_owned();
    for (start, end, new) in all.into_iter().rev() {
        text.replace_range(start..end, new);
    }
    text
}
