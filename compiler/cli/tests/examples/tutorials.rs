//! The tutorials, done as they say: their files are written into an empty folder, their commands are run there in order, and print what is
//! shown. One that follows an example shows parts of its files, and what cargo prints there as the example's page has it, which its own
//! test holds.
//!
//! A file is named in the line before its fence, as in "Save this as `plc.st`:".

use super::{project, read};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

#[test]
fn tutorials_work_as_they_say() {
    let pages: Vec<PathBuf> = fs::read_dir(project().join("docs/tutorials"))
        .expect("the folder exists")
        .flatten()
        .map(|it| it.path())
        .collect();
    assert!(pages.len() >= 5, "{pages:?}");
    for page in pages {
        let name = page.file_stem().expect("a page has a name").to_string_lossy().into_owned();
        let text = read(&page);
        let example = text.lines().find_map(|it| it.strip_prefix("<!-- files of ")?.strip_suffix(" -->"));
        let folder = match example {
            Some(_) => project(),
            None => empty(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("tutorials").join(&name)),
        };
        let mut steps = 0;
        for fence in fences(&text) {
            let place = format!("{name}: {}", fence.text.lines().next().unwrap_or_default());
            match (&fence.file, example) {
                (_, Some(example)) if fence.text.starts_with("$ cargo ") => {
                    let page = read(&project().join(example).join("README.md"));
                    let missing = fence.text.lines().find(|line| !page.lines().any(|it| it == *line));
                    assert_eq!(missing, None, "{place}: not in the example's page");
                }
                _ if fence.language == "console" => steps += run(&folder, &fence.text, &place),
                (Some(file), Some(example)) => {
                    assert!(read(&project().join(example).join(file)).contains(&fence.text), "{place}: not in {file}");
                }
                (Some(file), None) => fs::write(folder.join(file), &fence.text).expect("the folder exists"),
                (None, _) => {}
            }
        }
        assert!(steps > 0, "{name} runs nothing");
    }
}

struct Fence {
    language: String,
    /// What the line before it names.
    file: Option<String>,
    text: String,
}

fn fences(page: &str) -> Vec<Fence> {
    let mut found = Vec::new();
    let mut open: Option<Fence> = None;
    let mut before = "";
    for line in page.lines() {
        match (&mut open, line.strip_prefix("```")) {
            (Some(_), Some(_)) => found.extend(open.take()),
            (Some(fence), None) => fence.text += &format!("{line}\n"),
            (None, Some(info)) => {
                let language = info.split([' ', ',']).next().unwrap_or_default().to_owned();
                open = Some(Fence { language, file: named(before), text: String::new() });
            }
            (None, None) if !line.trim().is_empty() => before = line,
            (None, None) => {}
        }
    }
    found
}

/// The name in backticks at the end of a line, before its colon.
fn named(line: &str) -> Option<String> {
    line.strip_suffix("`:")?.rsplit('`').next().map(str::to_owned)
}

fn empty(folder: &Path) -> PathBuf {
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder).expect("a folder can be made");
    folder.to_owned()
}

/// Runs the commands of a fence; how many.
fn run(folder: &Path, text: &str, place: &str) -> usize {
    let mut printed = String::new();
    let mut rest = String::new();
    let mut count = 0;
    for line in text.lines() {
        if let Some(command) = line.strip_prefix("$ ") {
            let output = started(folder, command);
            printed = String::from_utf8_lossy(&[output.stderr, output.stdout].concat()).into_owned();
            rest.clone_from(&printed);
            count += 1;
            continue;
        }
        let mut lines = rest.lines();
        let is_there = lines.any(|it| it.trim_end() == line.trim_end());
        assert!(is_there, "{place}: not printed\n  {line}\nbut\n{printed}");
        rest = lines.map(|it| format!("{it}\n")).collect();
    }
    count
}

fn started(folder: &Path, command: &str) -> Output {
    let mut words = command.split(' ');
    let mut process = match words.next() {
        Some("staunch") => Command::new(env!("CARGO_BIN_EXE_staunch")),
        Some(own) if own.starts_with("./") => Command::new(folder.join(own)),
        other => panic!("a tutorial does not run {other:?}"),
    };
    process.args(words).current_dir(folder).env("NO_COLOR", "1").env_remove("COLUMNS");
    process.env("STAUNCH_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"));
    process.output().expect("the command starts")
}
