//! Structured Text in a Rust crate, by one call in its build script:
//!
//! ```no_run
//! // build.rs
//! staunch_build::compile("src/plc.st");
//! ```
//!
//! ```ignore
//! // src/main.rs
//! mod plc {
//!     staunch_runtime::include_st!("plc");
//! }
//! ```
//!
//! Mistakes in the source appear in cargo's output with file, line and caret.
#![forbid(unsafe_code)]

mod cargo;
mod files;

use std::path::{Path, PathBuf};

use staunch_frontend::{Severity, Source, Sources};
use staunch_rust::Shape;

pub use staunch_frontend::Dialect;

/// Compiles a file, or every source below a folder, to `$OUT_DIR/<its stem>.rs`.
///
/// Ends the build script with exit code 1 if the source is rejected.
pub fn compile(path: impl Into<PathBuf>) {
    let path = path.into();
    let build = Build::new();
    if path.is_dir() { build.folder(path) } else { build.file(path) }.compile();
}

/// What to compile, and how. All sources together are one program.
#[derive(Clone, Debug, Default)]
pub struct Build {
    paths: Vec<PathBuf>,
    name: Option<String>,
    runtime: Option<String>,
    options: staunch_frontend::Options,
}

/// Why there is no output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Failed;

impl Build {
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a source; relative to the crate's folder.
    #[must_use]
    pub fn file(mut self, path: impl Into<PathBuf>) -> Self {
        self.paths.push(path.into());
        self
    }

    /// Adds every `.st` and `.iecst` file below a folder.
    #[must_use]
    pub fn folder(self, path: impl Into<PathBuf>) -> Self {
        self.file(path)
    }

    /// Whose blocks a bare name means, in files that do not say it themselves.
    #[must_use]
    pub fn dialect(mut self, dialect: Dialect) -> Self {
        self.options.dialect = dialect;
        self
    }

    /// CODESYS `CTU` stops at its preset.
    #[must_use]
    pub fn ctu_stop_at_pv(mut self, stops: bool) -> Self {
        self.options.ctu_stop_at_pv = stops;
        self
    }

    /// The name for `include_st!`; the stem of the first source otherwise.
    #[must_use]
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// The path of the runtime crate, if it is not `staunch_runtime`.
    #[must_use]
    pub fn runtime(mut self, path: impl Into<String>) -> Self {
        self.runtime = Some(path.into());
        self
    }

    /// Compiles to `$OUT_DIR/<name>.rs`, and tells cargo when to do so again.
    ///
    /// Ends the build script with exit code 1 if the source is rejected or cannot be read.
    pub fn compile(&self) {
        let mut instructions = cargo::Instructions::default();
        let done = match std::env::var_os("OUT_DIR") {
            Some(folder) => self.compile_to(Path::new(&folder), &mut instructions),
            None => {
                instructions.error("OUT_DIR is not set: call this from a build script");
                Err(Failed)
            }
        };
        instructions.print();
        if done.is_err() {
            std::process::exit(1);
        }
    }

    fn compile_to(&self, folder: &Path, cargo: &mut cargo::Instructions) -> Result<(), Failed> {
        let sources = self.read(cargo)?;
        let compilation = staunch_frontend::compile(&sources, &self.options);
        for diagnostic in &compilation.diagnostics {
            let text = staunch_frontend::render(
                diagnostic,
                &sources,
                staunch_frontend::Format::Human,
                staunch_frontend::Style::default(),
            );
            match diagnostic.severity {
                Severity::Error => cargo.error(&text),
                Severity::Warning => cargo.warning(&text),
            }
        }
        let program = compilation.program.ok_or(Failed)?;
        let name = self.output_name();
        let mut options =
            staunch_rust::Options { shape: Shape::Include { module: name.clone() }, ..Default::default() };
        if let Some(runtime) = &self.runtime {
            options.runtime.clone_from(runtime);
        }
        let text = staunch_rust::emit(&program, &options);
        let path = folder.join(format!("{name}.rs"));
        std::fs::write(&path, text).map_err(|error| cargo.failed("write", &path, &error))
    }

    fn read(&self, cargo: &mut cargo::Instructions) -> Result<Sources, Failed> {
        let mut sources = Sources::default();
        for path in files::find(&self.paths, cargo)? {
            let bytes = std::fs::read(&path).map_err(|error| cargo.failed("read", &path, &error))?;
            sources.add(Source::decode(path.display().to_string(), &bytes));
        }
        if sources.files().is_empty() {
            cargo.error("there is no Structured Text to compile");
            return Err(Failed);
        }
        Ok(sources)
    }

    fn output_name(&self) -> String {
        let stem = || self.paths.first().and_then(|path| path.file_stem());
        let name = self.name.clone().or_else(|| stem().map(|it| it.to_string_lossy().into_owned()));
        name.unwrap_or_else(|| "plc".to_owned())
    }
}

#[cfg(test)]
mod tests;
