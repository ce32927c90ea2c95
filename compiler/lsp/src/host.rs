//! What the server asks of the machine it runs on.

use staunch_frontend::format::Style;
use staunch_frontend::{Levels, Options, Sources};
use std::path::{Path, PathBuf};

/// Finds the files of projects.
pub trait Host {
    /// The program that a file is a part of, as it is on disk. A file of no project is a program by itself.
    ///
    /// # Errors
    /// A sentence that says what is wrong: with the project's settings, or with a file that cannot be read.
    fn unit(&self, path: &Path) -> Result<Unit, String>;
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
}

impl Unit {
    /// The source that a file is.
    pub fn file(&self, path: &Path) -> Option<u16> {
        self.paths.iter().zip(0u16..).find(|it| it.0 == path).map(|it| it.1)
    }
}
