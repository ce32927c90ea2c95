//! The front end's folders are layers, and so are those of the comparison: each imports from those before it. No modules of a
//! crate import one another in a circle, but for those that are listed.

use staunch_tests::project;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const SYNTAX: &str = "compiler/syntax/src";
const SYNTAX_LAYERS: [&str; 9] =
    ["spelling", "vendor", "source", "diagnostic", "ast", "foreign", "lex", "parse", "format"];

const ROOT: &str = "compiler/frontend/src";

/// The folders and files at the root, from the lowest.
const LAYERS: [&str; 29] = [
    "added",
    "allow",
    "declared",
    "index",
    "testing",
    "start_up",
    "pooled",
    "automation_studio",
    "mutate",
    "start",
    "tasks",
    "dialect",
    "options",
    "log",
    "locate",
    "absent",
    "said_once",
    "chart",
    "enabled",
    "prelude",
    "names",
    "inherit",
    "types",
    "expr",
    "declare",
    "body",
    "library",
    "program",
    "lints",
];

const COMPARE: &str = "compiler/compare/src";
const COMPARE_LAYERS: [&str; 11] = [
    "request",
    "other",
    "program",
    "pair",
    "variants",
    "inputs",
    "difference",
    "search",
    "findings",
    "verdict",
    "compared",
];

const LSP: &str = "compiler/lsp/src";
const LSP_LAYERS: [&str; 8] = ["calls", "place", "uri", "host", "results", "project", "answers", "server"];

/// The crates whose modules import one another in no circle, and what is divided into a few files that do.
const CIRCLES: [(&str, &[&[&str]]); 9] = [
    (ROOT, &[]),
    (
        SYNTAX,
        &[
            &["diagnostic", "diagnostic::codes", "diagnostic::levels", "diagnostic::render"],
            &["parse::diagnostics", "parse::diagnostics::declared"],
            &["parse::doc", "parse::parser"],
        ],
    ),
    ("compiler/ir/src", &[&["interpret", "interpret::place"]]),
    ("compiler/rust/src", &[]),
    ("compiler/native/src", &[]),
    (COMPARE, &[]),
    (LSP, &[]),
    ("compiler/cli/src", &[]),
    ("runtime/host/src", &[&["trace", "trace::table"]]),
];

type Imports = BTreeMap<String, BTreeSet<String>>;

#[test]
fn a_layer_imports_from_those_below_it() {
    for (root, layers, least) in [
        (SYNTAX, SYNTAX_LAYERS.as_slice(), 100),
        (ROOT, &LAYERS, 200),
        (COMPARE, &COMPARE_LAYERS, 100),
        (LSP, &LSP_LAYERS, 20),
    ] {
        let checked = check_layers(&imports(root), layers);
        assert!(checked > least, "{root}: {checked}");
    }
}

/// How many imports there are, none of which leads up.
fn check_layers(imports: &Imports, layers: &[&str]) -> usize {
    let rank = |module: &str| {
        let layer = module.split("::").next().unwrap();
        layers.iter().position(|it| *it == layer).unwrap_or_else(|| panic!("`{layer}` is in no layer"))
    };
    let all: Vec<_> = imports.iter().flat_map(|(module, them)| them.iter().map(move |it| (module, it))).collect();
    let wrong: Vec<_> = all.iter().filter(|(module, import)| rank(import) > rank(module)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    all.len()
}

#[test]
fn no_modules_import_one_another_in_a_circle() {
    for (root, allowed) in CIRCLES {
        let allowed: BTreeSet<Vec<&str>> = allowed.iter().map(|it| it.to_vec()).collect();
        let imports = imports(root);
        assert!(imports.len() > 20, "{root}");
        assert_eq!(circles(&imports), allowed, "{root}");
    }
}

fn circles(imports: &Imports) -> BTreeSet<Vec<&str>> {
    let reached: BTreeMap<_, _> = imports.keys().map(|it| (it.as_str(), reach(imports, it))).collect();
    let mut circles = BTreeSet::new();
    for (module, all) in &reached {
        let back = |it: &&&str| reached[**it].contains(*module) && all.contains(**it);
        let circle: Vec<_> = reached.keys().filter(back).copied().collect();
        if circle.len() > 1 {
            circles.insert(circle);
        }
    }
    circles
}

fn reach<'i>(imports: &'i Imports, from: &str) -> BTreeSet<&'i str> {
    let (mut reached, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(module) = open.pop() {
        for next in &imports[module] {
            if reached.insert(next.as_str()) {
                open.push(next);
            }
        }
    }
    reached
}

/// For each module of a crate, tests aside, the modules of it that it names.
fn imports(root: &str) -> Imports {
    let mut texts = BTreeMap::new();
    read(&project().join(root), "", &mut texts);
    let known: BTreeSet<_> = texts.keys().cloned().collect();
    let found = texts.iter().map(|(module, text)| {
        let paths = paths(text).into_iter().filter_map(|path| meant(module, &path, &known));
        (module.clone(), paths.filter(|it| it != module).collect())
    });
    found.collect()
}

fn read(folder: &Path, prefix: &str, texts: &mut BTreeMap<String, String>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
        let name = name.trim_end_matches(".rs");
        let module = if prefix.is_empty() { name.to_owned() } else { format!("{prefix}::{name}") };
        match name {
            "tests" | "lib" | "main" => {}
            _ if path.is_dir() => read(&path, &module, texts),
            "mod" => drop(texts.insert(prefix.to_owned(), std::fs::read_to_string(path).unwrap())),
            _ => drop(texts.insert(module, std::fs::read_to_string(path).unwrap())),
        }
    }
}

/// Every path in a file that starts with `crate`, `super`, `self` or, after `use`, a module: those in
/// braces in full.
fn paths(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let code: String = code.lines().map(|it| it.split("//").next().unwrap()).collect::<Vec<_>>().join("\n");
    let mut paths = Vec::new();
    for start in starts(&code) {
        expand("", &code[start..], &mut paths);
    }
    paths
}

fn starts(code: &str) -> Vec<usize> {
    let boundary = |at: usize| !code[..at].ends_with(|it: char| it.is_alphanumeric() || it == '_' || it == ':');
    let mut starts: Vec<_> = ["crate::", "super::", "self::"]
        .iter()
        .flat_map(|word| code.match_indices(word).map(|(at, _)| at))
        .filter(|at| boundary(*at))
        .collect();
    starts.extend(code.match_indices("use ").filter(|(at, _)| boundary(*at)).map(|(at, _)| at + "use ".len()));
    starts
}

/// The paths of a use tree, and how much of the text it takes.
fn expand(before: &str, text: &str, paths: &mut Vec<String>) -> usize {
    let end = text.find(|it: char| !(it.is_alphanumeric() || it == '_' || it == ':')).unwrap_or(text.len());
    let path = format!("{before}{}", &text[..end]);
    if !text[end..].starts_with('{') || !path.ends_with("::") {
        paths.push(path);
        return end;
    }
    let mut at = end + 1;
    loop {
        at += text[at..].len() - text[at..].trim_start_matches([' ', '\n', ',']).len();
        if text[at..].starts_with('}') {
            return at + 1;
        }
        let taken = expand(&path, &text[at..], paths);
        // `as name`, or text that is not a path.
        let rest = text[at + taken..].find([',', '}']).unwrap_or(text.len() - at - taken);
        at += taken + rest;
        if at >= text.len() {
            return at;
        }
    }
}

/// The module that a path in `module` leads to, or into.
fn meant(module: &str, path: &str, known: &BTreeSet<String>) -> Option<String> {
    let mut parts: Vec<&str> = path.split("::").filter(|it| !it.is_empty()).collect();
    let mut full: Vec<&str> = module.split("::").collect();
    match *parts.first()? {
        "crate" => full.clear(),
        "self" => {}
        "super" => {
            while parts.first() == Some(&"super") {
                full.pop();
                parts.remove(0);
            }
        }
        first if known.contains(&format!("{module}::{first}")) => {}
        _ => return None,
    }
    full.extend(parts.iter().filter(|it| !matches!(**it, "crate" | "self")));
    (1..=full.len()).rev().map(|len| full[..len].join("::")).find(|it| known.contains(it))
}
