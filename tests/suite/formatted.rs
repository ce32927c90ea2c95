//! rustfmt leaves emitted Rust as it is: all that the cases emit, with names and without.

use staunch_rust::{Options, State, emit};
use staunch_tests::case::{self, Case};
use staunch_tests::cases;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn emitted_rust_is_as_rustfmt_lays_it_out() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("formatted");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder for the texts");
    // The settings of whoever has the text are not ours.
    fs::write(folder.join("rustfmt.toml"), "").expect("rustfmt's settings");
    let (cases, _) = case::discover(&cases());
    let files: Vec<PathBuf> = cases.iter().filter_map(|it| write(it, &folder)).collect();
    assert!(files.len() > 200, "only {} cases emit", files.len());
    // A crate includes them in its own edition.
    for edition in ["2021", "2024"] {
        let mut rustfmt = Command::new("rustfmt");
        rustfmt.args(["--check", "--edition", edition, "--config-path"]).arg(&folder).args(&files);
        let output = rustfmt.output().expect("rustfmt is a part of the toolchain");
        let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        let first = || text.lines().take(60).collect::<Vec<_>>().join("\n");
        assert!(output.status.success(), "{edition}: {}", first());
    }
}

/// Most functions are short enough to be laid out for certain; only others ask rustfmt to pass them over.
#[test]
fn most_functions_are_laid_out_by_rustfmts_rules() {
    let (cases, _) = case::discover(&cases());
    let texts = cases.iter().filter_map(|it| emitted(it, false));
    let count = |text: &str, word: &str| text.matches(word).count();
    // Items that are not functions are always ignored: a macro's call, and the table of objects.
    let others = ["#[rustfmt::skip]\nreference::shared", "#[rustfmt::skip]\nconst "];
    let (skipped, functions) = texts.fold((0, 0), |(skipped, functions), text| {
        let no_functions: usize = others.iter().map(|it| count(&text, it)).sum();
        (skipped + count(&text, "rustfmt::skip") - no_functions, functions + count(&text, "fn "))
    });
    assert!(skipped * 4 < functions, "{skipped} of {functions}");
}

fn write(case: &Case, folder: &Path) -> Option<PathBuf> {
    let path = folder.join(format!("{}.rs", case.module()));
    // A half of them with names.
    fs::write(&path, emitted(case, case.name.len().is_multiple_of(2))?).expect("a text is written");
    Some(path)
}

fn emitted(case: &Case, names: bool) -> Option<String> {
    let program = case.compile().1.program?;
    Some(emit(&program, &Options { state: State::Lean, names, ..Options::default() }))
}
