//! What completion offers can be written there: it means something.

mod support;

use serde_json::Value as Json;
use staunch_frontend::{Code, Source, check};
use support::Editor;
use support::programs::{Program, sample};

/// Names that are written and not offered yet: conversions, which are hundreds (`INT_TO_REAL`), what a dialect computes at addresses
/// and of sizes, THIS, and what is in place of blocks in Logix and S7 where it is called.
const NOT_YET: [&str; 14] = [
    "_TO_",
    "ADR",
    "SIZEOF",
    "MEMMOVE",
    "MEMCMP",
    "MEMCPY",
    "MEMSET",
    "THIS",
    "SUPER",
    "LOWER_BOUND",
    "UPPER_BOUND",
    "INELSE",
    "CTU",
    "RES",
];

#[test]
fn each_name_that_is_offered_means_something() {
    let (mut count, mut wrong, mut missing) = (0, Vec::new(), Vec::new());
    for program in sample(12) {
        // A text of pieces is not what an editor shows, and others have what is written in the first.
        if !program.sources.get(0).is_assembled() && program.sources.files().len() == 1 {
            count += try_all(&program, &mut wrong, &mut missing);
        }
    }
    assert!(count > 1500, "{count} names");
    missing.retain(|it| !NOT_YET.iter().any(|known| it.contains(known)));
    println!("not offered where they are written: {missing:#?}");
    assert!(wrong.is_empty(), "{} of {count}: {:#?}", wrong.len(), &wrong[..wrong.len().min(60)]);
}

fn try_all(program: &Program, wrong: &mut Vec<String>, missing: &mut Vec<String>) -> usize {
    let source = program.sources.get(0);
    let mut editor = Editor::open(program.options.dialect, &[]);
    editor.open_one("main.st", &source.text);
    let mut count = 0;
    let places = names_in_bodies(program);
    for (start, end) in places.iter().step_by(places.len() / 5 + 1) {
        let (line, _) = source.line_column(*start);
        let begins = source.line_range(line).start;
        let column = source.text[begins..*start as usize].encode_utf16().count() as u32;
        let items = editor.at("completion", "main.st", (line - 1, column));
        let old = &source.text[*start as usize..*end as usize];
        let items = items.as_array().expect("a list");
        // What is written there says what is wanted: a variable is not put in the place of a FUNCTION's name.
        let kind = items.iter().find(|it| it["label"].as_str().is_some_and(|it| it.eq_ignore_ascii_case(old)));
        let Some(kind) = kind.map(|it| it["kind"].clone()) else {
            missing.push(format!("{}:{line}: {old}", program.name));
            continue;
        };
        let offered: Vec<_> = items.iter().filter(|it| it["kind"] == kind).filter_map(name).collect();
        // A few of them.
        for name in offered.iter().step_by(offered.len() / 8 + 1) {
            count += 1;
            let text = format!("{}{name}{}", &source.text[..*start as usize], &source.text[*end as usize..]);
            if let Some(why) = unknown(program, &text, *start) {
                wrong.push(format!("{}:{line}: {name} for {old}: {why}", program.name));
            }
        }
    }
    editor.close();
    count
}

/// What is inserted, of an item that is a name.
fn name(item: &Json) -> Option<String> {
    const KEYWORD: u64 = 14;
    const SNIPPET: u64 = 15;
    let is_name = item["kind"].as_u64().is_some_and(|it| it != KEYWORD && it != SNIPPET);
    let text = item["insertText"].as_str().or(item["label"].as_str())?;
    is_name.then(|| text.to_owned())
}

/// Where names are used that are in statements.
fn names_in_bodies(program: &Program) -> Vec<(u32, u32)> {
    let (index, _) =
        staunch_frontend::index(&program.sources, &program.options, Default::default(), &Default::default());
    let tree = staunch_frontend::parse_file(&program.sources, 0);
    let mut statements = Vec::new();
    for item in &tree.items {
        if let staunch_frontend::ast::Item::Pou(pou) = item {
            let bodies = std::iter::once(pou).chain(&pou.routines).flat_map(|it| &it.body);
            statements.extend(bodies.map(|it| it.span));
        }
    }
    let is_in_body = |at: u32| statements.iter().any(|it| it.start <= at && at < it.end);
    let own = index.uses.iter().filter(|it| it.span.file == 0 && is_in_body(it.span.start));
    own.map(|it| (it.span.start, it.span.end)).collect()
}

/// What is said where a name means nothing.
fn unknown(program: &Program, text: &str, at: u32) -> Option<String> {
    let mut sources = staunch_frontend::Sources::default();
    sources.add(Source::decode("main.st", text.as_bytes()));
    let is_there = |it: &staunch_frontend::Diagnostic| it.span.file == 0 && it.span.start <= at && at < it.span.end;
    let found = check(&sources, &program.options);
    let it = found.into_iter().find(|it| is_there(it) && UNKNOWN.contains(&it.code))?;
    Some(format!("{}: {}", it.code.name(), it.message))
}

/// Not declared, or no member or pin.
const UNKNOWN: [Code; 4] = [Code::E0101, Code::E0102, Code::E0107, Code::E0108];
