//! The output of a build script for cargo: lines on standard output.

use std::path::Path;

use crate::Failed;

#[derive(Debug, Default)]
pub struct Instructions {
    pub lines: Vec<String>,
}

impl Instructions {
    pub fn rerun_if_changed(&mut self, path: &Path) {
        self.lines.push(format!("cargo::rerun-if-changed={}", path.display()));
    }

    /// A message of any number of lines; cargo shows each line of it.
    pub fn error(&mut self, text: &str) {
        self.message("error", text);
    }

    pub fn warning(&mut self, text: &str) {
        self.message("warning", text);
    }

    fn message(&mut self, kind: &str, text: &str) {
        let lines = text.lines().map(str::trim_end).filter(|line| !line.is_empty());
        self.lines.extend(lines.map(|line| format!("cargo::{kind}={line}")));
    }

    pub fn failed(&mut self, verb: &str, path: &Path, error: &std::io::Error) -> Failed {
        self.error(&format!("cannot {verb} {}: {error}", path.display()));
        Failed
    }

    pub fn print(&self) {
        for line in &self.lines {
            println!("{line}");
        }
    }
}
