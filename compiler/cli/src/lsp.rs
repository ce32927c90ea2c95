//! `lsp`: an editor's questions, answered on standard input and output.

mod child;

use crate::args::Common;
use crate::{input, other_dialects, session};
use staunch_build::{Project, listing};
use staunch_frontend::{Dialect, Severity, Source, Sources, check};
use staunch_lsp::{Choice, Connection, Host, TestResult, Unit, Work};
use std::fs;
use std::path::{Path, PathBuf};

pub fn lsp(common: &Common) -> Result<u8, String> {
    // What a panic says is the editor's log.
    let (connection, threads) = Connection::stdio();
    staunch_lsp::serve(&connection, &Disk { common })?;
    drop(connection);
    threads.join().map_err(|it| format!("standard output: {it}"))?;
    Ok(0)
}

/// The files of this machine, by the rules of the other commands.
struct Disk<'a> {
    common: &'a Common,
}

impl Host for Disk<'_> {
    fn unit(&self, path: &Path) -> Result<Unit, String> {
        let folder = path.parent().unwrap_or(path);
        self.unit_of(path, Project::find(folder)).or_else(|why| {
            let alone = self.unit_of(path, Ok(None)).map_err(|_| why.clone())?;
            Ok(Unit { problem: Some(why), ..alone })
        })
    }

    fn test(&self, path: &Path, title: &str) -> Result<Work<Vec<TestResult>>, String> {
        child::test(self.common, &files(path)?, title)
    }

    fn compare(&self, path: &Path, from: Dialect, to: Dialect) -> Result<Work<String>, String> {
        child::compare(self.common, &files(path)?, from, to)
    }
}

impl Disk<'_> {
    /// The program of a file, by the settings that were found for its folder.
    fn unit_of(&self, path: &Path, found: Result<Option<Project>, String>) -> Result<Unit, String> {
        let folder = path.parent().unwrap_or(path);
        let found = found?;
        let settings = found.as_ref().map_or(folder, |it| &it.folder).join("staunch.toml");
        let has_settings = found.is_some();
        let mut project = found.unwrap_or_default();
        let libraries = session::seen(&project, "libraries", &project.libraries)?;
        let sources = match listed(&project, path)? {
            Some(named) => input::read(&named, &libraries)?,
            None => {
                let alone = self.alone(path, &libraries)?;
                self.folder(path, &project, &libraries, &alone).unwrap_or(alone)
            }
        };
        let is_chosen = self.common.dialect.is_some() || project.dialect.is_some() || sources.dialect().is_some();
        let options = {
            project.dialect = project.dialect.take().or_else(|| sources.dialect().map(str::to_owned));
            session::options(self.common, &project)?
        };
        let here = std::env::current_dir().map_err(|it| format!("the current folder: {it}"))?;
        let named = |it: &Source| {
            let full = here.join(&it.path);
            if is_same(&full, path) { path.to_owned() } else { full.canonicalize().unwrap_or(full) }
        };
        Ok(Unit {
            paths: sources.files().iter().map(named).collect(),
            sources,
            options: staunch_frontend::Options { is_run: false, ..options },
            levels: session::levels(self.common, &project)?,
            layout: project.layout.clone(),
            choice: (!is_chosen).then_some(Choice { accepting: other_dialects::accepting, settings, has_settings }),
            problem: None,
        })
    }
}

/// What names the program of a file on the command line.
fn files(path: &Path) -> Result<Vec<PathBuf>, String> {
    let project = Project::find(path.parent().unwrap_or(path))?.unwrap_or_default();
    Ok(listed(&project, path)?.unwrap_or_else(|| vec![path.to_owned()]))
}

/// The files or the project that list a file: those of staunch.toml, or those of another system nearby.
fn listed(project: &Project, path: &Path) -> Result<Option<Vec<PathBuf>>, String> {
    let own = session::seen(project, "files", &project.files)?;
    let is_in = |arguments: &Vec<PathBuf>| {
        let files = input::found(arguments).unwrap_or_default();
        !arguments.is_empty() && files.iter().any(|it| is_same(it, path))
    };
    Ok([own].into_iter().chain(lists_above(path.parent().unwrap_or(path))).find(is_in))
}

/// A folder of more files is not looked at for the program of one of them.
const MOST: usize = 200;

impl Disk<'_> {
    /// The folder of a file that no project lists, where that is a program, and the file is none by itself.
    fn folder(&self, path: &Path, project: &Project, libraries: &[PathBuf], alone: &Sources) -> Option<Sources> {
        let folder = path.parent().filter(|_| path.exists())?.to_owned();
        let files = input::found(std::slice::from_ref(&folder)).ok()?;
        let options = session::options(self.common, project).ok()?;
        let is_wrong = |it: &Sources| check(it, &options).iter().any(|it| it.severity == Severity::Error);
        if !(2..=MOST).contains(&files.len()) || !files.iter().any(|it| is_same(it, path)) || !is_wrong(alone) {
            return None;
        }
        input::read(&[folder], libraries).ok().filter(|it| !is_wrong(it))
    }

    /// A file that no project lists; one that is not on disk yet is empty.
    #[allow(clippy::unused_self, reason = "it reads the disk")]
    fn alone(&self, path: &Path, libraries: &[PathBuf]) -> Result<Sources, String> {
        if path.exists() {
            return input::read(&[path.to_owned()], libraries);
        }
        let mut sources = Sources::default();
        sources.add(Source::decode(input::shown(path), &[]));
        Ok(sources)
    }
}

/// The projects of other systems in a folder and those above it, the nearest first.
fn lists_above(folder: &Path) -> impl Iterator<Item = Vec<PathBuf>> {
    folder.ancestors().take(8).flat_map(|folder| {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|it| it.path());
        let is_project = |it: &PathBuf| it.extension().is_some_and(|it| it.eq_ignore_ascii_case("plcproj"));
        let mut projects: Vec<_> = entries.filter(is_project).chain(listing::project_in(folder)).collect();
        projects.sort();
        projects.into_iter().map(|it| vec![it])
    })
}

fn is_same(one: &Path, other: &Path) -> bool {
    one == other || one.canonicalize().is_ok_and(|one| other.canonicalize().is_ok_and(|other| one == other))
}
