//! Every folder in `st_examples` with an `expected.csv`, and every command that a document shows.
//!
//! An example's README shows the command that runs it; the same command with `--trace -` must
//! print `expected.csv`, on every back end. No list names the examples: a folder is enough.

mod tutorials;

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the project's folder exists")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A command of a document, and the lines shown below it.
struct Shown {
    arguments: Vec<String>,
    lines: Vec<String>,
}

/// The `$ staunch …` commands in the console fences of a document.
fn commands(document: &str) -> Vec<Shown> {
    let mut commands: Vec<Shown> = Vec::new();
    let mut in_fence = false;
    let mut is_ours = false;
    for line in document.lines() {
        if line.starts_with("```") {
            in_fence = line == "```console";
            is_ours = false;
        } else if let Some(command) = line.strip_prefix("$ ").filter(|_| in_fence) {
            let command = command.strip_prefix("cargo run -p staunch -- ").or_else(|| command.strip_prefix("staunch "));
            is_ours = command.is_some();
            let words = command.into_iter().map(|it| it.split(' ').map(|it| it.trim_matches('\'').to_owned()));
            commands.extend(words.map(|it| Shown { arguments: it.collect(), lines: Vec::new() }));
        } else if let Some(last) = commands.last_mut().filter(|_| is_ours) {
            last.lines.push(line.to_owned());
        }
    }
    commands
}

fn staunch(arguments: &[String], more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.args(arguments).args(more).current_dir(project()).env("NO_COLOR", "1").env_remove("COLUMNS");
    command.env("STAUNCH_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"));
    command.output().expect("the command starts")
}

fn examples() -> Vec<PathBuf> {
    let folder = fs::read_dir(project().join("st_examples")).expect("the examples are there");
    let mut folders: Vec<_> =
        folder.flatten().map(|it| it.path()).filter(|it| it.join("expected.csv").is_file()).collect();
    folders.sort();
    assert!(folders.len() >= 12, "only {} examples", folders.len());
    folders
}

/// Where the trace of an example differs from what it should be.
fn difference(folder: &Path, backend: &str) -> Option<String> {
    let name = folder.file_name()?.to_string_lossy();
    let all = commands(&read(&folder.join("README.md")));
    let Some(shown) = all.iter().find(|it| it.arguments.first().is_some_and(|it| it == "run")) else {
        return Some(format!("{name}: its README shows no `$ staunch run …`\n"));
    };
    let output = staunch(&shown.arguments, &["--trace", "-", "--backend", backend]);
    // An example shows how it is done: there is nothing to remark.
    let remarks = String::from_utf8_lossy(&output.stderr).contains("warning[");
    if remarks || !output.status.success() {
        return Some(format!("{name}, {backend}: {}\n", String::from_utf8_lossy(&output.stderr)));
    }
    let (expected, found) = (read(&folder.join("expected.csv")), String::from_utf8_lossy(&output.stdout));
    let pairs = expected.lines().zip(found.lines()).enumerate();
    let mut text = String::new();
    for (at, (expected, found)) in pairs.filter(|(_, (expected, found))| expected != found).take(5) {
        let _ = writeln!(text, "{name}, {backend}: expected.csv:{}\n  expected {expected}\n  found    {found}", at + 1);
    }
    if text.is_empty() && expected != found {
        let _ = writeln!(
            text,
            "{name}, {backend}: {} lines expected, {} found",
            expected.lines().count(),
            found.lines().count()
        );
    }
    Some(text).filter(|it| !it.is_empty())
}

fn check(backend: &str) {
    let differences: String = examples().iter().filter_map(|it| difference(it, backend)).collect();
    assert!(differences.is_empty(), "\n{differences}");
}

#[test]
fn native_code_does_what_the_examples_say() {
    check("native");
}

#[test]
fn the_interpreter_does_what_the_examples_say() {
    check("interpret");
}

#[test]
fn generated_rust_does_what_the_examples_say() {
    check("rust");
}

/// The project's Markdown, without build output.
fn documents(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).expect("a folder of the project").flatten().map(|it| it.path()) {
        let is_output = path.file_name().is_some_and(|it| it == "target" || it == ".git");
        if path.is_dir() && !is_output {
            documents(&path, found);
        } else if path.extension().is_some_and(|it| it == "md") {
            found.push(path);
        }
    }
}

/// Each line that a document shows is a line of the output, in the same order; others may be left out.
#[test]
fn documents_show_what_the_command_prints() {
    let mut paths = Vec::new();
    documents(&project(), &mut paths);
    let mut wrong = String::new();
    // A tutorial's commands are for its own folder.
    for path in paths.into_iter().filter(|it| !it.parent().is_some_and(|it| it.ends_with("docs/tutorials"))) {
        for shown in commands(&read(&path)) {
            let output = staunch(&shown.arguments, &[]);
            let printed = [output.stderr, output.stdout].concat();
            let printed = String::from_utf8_lossy(&printed);
            let mut printed = printed.lines();
            let missing = shown.lines.iter().find(|line| !printed.any(|it| it.trim_end() == line.trim_end()));
            if let Some(line) = missing {
                let _ = writeln!(
                    wrong,
                    "{}: `staunch {}` does not print\n  {line}",
                    path.display(),
                    shown.arguments.join(" ")
                );
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

/// A relative link in a document leads somewhere.
#[test]
fn links_in_documents_lead_somewhere() {
    let mut paths = Vec::new();
    documents(&project(), &mut paths);
    let mut broken = String::new();
    for path in paths {
        let folder = path.parent().expect("a file is in a folder");
        // What is between backticks is code, and no link.
        let text: String = read(&path).split('`').step_by(2).collect();
        for link in text.split("](").skip(1).filter_map(|it| it.split_once(')')).map(|it| it.0.to_owned()) {
            let target = link.split('#').next().unwrap_or_default();
            let is_path = !target.is_empty() && !target.contains("://") && !target.contains(['\n', '|', ' ']);
            if is_path && !folder.join(target).exists() {
                let _ = writeln!(broken, "{}: {link}", path.display());
            }
        }
    }
    assert!(broken.is_empty(), "\n{broken}");
}

/// What is above a picture in a document, which says how it is drawn.
const DRAWN: &str = "<!-- drawn by: staunch ";

/// A picture in a document is what the command above it draws; `STAUNCH_BLESS=1` draws it again.
#[test]
fn pictures_in_documents_are_drawn_by_the_command() {
    let mut paths = Vec::new();
    documents(&project(), &mut paths);
    let mut count = 0;
    for path in paths {
        let text = read(&path);
        let lines: Vec<&str> = text.lines().collect();
        for pair in lines.windows(2) {
            let Some(command) = pair[0].strip_prefix(DRAWN).and_then(|it| it.strip_suffix(" -->")) else { continue };
            let target = pair[1].split_once("](").and_then(|it| it.1.strip_suffix(')'));
            let picture = path.parent().expect("a file is in a folder").join(target.expect("a picture is below"));
            let drawn = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("picture_{count}.svg"));
            let arguments: Vec<String> = command.split(' ').map(str::to_owned).collect();
            let output = staunch(&arguments, &["--trace", &drawn.display().to_string()]);
            assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
            if std::env::var_os("STAUNCH_BLESS").is_some() {
                fs::copy(&drawn, &picture).expect("the picture is written");
            }
            assert!(read(&picture) == read(&drawn), "{} is not what `staunch {command}` draws", picture.display());
            count += 1;
        }
    }
    assert!(count >= 1, "no document has a picture");
}
