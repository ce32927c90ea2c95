//! What crates.io asks of each crate that is to be published, and what its licences ask of its packages.

use crate::architecture::{metadata, name, texts};
use serde_json::Value as Json;
use staunch_tests::project;
use std::path::Path;
use std::process::Command;

fn published(metadata: &Json) -> impl Iterator<Item = &Json> {
    let is_ours = |it: &&Json| it["source"].is_null() && it["publish"].is_null();
    texts(metadata, "packages").filter(is_ours)
}

#[test]
fn each_published_crate_says_what_it_is() {
    let metadata = metadata();
    let mut count = 0;
    for package in published(&metadata) {
        count += 1;
        for field in ["description", "license", "repository", "readme", "rust_version"] {
            let text = package[field].as_str().unwrap_or_default();
            assert!(!text.is_empty(), "{} has no {field}", name(package));
        }
        for list in ["keywords", "categories"] {
            // crates.io takes at most five.
            assert!((1..=5).contains(&texts(package, list).count()), "{list} of {}", name(package));
        }
    }
    assert_eq!(count, 13);
}

#[test]
fn each_package_has_its_readme_and_licences() {
    let root = |file: &str| std::fs::read(project().join(file)).unwrap();
    for package in published(&metadata()) {
        let name = name(package);
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["package", "--list", "--offline", "--allow-dirty", "--package", &name]).current_dir(project());
        let output = cargo.output().unwrap();
        let listed = String::from_utf8_lossy(&output.stdout);
        for file in ["Cargo.toml", "README.md", "LICENSE-APACHE", "LICENSE-MIT"] {
            assert!(listed.lines().any(|it| it == file), "{name} has no {file}: {output:?}");
        }
        assert!(!listed.lines().any(|it| it.starts_with("tests/")), "{name}: {listed}");
        let folder = Path::new(package["manifest_path"].as_str().unwrap()).parent().unwrap();
        for file in ["LICENSE-APACHE", "LICENSE-MIT"] {
            assert_eq!(std::fs::read(folder.join(file)).unwrap(), root(file), "{name}/{file}");
        }
    }
}
