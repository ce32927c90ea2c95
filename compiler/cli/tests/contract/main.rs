//! The contract of `docs/cli.md`, held from outside: each test runs the command as a user would.

#![allow(clippy::unwrap_used)]

mod axunit;
mod build;
#[cfg(unix)]
mod cache;
mod check;
mod coverage;
mod debug;
#[path = "../support/editor.rs"]
mod editor;
mod external;
mod fmt;
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
mod gdb;
mod header;
#[cfg(unix)]
mod io;
mod lenses;
mod lists;
mod mutants;
mod near;
mod openplc;
mod page;
#[cfg(unix)]
mod power;
#[cfg(unix)]
mod realtime;
mod report;
mod retain;
mod run;
#[cfg(unix)]
mod safety;
mod stimulus;
mod tables;
mod tcunit;
mod unit_tests;
mod vendor;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A folder of its own for one test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("contract").join(name);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn with(name: &str, files: &[(&str, &str)]) -> Self {
        let folder = Self::new(name);
        files.iter().for_each(|(file, text)| folder.write(file, text));
        folder
    }

    fn write(&self, file: &str, text: impl AsRef<[u8]>) {
        fs::write(self.0.join(file), text).unwrap();
    }

    fn read(&self, file: &str) -> String {
        fs::read_to_string(self.0.join(file)).unwrap()
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
        command.args(arguments.split_whitespace()).current_dir(&self.0).env("NO_COLOR", "1");
        command
    }

    fn staunch(&self, arguments: &str) -> Ran {
        Ran::of(self.command(arguments).output().unwrap())
    }

    fn with_input(&self, arguments: &str, input: &str) -> Ran {
        let mut command = self.command(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
        Ran::of(child.wait_with_output().unwrap())
    }
}

/// What came out.
#[derive(Debug, PartialEq)]
struct Ran {
    code: i32,
    out: String,
    err: String,
}

impl Ran {
    fn of(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self { code: output.status.code().unwrap(), out: text(output.stdout), err: text(output.stderr) }
    }

    /// Standard output of a command that ended with `code`.
    #[track_caller]
    fn out(self, code: i32) -> String {
        assert_eq!(self.code, code, "{}\n{}", self.out, self.err);
        self.out
    }

    /// Standard error of a command that ended with `code`.
    #[track_caller]
    fn err(self, code: i32) -> String {
        assert_eq!(self.code, code, "{}\n{}", self.out, self.err);
        self.err
    }
}

/// Holds that `text` has each of `parts`.
#[track_caller]
fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
}

/// Whether a program that a test needs exists. Where all tools are expected, it is a mistake if it does not.
fn has_tool(command: &mut Command, package: &str) -> bool {
    let is_there = command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|it| it.success());
    if !is_there {
        assert!(std::env::var_os("CI").is_none(), "apt-get install {package}");
        println!("SKIPPED: no {package}");
    }
    is_there
}

const COUNTER: &str = "PROGRAM Main
VAR_INPUT pulse, reset : BOOL; END_VAR
VAR_OUTPUT full : BOOL; END_VAR
VAR parts : CTU; END_VAR
parts(CU := pulse, R := reset, PV := 2);
full := parts.Q;
END_PROGRAM
";
