//! Every name of many programs is renamed, one at a time: the program stays the same.

mod support;

use serde_json::json;
use staunch_frontend::{Asked, Options, Source, Sources, Stop, compile, index};
use std::collections::HashSet;
use std::path::PathBuf;
use support::programs::{Program, files, read, stem};
use support::{Editor, edited, place, uri};

#[test]
fn each_name_of_the_examples_can_be_another() {
    let (count, refused) = renamed(files("st_examples"));
    assert!(count > 150, "{count} names");
    assert!(refused.is_empty(), "{} of {count}: {:#?}", refused.len(), &refused[..refused.len().min(60)]);
}

/// Cases with names that cannot be others yet: the library has a type of the same name, and a METHOD is called through an element of
/// a POINTER TO an INTERFACE.
const NOT_YET: [&str; 2] = ["own_vendor_names", "indexed_pointers"];

/// A case with two variables of the same name, which the program numbers.
const NUMBERED: &str = "globals_and_programs";

#[test]
fn each_name_of_many_cases_can_be_another() {
    // About each eleventh of those with one file, whatever others there are.
    let is_alone = |it: &PathBuf| !it.with_extension("2.st").exists();
    let is_chosen = |it: &PathBuf| stem(it).contains("chart") || stem(it).bytes().map(u32::from).sum::<u32>() % 11 == 0;
    let is_known = |it: &PathBuf| NOT_YET.contains(&stem(it)) || stem(it) == NUMBERED;
    let files: Vec<_> =
        files("tests/cases").into_iter().filter(|it| is_alone(it) && is_chosen(it) && !is_known(it)).collect();
    let (count, refused) = renamed(files);
    assert!(count > 300, "{count} names");
    assert!(refused.is_empty(), "{} of {count}: {:#?}", refused.len(), &refused[..refused.len().min(60)]);
}

/// How many names were renamed, and those where the program is another one then.
fn renamed(files: Vec<PathBuf>) -> (usize, Vec<String>) {
    let (mut count, mut wrong) = (0, Vec::new());
    for path in files {
        let Some(Program { name, sources, options }) = read(&path) else { continue };
        if sources.get(0).is_assembled() {
            continue;
        }
        let text = sources.get(0).text.clone();
        if let Some(before) = program(&text, &options) {
            count += of_file(&name, &text, &options, &before, &mut wrong);
        }
    }
    (count, wrong)
}

/// The program in words; nothing where it is refused.
fn program(text: &str, options: &Options) -> Option<String> {
    let mut sources = Sources::default();
    sources.add(Source::decode("main.st", text.as_bytes()));
    let compilation = compile(&sources, options);
    // What a condition asks for by name is not a name, and a text with a name in it is not in the index.
    let is_plain = !text.contains("{IF ")
        && !["NAME_OF"].iter().any(|it| text.contains(it))
        && !text.contains("to_string")
        && !text.contains("{external")
        && !text.contains("attribute 'instance-path'");
    compilation.program.filter(|_| is_plain).map(|it| format!("{it:?}"))
}

fn of_file(case: &str, text: &str, options: &Options, before: &str, wrong: &mut Vec<String>) -> usize {
    let mut sources = Sources::default();
    sources.add(Source::decode("main.st", text.as_bytes()));
    let (index, _) = index(&sources, options, Asked::All, &Stop::default());
    let source = sources.get(0);
    let mut editor = Editor::open(options.dialect, &[]);
    editor.open_one("main.st", text);
    let words: HashSet<String> =
        text.split(|it: char| !(it.is_alphanumeric() || it == '_')).map(str::to_ascii_lowercase).collect();
    let mut count = 0;
    for definition in index.definitions.iter().filter(|it| it.name.file == 0 && it.name.start < it.name.end) {
        let old = sources.text(definition.name);
        let Some(new) = other(old, &words) else { continue };
        let (line, _) = source.line_column(definition.name.start);
        let range = source.line_range(line);
        let column = text[range.start..definition.name.start as usize].encode_utf16().count() as u32;
        let mut params = place("main.st", (line - 1, column));
        params["newName"] = json!(new);
        count += 1;
        match editor.try_ask("textDocument/rename", params) {
            // What has its meaning by its name, or is a library's, stays.
            Err(why)
                if why.contains("has a fixed meaning")
                    || why.contains("is not a name")
                    || why.contains("not a part of the file") =>
            {
                count -= 1
            }
            Err(why) => wrong.push(format!("{case}:{line}: {old}: {why}")),
            Ok(edit) => {
                let text = edited(text, &edit["changes"][uri("main.st")]);
                let after = program(&text, options).map(|it| it.replace(&new, old));
                if after.as_deref().map(same_letters) != Some(same_letters(before)) {
                    wrong.push(format!("{case}:{line}: {old} as {new} is another program"));
                }
            }
        }
    }
    editor.close();
    count
}

/// What is emitted may have a name in small letters, or in capitals.
fn same_letters(program: &str) -> String {
    program.to_ascii_lowercase()
}

/// A name of the same length that nothing has: so places stay as they are.
fn other(old: &str, words: &HashSet<String>) -> Option<String> {
    let length = old.len().checked_sub(2)?;
    let letters = || ('a'..='z').rev();
    let all = letters().flat_map(|a| letters().map(move |b| format!("{a}{b}{}", "q".repeat(length))));
    let is_free = |it: &String| {
        !words.contains(it) && !matches!(it.as_str(), "if" | "do" | "of" | "or" | "to" | "by" | "at" | "on")
    };
    old.is_ascii().then(|| all.into_iter().find(is_free)).flatten()
}
