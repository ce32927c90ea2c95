//! Which files a call reads and writes: none is both.

use crate::args::{Compare, Run, Test};
use crate::session::Session;
use staunch_host::{Expectations, Role, keep_apart};
use std::path::{Path, PathBuf};

/// `-o` of a build or a conversion, also where its name is not given.
pub fn output(session: &Session, out: &Path) -> Result<(), String> {
    check(session, &[], &[("-o", out)])
}

pub fn run(session: &Session, args: &Run) -> Result<(), String> {
    let inputs = roles(&[("--stimulus", &args.stimulus)]);
    check(session, &inputs, &roles(&[("--retain", &args.retain), ("--trace", &args.trace)]))
}

pub fn test(session: &Session, args: &Test) -> Result<(), String> {
    let mut outputs = roles(&[("--junit", &args.junit)]);
    let files = args.coverage.iter().filter(|it| it.as_os_str() != "table");
    outputs.extend(files.map(|it| ("--coverage", it.as_path())));
    check(session, &[], &outputs)
}

pub fn compare(session: &Session, args: &Compare) -> Result<(), String> {
    let inputs = [
        ("--stimulus", &args.stimulus),
        ("--against", &args.against),
        ("--accept", &args.accept),
        ("--assume", &args.assume),
    ];
    let mut outputs = roles(&[("--save-stimulus", &args.save_stimulus), ("--write", &args.write)]);
    outputs.extend(args.picture().map(|it| ("--trace", it.as_path())));
    check(session, &roles(&inputs), &outputs)
}

fn roles<'a>(files: &[(&'a str, &'a Option<PathBuf>)]) -> Vec<Role<'a>> {
    files.iter().filter_map(|(what, path)| Some((*what, path.as_deref()?))).collect()
}

/// With what every call reads: sources, the tables next to them, and the project file.
fn check(session: &Session, inputs: &[Role<'_>], outputs: &[Role<'_>]) -> Result<(), String> {
    let sources: Vec<&Path> = session.sources.files().iter().map(|it| Path::new(&it.path)).collect();
    let tables: Vec<PathBuf> = sources.iter().map(|it| it.with_extension("csv")).filter(|it| is_table(it)).collect();
    let project = session.project.folder.join("staunch.toml");
    let mut all: Vec<Role<'_>> = sources.iter().filter(|it| it.exists()).map(|it| ("the source", *it)).collect();
    all.extend(
        [("the project", session.first.as_path()), ("the project file", &project)].iter().filter(|it| it.1.exists()),
    );
    if session.sources.files().iter().any(|it| it.path == "<stdin>") {
        all.push(("the source", Path::new("/dev/stdin")));
    }
    all.extend(inputs);
    all.extend(tables.iter().map(|it| ("the table", it.as_path())));
    keep_apart(&all, outputs)
}

/// A trace of an earlier run may have the name of its source, and is not read.
fn is_table(path: &Path) -> bool {
    path.is_file() && std::fs::read(path).is_ok_and(|it| Expectations::are_in(&it))
}
