//! Commands of lenses: what they run takes a while, and is done in a thread.

use super::requests::{Answer, path, read};
use super::{Found, Refused, Server};
use crate::answers::lenses;
use crate::results::Task;
use gen_lsp_types::Uri;
use lsp_server::{ErrorCode, Message, Request, RequestId};
use serde_json::{Value as Json, json};
use staunch_frontend::Dialect;
use std::path::Path;
use std::thread;

/// What came of a task, and perhaps of others that ran with it.
type Ended = Vec<(Task, String)>;

impl Server<'_> {
    /// Begins what a lens offers. What comes of it is in the lens, when the editor asks for lenses again.
    pub(super) fn execute(&mut self, command: &str, arguments: Vec<Json>) -> Answer {
        let wrong = |why: String| Refused::new(ErrorCode::InvalidParams, why);
        let mut arguments = arguments.into_iter();
        let uri: Uri = read(arguments.next().unwrap_or_default())?;
        let argument: String = read(arguments.next().unwrap_or_default())?;
        let task = match command {
            lenses::TEST => Task::Test(argument),
            lenses::COMPARE => Task::Compare(
                Dialect::named(&argument).ok_or_else(|| wrong(format!("there is no dialect `{argument}`")))?,
            ),
            other => return Err(wrong(format!("there is no command `{other}`"))),
        };
        self.begin(&path(&uri)?, task)?;
        self.ask_for_lenses()?;
        Ok(Json::Null)
    }

    fn begin(&mut self, path: &Path, task: Task) -> Result<(), String> {
        let at = self.project_of(path)?;
        if let Some(changed) = self.open.iter().find(|it| it.is_changed && self.projects[at].has(&it.path)) {
            let name = changed.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            return Err(format!("save {name} first: files run as they are on disk"));
        }
        let project = &mut self.projects[at];
        let work: Box<dyn FnOnce() -> Result<Ended, String> + Send> = match &task {
            Task::Test(title) => {
                let work = self.host.test(path, title)?;
                Box::new(move || Ok(work()?.into_iter().map(|it| (Task::Test(it.title), it.outcome)).collect()))
            }
            Task::Compare(to) => {
                let (work, to) = (self.host.compare(path, project.unit.options.dialect, *to)?, *to);
                Box::new(move || Ok(vec![(Task::Compare(to), work()?)]))
            }
        };
        project.results.begin(task.clone());
        let (ended, path, generation) = (self.checked.0.clone(), path.to_owned(), project.results.generation());
        let work = move || {
            // It has ended in any case.
            let results = work().unwrap_or_else(|why| vec![(task.clone(), why)]);
            let is_missing = !results.iter().any(|it| it.0 == task);
            let results = results.into_iter().chain(is_missing.then(|| (task, "it did not run".to_owned()))).collect();
            drop(ended.send(Found::Ran { path, generation, results }));
        };
        thread::Builder::new().spawn(work).map(drop).map_err(|it| format!("no thread: {it}"))
    }

    /// What an editor has of lenses is out of date.
    pub(super) fn ask_for_lenses(&mut self) -> Result<(), String> {
        if !self.refreshes_lenses {
            return Ok(());
        }
        self.requests += 1;
        let id = RequestId::from(self.requests);
        self.send(Message::Request(Request::new(id, "workspace/codeLens/refresh".to_owned(), json!(null))))
    }
}
