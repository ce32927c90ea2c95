//! What the tests share: a folder of files for each of them, and the command on what is in it.

use std::path::PathBuf;
use std::process::{Command, Output};

/// The command, on programs that are in this folder.
pub fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.arg("compare").env("NO_COLOR", "1");
    command
}

/// The exit code, and all that is printed.
pub fn compare(arguments: &[&str]) -> (Option<i32>, String) {
    let output = command().args(arguments).output().expect("the command starts");
    (output.status.code(), printed(&output))
}

pub fn printed(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|it| String::from_utf8_lossy(it).into_owned()).concat()
}

/// The files of one module of tests.
#[derive(Clone, Copy)]
pub struct Folder(pub &'static str);

impl Folder {
    /// Where they are.
    pub fn path(self) -> PathBuf {
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("comparing").join(self.0);
        std::fs::create_dir_all(&path).expect("a folder for the programs");
        path
    }

    /// A file, by its path.
    pub fn written(self, name: &str, text: &str) -> String {
        let path = self.path().join(name);
        std::fs::create_dir_all(path.parent().expect("it is in a folder")).expect("a folder");
        std::fs::write(&path, text).expect("a file");
        path.display().to_string()
    }
}
