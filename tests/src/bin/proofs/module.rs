//! A program's Rust as a module of a crate, together with others.

use staunch_ir::Program;
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text;
use staunch_tests::case::Case;
use std::fs;
use std::path::Path;

pub struct Printed {
    pub module: String,
    code: String,
    glue: String,
}

impl Printed {
    pub fn new(module: String, program: &Program) -> Self {
        let options = staunch_rust::Options::default();
        let map = map_text(program, &Layout::new(program));
        let glue = staunch_rust::emit_glue(program, "super::code", &map, &options);
        // Many programs are in one crate: their entry points are distinguished by their modules.
        Self { module, code: staunch_rust::emit(program, &options), glue: glue.replace("#[unsafe(no_mangle)]\n", "") }
    }

    pub fn is_safe(&self) -> bool {
        self.code.contains("#![forbid(unsafe_code)]\n")
    }

    pub fn has_floats(&self) -> bool {
        let words = |text: &str| text.contains("f32") || text.contains("f64");
        words(&self.code) || words(&self.glue)
    }

    pub fn write(&self, folder: &Path) -> Result<(), String> {
        let folder = folder.join(&self.module);
        fs::create_dir_all(&folder).map_err(|it| it.to_string())?;
        put(&folder.join("code.rs"), &self.code)?;
        put(&folder.join("glue.rs"), &self.glue)
    }
}

/// The program as it runs where nothing implements what is outside of it.
pub fn program(case: &Case) -> Option<Program> {
    let mut options = case.settings().options;
    options.is_run = true;
    staunch_frontend::compile(&case.sources(), &options).program
}

/// A file of modules in a folder, and their entry points in a list. `shared` is the path of `Entry`.
pub fn entries<'a>(
    modules: impl Iterator<Item = &'a str> + Clone,
    folder: &Path,
    shared: &str,
) -> Result<String, String> {
    let folder = fs::canonicalize(folder).map_err(|it| it.to_string())?;
    let folder = folder.display();
    let module = |it: &str| {
        format!(
            "mod {it} {{\n    #[path = \"{folder}/{it}/code.rs\"]\n    pub mod code;\n    \
             #[path = \"{folder}/{it}/glue.rs\"]\n    pub mod glue;\n}}\n"
        )
    };
    let entry = |it: &str| format!("    Entry {{ init: {it}::glue::staunch_init, scan: {it}::glue::staunch_scan }},\n");
    let (modules, entries): (String, String) = (modules.clone().map(module).collect(), modules.map(entry).collect());
    Ok(format!("//! Programs.\n\nuse {shared}::Entry;\n\n{modules}\npub const ENTRIES: &[Entry] = &[\n{entries}];\n"))
}

pub fn put(path: &Path, text: impl AsRef<[u8]>) -> Result<(), String> {
    fs::write(path, text).map_err(|it| format!("{}: {it}", path.display()))
}
