//! The command, built together with the tests, and what they need besides.
//!
//! Where a tool is missing a test says `SKIPPED` on standard error; under `CI` it fails.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

pub fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// A folder of a test's own.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("targets").join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The command, built together with this test.
pub fn staunch() -> Command {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    let path = BUILT.get_or_init(|| {
        let test = std::env::current_exe().unwrap();
        let profile = test.parent().and_then(Path::parent).unwrap();
        let name = profile.file_name().unwrap().to_string_lossy().replace("debug", "dev");
        let mut cargo = Command::new(env!("CARGO"));
        // With the features of the whole workspace, as its tests are compiled: alone it would be compiled again.
        cargo.args(["build", "--quiet", "--workspace", "--bin", "staunch", "--profile", &name, "--target-dir"]);
        succeed(cargo.arg(profile.parent().unwrap()).current_dir(project()));
        profile.join("staunch")
    });
    let mut command = Command::new(path);
    command.env("STAUNCH_CACHE", folder("cache")).env_remove("CC").env("NO_COLOR", "1").current_dir(project());
    command
}

pub fn succeed(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Whether everything is available. Missing tools are reported past the test runner, which keeps the output of
/// tests that pass.
pub fn have(test: &str, tools: &[&str], target: &str) -> bool {
    let mut missing: Vec<String> = tools.iter().filter(|it| !is_installed(it)).map(|it| format!("`{it}`")).collect();
    if !has_library(target) {
        missing.push(format!("Rust's library for {target}"));
    }
    if missing.is_empty() {
        return true;
    }
    let text = format!("SKIPPED: {test}: there is no {}", missing.join(", no "));
    assert!(std::env::var_os("CI").is_none(), "{text}");
    let _ = writeln!(std::io::stderr(), "\n{text}\n");
    false
}

fn is_installed(tool: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|it| it.join(tool).is_file())
}

fn has_library(target: &str) -> bool {
    let output = Command::new("rustc").args(["--print", "target-libdir", "--target", target]).output();
    output.is_ok_and(|it| Path::new(String::from_utf8_lossy(&it.stdout).trim()).is_dir())
}
