//! Programs to try an editor's requests on: the examples, and golden cases, always the same ones whatever others there are.

use staunch_frontend::{Dialect, Options, Source, Sources, check};
use std::fs;
use std::path::{Path, PathBuf};

pub struct Program {
    pub name: String,
    pub sources: Sources,
    pub options: Options,
}

/// The examples and about one case in so many, of those that are accepted.
pub fn sample(one_in: u32) -> impl Iterator<Item = Program> {
    let mut chosen = files("st_examples");
    chosen.extend(files("tests/cases").into_iter().filter(|it| hash(stem(it)).is_multiple_of(one_in)));
    chosen.into_iter().filter_map(|it| read(&it)).filter(|it| {
        let found = check(&it.sources, &it.options);
        found.iter().all(|it| it.severity != staunch_frontend::Severity::Error)
    })
}

/// The files of a folder of the project; one of several files of a program is the first one's part.
pub fn files(folder: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    list(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder), &mut files);
    files.retain(|it| !stem(it).contains('.'));
    files
}

fn list(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = fs::read_dir(folder).expect("a folder").flatten().map(|it| it.path()).collect();
    entries.sort();
    for path in entries {
        match path.extension().and_then(|it| it.to_str()) {
            _ if path.is_dir() && !path.ends_with("target") => list(&path, files),
            Some("st") => files.push(path),
            _ => {}
        }
    }
}

pub fn stem(path: &Path) -> &str {
    path.file_stem().and_then(|it| it.to_str()).unwrap_or_default()
}

fn hash(name: &str) -> u32 {
    name.bytes().fold(2_166_136_261, |hash, it| (hash ^ u32::from(it)).wrapping_mul(16_777_619)) >> 8
}

/// As the comments of a case, and the project of an example, have it.
pub fn read(path: &Path) -> Option<Program> {
    let text = fs::read_to_string(path).ok()?;
    let named = text.lines().map_while(|it| it.strip_prefix("//")).find_map(|it| it.trim().strip_prefix("dialect:"));
    let settings = fs::read_to_string(path.with_file_name("staunch.toml")).unwrap_or_default();
    let of_project = settings.lines().find_map(|it| it.strip_prefix("dialect = ")).map(|it| it.trim_matches('"'));
    let dialect = Dialect::named(named.or(of_project).map_or("iec", str::trim))?;
    let mut sources = Sources::default();
    sources.add(Source::decode("main.st", text.as_bytes()));
    let others = (2..).map(|it| path.with_extension(format!("{it}.st"))).map_while(|it| fs::read(it).ok());
    for (text, number) in others.zip(2..) {
        sources.add(Source::decode(format!("main.{number}.st"), &text));
    }
    Some(Program { name: stem(path).to_owned(), sources, options: Options { dialect, ..Options::default() } })
}
