//! What `build.rs` is given: modules, mistakes with their places, levels of lints.

#![allow(clippy::unwrap_used)]

use super::*;

const GOOD: &str = "PROGRAM Main VAR x : INT; END_VAR x := x + 1; END_PROGRAM";

fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("staunch-build-{}-{name}", std::process::id()));
    for (file, text) in files {
        let path = folder.join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

#[test]
fn a_folder_becomes_a_module() {
    let folder =
        folder("good", &[("src/b/main.iecst", GOOD), ("src/a.ST", "TYPE T : INT; END_TYPE"), ("src/x.txt", "")]);
    let mut cargo = cargo::Instructions::default();
    let build = Build::new().folder(folder.join("src")).name("plant");
    assert_eq!(build.compile_to(&folder, &mut cargo), Ok(()));
    let text = std::fs::read_to_string(folder.join("plant.rs")).unwrap();
    assert!(text.contains("mod plant {") && text.contains("pub use plant::*;"), "{text}");
    let expected = ["src", "src/a.ST", "src/b", "src/b/main.iecst"];
    let expected = expected.map(|it| format!("cargo::rerun-if-changed={}", folder.join(it).display()));
    assert_eq!(cargo.lines, expected);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_mistake_is_shown_with_its_place() {
    let folder = folder("bad", &[("plc.st", "PROGRAM Main\nx := 1;\nEND_PROGRAM\n")]);
    let mut cargo = cargo::Instructions::default();
    assert_eq!(Build::new().file(folder.join("plc.st")).compile_to(&folder, &mut cargo), Err(Failed));
    let errors: Vec<_> = cargo.lines.iter().filter_map(|it| it.strip_prefix("cargo::error=")).collect();
    assert!(errors[0].starts_with("error[E"), "{errors:?}");
    assert!(errors.iter().any(|it| it.contains("plc.st:2:1")), "{errors:?}");
    assert!(errors.iter().any(|it| it.contains('^')), "{errors:?}");
    assert!(!folder.join("plc.rs").exists());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_missing_file_is_named() {
    let mut cargo = cargo::Instructions::default();
    let build = Build::new().file("no/such.st");
    assert_eq!(build.compile_to(Path::new("."), &mut cargo), Err(Failed));
    assert!(cargo.lines.iter().any(|it| it.contains("cannot read no/such.st")), "{:?}", cargo.lines);
}

#[test]
fn lints_have_levels_here_and_in_the_project_file() {
    let unused = "PROGRAM Main VAR a : INT; END_VAR ; END_PROGRAM";
    let made = |name: &str, project: &str, set: fn(Build) -> Build| {
        let folder = folder(name, &[("src/plc.st", unused), ("staunch.toml", project)]);
        let mut cargo = cargo::Instructions::default();
        let done = set(Build::new().folder(folder.join("src"))).compile_to(&folder, &mut cargo);
        std::fs::remove_dir_all(folder).unwrap();
        (done.is_ok(), cargo.lines.iter().any(|it| it.contains("W0501")))
    };
    assert_eq!(made("warns", "", |it| it), (true, true));
    assert_eq!(made("denied", "deny = [\"warnings\"]", |it| it), (false, true));
    assert_eq!(made("allowed", "allow = [\"W0501\"]", |it| it), (true, false));
    assert_eq!(made("allowed_here", "deny = [\"W0501\"]", |it| it.allow("W0501")), (true, false));
    assert_eq!(made("denied_here", "", |it| it.deny("warnings")), (false, true));
    assert_eq!(made("unknown", "", |it| it.warn("W9999")), (false, false));
    assert_eq!(made("bad", "dialekt = 1", |it| it), (false, false));
}

#[test]
fn the_project_file_names_the_dialect() {
    let wide = "PROGRAM Main VAR c : CTU; w : WORD; END_VAR c(RESET := FALSE, PV := 1); w := c.CV; END_PROGRAM";
    let folder = folder("dialect", &[("plc.st", wide), ("staunch.toml", "dialect = \"codesys\"")]);
    let build = Build::new().file(folder.join("plc.st"));
    let mut cargo = cargo::Instructions::default();
    assert_eq!(build.compile_to(&folder, &mut cargo), Ok(()), "{:?}", cargo.lines);
    assert!(cargo.lines.iter().any(|it| it.starts_with("cargo::rerun-if-changed=") && it.ends_with("staunch.toml")));
    assert_eq!(build.dialect(Dialect::Iec).compile_to(&folder, &mut cargo), Err(Failed));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn libraries_are_named_here_and_in_the_project_file() {
    let main = "PROGRAM Main VAR x : INT; END_VAR x := One(1) + Two(2); END_PROGRAM";
    let of = |name: &str, body: &str| format!("FUNCTION {name} : INT VAR_INPUT a : INT; END_VAR {body} END_FUNCTION");
    let (one, two, stub) = (of("One", "One := a;"), of("Two", "Two := a;"), of("Two", ""));
    let toml = "libraries = [\"lib/one.st\"]";
    let files = [("src/plc.st", main), ("lib/one.st", &one), ("more/two.st", &two), ("stub.st", &stub)];
    let folder = folder("libraries", &[&files[..], &[("staunch.toml", toml)]].concat());
    let build = Build::new().folder(folder.join("src"));
    let mut cargo = cargo::Instructions::default();
    let with_stub = build.clone().library(folder.join("stub.st"));
    assert_eq!(with_stub.compile_to(&folder, &mut cargo), Err(Failed));
    assert!(cargo.lines.iter().any(|it| it.contains("`Two` has no implementation")), "{:?}", cargo.lines);
    let mut cargo = cargo::Instructions::default();
    assert_eq!(build.library(folder.join("more")).compile_to(&folder, &mut cargo), Ok(()), "{:?}", cargo.lines);
    for name in ["lib/one.st", "more/two.st"] {
        let line = format!("cargo::rerun-if-changed={}", folder.join(name).display());
        assert!(cargo.lines.contains(&line), "{:?}", cargo.lines);
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_project_of_openplc_editor_is_compiled_as_it_is() {
    let project = r#"{ "meta": { "type": "plc-project" }, "data": { "libraries": [], "pous": [] } }"#;
    let main = "PROGRAM main VAR x : INT AT %MW0; END_VAR x := x + 1; END_PROGRAM";
    let files = [("tank/project.json", project), ("tank/pous/programs/main.st", main)];
    let folder = folder("openplc", &files);
    for source in [folder.join("tank"), folder.join("tank/project.json")] {
        let build = if source.is_dir() { Build::new().folder(&source) } else { Build::new().file(&source) };
        let mut cargo = cargo::Instructions::default();
        assert_eq!(build.compile_to(&folder, &mut cargo), Ok(()), "{:?}", cargo.lines);
        assert!(folder.join("tank.rs").is_file());
        std::fs::remove_file(folder.join("tank.rs")).unwrap();
        for name in ["project.json", "pous/programs/main.st"] {
            let line = format!("cargo::rerun-if-changed={}", folder.join("tank").join(name).display());
            assert!(cargo.lines.contains(&line), "{:?}", cargo.lines);
        }
        assert_eq!(build.dialect(Dialect::Codesys).compile_to(&folder, &mut cargo), Err(Failed));
    }
    std::fs::remove_dir_all(folder).unwrap();
}
