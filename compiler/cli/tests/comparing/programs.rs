//! What the tests share: a folder of files for each of them, and the command on what is in it.

use std::path::{Path, PathBuf};
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

/// The programs that are files of this repository.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/compare")
}

/// The command there, with words that blanks part.
pub fn run(arguments: &str) -> Output {
    let mut command = command();
    command.args(arguments.split_whitespace()).current_dir(folder());
    if !arguments.contains("--budget") {
        // Tests are built without optimisation; what they look for is found soon.
        command.args(["--budget", "1000000"]);
    }
    command.output().expect("the command starts")
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// What is printed where a difference is found.
pub fn difference(arguments: &str) -> String {
    let output = run(arguments);
    let out = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{arguments}\n{out}{}", text(&output.stderr));
    out
}

/// A file for [`run`].
pub fn written(name: &str, source: &str) -> PathBuf {
    Folder("written").written(name, source).into()
}

/// The exit code, and what is printed of the verdict, with a budget that suffices here.
pub fn moved(path: &str, from: &str, to: &str, more: &[&str]) -> (Option<i32>, String) {
    let budget = if more.contains(&"--budget") { "20000" } else { "400000" };
    let more = more.iter().filter(|it| !["--budget", "20000"].contains(*it));
    let output = command()
        .args([path, "--from", from, "--to", to, "-A", "warnings", "--budget", budget])
        .args(more)
        .output()
        .expect("the command starts");
    (output.status.code(), text(&output.stdout))
}

/// Nothing happens but scans.
pub const NO_EVENT: &str = "no run\nno restart\nno reset\n";

/// `En` of a block without ENO: on IEC and OPENPLC it stops the body, so that `off` stays FALSE.
pub const ENABLED: &str = "FUNCTION_BLOCK Pump
VAR_INPUT En : BOOL; END_VAR
VAR_OUTPUT Off : BOOL; END_VAR
Off := NOT En;
END_FUNCTION_BLOCK
PROGRAM p
VAR_INPUT on : BOOL; END_VAR
VAR pump : Pump; END_VAR
VAR_OUTPUT off : BOOL; END_VAR
pump(En := on);
off := pump.Off;
END_PROGRAM
";

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
        // Tests run at once: one must not read what another is writing.
        let aside = self.path().join(format!("{:?}", std::thread::current().id()));
        std::fs::write(&aside, text).expect("a file");
        std::fs::rename(&aside, &path).expect("a file");
        path.display().to_string()
    }

    /// A PROGRAM of these lines, by its path.
    pub fn program(self, name: &str, lines: &str) -> String {
        self.written(&format!("{name}.st"), &format!("PROGRAM p\n{lines}\nEND_PROGRAM\n"))
    }

    /// The exit code, and what is printed of the verdict on a program.
    pub fn compare(self, name: &str, source: &str, arguments: &[&str]) -> (Option<i32>, String) {
        let output = self.output(name, source, arguments);
        (output.status.code(), text(&output.stdout))
    }

    /// All that comes out.
    pub fn output(self, name: &str, source: &str, arguments: &[&str]) -> Output {
        let path = self.written(&format!("{name}.st"), source);
        command().arg(&path).args(arguments).output().expect("it starts")
    }
}
