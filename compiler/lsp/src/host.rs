//! What the server asks of the machine it runs on.

use staunch_frontend::format::Style;
use staunch_frontend::{Diagnostic, Dialect, Levels, Options, Sources};
use std::path::{Path, PathBuf};

/// Work that takes a while, for a thread of its own.
pub type Work<T> = Box<dyn FnOnce() -> Result<T, String> + Send>;

/// What came of a test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TestResult {
    pub title: String,
    /// `passed`, or what went wrong, in a line.
    pub outcome: String,
}

/// Finds the files of projects, and runs them as they are on disk.
pub trait Host {
    /// The program that a file is a part of, as it is on disk. A file of no project is a program by itself, and one of a project that
    /// cannot be read.
    ///
    /// # Errors
    /// A sentence that says what is wrong: with the project's settings, or with a file that cannot be read.
    fn unit(&self, path: &Path) -> Result<Unit, String>;

    /// The work of running a test of the program that a file is a part of.
    ///
    /// # Errors
    /// A sentence, as above.
    fn test(&self, path: &Path, title: &str) -> Result<Work<Vec<TestResult>>, String>;

    /// The work of comparing the program that a file is a part of with itself on another system: the verdict, in a line.
    ///
    /// # Errors
    /// A sentence, as above.
    fn compare(&self, path: &Path, from: Dialect, to: Dialect) -> Result<Work<String>, String>;
}

/// The files that are one program, with the settings by which they are read.
#[derive(Clone, Debug)]
pub struct Unit {
    pub sources: Sources,
    /// For each of the sources, where it is: absolute.
    pub paths: Vec<PathBuf>,
    pub options: Options,
    pub levels: Levels,
    pub layout: Style,
    /// Where nobody has chosen the dialect.
    pub choice: Option<Choice>,
    /// Why the project could not be read, where this is the file alone.
    pub problem: Option<String>,
}

/// A dialect that may be another one.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Those that accept sources which have these diagnostics in that of the options.
    pub accepting: fn(&Sources, &Options, &[Diagnostic]) -> Vec<Dialect>,
    /// The file that says which one it is, and whether it exists.
    pub settings: PathBuf,
    pub has_settings: bool,
}

impl Unit {
    /// The source that a file is.
    pub fn file(&self, path: &Path) -> Option<u16> {
        self.paths.iter().zip(0u16..).find(|it| it.0 == path).map(|it| it.1)
    }
}
