//! Who may depend on whom, and where `unsafe` and `unwrap` may be.

use serde_json::Value as Json;
use staunch_tests::project;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What each crate may name in its `[dependencies]`. A name that ends in `*` is a family.
const EDGES: &[(&str, &[&str])] = &[
    ("staunch-runtime", &["libm", "ryu"]),
    ("staunch-runtime-abi", &["staunch-runtime"]),
    ("staunch-host", &["staunch-runtime"]),
    ("staunch-ir", &["staunch-runtime"]),
    (
        "staunch-syntax",
        &[
            "staunch-ir",
            "staunch-runtime",
            "quick-xml",
            "memchr",
            "rustc-hash",
            "chumsky",
            "strsim",
            "annotate-snippets",
        ],
    ),
    ("staunch-frontend", &["staunch-syntax", "staunch-ir", "staunch-runtime", "rustc-hash", "strsim"]),
    ("staunch-rust", &["staunch-ir", "staunch-runtime", "quote", "syn", "proc-macro2", "prettyplease"]),
    (
        "staunch-native",
        &[
            "staunch-ir",
            "staunch-runtime",
            "staunch-runtime-abi",
            "cranelift-*",
            "object",
            "gimli",
            "rustc-hash",
            "target-lexicon",
        ],
    ),
    // A second reading of the language sees the syntax tree, and nothing of the first.
    ("staunch-witness", &["staunch-frontend", "staunch-runtime"]),
    ("staunch-machine", &["staunch-native", "staunch-ir", "staunch-host", "staunch-runtime"]),
    ("staunch-compare", &["staunch-frontend", "staunch-machine", "staunch-ir", "staunch-host", "staunch-runtime"]),
    (
        "staunch-lsp",
        &[
            "staunch-frontend",
            "staunch-syntax",
            "staunch-runtime",
            "rustc-hash",
            "crossbeam-channel",
            "lsp-server",
            "gen-lsp-types",
            "serde",
            "serde_json",
        ],
    ),
    ("staunch-build", &["staunch-frontend", "staunch-ir", "staunch-rust", "toml"]),
    ("staunch-example-build-script", &["staunch-runtime", "staunch-build"]),
    ("staunch-example-external-rust", &["staunch-runtime", "staunch-build"]),
];

/// What a user's build script must never compile.
const KEPT_FROM_BUILD: [&str; 4] = ["cranelift", "cc", "cmake", "stacker"];

/// Folders whose code may be `unsafe`, each block with its `SAFETY:`.
const UNSAFE: &[&str] = &[
    "runtime/abi/",
    "runtime/host/src/allocations.rs",
    "runtime/host/src/attachments/gpio/chip.rs",
    "runtime/host/src/attachments/line/serial.rs",
    "runtime/host/src/attachments/mapping.rs",
    "runtime/host/src/compiled.rs",
    "runtime/host/src/retain/lock.rs",
    "runtime/host/src/realtime/system.rs",
    "runtime/host/src/realtime/watchdog.rs",
    "runtime/host/src/signal.rs",
    "runtime/host/src/terminal.rs",
    "compiler/native/src/jit.rs",
    "compiler/machine/src/lib.rs",
    "compiler/rust/src/glue.rs",
    // Texts of entry points, compiled on their own.
    "compiler/cli/src/toolchain.rs",
    "compiler/cli/src/rustc.rs",
    "compiler/rust/tests/",
    "tests/src/generated.rs",
    "tests/src/execute.rs",
    // What `.ci/proofs` links and runs on other machines.
    "tests/proofs/",
    "tests/fuzz/",
    "tests/src/bin/proofs/",
    // The test that forks, of a copy with mutants.
    "tests/mutants/ask.rs",
];

pub fn metadata() -> Json {
    let mut cargo = Command::new(env!("CARGO"));
    // What other platforms need has not been downloaded.
    cargo.args(["metadata", "--format-version", "1", "--offline", "--filter-platform", "host-tuple"]);
    let output = cargo.current_dir(project()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

pub fn texts<'j>(json: &'j Json, list: &str) -> impl Iterator<Item = &'j Json> {
    json[list].as_array().unwrap().iter()
}

/// Crates that users copy: what they may name is their own affair.
const EXAMPLES: &str = "staunch-example-";

/// For each crate of the project, its normal dependencies and those of its build script.
fn edges(metadata: &Json) -> BTreeMap<String, BTreeSet<String>> {
    let members: BTreeSet<_> = texts(metadata, "workspace_members").map(|it| it.as_str().unwrap()).collect();
    let packages = texts(metadata, "packages").filter(|it| members.contains(it["id"].as_str().unwrap()));
    let edges = packages.map(|package| {
        let named = texts(package, "dependencies").filter(|it| it["kind"] != "dev");
        (name(package), named.map(name).collect())
    });
    edges.collect()
}

pub fn name(json: &Json) -> String {
    json["name"].as_str().unwrap().to_owned()
}

fn allowed(edges: &[&str], name: &str) -> bool {
    edges.iter().any(|it| it.strip_suffix('*').map_or(*it == name, |family| name.starts_with(family)))
}

#[test]
fn crates_depend_as_the_design_says() {
    let found = edges(&metadata());
    for (name, allowed_edges) in EDGES {
        let named = found.get(*name).unwrap_or_else(|| panic!("the crate {name} does not exist"));
        let others: Vec<_> = named.iter().filter(|it| !allowed(allowed_edges, it)).collect();
        assert!(others.is_empty(), "{name} may not depend on {others:?}");
    }
    let known = |it: &&String| {
        EDGES.iter().any(|(name, _)| name == it)
            || ["staunch", "staunch-tests"].contains(&it.as_str())
            || it.starts_with(EXAMPLES)
    };
    let unknown: Vec<_> = found.keys().filter(|it| !known(it)).collect();
    assert!(unknown.is_empty(), "{unknown:?} are in no rule");
}

#[test]
fn only_the_native_back_end_names_cranelift() {
    for (name, dependencies) in edges(&metadata()) {
        let names_it = dependencies.iter().any(|it| it.starts_with("cranelift"));
        assert_eq!(names_it, name == "staunch-native", "{name}");
    }
}

#[test]
fn a_build_script_compiles_neither_cranelift_nor_c() {
    let metadata = metadata();
    let nodes: BTreeMap<_, _> =
        texts(&metadata["resolve"], "nodes").map(|it| (it["id"].as_str().unwrap(), it)).collect();
    let root = nodes.keys().copied().find(|it| package_name(it) == "staunch-build").unwrap();
    let (mut reached, mut open) = (BTreeSet::new(), vec![root]);
    while let Some(id) = open.pop() {
        if reached.insert(id) {
            let normal = |it: &&Json| texts(it, "dep_kinds").any(|kind| kind["kind"] != "dev");
            open.extend(texts(nodes[id], "deps").filter(normal).map(|it| it["pkg"].as_str().unwrap()));
        }
    }
    assert!(reached.len() > 10, "{reached:?}");
    let refused = |it: &str| KEPT_FROM_BUILD.iter().any(|kept| it == *kept || it.starts_with("cranelift"));
    let found: Vec<_> = reached.into_iter().map(package_name).filter(|it| refused(it)).collect();
    assert!(found.is_empty(), "staunch-build reaches {found:?}");
}

/// From `registry+…#name@1.0.0` or `path+file:///…/folder#name@1.0.0`.
fn package_name(id: &str) -> &str {
    let last = id.rsplit_once('#').unwrap().1;
    last.split_once('@').map_or_else(|| id.rsplit_once('#').unwrap().0.rsplit('/').next().unwrap(), |it| it.0)
}

#[test]
fn no_code_unwraps() {
    let offending = lines_with(|line| line.contains(".unwrap()"));
    assert!(offending.is_empty(), "{}", offending.join("\n"));
}

/// What may follow the sentence of a diagnostic, or of anything else that is shown: it is passed on or shown as a whole.
const LOOKS: [&str; 19] = [
    "starts_with",
    "ends_with",
    "contains",
    "find",
    "rfind",
    "split",
    "rsplit",
    "strip_",
    "trim",
    "matches",
    "replace",
    "lines",
    "chars",
    "bytes",
    "as_bytes",
    "char_indices",
    "get",
    "eq",
    "eq_ignore_ascii_case",
];

#[test]
fn no_code_of_the_compiler_looks_into_the_words_of_a_message() {
    let mut offending = Vec::new();
    for (path, text) in sources().into_iter().filter(|(path, _)| path.starts_with("compiler/")) {
        let code: String = text.split("#[cfg(test)]\nmod tests {").next().unwrap().split_whitespace().collect();
        for field in [".message", ".label", ".help", ".notes"] {
            let words = code.split(field).skip(1).filter(|rest| {
                let rest = ["()", ".as_str()", ".to_string()", ".clone()", ".as_deref()", ".as_ref()", "?"]
                    .iter()
                    .fold(*rest, |rest, passed| rest.strip_prefix(passed).unwrap_or(rest));
                let looks = rest.strip_prefix('.').is_some_and(|it| LOOKS.iter().any(|look| it.starts_with(look)));
                looks || rest.starts_with("==\"") || rest.starts_with("!=\"") || rest.starts_with('[')
            });
            offending.extend(words.map(|rest| format!("{path}: {field}{}", rest.get(..60).unwrap_or(rest))));
        }
    }
    assert!(offending.is_empty(), "a diagnostic's `subject` says what it is about: {offending:#?}");
    // Its type shows the words to nobody but those who lay a diagnostic out.
    let sentence = std::fs::read_to_string(project().join("compiler/syntax/src/diagnostic/sentence.rs")).unwrap();
    for open in ["pub fn ", "pub struct Sentence(pub", "pub String", "Deref", "AsRef", "Borrow", "for String"] {
        assert!(!sentence.contains(open), "`{open}` opens the words of a message");
    }
}

/// How many tables of the front end are keyed by a place in the text, where an id of the declaration is to be: this only falls.
const KEYED_BY_SPANS: usize = 46;

#[test]
fn the_front_end_has_no_more_tables_that_are_keyed_by_places() {
    let mut paths = Vec::new();
    list(&project().join("compiler/frontend/src"), &mut paths);
    let texts: Vec<_> = paths.iter().map(|it| std::fs::read_to_string(it).unwrap()).collect();
    let keyed = |place: &str| -> Vec<&str> {
        let keys = ["Map<", "Map<(", "Set<", "Set<("].map(|it| format!("{it}{place}"));
        let lines = texts.iter().flat_map(|it| it.lines());
        lines.filter(|line| keys.iter().any(|it| line.contains(it.as_str()))).collect()
    };
    let spans = keyed("Span");
    assert_eq!(spans.len(), KEYED_BY_SPANS, "more of them need ids; with fewer, lower the number: {spans:#?}");
    // The column of a `Location` ends at 65,535: it is for people. The tables that are left are of expressions.
    let locations = keyed("Location");
    assert!(locations.iter().all(|it| it.contains("pub written: ")) && locations.len() == 1, "{locations:#?}");
}

#[test]
fn unsafe_stands_where_it_may() {
    let is_unsafe = |line: &str| {
        let words = line.split(|it: char| !it.is_alphanumeric() && it != '_');
        words.clone().any(|it| it == "unsafe")
            && !line.contains("\"unsafe\"")
            && !line.contains(".replace(")
            && !line.contains("unsafe_code")
            && !line.trim_start().starts_with("//")
    };
    let found = lines_with(is_unsafe);
    let offending: Vec<_> = found.iter().filter(|it| !UNSAFE.iter().any(|path| it.starts_with(path))).collect();
    assert!(offending.is_empty(), "{offending:#?}");
    assert!(!found.is_empty());
}

#[test]
fn crates_without_unsafe_forbid_it() {
    for (path, text) in sources() {
        let is_root = path.ends_with("src/lib.rs") || path.ends_with("src/main.rs");
        let folder = path.split("src/").next().unwrap();
        let may = UNSAFE.iter().any(|it| it.starts_with(folder));
        if is_root && !may && folder.starts_with("compiler") && folder != "compiler/cli/" {
            assert!(text.contains("#![forbid(unsafe_code)]"), "{path} does not forbid unsafe code");
        }
    }
}

/// `path:line: text` of each line of code, outside tests, that `wanted` picks.
fn lines_with(wanted: impl Fn(&str) -> bool) -> Vec<String> {
    let mut found = Vec::new();
    for (path, text) in sources() {
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        let lines = code.lines().enumerate().filter(|(_, line)| wanted(line));
        found.extend(lines.map(|(at, line)| format!("{path}:{}: {}", at + 1, line.trim())));
    }
    found
}

/// Path and text of the project's Rust, without tests.
fn sources() -> Vec<(String, String)> {
    let mut paths = Vec::new();
    for folder in ["compiler", "runtime", "tests"] {
        list(&project().join(folder), &mut paths);
    }
    let shown = |it: &Path| it.strip_prefix(project()).unwrap().to_string_lossy().replace('\\', "/");
    let all = paths.iter().map(|it| (shown(it), std::fs::read_to_string(it).unwrap()));
    all.filter(|(path, _)| !is_test(path)).collect()
}

fn is_test(path: &str) -> bool {
    ["/tests/", "/tests.rs", "/suite/", "fixture.rs"].iter().any(|it| path.contains(it))
        || path == "tests/suite/main.rs"
}

fn list(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        let name = entry.file_name();
        match path.is_dir() {
            true if name != "target" && name != "cases" => list(&path, paths),
            true => {}
            false if path.extension().is_some_and(|it| it == "rs") => paths.push(path),
            false => {}
        }
    }
}

/// A file that others include as text is not a module.
const INCLUDED: [&str; 1] = ["compiler/rust/tests/support/show.rs"];

#[test]
fn every_module_says_what_it_is() {
    let mut found = 0;
    for root in ["compiler", "runtime", "st_examples", "tests/src", "tests/suite", "tests/witness", "tests/mutants"] {
        let mut waiting = vec![project().join(root)];
        while let Some(path) = waiting.pop() {
            if path.is_dir() {
                let inner = std::fs::read_dir(&path).unwrap().map(|it| it.unwrap().path());
                waiting.extend(inner.filter(|it| !it.ends_with("target")));
            } else if path.extension().is_some_and(|it| it == "rs") && !INCLUDED.iter().any(|it| path.ends_with(it)) {
                let text = std::fs::read_to_string(&path).unwrap();
                assert!(
                    text.starts_with("//!"),
                    "{}: a module begins with a line that says what it is",
                    path.display()
                );
                found += 1;
            }
        }
    }
    assert!(found > 300, "only {found} modules");
}
