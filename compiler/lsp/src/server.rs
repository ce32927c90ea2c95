//! The messages of an editor. Changes of documents are read before requests are answered, so that no answer is about an older text.

mod capabilities;
mod execute;
mod requests;

use crate::answers::{dialects, problems};
use crate::host::Host;
use crate::project::{Analysis, CheckId, Documents, Project};
use crate::results::Task;
use crate::{place, uri};
use crossbeam_channel::{Receiver, Sender, select};
use gen_lsp_types::{
    CancelParams, DidChangeTextDocumentParams, DidChangeWatchedFilesParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, DidSaveTextDocumentParams, InitializeParams, LspNotificationMethod, LspRequestMethod,
    PublishDiagnosticsParams, TextDocumentContentChangeEvent, Uri,
};
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use serde_json::Value as Json;
use staunch_frontend::{Dialect, Source};
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

/// How long nothing is typed before diagnostics are sent.
const PAUSE: Duration = Duration::from_millis(20);
/// How long the server waits where it has nothing to do.
const FOREVER: Duration = Duration::from_secs(1 << 20);
/// Of a thread that checks: deep enough for expressions and statements at the parser's nesting limit.
const STACK: usize = 256 << 20;

/// Why a request has no answer.
#[derive(Debug)]
pub(crate) struct Refused {
    code: ErrorCode,
    why: String,
}

impl Refused {
    pub fn new(code: ErrorCode, why: impl Into<String>) -> Self {
        Self { code, why: why.into() }
    }
}

impl From<String> for Refused {
    fn from(why: String) -> Self {
        Self::new(ErrorCode::RequestFailed, why)
    }
}

/// Answers an editor until it ends the connection.
///
/// # Errors
/// When the editor does not keep to the protocol, or is gone.
pub fn serve(connection: &Connection, host: &dyn Host) -> Result<(), String> {
    let (id, params) = connection.initialize_start().map_err(|it| it.to_string())?;
    let can_create = can_create_files(&params);
    let refreshes_lenses = params["capabilities"]["workspace"]["codeLens"]["refreshSupport"] == true;
    let _: InitializeParams = serde_json::from_value(params).map_err(|it| format!("initialize: {it}"))?;
    let result = capabilities::initialized();
    connection.initialize_finish(id, result).map_err(|it| it.to_string())?;
    let mut server = Server {
        connection,
        host,
        projects: Vec::new(),
        documents: Documents::default(),
        open: Vec::new(),
        checks: 0,
        can_create,
        refreshes_lenses,
        requests: 0,
        checked: crossbeam_channel::unbounded(),
    };
    server.run()
}

/// Whether an editor makes files, as it says at the start.
fn can_create_files(params: &Json) -> bool {
    let edits = &params["capabilities"]["workspace"]["workspaceEdit"];
    edits["resourceOperations"].as_array().is_some_and(|it| it.iter().any(|it| it == "create"))
}

/// A document that is open.
#[derive(Debug)]
struct Open {
    uri: Uri,
    path: PathBuf,
    version: i32,
    /// What was said of it is out of date.
    is_due: bool,
    /// Since it was opened or saved.
    is_changed: bool,
}

pub(crate) struct Server<'a> {
    connection: &'a Connection,
    host: &'a dyn Host,
    projects: Vec<Project>,
    documents: Documents,
    open: Vec<Open>,
    /// The editor makes files where an edit asks for that.
    can_create: bool,
    /// The editor asks for lenses again where it is asked to.
    refreshes_lenses: bool,
    /// How many requests the editor got.
    requests: i32,
    /// How many checks have begun.
    checks: u64,
    /// What they have found out.
    checked: (Sender<Found>, Receiver<Found>),
}

/// What a thread has found out.
enum Found {
    /// A check has ended.
    Whole(CheckId, Arc<Analysis>),
    /// These dialects accept the project of a file.
    Dialects(PathBuf, Vec<Dialect>),
    /// What a lens began in the project of a file has ended.
    Ran { path: PathBuf, generation: u64, results: Vec<(Task, String)> },
}

/// What happens next.
enum Event {
    Message(Message),
    Found(Found),
    /// Nothing is typed: there is time for what waits.
    Pause,
    /// The editor is gone.
    End,
}

impl Server<'_> {
    fn run(&mut self) -> Result<(), String> {
        let mut waiting: VecDeque<Request> = VecDeque::new();
        loop {
            match self.next(&waiting) {
                Event::Message(Message::Request(request)) => {
                    if self.connection.handle_shutdown(&request).map_err(|it| it.to_string())? {
                        return Ok(());
                    }
                    waiting.push_back(request);
                }
                Event::Message(Message::Notification(it)) => self.notified(it, &mut waiting)?,
                // It asks nothing of the editor that it needs.
                Event::Message(Message::Response(_)) => {}
                Event::Found(it) => self.found(it)?,
                Event::Pause => match waiting.iter().position(|it| self.project_asked(it).is_none()) {
                    Some(at) => {
                        if let Some(request) = waiting.remove(at) {
                            let response = self.answered(request);
                            self.send(Message::Response(response))?;
                        }
                    }
                    None => {
                        let asked: Vec<_> = waiting.iter().filter_map(|it| self.project_asked(it)).collect();
                        asked.into_iter().for_each(|it| self.check(it));
                        self.publish()?;
                    }
                },
                Event::End => return Ok(()),
            }
        }
    }

    fn next(&self, waiting: &VecDeque<Request>) -> Event {
        // Changes are read before a request is answered, so that no answer is about an older text.
        if let Ok(message) = self.connection.receiver.try_recv() {
            return Event::Message(message);
        }
        let runs = |project: Option<usize>| project.is_some_and(|it| self.projects[it].check().is_some());
        let project = |path: &Path| self.projects.iter().position(|it| it.has(path));
        let pause = if waiting.iter().any(|it| !runs(self.project_asked(it))) {
            Duration::ZERO
        } else if self.open.iter().any(|it| it.is_due && !runs(project(&it.path))) {
            PAUSE
        } else {
            FOREVER
        };
        select! {
            recv(self.connection.receiver) -> it => it.map_or(Event::End, Event::Message),
            recv(self.checked.1) -> it => it.map_or(Event::End, Event::Found),
            default(pause) => Event::Pause,
        }
    }

    fn send(&self, message: Message) -> Result<(), String> {
        self.connection.sender.send(message).map_err(|_| "the editor is gone".to_owned())
    }

    /// A mistake in one answer must not end the others.
    fn answered(&mut self, request: Request) -> Response {
        let Request { id, method, params } = request;
        let answer = catch_unwind(AssertUnwindSafe(|| self.answer(LspRequestMethod::from(method.as_str()), params)));
        match answer {
            Ok(Ok(result)) => Response::new_ok(id, result),
            Ok(Err(Refused { code, why })) => error(id, code, why),
            Err(_) => {
                self.projects.iter_mut().for_each(Project::forget);
                error(id, ErrorCode::InternalError, format!("{method}: a mistake of the server's own"))
            }
        }
    }

    fn notified(&mut self, it: Notification, waiting: &mut VecDeque<Request>) -> Result<(), String> {
        match LspNotificationMethod::from(it.method.as_str()) {
            LspNotificationMethod::TextDocumentDidOpen => {
                if let Some(params) = read::<DidOpenTextDocumentParams>(it.params) {
                    let document = params.text_document;
                    self.opened(document.uri, document.version, document.text);
                }
            }
            LspNotificationMethod::TextDocumentDidChange => {
                if let Some(params) = read::<DidChangeTextDocumentParams>(it.params) {
                    self.changed(params);
                }
            }
            LspNotificationMethod::TextDocumentDidClose => {
                if let Some(params) = read::<DidCloseTextDocumentParams>(it.params) {
                    self.closed(&params.text_document.uri)?;
                }
            }
            LspNotificationMethod::TextDocumentDidSave => {
                if let Some(params) = read::<DidSaveTextDocumentParams>(it.params) {
                    let path = uri::path(&params.text_document.uri);
                    let is_saved = |it: &&mut Open| Some(&it.path) == path.as_ref();
                    self.open.iter_mut().filter(is_saved).for_each(|it| it.is_changed = false);
                    let saved = self.projects.iter_mut().filter(|it| path.as_ref().is_some_and(|path| it.has(path)));
                    for project in saved {
                        project.saved();
                        ask_dialects(project, &self.checked.0);
                    }
                    self.reread(&[params.text_document.uri]);
                }
            }
            LspNotificationMethod::WorkspaceDidChangeWatchedFiles => {
                if let Some(params) = read::<DidChangeWatchedFilesParams>(it.params) {
                    let changed: Vec<_> = params.changes.into_iter().map(|it| it.uri).collect();
                    self.reread(&changed);
                }
            }
            LspNotificationMethod::CancelRequest => {
                if let Some(params) = read::<CancelParams>(it.params) {
                    let id = match params.id {
                        gen_lsp_types::Id::Int(it) => RequestId::from(it),
                        gen_lsp_types::Id::String(it) => RequestId::from(it),
                    };
                    if let Some(at) = waiting.iter().position(|it| it.id == id) {
                        waiting.remove(at);
                        let why = "it is not wanted any more".to_owned();
                        self.send(Message::Response(error(id, ErrorCode::RequestCanceled, why)))?;
                    }
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn opened(&mut self, uri: Uri, version: i32, text: String) {
        let Some(path) = uri::path(&uri) else { return };
        self.documents.insert(path.clone(), text);
        self.open.retain(|it| it.path != path);
        self.open.push(Open { uri, path: path.clone(), version, is_due: true, is_changed: false });
        match self.projects.iter_mut().find(|it| it.has(&path)) {
            Some(project) => project.has_changed(&path),
            None => _ = self.project_of(&path),
        }
        self.all_are_due(&path);
    }

    fn changed(&mut self, params: DidChangeTextDocumentParams) {
        let Some(path) = uri::path(&params.text_document.text_document_identifier.uri) else { return };
        let Some(text) = self.documents.get_mut(&path) else { return };
        for change in params.content_changes {
            match change {
                TextDocumentContentChangeEvent::TextDocumentContentChangePartial(it) => {
                    let document = Source::new("", std::mem::take(text));
                    let at = |it| usize::try_from(place::offset(&document, it)).unwrap_or(usize::MAX);
                    let (start, end) = (at(it.range.start), at(it.range.end));
                    *text = document.text;
                    text.replace_range(start..end.max(start), &it.text);
                }
                TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(it) => *text = it.text,
            }
        }
        if let Some(open) = self.open.iter_mut().find(|it| it.path == path) {
            (open.version, open.is_changed) = (params.text_document.version, true);
        }
        self.all_are_due(&path);
    }

    /// What a text changes is known of all files of its project anew.
    fn all_are_due(&mut self, path: &Path) {
        for project in self.projects.iter_mut().filter(|it| it.has(path)) {
            project.has_changed(path);
            self.open.iter_mut().filter(|it| project.has(&it.path)).for_each(|it| it.is_due = true);
        }
    }

    fn closed(&mut self, uri: &Uri) -> Result<(), String> {
        let Some(path) = uri::path(uri) else { return Ok(()) };
        self.documents.remove(&path);
        self.open.retain(|it| it.path != path);
        self.all_are_due(&path);
        self.projects.retain(|it| self.open.iter().any(|open| it.has(&open.path)));
        self.publish_one(uri.clone(), None, Vec::new())
    }

    /// Files have changed on disk: their projects are read again, and those that list other files now.
    fn reread(&mut self, changed: &[Uri]) {
        let paths: Vec<_> = changed.iter().filter_map(uri::path).collect();
        let is_text = |path: &PathBuf| self.projects.iter().any(|it| it.has(path));
        if paths.iter().all(|it| is_text(it) && self.documents.contains_key(it)) {
            // What the editor has was written.
            return;
        }
        self.projects.clear();
        let open: Vec<_> = self.open.iter().map(|it| it.path.clone()).collect();
        for path in open {
            let _ = self.project_of(&path);
        }
        self.open.iter_mut().for_each(|it| it.is_due = true);
    }

    /// The project of a file, which is read where it is not known.
    pub fn project_of(&mut self, path: &Path) -> Result<usize, String> {
        if let Some(known) = self.projects.iter().position(|it| it.has(path)) {
            return Ok(known);
        }
        let unit = self.host.unit(path)?;
        if !unit.paths.iter().any(|it| it == path) {
            return Err(format!("{} is not a source of its project", path.display()));
        }
        self.projects.push(Project::new(unit));
        Ok(self.projects.len() - 1)
    }

    /// The project that has to be checked before a request is answered.
    fn project_asked(&self, request: &Request) -> Option<usize> {
        if !requests::needs_check(&LspRequestMethod::from(request.method.as_str())) {
            return None;
        }
        let path = self.path(&request.params).ok()?;
        self.projects.iter().position(|it| it.has(&path)).filter(|it| self.projects[*it].known().is_none())
    }

    /// Begins to check a project, in a thread of its own, where that has not begun.
    fn check(&mut self, project: usize) {
        let project = &mut self.projects[project];
        if project.known().is_some() || project.check().is_some() {
            return;
        }
        self.checks += 1;
        let id = CheckId(self.checks);
        let (check, ended) = (project.begin_check(&self.documents, id), self.checked.0.clone());
        let thread = thread::Builder::new().stack_size(STACK).spawn(move || ended.send(Found::Whole(id, check())));
        if thread.is_err() {
            let analysis = project.whole(&self.documents);
            project.checked(analysis);
        }
    }

    /// Takes what a thread has found out, and says what is new.
    fn found(&mut self, it: Found) -> Result<(), String> {
        match it {
            Found::Whole(id, analysis) => {
                let Some(project) = self.projects.iter_mut().find(|it| it.check() == Some(id)) else { return Ok(()) };
                project.checked(analysis);
                ask_dialects(project, &self.checked.0);
            }
            Found::Dialects(path, dialects) => {
                let Some(project) = self.projects.iter_mut().find(|it| it.has(&path)) else { return Ok(()) };
                if dialects.is_empty() {
                    return Ok(());
                }
                project.dialects = dialects;
                self.open.iter_mut().filter(|it| project.has(&it.path)).for_each(|it| it.is_due = true);
            }
            Found::Ran { path, generation, results } => {
                if let Some(project) = self.projects.iter_mut().find(|it| it.has(&path)) {
                    project.results.end(generation, results);
                }
                self.ask_for_lenses()?;
            }
        }
        self.publish()
    }

    /// What is known of a project that has been checked.
    fn whole(&mut self, project: usize) -> Arc<Analysis> {
        self.projects[project].whole(&self.documents)
    }

    /// Says what there is to say of the open documents of which it is not known; of what was not checked, when it is.
    fn publish(&mut self) -> Result<(), String> {
        let due: Vec<_> = self.open.iter().filter(|it| it.is_due).map(|it| it.path.clone()).collect();
        for path in due {
            if let Ok(project) = self.project_of(&path)
                && self.projects[project].known().is_none()
            {
                self.check(project);
                continue;
            }
            let found = catch_unwind(AssertUnwindSafe(|| self.problems(&path))).unwrap_or_default();
            let Some(open) = self.open.iter_mut().find(|it| it.path == path) else { continue };
            open.is_due = false;
            let (uri, version) = (open.uri.clone(), open.version);
            self.publish_one(uri, Some(version), found)?;
        }
        Ok(())
    }

    /// What there is to say of a file; what is wrong with its project, at its beginning.
    pub fn problems(&mut self, path: &Path) -> Vec<gen_lsp_types::Diagnostic> {
        let project = match self.project_of(path) {
            Ok(at) => at,
            Err(why) => return vec![problems::of_project(why)],
        };
        let analysis = self.whole(project);
        let project = &self.projects[project];
        let mut found = project.file(path).map(|it| problems::of(&analysis, it)).unwrap_or_default();
        found.extend(project.unit.problem.clone().map(problems::of_project));
        if !project.dialects.is_empty() {
            found.extend(dialects::hint(&found, &project.dialects));
        }
        found
    }

    fn publish_one(
        &self,
        uri: Uri,
        version: Option<i32>,
        diagnostics: Vec<gen_lsp_types::Diagnostic>,
    ) -> Result<(), String> {
        let params = PublishDiagnosticsParams { uri, version, diagnostics };
        let method = LspNotificationMethod::TextDocumentPublishDiagnostics.as_str().to_owned();
        self.send(Message::Notification(Notification::new(method, params)))
    }
}

/// Begins to ask other dialects about a project that has errors, where that is due, in a thread of its own.
fn ask_dialects(project: &mut Project, ended: &Sender<Found>) {
    let first = project.unit.paths.first().cloned();
    if let (Some(ask), Some(path)) = (project.ask_dialects(), first) {
        let ended = ended.clone();
        let work = move || ended.send(Found::Dialects(path, ask()));
        // Without a thread, no advice is given.
        drop(thread::Builder::new().stack_size(STACK).spawn(work));
    }
}

fn read<T: serde::de::DeserializeOwned>(params: Json) -> Option<T> {
    serde_json::from_value(params).ok()
}

fn error(id: RequestId, code: ErrorCode, why: String) -> Response {
    Response::new_err(id, code as i32, why)
}
