//! Names without an entry.
use staunch_frontend::{Dialect, Options, Source, Sources, compile, index};
use staunch_syntax::lex::{Kind, lex};
use std::path::Path;

fn walk(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for it in std::fs::read_dir(folder).unwrap().flatten() {
        let path = it.path();
        if path.is_dir() { walk(&path, found) } else { found.push(path) }
    }
}

#[test]
fn names() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/cases");
    let mut files = Vec::new();
    walk(&root, &mut files);
    files.sort();
    let only = std::env::var("ONLY").unwrap_or_default();
    let (mut all, mut missing, mut cases) = (0, 0, 0);
    for path in
        files.iter().filter(|it| it.extension().is_some_and(|it| it == "st") && it.to_str().unwrap().contains(&only))
    {
        if path.file_stem().unwrap().to_str().unwrap().contains('.') {
            continue;
        }
        let mut sources = Sources::default();
        sources.add(Source::decode("x.st", &std::fs::read(path).unwrap()));
        for n in 2..5 {
            let other = path.with_extension(format!("{n}.st"));
            if other.exists() {
                sources.add(Source::decode("y.st", &std::fs::read(other).unwrap()));
            }
        }
        let mut options = Options::default();
        let text = sources.files()[0].text.clone();
        for line in text.lines().map_while(|it| it.strip_prefix("//")) {
            if let Some(it) = line.trim().strip_prefix("dialect:") {
                options.dialect = Dialect::named(it.trim()).unwrap()
            }
            if line.trim() == "tests: on" {
                options.tests = true
            }
        }
        if compile(&sources, &options).has_errors() {
            continue;
        }
        cases += 1;
        let (index, _) = index(&sources, &options, None);
        for (file, source) in sources.files().iter().enumerate() {
            let tokens = lex(file as u16, &source.text);
            let mut shown = 0;
            for (kind, place) in tokens.kinds.iter().zip(&tokens.places) {
                if *kind != Kind::Name {
                    continue;
                }
                let word = source.text[place.0 as usize..place.1 as usize].to_ascii_uppercase();
                if [
                    "STRING",
                    "METHOD",
                    "POINTER",
                    "INTERFACE",
                    "WSTRING",
                    "EXTENDS",
                    "RESOURCE",
                    "IMPLEMENTS",
                    "ON",
                    "REF_TO",
                    "REFERENCE",
                    "PUBLIC",
                    "PRIVATE",
                    "PROTECTED",
                    "INTERNAL",
                    "FINAL",
                    "ABSTRACT",
                    "OVERRIDE",
                    "UNION",
                    "TASK",
                    "NAMESPACE",
                    "ACTION",
                    "PROPERTY",
                    "USING",
                    "GET",
                    "SET",
                    "BIT",
                    "CLASS",
                    "S",
                    "R",
                    "TO",
                    "INITIAL_STEP",
                    "STEP",
                    "END_STEP",
                    "OVERLAP",
                    "TEST",
                    "R_EDGE",
                    "F_EDGE",
                    "JMP",
                    "WITH",
                    "PROPERTY_GET",
                    "PROPERTY_SET",
                    "ACTIONS",
                    "END_METHOD",
                    "END_ACTION",
                    "END_PROPERTY",
                    "END_INTERFACE",
                    "PERSISTENT",
                ]
                .contains(&word.as_str())
                {
                    continue;
                }
                all += 1;
                if index.at(file as u16, place.0).is_none() {
                    missing += 1;
                    shown += 1;
                    if shown < 5 {
                        let line = source.line(place.0);
                        println!(
                            "{}:{line} {} | {}",
                            path.strip_prefix(&root).unwrap().display(),
                            &source.text[place.0 as usize..place.1 as usize],
                            source.text.lines().nth(line as usize - 1).unwrap_or_default().trim()
                        );
                    }
                }
            }
        }
    }
    println!("{cases} cases, {all} names, {missing} missing");
}
