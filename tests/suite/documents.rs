//! The Structured Text in the documentation compiles, and its tables are tables.
//!
//! A fence ```` ```iecst ```` holds a whole program, or statements, or declarations. After the
//! language may be `ignore` (a fragment), `error` (it must be refused), or a dialect's name.

use staunch_frontend::{Compilation, Dialect, Format, Options, Source, Sources, Style, render};
use staunch_tests::project;
use std::path::PathBuf;

struct Fence {
    place: String,
    words: Vec<String>,
    text: String,
}

#[test]
fn the_structured_text_in_documents_compiles() {
    let fences: Vec<_> = documents().iter().flat_map(fences).collect();
    let failures: Vec<_> = fences.iter().filter_map(|it| check(it).err()).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn each_table_in_documents_has_a_head() {
    let mut tables = 0;
    for path in documents() {
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<_> = text.lines().collect();
        for (number, line) in lines.iter().enumerate().filter(|(_, it)| it.starts_with('|')) {
            if number == 0 || !lines[number - 1].starts_with('|') {
                let rule = lines.get(number + 1).copied().unwrap_or_default();
                assert!(rule.starts_with("|-"), "{}:{}: {line}", path.display(), number + 1);
                tables += 1;
            }
        }
    }
    assert!(tables > 50, "{tables}");
}

/// The most characters of a cell, as a reader sees it: without the targets of links.
const CELL: usize = 220;

#[test]
fn cells_of_tables_are_short() {
    let mut long = Vec::new();
    for path in documents() {
        let text = std::fs::read_to_string(&path).unwrap();
        for (number, line) in text.lines().enumerate().filter(|(_, it)| it.starts_with('|')) {
            let most = line.split(" | ").map(|it| without_targets(it).chars().count()).max();
            if most > Some(CELL) {
                long.push(format!("{}:{}: a cell has {} characters", path.display(), number + 1, most.unwrap_or(0)));
            }
        }
    }
    assert!(long.is_empty(), "at most {CELL}; make two rows:\n{}", long.join("\n"));
}

fn without_targets(cell: &str) -> String {
    let mut shown = String::new();
    let mut rest = cell;
    while let Some((before, target)) = rest.split_once("](") {
        shown += before;
        rest = target.split_once(')').map_or("", |it| it.1);
    }
    shown + rest
}

fn documents() -> Vec<PathBuf> {
    let folders = ["docs", "docs/tutorials"].into_iter();
    let docs = folders.flat_map(|it| std::fs::read_dir(project().join(it)).expect("the folder exists"));
    let all = [project().join("README.md")].into_iter().chain(docs.flatten().map(|it| it.path()));
    all.filter(|it| it.is_file() && it.extension().is_some_and(|it| it == "md")).collect()
}

fn fences(path: &PathBuf) -> Vec<Fence> {
    let text = std::fs::read_to_string(path).unwrap();
    let name = path.file_name().unwrap().to_string_lossy();
    let mut fences: Vec<Fence> = Vec::new();
    let mut open: Option<Fence> = None;
    for (number, line) in text.lines().enumerate() {
        match (&mut open, line.trim_start().strip_prefix("```")) {
            (None, Some(info)) => {
                let words = info.split([' ', ',']).filter(|it| !it.is_empty()).map(str::to_owned).collect();
                open = Some(Fence { place: format!("{name}:{}", number + 1), words, text: String::new() });
            }
            (Some(_), Some(_)) => fences.extend(open.take()),
            (Some(fence), None) => fence.text.push_str(&format!("{line}\n")),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "{name}: a fence is not closed");
    fences.into_iter().filter(|it| it.words.first().is_some_and(|it| it == "iecst")).collect()
}

fn check(fence: &Fence) -> Result<(), String> {
    let has = |word: &str| fence.words.iter().any(|it| it == word);
    if has("ignore") {
        return Ok(());
    }
    let dialect = fence.words.iter().find_map(|it| Dialect::named(it)).unwrap_or_default();
    let (sources, compilation) = compile(fence, dialect);
    match (compilation.has_errors(), has("error")) {
        (false, true) => Err(format!("{}: it is marked `error`, and compiles", fence.place)),
        (true, false) => {
            let messages =
                compilation.diagnostics.iter().map(|it| render(it, &sources, Format::Human, Style::default()));
            Err(format!("{}:\n{}", fence.place, messages.collect::<String>()))
        }
        _ => Ok(()),
    }
}

fn compile(fence: &Fence, dialect: Dialect) -> (Sources, Compilation) {
    let mut sources = Sources::default();
    sources.add(Source::new(fence.place.clone(), wrapped(&fence.text)));
    let compilation = staunch_frontend::compile(&sources, &Options { dialect, ..Options::default() });
    (sources, compilation)
}

/// Declarations of variables, with or without statements, become a PROGRAM.
pub fn wrapped(text: &str) -> String {
    let units =
        ["PROGRAM ", "FUNCTION", "NAMESPACE ", "TYPE", "CONFIGURATION", "VAR_GLOBAL", "{dialect", "TEST ", "SETUP"];
    let is_unit = |line: &str| units.iter().any(|it| line.starts_with(it));
    match text.lines().any(is_unit) {
        true => text.to_owned(),
        false => format!("PROGRAM Example\n{text}\nEND_PROGRAM\n"),
    }
}
