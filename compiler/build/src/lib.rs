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
pub mod listing;
mod project;

use std::path::{Path, PathBuf};

use staunch_frontend::{Level, Levels, Severity, Source, Sources};
use staunch_rust::{Shape, State};

pub use project::{Gpio, GpioLine, Modbus, Project};
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
///
/// Settings that are not made here are read from the `staunch.toml` in the folder of the first source, or in the nearest
/// folder above it that has one.
#[derive(Clone, Debug, Default)]
pub struct Build {
    paths: Vec<PathBuf>,
    name: Option<String>,
    runtime: Option<String>,
    names: bool,
    libraries: Vec<PathBuf>,
    dialect: Option<Dialect>,
    ctu_stop_at_pv: Option<bool>,
    openplc4_cd_rises: Option<bool>,
    s7_ld_edge: Option<bool>,
    f_trig_before_2024_12: Option<bool>,
    codesys_lreal_literals: Option<bool>,
    implicit_narrowing: Option<bool>,
    default_pool: Option<u32>,
    levels: Vec<(Level, String)>,
}

/// Why no output was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Failed;

impl Build {
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a source. The path is relative to the crate's folder.
    #[must_use]
    pub fn file(mut self, path: impl Into<PathBuf>) -> Self {
        self.paths.push(path.into());
        self
    }

    /// Adds every `.st` and `.iecst` file below a folder, and TwinCAT's `.TcPOU`, `.TcGVL`, `.TcDUT`, `.TcIO`, `.TcTLEO` and
    /// `.TcTTO`, Rockwell's `.L5X` and Siemens' `.scl`.
    #[must_use]
    pub fn folder(self, path: impl Into<PathBuf>) -> Self {
        self.file(path)
    }

    /// Adds a library: a file, a folder or a TwinCAT project that the program uses but that is not part of it.
    /// POUs in it may be without bodies, as long as the program does not call them.
    #[must_use]
    pub fn library(mut self, path: impl Into<PathBuf>) -> Self {
        self.libraries.push(path.into());
        self
    }

    /// The dialect of files that do not name one themselves; it decides which system's block a bare name means.
    #[must_use]
    pub fn dialect(mut self, dialect: Dialect) -> Self {
        self.dialect = Some(dialect);
        self
    }

    /// OpenPLC from v4.1: `CTD`, and `CD` of a `CTUD`, count on the rising edge, as with `openplc4-cd-edge = "rising"`.
    #[must_use]
    pub fn openplc4_cd_rises(mut self, rises: bool) -> Self {
        self.openplc4_cd_rises = Some(rises);
        self
    }

    /// CODESYS `CTU` stops at its preset.
    #[must_use]
    pub fn ctu_stop_at_pv(mut self, stops: bool) -> Self {
        self.ctu_stop_at_pv = Some(stops);
        self
    }

    /// S7 loads its counters when LD becomes TRUE, not as long as it is TRUE, as with `s7-ld = "edge"`.
    #[must_use]
    pub fn s7_ld_edge(mut self, is_edge: bool) -> Self {
        self.s7_ld_edge = Some(is_edge);
        self
    }

    /// OpenPLC `F_TRIG` sees an edge in a first call with FALSE, as before 2024-12.
    #[must_use]
    pub fn f_trig_before_2024_12(mut self, is_old: bool) -> Self {
        self.f_trig_before_2024_12 = Some(is_old);
        self
    }

    /// CODESYS: a number with a fraction is an LREAL even next to a REAL, as with `codesys-real-literals = "lreal"`.
    #[must_use]
    pub fn codesys_lreal_literals(mut self, are_lreal: bool) -> Self {
        self.codesys_lreal_literals = Some(are_lreal);
        self
    }

    /// In `codesys`, an integer is converted implicitly to one with fewer bits, with a lint.
    #[must_use]
    pub fn implicit_narrowing(mut self, narrows: bool) -> Self {
        self.implicit_narrowing = Some(narrows);
        self
    }

    /// The number of objects in the pool of a type that `__NEW` names and that declares no pool, as with `[pool] default`.
    #[must_use]
    pub fn default_pool(mut self, objects: u32) -> Self {
        self.default_pool = Some(objects);
        self
    }

    /// Allows a lint by its code; `warnings` means all.
    #[must_use]
    pub fn allow(self, lint: impl Into<String>) -> Self {
        self.level(Level::Allow, lint.into())
    }

    /// Reports a lint as a warning, even if `staunch.toml` allows it.
    #[must_use]
    pub fn warn(self, lint: impl Into<String>) -> Self {
        self.level(Level::Warn, lint.into())
    }

    /// Reports a lint as an error; `warnings` means all.
    #[must_use]
    pub fn deny(self, lint: impl Into<String>) -> Self {
        self.level(Level::Deny, lint.into())
    }

    fn level(mut self, level: Level, lint: String) -> Self {
        self.levels.push((level, lint));
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

    /// Gives the program `NAMES`, its variables by name at run time, and `named`, which reads them.
    #[must_use]
    pub fn names(mut self) -> Self {
        self.names = true;
        self
    }

    /// Compiles to `$OUT_DIR/<name>.rs`, and prints the files for cargo after whose changes it must compile again.
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
        let fail = |cargo: &mut cargo::Instructions, error: String| {
            cargo.error(&error);
            Failed
        };
        let project = self.project(cargo).map_err(|error| fail(cargo, error))?;
        let sources = self.read(&project, cargo)?;
        let (options, levels) = self.settings(&project, &sources).map_err(|error| fail(cargo, error))?;
        let compilation = staunch_frontend::compile(&sources, &options);
        let diagnostics: Vec<_> = compilation.diagnostics.into_iter().filter_map(|it| levels.apply(it)).collect();
        let is_rejected = diagnostics.iter().any(|it| it.severity == Severity::Error);
        for diagnostic in &diagnostics {
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
        let program = compilation.program.filter(|_| !is_rejected).ok_or(Failed)?;
        let name = self.output_name();
        let mut options = staunch_rust::Options {
            shape: Shape::Include { module: name.clone() },
            state: State::Lean,
            names: self.names,
            ..Default::default()
        };
        if let Some(runtime) = &self.runtime {
            options.runtime.clone_from(runtime);
        }
        let text = staunch_rust::emit(&program, &options);
        let path = folder.join(format!("{name}.rs"));
        std::fs::write(&path, text).map_err(|error| cargo.failed("write", &path, &error))
    }

    fn project(&self, cargo: &mut cargo::Instructions) -> Result<Project, String> {
        let first = self.paths.first().map_or(Path::new("."), PathBuf::as_path);
        let folder = if first.is_dir() { first } else { first.parent().unwrap_or(first) };
        let here = if folder == Path::new("") { Path::new(".") } else { folder };
        let found = Project::find(here)?;
        if let Some(project) = &found {
            cargo.rerun_if_changed(&project.folder.join("staunch.toml"));
        }
        Ok(found.unwrap_or_default())
    }

    /// The settings of this build, which take precedence over those of its project file.
    fn settings(&self, project: &Project, sources: &Sources) -> Result<(staunch_frontend::Options, Levels), String> {
        let options = staunch_frontend::Options {
            dialect: self
                .dialect
                .or(project.dialect()?)
                .or_else(|| Dialect::named(sources.dialect()?))
                .unwrap_or_default(),
            ctu_stop_at_pv: self.ctu_stop_at_pv.unwrap_or(project.ctu_stop_at_pv),
            openplc4_cd_rises: self.openplc4_cd_rises.unwrap_or(project.openplc4_cd_rises),
            s7_ld_edge: self.s7_ld_edge.unwrap_or(project.s7_ld_edge),
            f_trig_before_2024_12: self.f_trig_before_2024_12.unwrap_or(project.f_trig_before_2024_12),
            codesys_lreal_literals: self.codesys_lreal_literals.unwrap_or(project.codesys_lreal_literals),
            implicit_narrowing: self.implicit_narrowing.unwrap_or(project.implicit_narrowing),
            default_pool: self.default_pool.or(project.default_pool),
            ..Default::default()
        };
        let mut levels = project.levels()?;
        for (level, lint) in &self.levels {
            levels.add(*level, [lint.as_str()])?;
        }
        Ok((options, levels))
    }

    /// The program's own sources, and then those of its libraries.
    fn read(&self, project: &Project, cargo: &mut cargo::Instructions) -> Result<Sources, Failed> {
        let mut sources = Sources::default();
        let own = files::find(&self.paths, cargo)?;
        let libraries =
            project.libraries.iter().map(|it| project.folder.join(it)).chain(self.libraries.iter().cloned());
        let mut all: Vec<_> = own.iter().map(|it| (it.clone(), None)).collect();
        for (library, name) in listing::libraries(&self.paths, libraries) {
            all.extend(files::find(&[library], cargo)?.into_iter().map(|it| (it, Some(name.clone()))));
        }
        for (path, library) in all {
            let source = if self.paths.contains(&path) || path.exists() {
                let bytes = std::fs::read(&path).map_err(|error| cargo.failed("read", &path, &error))?;
                Source::decode(shown(&path), &bytes)
            } else {
                Source::absent(shown(&path))
            };
            sources.add(match library {
                Some(name) => source.of_library(&name),
                None => source,
            });
        }
        for list in self.paths.iter().filter(|it| listing::is_list(it)) {
            if let Ok((_, lists)) = listing::sources(list) {
                sources.refer(listing::references(&lists));
                sources.define(listing::definitions(&lists));
                sources.name_project(listing::project_name(&lists));
            }
        }
        if own.is_empty() {
            cargo.error("there is no Structured Text to compile");
            return Err(Failed);
        }
        Ok(sources)
    }

    fn output_name(&self) -> String {
        let stem = |path: &PathBuf| match listing::is_list(path) {
            true => Some(listing::name(path)),
            false => path.file_stem().map(|it| it.to_string_lossy().into_owned()),
        };
        let name = self.name.clone().or_else(|| stem(self.paths.first()?));
        name.unwrap_or_else(|| "plc".to_owned())
    }
}

/// A path for messages and the emitted Rust, which is the same on every machine.
fn shown(path: &Path) -> String {
    let crate_folder = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let inside = crate_folder.as_deref().and_then(|it| path.strip_prefix(it).ok());
    inside.unwrap_or(path).display().to_string().replace(std::path::MAIN_SEPARATOR, "/")
}

#[cfg(test)]
mod tests;
